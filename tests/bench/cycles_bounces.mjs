// Compares the means of the Cornell box by path length, from 0 to 6 bounces, with the means of Cycles.
// Reveals errors that cancel in the image.

import { channelStatistics, differences } from "./cycles_bias.mjs";
import { showProgress } from "./measure.mjs";
import { startRenderers } from "./renderers.mjs";

const MOST_BOUNCES = 6,
  SIZE = 128,
  SAMPLES = 16,
  PAIRS = 8; // pairs of images of each renderer
const MOST_ERRORS = 3; // limit of differences in standard errors

async function measure(renderers, bounces, count, samples) {
  const pictures = { ours: [], theirs: [] };
  for (let seed = 1; seed <= count; ++seed) {
    showProgress(`cycles: ${bounces} bounces, seed ${seed} of ${count}`);
    for (const side of seed % 2 ? ["ours", "theirs"] : ["theirs", "ours"])
      pictures[side].push((await renderers[side]({ samples, seed, bounces })).picture);
  }
  showProgress("");
  return { ours: channelStatistics(pictures.ours), theirs: channelStatistics(pictures.theirs) };
}

const value = ({ mean, error }) => `${mean.toFixed(6)}+-${error.toFixed(6)}`.padStart(20);

// Prints the table. `options.seeds` counts pairs of images of each renderer.
export async function comparePathLengths(scene, { seeds = PAIRS, samples = SAMPLES, size = SIZE }) {
  const renderers = startRenderers(scene, size),
    count = 2 * seeds;
  console.log(
    `\nmeans of R, G and B by path length, ${size}x${size}, ${samples} samples, ${count} seeds; z is theirs minus`,
  );
  console.log("ours, in standard errors");
  const head = ["R", "G", "B"].map((c) => `ours ${c}`.padStart(20) + `theirs ${c}`.padStart(20) + "z".padStart(6));
  console.log(`depth bounces  ${head.join("")}`);
  let most = 0;
  try {
    for (let bounces = 0; bounces <= MOST_BOUNCES; ++bounces) {
      const { ours, theirs } = await measure(renderers, bounces, count, samples);
      const apart = differences(ours, theirs);
      const cells = apart.map(({ z }, c) => `${value(ours[c])}${value(theirs[c])}${z.toFixed(1).padStart(6)}`);
      console.log(`${String(bounces + 1).padStart(5)}${String(bounces).padStart(8)}  ${cells.join("")}`);
      most = Math.max(most, ...apart.map(({ z }) => Math.abs(z)));
    }
  } finally {
    await renderers.stop();
  }
  const verdict = most <= MOST_ERRORS ? "equal" : "DIFFERENT";
  console.log(`largest difference ${most.toFixed(1)} standard errors (limit ${MOST_ERRORS}): ${verdict}`);
  if (most > MOST_ERRORS) process.exitCode = 1;
  return [];
}
