// Measures how well images of orrery and Cycles agree, and the bias of Blender's defaults.

import { blockMeans, channelMeans, meanPicture, meanProduct, productStatistics } from "./picture.mjs";

const CHANNELS = ["R", "G", "B"];
const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
const signedRoot = (x) => Math.sign(x) * Math.sqrt(Math.abs(x));

// Returns mean and standard error for each channel, over images of different seeds.
export function channelStatistics(pictures) {
  const found = pictures.map(channelMeans);
  return CHANNELS.map((_, c) => {
    const values = found.map((means) => means[c]),
      middle = mean(values);
    const variance = values.reduce((sum, v) => sum + (v - middle) ** 2, 0) / (values.length - 1);
    return { mean: middle, error: Math.sqrt(variance / values.length) };
  });
}

// Returns the difference b - a of each channel, its standard error, and their ratio z.
export function differences(a, b) {
  return a.map((one, c) => {
    const difference = b[c].mean - one.mean,
      error = Math.hypot(one.error, b[c].error);
    return { difference, error, z: difference / error };
  });
}

// Returns statistics of the images with the most samples. `halves` are two independent references: the means
// of the images with odd and with even seeds.
export function agreement(pairs, blocks) {
  const of = (side) => {
    const pictures = pairs.flatMap((pair) => pair[side].pictures);
    const halves = [0, 1].map((i) => meanPicture(pairs.map((pair) => pair[side].pictures[i])));
    return { halves, last: pairs.at(-1)[side], statistics: channelStatistics(pictures) };
  };
  return { ours: of("ours"), theirs: of("theirs"), blocks };
}

// Returns the mean squared error of images relative to a reference in two independent halves. The noise of
// the halves cancels on average.
const squaredError = (pictures, [r, s]) => mean(pictures.map((one) => meanProduct(one, r, one, s)));

// Returns the root mean squared difference between the limits of two estimates, each in two halves, as text.
// The noise is the square root of the standard error of the mean square. A negative value is due to noise.
function apart(halves, others, side) {
  const [a, b, c, d] = [...halves, ...others].map((half) => blockMeans(half, side));
  const square = productStatistics(a, c, b, d);
  return `${signedRoot(square.mean).toExponential(1)} (noise ${Math.sqrt(square.error).toExponential(1)})`;
}

export function printAgreement({ ours, theirs, blocks }, names) {
  const words = differences(ours.statistics, theirs.statistics).map(
    ({ difference, error, z }, c) =>
      `${CHANNELS[c]} ${difference.toExponential(1)} +- ${error.toExponential(1)} (${z.toFixed(1)})`,
  );
  console.log(`\ndifference of the means, theirs minus ours (in standard errors): ${words.join(", ")}`);
  const differing = blocks.map((side, i) => `${names[i]} ${apart(ours.halves, theirs.halves, side)}`);
  console.log(`root mean squared difference of the limits: ${differing.join(", ")}`);
  for (const [name, one, other] of [
    ["ours", ours, theirs],
    ["theirs", theirs, ours],
  ]) {
    const [a, b] = one.last.pictures;
    const [byPair, byOther] = [meanProduct(a, b, a, b) / 2, squaredError([a, b], other.halves)].map(signedRoot);
    console.log(`${name}: error from own pair ${byPair.toFixed(6)}, relative to other renderer ${byOther.toFixed(6)}`);
  }
}

// Prints cost, error and bias of Blender's defaults. The reference is the mean of both renderers.
export function printDefaults(defaults, samples, { ours, theirs, blocks }, fair) {
  const pictures = defaults.flatMap((pair) => pair.pictures);
  const halves = [0, 1].map((i) => meanPicture(defaults.map((pair) => pair.pictures[i])));
  const joint = [0, 1].map((i) => meanPicture([ours.halves[i], theirs.halves[i]]));
  const reference = ours.statistics.map((one, c) => ({
    mean: (one.mean + theirs.statistics[c].mean) / 2,
    error: Math.hypot(one.error, theirs.statistics[c].error) / 2,
  }));
  const words = differences(reference, channelStatistics(pictures)).map(({ difference, error }, c) => {
    const [bias, noise] = [difference, error].map((x) => ((100 * x) / reference[c].mean).toFixed(3));
    return `${CHANNELS[c]} ${bias} +- ${noise} %`;
  });
  const cpuS = mean(defaults.map((pair) => pair.cpuS)),
    error = signedRoot(squaredError(pictures, joint));
  console.log(
    `\nCycles with Blender's defaults (adaptive to 0.01, at most ${samples} samples, indirect light clamped at 10, light ` +
      `threshold 0.01, first sample at the pixel centre):\n` +
      `${cpuS.toFixed(3)} CPU s (fair: ${fair.cpuS.toFixed(3)}), error of a pixel ${error.toFixed(6)} ` +
      `(fair: ${Math.sqrt(fair.squaredErrors[0]).toFixed(6)}), bias ${apart(halves, joint, blocks[0])}\n` +
      `difference of the means from the reference: ${words.join(", ")}`,
  );
}
