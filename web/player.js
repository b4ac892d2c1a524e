// Chooses the picture on the canvas: the orbit stream while playing, previews while the view moves by hand,
// refined stills at rest. A scene that is new to the canvas starts with the cheapest picture.

import { getFrame, isAbort } from "./api.js";
import { Backoff } from "./backoff.js";
import { amount, Cost } from "./cost.js";
import { playStream } from "./orbit-stream.js";
import { Pace } from "./pace.js";
import { decodeUnlessAborted, Refiner } from "./refine.js";
import { frameUrl, orbitUrl } from "./urls.js";
import { decode } from "./view.js";

const REST_MS = 100; // time without input until the view is at rest
const RESTART_MS = 150; // debounce time of size and speed changes
const PREVIEW_MS = 75; // target latency of previews, from request to display
const FRAME_MS = 60; // target render time of orbit frames before the first measurement
const DRAFT_MS = 100; // a draft precedes a first picture that takes longer

// `on` has
//   movingPictures(purpose, view) -> pictures, each cheaper than the one before, [] without a scene
//   pictureAtRest(view) -> {picture, isRequested} or null. isRequested: the user has chosen the samples
//   repost() -> promise; posts the scene again and refreshes the player
//   drawn(kind, figures), retrying(error, seconds), failed(error), progress(figures or null)
//   stopped() when another picture is pending
//   settled() when the view no longer moves
//   finished() when the picture is final
export class Player {
  speed = 20; // degrees per second
  streamFrames = 3600;
  #camera;
  #view;
  #on;
  #isPlaying = false;
  #isVisible = true;
  #isHeld = false; // true during a drag: no stream until it ends
  #isMoving = false; // true while the view moves by hand, and for REST_MS after the last input
  #lastInput = 0;
  #lastTick = 0;
  #work = null; // {kind, key, abort} of the current stream or still
  #shown = ""; // URL of the still or preview on the canvas, "" for a stream or draft
  #shownSamples = 0; // samples of the picture on the canvas
  #shownLocation; // URL that reproduces a picture rendered to a budget
  #shownFigures; // figures of the picture on the canvas
  #shownId = ""; // id of the scene on the canvas
  #cost = new Cost(); // render times
  #delay = new Cost(); // latencies of previews, from request to display
  #refiner = new Refiner(this.#cost);
  #isPreviewing = false;
  #epoch = 0; // counts invalidations, to drop late previews
  // Earliest time of the next preview after a failure.
  #previewFrom = 0;
  #pace = new Pace();
  #backoff = new Backoff();
  #timer = 0;
  #reposts = 0; // reposts of the scene since the last picture

