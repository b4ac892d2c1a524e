// Means of the Cornell box by path length, from 0 to 6 bounces, by Cycles and by ours. Reveals errors that
// cancel in the whole picture.

import { channel_statistics, differences } from "./cycles_bias.mjs";
import { show_progress } from "./measure.mjs";
import { start_renderers } from "./renderers.mjs";

const kMostBounces = 6,
  kSize = 128,
  kSamples = 16,
  kPairs = 8; // pairs of pictures of each renderer
const kMostErrors = 3; // in standard errors, largest difference due to chance

async function measure(renderers, bounces, count, samples) {
  const pictures = { ours: [], theirs: [] };
  for (let seed = 1; seed <= count; ++seed) {
    show_progress(`cycles: ${bounces} bounces, seed ${seed} of ${count}`);
    for (const side of seed % 2 ? ["ours", "theirs"] : ["theirs", "ours"])
      pictures[side].push((await renderers[side]({ samples, seed, bounces })).picture);
  }
  show_progress("");
  return { ours: channel_statistics(pictures.ours), theirs: channel_statistics(pictures.theirs) };
}

const value = ({ mean, error }) => `${mean.toFixed(6)}+-${error.toFixed(6)}`.padStart(20);

// Prints the table. `options.seeds` counts pairs of pictures of each renderer.
export async function compare_path_lengths(scene, { seeds = kPairs, samples = kSamples, size = kSize }) {
  const renderers = start_renderers(scene, size),
    count = 2 * seeds;
  console.log(
    `\nmeans of R, G and B by path length, ${size}x${size}, ${samples} samples, ${count} seeds; z: theirs less`,
  );
  console.log("ours in standard errors");
  const head = ["R", "G", "B"].map((c) => `ours ${c}`.padStart(20) + `theirs ${c}`.padStart(20) + "z".padStart(6));
  console.log(`depth bounces  ${head.join("")}`);
  let most = 0;
  try {
    for (let bounces = 0; bounces <= kMostBounces; ++bounces) {
      const { ours, theirs } = await measure(renderers, bounces, count, samples);
      const apart = differences(ours, theirs);
      const cells = apart.map(({ z }, c) => `${value(ours[c])}${value(theirs[c])}${z.toFixed(1).padStart(6)}`);
      console.log(`${String(bounces + 1).padStart(5)}${String(bounces).padStart(8)}  ${cells.join("")}`);
      most = Math.max(most, ...apart.map(({ z }) => Math.abs(z)));
    }
  } finally {
    await renderers.stop();
  }
  const verdict = most <= kMostErrors ? "they agree" : "THEY DIFFER";
  console.log(`largest difference ${most.toFixed(1)} standard errors, ${kMostErrors} allowed: ${verdict}`);
  if (most > kMostErrors) process.exitCode = 1;
  return [];
}
