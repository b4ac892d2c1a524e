// Chooses the picture on the canvas: the orbit stream while playing, previews while the view moves by hand,
// refined stills at rest. A scene that is new to the canvas starts with the cheapest picture.

import { get_frame, is_abort } from "./api.js";
import { Backoff } from "./backoff.js";
import { amount, Cost } from "./cost.js";
import { play_stream } from "./orbit_stream.js";
import { Pace } from "./pace.js";
import { decode_unless, Refiner } from "./refine.js";
import { frame_url, orbit_url } from "./urls.js";
import { decode } from "./view.js";

const kRestMs = 100; // time without input until the view is at rest
const kRestartMs = 150; // debounce time of size and speed changes
const kPreviewMs = 75; // target latency of previews, from request to display
const kFrameMs = 60; // target render time of orbit frames before the first measurement
const kDraftMs = 100; // a draft precedes a first picture that takes longer

// `on` has
//   moving(purpose, view) -> pictures, each cheaper than the one before, [] without a scene
//   at_rest(view) -> {picture, asked} or null
//   missing() -> promise; posts the scene again
//   stats(kind, figures), waiting(error, seconds), problem(error), progress(figures or null)
//   stale() if another picture is due
//   settled() if the view no longer moves
//   rested() if the picture is final
export class Player {
  speed = 20; // degrees per second
  stream_frames = 3600;
  #camera;
  #view;
  #on;
  #playing = false;
  #visible = true;
  #held = false; // true during a drag: no stream until it ends
  #moving = false; // true while the view moves by hand, and kRestMs longer
  #last_input = 0;
  #last_tick = 0;
  #work = null; // {kind, key, abort} of the current stream or still
  #shown = ""; // address of the still on the canvas
  #shown_samples = 0; // samples of the picture on the canvas
  #shown_location; // address that reproduces a picture made to a budget
  #shown_figures; // figures of the picture on the canvas
  #shown_id = ""; // id of the scene on the canvas
  #cost = new Cost(); // render times
  #delay = new Cost(); // latencies of previews, from request to display
  #refiner = new Refiner(this.#cost);
  #preview_busy = false;
  #epoch = 0; // counts invalidations, to drop late previews
  // Earliest time of the next preview after a failure.
  #preview_from = 0;
  #pace = new Pace();
  #backoff = new Backoff();
  #timer = 0;
  #reposts = 0; // reposts of the scene since the last picture

  constructor(camera, view, on) {
    this.#camera = camera;
    this.#view = view;
    this.#on = on;
    document.addEventListener("visibilitychange", () =>
      this.#show_tab(document.visibilityState === "visible"),
    );
    this.#visible = document.visibilityState === "visible";
    addEventListener("online", () => this.retry_now());
  }

  set playing(playing) {
    this.#playing = playing;
    this.refresh();
  }

