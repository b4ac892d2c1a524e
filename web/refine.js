// The pictures of a view at rest: one after the other, each with more samples than the one before.

import { get_frame } from "./api.js";
import { render_job } from "./job.js";
import { frame_url } from "./urls.js";
import { decode } from "./view.js";

const kJobMs = 1500; // what takes longer is a job, whose progress is known
const kLongestMs = 20_000; // finer pictures that nobody has asked for may take this long
const kTickMs = 250;

export class Refiner {
  #jobs = true; // false: the service takes none
  #kind = ""; // what #cost holds for
  #cost = NaN; // milliseconds for a sample of a pixel

  // A picture was rendered in `render_ms`.
  note(picture, render_ms) {
    this.#kind = kind_of(picture);
    this.#cost = render_ms / amount(picture);
  }

  // What rendering should take, from the last picture of the same scene; NaN before the first. Samples cost alike.
  expected_ms(picture) {
    return kind_of(picture) === this.#kind ? this.#cost * amount(picture) : NaN;
  }

  // The picture that climb() ends with.
  last(pictures, asked) {
    const too_slow = (picture, at) => at > 0 && !asked && this.expected_ms(picture) > kLongestMs;
    const end = pictures.findIndex(too_slow);
    return pictures.at(end < 0 ? -1 : end - 1);
  }

  // Renders `pictures` in turn. `shown`: samples on the canvas, 0 where it shows another view; `asked`: the last one
  // is wanted however long it takes. draw(picture, bitmap, stats) shows one; progress({shown, end, part,
  // seconds_left}) hears how far the next is: without `part` the seconds are a guess.
  async climb(pictures, { shown, asked }, signal, { draw, progress }) {
    const end = pictures.at(-1)?.samples;
    for (const picture of pictures) {
      const expected = this.expected_ms(picture);
      if (shown > 0 && !asked && expected > kLongestMs) return;
      const tell = (figures) => progress({ shown, end, ...figures });
      const start = performance.now();
      const { png, stats } = await this.#render(picture, expected, signal, tell);
      const bitmap = await decode(png);
      if (signal.aborted) bitmap.close();
      signal.throwIfAborted();
      this.note(picture, stats.render_ms ?? performance.now() - start);
      draw(picture, bitmap, stats);
      shown = picture.samples;
    }
  }

  async #render(picture, expected, signal, tell) {
    const slow = expected > kJobMs && this.#jobs;
    const frame = slow ? await render_job(picture, signal, tell) : null;
    if (frame) return frame;
    const start = performance.now();
    const tick = () => tell({ seconds_left: (expected - (performance.now() - start)) / 1000 });
    const timer = setInterval(tick, kTickMs);
    tick();
    try {
      const plain = await get_frame(frame_url(picture), signal);
      if (slow) this.#jobs = false; // it knows the scene, so it was the job that it did not
      return plain;
    } finally {
      clearInterval(timer);
    }
  }
}

const kind_of = ({ id, technique }) => `${id} ${technique}`;

// Samples of a picture, a measure of its cost.
export const amount = ({ width, height, samples }) => width * height * Math.max(1, samples);
