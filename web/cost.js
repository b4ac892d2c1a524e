// Estimates of render times, from measured pictures.

export class Cost {
  #ms = new Map(); // milliseconds per sample of a pixel, by scene and technique

  // Records `ms`, the measured time of `picture` in milliseconds. Ignores times that are not positive.
  note(picture, ms) {
    if (ms > 0) this.#ms.set(kindOf(picture), ms / amount(picture));
  }

  knows(picture) {
    return this.#ms.has(kindOf(picture));
  }

  // Returns the expected time in milliseconds, assuming equal cost per sample. Returns NaN before the first
  // recorded picture of the same scene and technique.
  expectedMs(picture) {
    return (this.#ms.get(kindOf(picture)) ?? NaN) * amount(picture);
  }

  // Returns the index of the first picture estimated to take at most `ms`, else the last index.
  firstWithin(pictures, ms) {
    return firstWithin(
      pictures.map((picture) => this.expectedMs(picture)),
      ms,
    );
  }
}

// Returns the index of the first time that is at most `ms`, else the last index.
export function firstWithin(times, ms) {
  const at = times.findIndex((time) => time <= ms);
  return at < 0 ? times.length - 1 : at;
}

const kindOf = ({ id, technique }) => `${id} ${technique}`;

// Returns the number of samples in all pixels of a picture, a measure of cost.
export const amount = ({ width, height, samples }) => width * height * Math.max(1, samples);