  // Shows previews of the moving view until it rests.
  input() {
    this.#last_input = performance.now();
    if (this.#moving) return;
    this.#moving = true;
    this.#stop();
    this.#last_tick = this.#last_input;
    requestAnimationFrame((now) => this.#tick(now));
  }

  hold(held) {
    this.#held = held;
    if (held) this.input();
    else this.refresh();
  }

  // Shows the picture or stream for the current scene, size and options.
  refresh() {
    clearTimeout(this.#timer);
    if (this.#moving) return;
    if (!this.#visible) return this.#stop();
    if (this.#playing && !this.#held) this.#start_stream();
    else this.#start_still();
  }

  refresh_soon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), kRestartMs);
  }

  retry_now() {
    this.#backoff.reset();
    this.refresh();
  }

  // Makes the next refresh fetch even an equal picture.
  invalidate() {
    this.#stop();
    this.#shown = this.#shown_id = "";
    this.#epoch += 1;
  }

  // Picture to share: the one on the canvas if the view is at rest, else the last one of its refinement.
  get picture() {
    const { picture, asked } = this.#on.at_rest(this.#camera.goal);
    const seen = this.#seen_of(picture);
    if (seen) return { ...seen, location: this.#shown_location };
    return keeps_budget(picture) ? picture : this.#refiner.last(picture, asked);
  }

  // Returns the picture on the canvas if it is `picture` with any number of samples, else null.
  #seen_of(picture) {
    const seen = { ...picture, samples: this.#shown_samples };
    return frame_url(seen) === this.#shown ? seen : null;
  }

  #show_tab(visible) {
    this.#visible = visible;
    this.refresh();
  }

  #tick(now) {
    const seconds = Math.max(0, Math.min(0.1, (now - this.#last_tick) / 1000));
    const gliding = this.#camera.step(seconds, this.#view.box.height);
    this.#last_tick = now;
    if (gliding || now - this.#last_input < kRestMs) {
      this.#preview();
      requestAnimationFrame((next) => this.#tick(next));
      return;
    }
    this.#moving = false;
    this.#on.settled();
    this.refresh();
  }

  // Shows a preview. One is in flight at a time; the next one catches up with the camera.
  async #preview() {
    const start = performance.now();
    const waits = this.#preview_busy || start < this.#preview_from;
    const picture = waits ? null : this.#preview_picture();
    const url = picture && frame_url(picture);
    if (!url || url === this.#shown) return;
    this.#preview_busy = true;
    const epoch = this.#epoch;
    try {
      const frame = await get_frame(url);
      this.#cost.note(picture, frame.stats.render_ms);
      const bitmap = await decode(frame.png);
      if (this.#moving && epoch === this.#epoch) this.#draw(url, bitmap, picture, "preview", frame.stats);
      else bitmap.close();
      this.#delay.note(picture, performance.now() - start);
    } catch (error) {
      // The following still fails in the same way and reports it.
      this.#preview_from = performance.now() + 1000 * (error.retry_after_seconds ?? 1);
    } finally {
      this.#preview_busy = false;
    }
  }

  // Returns the finest picture expected within kPreviewMs, or null without a scene.
  #preview_picture() {
    const pictures = this.#on.moving("preview", this.#camera.view);
    if (pictures.length === 0) return null;
    const cost = this.#delay.knows(pictures[0]) ? this.#delay : this.#cost;
    return pictures[cost.first_within(pictures, kPreviewMs)];
  }

  // Shows a draft of a scene that is new to the canvas, unless the `first` picture is fast enough.
  async #draft(first, signal) {
    if (this.#shown_id === first.id || this.#cost.expected_ms(first) <= kDraftMs) return;
    const pictures = this.#on.moving("preview", this.#camera.view);
    const picture = pictures[this.#cost.first_within(pictures, kDraftMs)];
    const { png, stats } = await get_frame(frame_url(picture), signal);
    this.#cost.note(picture, stats.render_ms);
    this.#draw("", await decode_unless(signal, png), picture, "preview", stats);
  }

  #start_still() {
    const rest = this.#on.at_rest(this.#camera.view);
    if (!rest) return;
    // A held orbit shows one sample without a budget.
    const picture = this.#playing ? { ...rest.picture, samples: 1, seconds: 0, error: 0 } : rest.picture;
    const key = frame_url(picture);
    if (this.#work?.kind === "still" && this.#work.key === key) return;
    this.#stop();
    const { width, height, samples } = this.#seen_of(picture) ?? {};
    if (width) this.#on.stats("still", { ...this.#shown_figures, width, height });
    const shown = samples <= picture.samples ? samples : 0; // fewer samples may be wanted than are shown
    this.#run("still", key, async (signal) => {
      await this.#draft({ ...picture, samples: 1 }, signal);
      if (keeps_budget(picture)) await this.#keep_budget(picture, signal);
      else if (shown < picture.samples)
        await this.#refiner.climb(picture, { shown, asked: rest.asked }, signal, {
          draw: (each, bitmap, stats) => this.#draw(frame_url(each), bitmap, each, "still", stats),
          progress: this.#on.progress,
        });
      this.#on.rested();
    });
  }

  // Shows the picture that the service renders to a budget.
  async #keep_budget(picture, signal) {
    if (this.#shown === frame_url(picture)) return;
    const { png, stats } = await get_frame(frame_url(picture), signal);
    const bitmap = await decode_unless(signal, png);
    const plan = new URLSearchParams(stats.location?.split("?")[1]);
    const samples = Number(plan.get("samples") ?? picture.own); // a plan may leave them to the scene
    this.#draw(frame_url(picture), bitmap, picture, "still", { ...stats, samples });
    this.#shown_location = stats.location;
  }

  #start_stream() {
    const pictures = this.#on.moving("stream", this.#camera.view);
    if (pictures.length === 0) return;
    const [picture] = pictures;
    const key = JSON.stringify({ ...picture, azimuth: 0, time: 0, speed: this.speed });
    if (this.#work?.kind === "stream" && this.#work.key === key) return;
    this.#stop();
    this.#pace.play(picture, this.#cost.first_within(pictures, kFrameMs));
    this.#run("stream", key, (signal) => this.#stream(signal));
  }

  // Plays streams one after another. Each ends after `stream_frames` frames or if the pace changes.
  async #stream(signal) {
    const pace = this.#pace;
    for (;;) {
      const pictures = this.#on.moving("stream", this.#camera.view);
      const costs = pictures.map(amount);
      pace.level = Math.min(pace.level, pictures.length - 1);
      const picture = pictures[pace.level];
      const rate = {
        frames: this.stream_frames,
        fps: pace.fps,
        step: this.speed / pace.fps,
        time_step: picture.moves ? 1 / pace.fps : 0,
      };
      pace.restart();
      await play_stream(orbit_url(picture, rate), signal, (bitmap, header) => {
        this.#camera.follow(header.azimuth_degrees, header.time);
        this.#cost.note(picture, header.render_ms);
        this.#draw("", bitmap, picture, "stream", header);
        const work_ms = Math.max(header.render_ms, header.encode_ms);
        return !pace.note(performance.now(), work_ms, this.speed, costs);
      });
    }
  }

  #draw(url, bitmap, picture, kind, figures) {
    const { width, height } = bitmap;
    this.#view.draw(bitmap, picture.fills, kind === "still" && this.#camera.damped);
    this.#shown = url;
    this.#shown_id = picture.id;
    this.#shown_samples = picture.samples;
    this.#shown_location = undefined;
    this.#shown_figures = figures;
    this.#reposts = 0;
    this.#backoff.reset();
    if (kind !== "still") this.#on.progress(null);
    const draft = kind === "preview" || (kind === "stream" && this.#pace.level > 0);
    this.#on.stats(kind, { ...figures, width, height, draft });
  }

  async #run(kind, key, task) {
    const work = { kind, key, abort: new AbortController() };
    this.#work = work;
    this.#on.progress({});
    try {
      await task(work.abort.signal);
    } catch (error) {
      if (this.#work === work && !is_abort(error)) this.#fail(error);
    } finally {
      if (this.#work === work) this.#work = null;
      if (!this.#work) this.#on.progress(null);
    }
  }

  #stop() {
    this.#work?.abort.abort();
    this.#work = null;
    this.#on.progress(null);
    this.#on.stale();
  }

  async #fail(error) {
    if (error.status === 404 && this.#reposts < 2) {
      this.#reposts += 1;
      try {
        return await this.#on.missing(); // missing() refreshes
      } catch (second) {
        error = second;
      }
    }
    if (!error.retryable) return this.#on.problem(error);
    const seconds = this.#backoff.after(error);
    this.#on.waiting(error, seconds);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), 1000 * seconds);
  }
}

const keeps_budget = ({ seconds, error }) => Boolean(seconds || error);
