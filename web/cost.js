// What pictures cost, learned from those that were made.

export class Cost {
  #ms = new Map(); // for a sample of a pixel, by scene and technique

  // A picture took so long.
  note(picture, ms) {
    if (ms > 0) this.#ms.set(kind_of(picture), ms / amount(picture));
  }

  knows(picture) {
    return this.#ms.has(kind_of(picture));
  }

  // NaN before the first picture of the same scene. Samples cost alike.
  expected_ms(picture) {
    return (this.#ms.get(kind_of(picture)) ?? NaN) * amount(picture);
  }

  // The number of the first of `pictures` that should take at most `ms`; of the last where none does or nothing is known.
  first_within(pictures, ms) {
    return first_within(pictures.map((picture) => this.expected_ms(picture)), ms);
  }
}

// The number of the first of these times that is at most `ms`; of the last where none is.
export function first_within(times, ms) {
  const at = times.findIndex((time) => time <= ms);
  return at < 0 ? times.length - 1 : at;
}

const kind_of = ({ id, technique }) => `${id} ${technique}`;

// Samples of a picture, a measure of its cost.
export const amount = ({ width, height, samples }) => width * height * Math.max(1, samples);
