// Decides what the canvas shows: the orbit's stream while playing, small quick pictures while the view
// moves under the user's hand, and one full picture once it rests. At most one of them is at work.

import { ApiError, get_frame, is_abort, request } from "./api.js";
import { Backoff } from "./backoff.js";
import { kFrameType, read_frames } from "./stream.js";
import { frame_url, orbit_url } from "./urls.js";
import { decode } from "./view.js";

const kRestMs = 100; // without input for this long, the view counts as at rest
const kRestartMs = 150; // changes of size or speed are gathered this long
const kStreamFps = 30;
const kQuickMs = 60; // previews slower than this get a quarter of each side instead of a half
const kPreviewParts = [1 / 2, 1 / 4];

// `on` has: picture(purpose, preview_part) -> picture or null, missing() -> promise (post the scene again),
// stats(kind, figures), waiting(error, seconds), problem(error), busy(bool), settled().
export class Player {
  speed = 20; // degrees per second
  stream_frames = 3600;
  #camera;
  #view;
  #on;
  #playing = false;
  #visible = true;
  #held = false; // a drag is under way: no stream until it ends
  #moving = false; // the view moves by hand, or has done so less than kRestMs ago
  #last_input = 0;
  #last_tick = 0;
  #work = null; // {kind, key, abort} of the stream or still being fetched
  #shown = ""; // address of the still on the canvas
  #preview_busy = false;
  #epoch = 0; // counts invalidations: a preview asked for before one is not drawn after it
  #preview_slow = 0; // index into kPreviewParts
  #backoff = new Backoff();
  #timer = 0;
  #reposts = 0; // scenes posted again since the last picture

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

  get playing() {
    return this.#playing;
  }

  set playing(playing) {
    this.#playing = playing;
    this.refresh();
  }

  // The user moves the view: stop what is shown, follow the camera until it rests.
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

  // Scene, size or options changed: show what is right now.
  refresh() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    if (this.#moving) return;
    if (!this.#visible) return this.#stop();
    if (this.#playing && !this.#held) this.#start_stream();
    else this.#start_still();
  }

  // As refresh(), but gathers changes that come in quick succession.
  refresh_soon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), kRestartMs);
  }

  retry_now() {
    this.#backoff.reset();
    this.refresh();
  }

  // Forgets the picture shown, so that the next refresh fetches even an equal one.
  invalidate() {
    this.#stop();
    this.#shown = "";
    this.#epoch += 1;
  }

  #show_tab(visible) {
    this.#visible = visible;
    this.refresh();
  }

  #tick(now) {
    const gliding = this.#camera.step(Math.max(0, Math.min(0.1, (now - this.#last_tick) / 1000)));
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

  // One in flight; whatever the camera does meanwhile is caught up with by the next.
  async #preview() {
    const picture = this.#preview_busy
      ? null
      : this.#on.picture("preview", kPreviewParts[this.#preview_slow]);
    const url = picture && frame_url(picture);
    if (!url || url === this.#shown) return;
    this.#preview_busy = true;
    const epoch = this.#epoch;
    const start = performance.now();
    try {
      const frame = await get_frame(url);
      const bitmap = await decode(frame.png);
      if (this.#moving && epoch === this.#epoch) this.#draw(url, bitmap, picture, "preview", frame.stats);
      else bitmap.close();
      this.#preview_slow = performance.now() - start > kQuickMs ? 1 : 0;
    } catch (error) {
      // The still that follows meets the same trouble and reports it.
    } finally {
      this.#preview_busy = false;
    }
  }

  #start_still() {
    const picture = this.#on.picture("still");
    if (!picture) return;
    const url = frame_url(picture);
    if (this.#work?.kind === "still" && this.#work.key === url) return;
    this.#stop();
    if (url === this.#shown) return this.#on.stats("still", { width: picture.width, height: picture.height });
    this.#run("still", url, async (signal) => {
      const frame = await get_frame(url, signal);
      const bitmap = await decode_or_explain(frame.png);
      signal.throwIfAborted();
      this.#draw(url, bitmap, picture, "still", frame.stats);
    });
  }

  #start_stream() {
    const picture = this.#on.picture("stream");
    if (!picture) return;
    const key = JSON.stringify({ ...picture, azimuth: 0, speed: this.speed });
    if (this.#work?.kind === "stream" && this.#work.key === key) return;
    this.#stop();
    this.#run("stream", key, async (signal) => {
      for (let azimuth = picture.azimuth; ; azimuth = this.#camera.view.azimuth) {
        await this.#stream_once({ ...picture, azimuth }, signal);
      }
    });
  }

  async #stream_once(picture, signal) {
    const rate = { frames: this.stream_frames, fps: kStreamFps, step: this.speed / kStreamFps };
    const response = await request(orbit_url(picture, rate), { headers: { Accept: kFrameType }, signal });
    let newest = null;
    let painting = false;
    let failure = null;
    let seen = 0;
    let late = 0; // frames that came while an older one was being decoded, and gave way to a newer one
    const paint = async () => {
      painting = true;
      while (newest && !failure) {
        const { header, png } = newest;
        newest = null;
        const bitmap = await decode_or_explain(png).catch((error) => void (failure = error));
        if (!bitmap) break;
        if (signal.aborted) return bitmap.close();
        this.#camera.follow(header.azimuth_degrees);
        this.#draw("", bitmap, picture, "stream", { ...header, skipped: (header.skipped ?? 0) + late });
      }
      painting = false;
    };
    for await (const frame of read_frames(response.body)) {
      if (failure) throw failure;
      if (newest) late += 1;
      newest = frame;
      seen += 1;
      if (!painting) paint();
    }
    if (seen === 0) throw new ApiError({ status: 0, title: "The stream ended before its first frame" });
  }

  #draw(url, bitmap, picture, kind, figures) {
    const { width, height } = bitmap;
    this.#view.draw(bitmap, picture.fills);
    this.#shown = url;
    this.#reposts = 0;
    this.#backoff.reset();
    this.#on.busy(false);
    this.#on.stats(kind, { ...figures, width, height });
  }

  async #run(kind, key, task) {
    const work = { kind, key, abort: new AbortController() };
    this.#work = work;
    this.#on.busy(true);
    try {
      await task(work.abort.signal);
    } catch (error) {
      if (this.#work === work && !is_abort(error)) this.#fail(error);
    } finally {
      if (this.#work === work) this.#work = null;
      if (!this.#work) this.#on.busy(false);
    }
  }

  #stop() {
    this.#work?.abort.abort();
    this.#work = null;
    this.#on.busy(false);
  }

  async #fail(error) {
    if (error.status === 404 && this.#reposts < 2) {
      this.#reposts += 1;
      try {
        return await this.#on.missing(); // refreshes by itself
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

async function decode_or_explain(png) {
  try {
    return await decode(png);
  } catch {
    throw new ApiError({
      status: 200,
      title: "This picture cannot be shown",
      detail: "The browser could not decode it.",
    });
  }
}