  constructor(camera, view, on) {
    this.#camera = camera;
    this.#view = view;
    this.#on = on;
    document.addEventListener("visibilitychange", () => this.#showTab(document.visibilityState === "visible"));
    this.#isVisible = document.visibilityState === "visible";
    addEventListener("online", () => this.retryNow());
  }

  set playing(playing) {
    this.#isPlaying = playing;
    this.refresh();
  }

  // Shows previews of the moving view until it rests.
  input() {
    this.#lastInput = performance.now();
    if (this.#isMoving) return;
    this.#isMoving = true;
    this.#stop();
    this.#lastTick = this.#lastInput;
    requestAnimationFrame((now) => this.#tick(now));
  }

  hold(held) {
    this.#isHeld = held;
    if (held) this.input();
    else this.refresh();
  }

  // Shows the picture or stream for the current scene, size and options.
  refresh() {
    clearTimeout(this.#timer);
    if (this.#isMoving) return;
    if (!this.#isVisible) return this.#stop();
    if (this.#isPlaying && !this.#isHeld) this.#startStream();
    else this.#startStill();
  }

  refreshSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), RESTART_MS);
  }

  retryNow() {
    this.#backoff.reset();
    this.refresh();
  }

  // Makes the next refresh fetch the picture even if it is unchanged.
  invalidate() {
    this.#stop();
    this.#shown = this.#shownId = "";
    this.#epoch += 1;
  }

  // Picture to share: the picture on the canvas if it shows the view at rest, else the final picture of the
  // refinement.
  get picture() {
    const { picture, isRequested } = this.#on.pictureAtRest(this.#camera.goal);
    const shown = this.#shownPicture(picture);
    if (shown) return { ...shown, location: this.#shownLocation };
    return hasBudget(picture) ? picture : this.#refiner.last(picture, isRequested);
  }

  // Returns the picture on the canvas if it is `picture` with any number of samples, else null.
  #shownPicture(picture) {
    const shown = { ...picture, samples: this.#shownSamples };
    return frameUrl(shown) === this.#shown ? shown : null;
  }

  #showTab(visible) {
    this.#isVisible = visible;
    this.refresh();
  }

  #tick(now) {
    const seconds = Math.max(0, Math.min(0.1, (now - this.#lastTick) / 1000));
    const gliding = this.#camera.step(seconds, this.#view.box.height);
    this.#lastTick = now;
    if (gliding || now - this.#lastInput < REST_MS) {
      this.#preview();
      requestAnimationFrame((next) => this.#tick(next));
      return;
    }
    this.#isMoving = false;
    this.#on.settled();
    this.refresh();
  }

  // Shows a preview of the current view, unless another preview is in flight.
  async #preview() {
    const start = performance.now();
    const waits = this.#isPreviewing || start < this.#previewFrom;
    const picture = waits ? null : this.#previewPicture();
    const url = picture && frameUrl(picture);
    if (!url || url === this.#shown) return;
    this.#isPreviewing = true;
    const epoch = this.#epoch;
    try {
      const frame = await getFrame(url);
      this.#cost.note(picture, frame.stats.renderMs);
      const bitmap = await decode(frame.png);
      if (this.#isMoving && epoch === this.#epoch) this.#draw(url, bitmap, picture, "preview", frame.stats);
      else bitmap.close();
      this.#delay.note(picture, performance.now() - start);
    } catch (error) {
      // The still that follows fails in the same way and reports the error.
      this.#previewFrom = performance.now() + 1000 * (error.retryAfterSeconds ?? 1);
    } finally {
      this.#isPreviewing = false;
    }
  }

  // Returns the finest picture expected within PREVIEW_MS, or null without a scene.
  #previewPicture() {
    const pictures = this.#on.movingPictures("preview", this.#camera.view);
    if (pictures.length === 0) return null;
    const cost = this.#delay.knows(pictures[0]) ? this.#delay : this.#cost;
    return pictures[cost.firstWithin(pictures, PREVIEW_MS)];
  }

  // Shows a draft of a scene that is new to the canvas, unless the `first` picture is fast enough.
  async #draft(first, signal) {
    if (this.#shownId === first.id || this.#cost.expectedMs(first) <= DRAFT_MS) return;
    const pictures = this.#on.movingPictures("preview", this.#camera.view);
    const picture = pictures[this.#cost.firstWithin(pictures, DRAFT_MS)];
    const { png, stats } = await getFrame(frameUrl(picture), signal);
    this.#cost.note(picture, stats.renderMs);
    this.#draw("", await decodeUnlessAborted(signal, png), picture, "preview", stats);
  }

  #startStill() {
    const rest = this.#on.pictureAtRest(this.#camera.view);
    if (!rest) return;
    // While an orbit is held, shows one sample without a budget.
    const picture = this.#isPlaying ? { ...rest.picture, samples: 1, seconds: 0, error: 0 } : rest.picture;
    const key = frameUrl(picture);
    if (this.#work?.kind === "still" && this.#work.key === key) return;
    this.#stop();
    const { width, height, samples } = this.#shownPicture(picture) ?? {};
    if (width) this.#on.drawn("still", { ...this.#shownFigures, width, height });
    const shown = samples <= picture.samples ? samples : 0; // 0 also if more samples are shown than wanted
    this.#run("still", key, async (signal) => {
      await this.#draft({ ...picture, samples: 1 }, signal);
      if (hasBudget(picture)) await this.#renderToBudget(picture, signal);
      else if (shown < picture.samples)
        await this.#refiner.refineToEnd(picture, { shown, isRequested: rest.isRequested }, signal, {
          draw: (each, bitmap, stats) => this.#draw(frameUrl(each), bitmap, each, "still", stats),
          progress: this.#on.progress,
        });
      this.#on.finished();
    });
  }

  // Shows the picture that the service renders to a budget.
  async #renderToBudget(picture, signal) {
    if (this.#shown === frameUrl(picture)) return;
    const { png, stats } = await getFrame(frameUrl(picture), signal);
    const bitmap = await decodeUnlessAborted(signal, png);
    const plan = new URLSearchParams(stats.location?.split("?")[1]);
    const samples = Number(plan.get("samples") ?? picture.own); // a plan without samples uses the scene's
    this.#draw(frameUrl(picture), bitmap, picture, "still", { ...stats, samples });
    this.#shownLocation = stats.location;
  }

  #startStream() {
    const pictures = this.#on.movingPictures("stream", this.#camera.view);
    if (pictures.length === 0) return;
    const [picture] = pictures;
    const key = JSON.stringify({ ...picture, azimuth: 0, time: 0, speed: this.speed });
    if (this.#work?.kind === "stream" && this.#work.key === key) return;
    this.#stop();
    this.#pace.play(picture, this.#cost.firstWithin(pictures, FRAME_MS));
    this.#run("stream", key, (signal) => this.#stream(signal));
  }

  // Plays streams one after another. A stream ends after `streamFrames` frames or when the pace changes.
  async #stream(signal) {
    const pace = this.#pace;
    for (;;) {
      const pictures = this.#on.movingPictures("stream", this.#camera.view);
      const costs = pictures.map(amount);
      pace.level = Math.min(pace.level, pictures.length - 1);
      const picture = pictures[pace.level];
      const rate = {
        frames: this.streamFrames,
        fps: pace.fps,
        step: this.speed / pace.fps,
        timeStep: picture.isAnimated ? 1 / pace.fps : 0,
      };
      pace.restart();
      await playStream(orbitUrl(picture, rate), signal, (bitmap, figures) => {
        this.#camera.follow(figures.azimuth, figures.time);
        this.#cost.note(picture, figures.renderMs);
        this.#draw("", bitmap, picture, "stream", figures);
        const workMs = Math.max(figures.renderMs, figures.encodeMs);
        return !pace.note(performance.now(), workMs, this.speed, costs);
      });
    }
  }

  #draw(url, bitmap, picture, kind, figures) {
    const { width, height } = bitmap;
    this.#view.draw(bitmap, picture.fills, kind === "still" && this.#camera.damped);
    this.#shown = url;
    this.#shownId = picture.id;
    this.#shownSamples = picture.samples;
    this.#shownLocation = undefined;
    this.#shownFigures = figures;
    this.#reposts = 0;
    this.#backoff.reset();
    if (kind !== "still") this.#on.progress(null);
    const draft = kind === "preview" || (kind === "stream" && this.#pace.level > 0);
    this.#on.drawn(kind, { ...figures, width, height, draft });
  }

  async #run(kind, key, task) {
    const work = { kind, key, abort: new AbortController() };
    this.#work = work;
    this.#on.progress({});
    try {
      await task(work.abort.signal);
    } catch (error) {
      if (this.#work === work && !isAbort(error)) this.#fail(error);
    } finally {
      if (this.#work === work) this.#work = null;
      if (!this.#work) this.#on.progress(null);
    }
  }

  #stop() {
    this.#work?.abort.abort();
    this.#work = null;
    this.#on.progress(null);
    this.#on.stopped();
  }

  async #fail(error) {
    if (error.status === 404 && this.#reposts < 2) {
      this.#reposts += 1;
      try {
        return await this.#on.repost();
      } catch (second) {
        error = second;
      }
    }
    if (!error.retryable) return this.#on.failed(error);
    const seconds = this.#backoff.after(error);
    this.#on.retrying(error, seconds);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), 1000 * seconds);
  }
}

const hasBudget = ({ seconds, error }) => Boolean(seconds || error);
