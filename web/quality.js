// Quality levels of pictures, from fine to coarse: first with fewer samples, then with fewer pixels.

const SIDE_FACTORS = [0.84, 0.71, 0.59, 0.5, 0.42, 0.35, 0.3, 0.25]; // two steps halve the pixels
const MIN_PART = { fit: 0.25, half: 0.5 }; // both: a quarter of the stage's width
const DEFAULT_SAMPLES = 64;

// Returns the samples of the picture at rest: `chosen` by the user, or if this is 0, the larger of 64 and the
// scene's `own` samples. The result is at most `most`.
export const samplesAtRest = (chosen, own, most) => Math.min(most, chosen || Math.max(own, DEFAULT_SAMPLES));

// Returns the sample counts after each pass of a refinement by the service. Each count is half of the next,
// rounded down.
export function passes(samples) {
  const counts = [];
  for (let count = samples; count > 0; count = Math.floor(count / 2)) counts.unshift(count);
  return counts;
}

// Returns {part, samples} of pictures of a moving view, each cheaper than the one before. `part` is a factor
// of each side. `own`: the scene's samples, 0 if unknown. Keeps a sample count or a fixed size that the user
// has chosen.
export function qualityLevels({ samples, size, own }) {
  const counts = samples ? [samples] : passes(Math.max(1, own)).reverse();
  const parts = SIDE_FACTORS.filter((part) => part >= MIN_PART[size]);
  return [
    ...counts.map((count) => ({ part: 1, samples: count })),
    ...parts.map((part) => ({ part, samples: counts.at(-1) })),
  ];
}
