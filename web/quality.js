// What is given up for speed: of the picture's sides and of its samples.

// For the picture of a moving view; the second where the first takes too long.
const kPreviews = [{ part: 1 / 2 }, { part: 1 / 4 }];
// For the frames of an orbit, each level coarser than the one before.
export const kStreams = [{}, { samples: 1 }, { samples: 1, part: 1 / 2 }, { samples: 1, part: 1 / 4 }];

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

// {part, samples} for `purpose` "still", "preview" or "stream" at `level`. `part` is a factor of each side, `own` the
// samples that the scene asks for, 0 where that is not known. An orbit keeps what the user has chosen: a number of
// samples, or a size.
export function quality(purpose, level, { samples, size, own }) {
  if (purpose === "preview")
    return { part: kPreviews[Math.min(level, kPreviews.length - 1)].part, samples: 1 };
  if (purpose === "still") return { part: 1, samples };
  const stream = kStreams[level];
  const free_size = size === "fit" || size === "half";
  return { part: (free_size && stream.part) || 1, samples: samples || (stream.samples ?? own) };
}
