// Error budget compared with Cycles' noise threshold: requested, predicted and real errors. Errors are root
// mean squares of display values, from 0 to 1. The threshold of Cycles has no unit.

import { show_progress } from "./measure.mjs";
import { kOrrery } from "./command.mjs";
import { mean_picture } from "./picture.mjs";
import { start_renderers } from "./renderers.mjs";

const kScenes = [
  { title: "the Cornell box", file: "scenes/cornell-box.json" },
  { title: "glass, metal and chalk under a picture of a sky", file: "scenes/image-sky/stones.json" },
];
const kAsked = [0.05, 0.02, 0.01],
  kBounces = 8,
  kSize = 256,
  kReferenceSamples = 1024;

const encode_srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const shown = (x) => encode_srgb(Math.min(Math.max(x, 0), 1));

function display_error(a, b) {
  let squares = 0;
  a.values.forEach((value, i) => (squares += (shown(value) - shown(b.values[i])) ** 2));
  return Math.sqrt(squares / a.values.length);
}

// Returns a reference image made by the same renderer with many samples. Its error is small compared with
// the requested ones.
async function reference_of(render) {
  const pictures = [];
  for (const seed of [101, 102])
    pictures.push((await render({ samples: kReferenceSamples, bounces: kBounces, seed })).picture);
  return { picture: mean_picture(pictures), error: display_error(...pictures) / 2 };
}

const kWidths = [7, 10, 10, 10, 10, 10, 12, 10];
const line = (values) => values.map((v, i) => String(v).padStart(kWidths[i])).join("");
const digits = (x) => (x === null || x === undefined ? "unknown" : x.toPrecision(2));

async function compare({ title, file }, size) {
  const renderers = start_renderers(file, size),
    rows = [];
  try {
    show_progress("cycles-threshold: references");
    const ours_reference = await reference_of(renderers.ours),
      theirs_reference = await reference_of(renderers.theirs);
    for (const asked of kAsked) {
      show_progress(`cycles-threshold: ${asked}`);
      const ours = await renderers.ours({ error: asked, bounces: kBounces, seed: 1 });
      const theirs = await renderers.theirs({ threshold: asked, samples: 4096, bounces: kBounces, seed: 1 });
      const { certificate, samples } = ours.told;
      rows.push([
        asked,
        digits(certificate.total.rms),
        digits(certificate.estimate),
        digits(display_error(ours.picture, ours_reference.picture)),
        samples,
        ours.cpu_s.toFixed(2),
        digits(display_error(theirs.picture, theirs_reference.picture)),
        theirs.cpu_s.toFixed(2),
      ]);
    }
    console.log(
      `\n${title}, ${size}x${size}, ${kBounces} bounces; the references are off by ` +
        `${digits(ours_reference.error)} and ${digits(theirs_reference.error)}`,
    );
    console.log(line(["asked", "promised", "estimate", "ours is", "samples", "CPU s", "Cycles is", "CPU s"]));
    for (const row of rows) console.log(line(row));
  } finally {
    show_progress("");
    await renderers.stop();
  }
}

export const kCyclesThreshold = {
  name: "cycles-threshold",
  what: "requested, promised and actual error, compared with the noise threshold of Cycles",
  needs: ["blender", kOrrery],
  async run({ size = kSize }) {
    for (const scene of kScenes) await compare(scene, size);
    return [];
  },
};
