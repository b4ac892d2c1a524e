// Progressive refinement of a view at rest: one stream of pictures, each with about twice the samples of the
// previous one.

import { getFrame, request, warningOf } from "./api.js";
import { renderJob } from "./job.js";
import { passes } from "./quality.js";
import { figuresOf, FRAME_TYPE, readFrames } from "./stream.js";
import { frameUrl, refinementUrl } from "./urls.js";
import { decode } from "./view.js";

const JOB_MS = 1500; // longer single renders become jobs, which report progress
const MAX_UNREQUESTED_MS = 20_000; // longest estimated render of samples that the user has not requested
const TICK_MS = 250;
const TIME_LIMIT_STATUSES = new Set([422, 504]); // too many rays, or a timeout

export class Refiner {
  #jobs = true; // false: the service accepts no jobs
  #cost;

  // `cost`: the Cost of render times, which the refiner reads and updates.
  constructor(cost) {
    this.#cost = cost;
  }

  // Returns the last picture that refineToEnd() is expected to render.
  last(picture, isRequested) {
    const counts = passes(picture.samples);
    const end = counts.findIndex((samples, at) => at > 0 && !isRequested && this.#tooSlow({ ...picture, samples }));
    return { ...picture, samples: counts.at(end < 0 ? -1 : end - 1) };
  }

  // Renders `picture` from few samples to all.
  // `shown`: samples on the canvas, 0 if the canvas shows another view.
  // `isRequested`: render all samples, however long they take. Calls draw(picture, bitmap, stats) for each
  // picture, and progress({shown, end, rmse, part, secondsLeft}). Without `part`, `secondsLeft` is the page's
  // estimate.
  async refineToEnd(picture, { shown, isRequested }, signal, on) {
    const end = picture.samples;
    const at = { shown, end };
    const onProgress = (figures) => on.progress({ ...at, ...figures });
    const draw = (bitmap, stats) => {
      at.shown = stats.samples;
      at.rmse = stats.rmse;
      on.draw({ ...picture, samples: stats.samples }, bitmap, stats);
    };
    if (end > 1) {
      try {
        return await this.#stream(picture, { at, isRequested }, signal, { draw, onProgress });
      } catch (error) {
        const isTruncated = error.status === 0 && at.shown > shown;
        if (!TIME_LIMIT_STATUSES.has(error.status) && !isTruncated) throw error;
      }
    }
    // Falls back to single renders, with all samples only if isRequested.
    for (const samples of isRequested ? [1, end] : [1]) {
      if (samples <= at.shown) continue;
      const { bitmap, stats } = await this.#render({ ...picture, samples }, signal, onProgress);
      draw(bitmap, stats);
    }
  }

  #tooSlow(picture) {
    return this.#cost.expectedMs(picture) > MAX_UNREQUESTED_MS;
  }

  async #stream(picture, { at, isRequested }, signal, { draw, onProgress }) {
    const counts = passes(picture.samples);
    const tooSlow = (samples) => !isRequested && this.#tooSlow({ ...picture, samples });
    if (at.shown > 0 && tooSlow(counts.find((samples) => samples > at.shown))) return;
    let traced = 0;
    const left = () => this.#cost.expectedMs({ ...picture, samples: picture.samples - traced });
    const clock = ticking(left, onProgress);
    try {
      const response = await request(refinementUrl(picture), { headers: { Accept: FRAME_TYPE }, signal });
      const warning = warningOf(response);
      for await (const { header, png } of readFrames(response.body)) {
        const figures = figuresOf(header);
        const { samples, renderMs } = figures;
        this.#cost.note({ ...picture, samples: samples - traced }, renderMs);
        traced = samples;
        const stats = { ...figures, rmse: header.error?.rmse, warning };
        if (samples > at.shown) draw(await decodeUnlessAborted(signal, png), stats);
        clock.restart();
        if (samples < picture.samples && tooSlow(counts.find((count) => count > samples))) return;
      }
    } finally {
      clock.stop();
    }
  }

  // Renders all samples of a picture at once.
  async #render(picture, signal, onProgress) {
    const expected = this.#cost.expectedMs(picture);
    const start = performance.now();
    const { png, stats } = await this.#fetch(picture, expected, signal, onProgress);
    const bitmap = await decodeUnlessAborted(signal, png);
    this.#cost.note(picture, stats.renderMs ?? performance.now() - start);
    return { bitmap, stats: { ...stats, samples: picture.samples } };
  }

  async #fetch(picture, expected, signal, onProgress) {
    const slow = expected > JOB_MS && this.#jobs;
    const frame = slow ? await renderJob(picture, signal, onProgress) : null;
    if (frame) return frame;
    const clock = ticking(() => expected, onProgress);
    try {
      const plain = await getFrame(frameUrl(picture), signal);
      if (slow) this.#jobs = false; // the scene exists, so the service accepts no jobs
      return plain;
    } finally {
      clock.stop();
    }
  }
}

// Calls `onProgress({secondsLeft})` every TICK_MS. `expected()`: milliseconds from the last restart to the
// end.
function ticking(expected, onProgress) {
  let start = performance.now();
  const tick = () => onProgress({ secondsLeft: (expected() - (performance.now() - start)) / 1000 });
  const timer = setInterval(tick, TICK_MS);
  tick();
  const restart = () => {
    start = performance.now();
    tick();
  };
  return { restart, stop: () => clearInterval(timer) };
}

// Decodes a picture. Throws AbortError if `signal` has fired.
export async function decodeUnlessAborted(signal, png) {
  const bitmap = await decode(png);
  if (signal.aborted) bitmap.close();
  signal.throwIfAborted();
  return bitmap;
}
