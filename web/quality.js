// What is given up for speed: samples first, then the picture's sides.

const kParts = [0.84, 0.71, 0.59, 0.5, 0.42, 0.35, 0.3, 0.25]; // of each side: two steps halve the pixels
const kLeastPart = { fit: 0.25, half: 0.5 }; // a quarter of the stage's width
const kUsualSamples = 64;

// Samples of the picture at rest: what the user has `chosen` (0: nothing), else the usual number or what the scene asks
// for as its `own`.
export const samples_at_rest = (chosen, own, most) => Math.min(most, chosen || Math.max(own, kUsualSamples));

// Samples after each pass of a picture of so many, as the service renders them: each has half of the next.
export function passes(samples) {
  const counts = [];
  for (let count = samples; count > 0; count = Math.floor(count / 2)) counts.unshift(count);
  return counts;
}

// {part, samples} of pictures of a moving view, each cheaper than the one before. `part` is a factor of each side, `own`
// the samples that the scene asks for, 0 where that is not known. What the user has chosen is kept: a number of samples,
// or a size.
export function rungs({ samples, size, own }) {
  const counts = samples ? [samples] : passes(Math.max(1, own)).reverse();
  const parts = kParts.filter((part) => part >= kLeastPart[size]);
  return [
    ...counts.map((count) => ({ part: 1, samples: count })),
    ...parts.map((part) => ({ part, samples: counts.at(-1) })),
  ];
}
