// Agreement between our pictures and those of Cycles, and the bias of Blender's defaults.

import { block_means, channel_means, mean_picture, mean_product, product_statistics } from "./picture.mjs";

const kChannels = ["R", "G", "B"];
const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
const signed_root = (x) => Math.sign(x) * Math.sqrt(Math.abs(x));

// Returns the mean and its standard error for each channel, over pictures of different seeds.
export function channel_statistics(pictures) {
  const found = pictures.map(channel_means);
  return kChannels.map((_, c) => {
    const values = found.map((means) => means[c]),
      middle = mean(values);
    const variance = values.reduce((sum, v) => sum + (v - middle) ** 2, 0) / (values.length - 1);
    return { mean: middle, error: Math.sqrt(variance / values.length) };
  });
}

// Returns, for each channel of b - a, the difference, its standard error and their ratio.
export function differences(a, b) {
  return a.map((one, c) => {
    const difference = b[c].mean - one.mean,
      error = Math.hypot(one.error, b[c].error);
    return { difference, error, z: difference / error };
  });
}

// Returns statistics of the pictures with the most samples. `halves` are two independent references: each is
// the mean of one renderer's pictures of one seed parity.
export function agreement(pairs, blocks) {
  const of = (side) => {
    const pictures = pairs.flatMap((pair) => pair[side].pictures);
    const halves = [0, 1].map((i) => mean_picture(pairs.map((pair) => pair[side].pictures[i])));
    return { halves, last: pairs.at(-1)[side], statistics: channel_statistics(pictures) };
  };
  return { ours: of("ours"), theirs: of("theirs"), blocks };
}

// Returns the mean squared error of pictures against a reference in two halves. The noise of the halves
// cancels, as they are independent.
const squared_error = (pictures, [r, s]) => mean(pictures.map((one) => mean_product(one, r, one, s)));

// Returns the root mean squared difference between the limits of two estimates in halves, as text. The noise
// is the root of the square's standard error. A negative value is due to noise.
function apart(halves, others, side) {
  const [a, b, c, d] = [...halves, ...others].map((half) => block_means(half, side));
  const square = product_statistics(a, c, b, d);
  return `${signed_root(square.mean).toExponential(1)} (noise ${Math.sqrt(square.error).toExponential(1)})`;
}

export function print_agreement({ ours, theirs, blocks }, names) {
  const words = differences(ours.statistics, theirs.statistics).map(
    ({ difference, error, z }, c) =>
      `${kChannels[c]} ${difference.toExponential(1)} +- ${error.toExponential(1)} (${z.toFixed(1)})`,
  );
  console.log(`\nmean over the picture, theirs less ours, and in standard errors: ${words.join(", ")}`);
  const differing = blocks.map((side, i) => `${names[i]} ${apart(ours.halves, theirs.halves, side)}`);
  console.log(`root mean squared difference of what the two converge to: ${differing.join(", ")}`);
  for (const [name, one, other] of [
    ["ours", ours, theirs],
    ["theirs", theirs, ours],
  ]) {
    const [a, b] = one.last.pictures;
    const [by_pair, by_other] = [mean_product(a, b, a, b) / 2, squared_error([a, b], other.halves)].map(signed_root);
    console.log(
      `${name}: error by its own pair ${by_pair.toFixed(6)}, against the other's pictures ${by_other.toFixed(6)}`,
    );
  }
}

// Prints cost, error and bias of Blender's defaults. The reference is the mean of both renderers.
export function print_defaults(defaults, samples, { ours, theirs, blocks }, fair) {
  const pictures = defaults.flatMap((pair) => pair.pictures);
  const halves = [0, 1].map((i) => mean_picture(defaults.map((pair) => pair.pictures[i])));
  const joint = [0, 1].map((i) => mean_picture([ours.halves[i], theirs.halves[i]]));
  const reference = ours.statistics.map((one, c) => ({
    mean: (one.mean + theirs.statistics[c].mean) / 2,
    error: Math.hypot(one.error, theirs.statistics[c].error) / 2,
  }));
  const words = differences(reference, channel_statistics(pictures)).map(({ difference, error }, c) => {
    const [bias, noise] = [difference, error].map((x) => ((100 * x) / reference[c].mean).toFixed(3));
    return `${kChannels[c]} ${bias} +- ${noise} %`;
  });
  const cpu_s = mean(defaults.map((pair) => pair.cpu_s)),
    error = signed_root(squared_error(pictures, joint));
  console.log(
    `\nCycles with Blender's defaults (adaptive to 0.01, at most ${samples} samples; indirect light clamped at 10; light ` +
      `threshold 0.01; first sample through the pixel's centre):\n` +
      `${cpu_s.toFixed(3)} CPU s (fair: ${fair.cpu_s.toFixed(3)}), error of a pixel ${error.toFixed(6)} ` +
      `(fair: ${Math.sqrt(fair.squared_errors[0]).toFixed(6)}), of which bias ${apart(halves, joint, blocks[0])}\n` +
      `mean over the picture less that of the reference: ${words.join(", ")}`,
  );
}
