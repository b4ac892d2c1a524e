// Progressive refinement of a view at rest: one stream of pictures, each with about twice the samples of the
// last.

import { get_frame, request, warning_of } from "./api.js";
import { render_job } from "./job.js";
import { passes } from "./quality.js";
import { kFrameType, read_frames } from "./stream.js";
import { frame_url, refinement_url } from "./urls.js";
import { decode } from "./view.js";

const kJobMs = 1500; // longer single renders become jobs, which report progress
const kLongestMs = 20_000; // longest estimate for samples that the user did not ask for
const kTickMs = 250;
const kTooLong = new Set([422, 504]); // statuses of pictures that exceed the time limit of a request

export class Refiner {
  #jobs = true; // false: the service accepts no jobs
  #cost;

  // `cost`: the Cost of rendering, read and updated.
  constructor(cost) {
    this.#cost = cost;
  }

  // Returns the picture that climb() ends with.
  last(picture, asked) {
    const counts = passes(picture.samples);
    const end = counts.findIndex((samples, at) => at > 0 && !asked && this.#too_slow({ ...picture, samples }));
    return { ...picture, samples: counts.at(end < 0 ? -1 : end - 1) };
  }

  // Renders `picture` from few samples to all. `shown`: samples on the canvas, 0 if it shows another view.
  // `asked`: render all samples, however long they take. Calls draw(picture, bitmap, stats) for each picture
  // and progress({shown, end, rmse, part, seconds_left}). Without `part`, `seconds_left` is an estimate.
  async climb(picture, { shown, asked }, signal, on) {
    const end = picture.samples;
    const at = { shown, end };
    const tell = (figures) => on.progress({ ...at, ...figures });
    const draw = (bitmap, stats) => {
      at.shown = stats.samples;
      at.rmse = stats.rmse;
      on.draw({ ...picture, samples: stats.samples }, bitmap, stats);
    };
    if (end > 1) {
      try {
        return await this.#stream(picture, { at, asked }, signal, { draw, tell });
      } catch (error) {
        const broke_off = error.status === 0 && at.shown > shown;
        if (!kTooLong.has(error.status) && !broke_off) throw error;
      }
    }
    // Falls back to single renders, with all samples only if asked.
    for (const samples of asked ? [1, end] : [1]) {
      if (samples <= at.shown) continue;
      const { bitmap, stats } = await this.#render({ ...picture, samples }, signal, tell);
      draw(bitmap, stats);
    }
  }

  #too_slow(picture) {
    return this.#cost.expected_ms(picture) > kLongestMs;
  }

  async #stream(picture, { at, asked }, signal, { draw, tell }) {
    const counts = passes(picture.samples);
    const too_slow = (samples) => !asked && this.#too_slow({ ...picture, samples });
    if (at.shown > 0 && too_slow(counts.find((samples) => samples > at.shown))) return;
    let traced = 0;
    const left = () => this.#cost.expected_ms({ ...picture, samples: picture.samples - traced });
    const clock = ticking(left, tell);
    try {
      const response = await request(refinement_url(picture), { headers: { Accept: kFrameType }, signal });
      const warning = warning_of(response);
      for await (const { header, png } of read_frames(response.body)) {
        const { samples, render_ms } = header;
        this.#cost.note({ ...picture, samples: samples - traced }, render_ms);
        traced = samples;
        const stats = { ...header, rmse: header.error?.rmse, warning };
        if (samples > at.shown) draw(await decode_unless(signal, png), stats);
        clock.restart();
        if (samples < picture.samples && too_slow(counts.find((count) => count > samples))) return;
      }
    } finally {
      clock.stop();
    }
  }

  // Renders all samples of a picture at once.
  async #render(picture, signal, tell) {
    const expected = this.#cost.expected_ms(picture);
    const start = performance.now();
    const { png, stats } = await this.#fetch(picture, expected, signal, tell);
    const bitmap = await decode_unless(signal, png);
    this.#cost.note(picture, stats.render_ms ?? performance.now() - start);
    return { bitmap, stats: { ...stats, samples: picture.samples } };
  }

  async #fetch(picture, expected, signal, tell) {
    const slow = expected > kJobMs && this.#jobs;
    const frame = slow ? await render_job(picture, signal, tell) : null;
    if (frame) return frame;
    const clock = ticking(() => expected, tell);
    try {
      const plain = await get_frame(frame_url(picture), signal);
      if (slow) this.#jobs = false; // the scene exists, so the service accepts no jobs
      return plain;
    } finally {
      clock.stop();
    }
  }
}

// Calls `tell({seconds_left})` every kTickMs. `expected()`: milliseconds from the last restart to the end.
function ticking(expected, tell) {
  let start = performance.now();
  const tick = () => tell({ seconds_left: (expected() - (performance.now() - start)) / 1000 });
  const timer = setInterval(tick, kTickMs);
  tick();
  const restart = () => {
    start = performance.now();
    tick();
  };
  return { restart, stop: () => clearInterval(timer) };
}

// Decodes a picture. Throws AbortError if `signal` has fired.
export async function decode_unless(signal, png) {
  const bitmap = await decode(png);
  if (signal.aborted) bitmap.close();
  signal.throwIfAborted();
  return bitmap;
}
