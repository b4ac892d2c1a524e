// Compares error budgets with Cycles' noise threshold: requested, predicted and actual errors. Errors are
// root mean squares of display values in [0, 1]. The threshold of Cycles has no unit.

import { showProgress } from "./measure.mjs";
import { ORRERY } from "./command.mjs";
import { meanPicture } from "./picture.mjs";
import { startRenderers } from "./renderers.mjs";

const SCENES = [
  { title: "the Cornell box", file: "scenes/cornell-box.json" },
  { title: "glass, metal and chalk under an image of a sky", file: "scenes/image-sky/stones.json" },
];
const ASKED = [0.05, 0.02, 0.01],
  BOUNCES = 8,
  SIZE = 256,
  REFERENCE_SAMPLES = 1024;

const encodeSrgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const shown = (x) => encodeSrgb(Math.min(Math.max(x, 0), 1));

function displayError(a, b) {
  let squares = 0;
  a.values.forEach((value, i) => (squares += (shown(value) - shown(b.values[i])) ** 2));
  return Math.sqrt(squares / a.values.length);
}

// Returns a reference image of the same renderer with many samples, and an estimate of its error. This error
// is small compared with the requested errors.
async function referenceOf(render) {
  const pictures = [];
  for (const seed of [101, 102])
    pictures.push((await render({ samples: REFERENCE_SAMPLES, bounces: BOUNCES, seed })).picture);
  return { picture: meanPicture(pictures), error: displayError(...pictures) / 2 };
}

const WIDTHS = [7, 10, 10, 10, 10, 10, 12, 10];
const line = (values) => values.map((v, i) => String(v).padStart(WIDTHS[i])).join("");
const digits = (x) => (x === null || x === undefined ? "unknown" : x.toPrecision(2));

async function compare({ title, file }, size) {
  const renderers = startRenderers(file, size),
    rows = [];
  try {
    showProgress("cycles-threshold: references");
    const oursReference = await referenceOf(renderers.ours),
      theirsReference = await referenceOf(renderers.theirs);
    for (const asked of ASKED) {
      showProgress(`cycles-threshold: ${asked}`);
      const ours = await renderers.ours({ error: asked, bounces: BOUNCES, seed: 1 });
      const theirs = await renderers.theirs({ threshold: asked, samples: 4096, bounces: BOUNCES, seed: 1 });
      const { certificate, samples } = ours.stats;
      rows.push([
        asked,
        digits(certificate.total.rms),
        digits(certificate.estimate),
        digits(displayError(ours.picture, oursReference.picture)),
        samples,
        ours.cpuS.toFixed(2),
        digits(displayError(theirs.picture, theirsReference.picture)),
        theirs.cpuS.toFixed(2),
      ]);
    }
    console.log(
      `\n${title}, ${size}x${size}, ${BOUNCES} bounces; errors of the references ` +
        `${digits(oursReference.error)} and ${digits(theirsReference.error)}`,
    );
    console.log(line(["requested", "promised", "estimate", "ours", "samples", "CPU s", "Cycles", "CPU s"]));
    for (const row of rows) console.log(line(row));
  } finally {
    showProgress("");
    await renderers.stop();
  }
}

export const CYCLES_THRESHOLD = {
  name: "cycles-threshold",
  what: "requested, promised and actual error, compared with the noise threshold of Cycles",
  needs: ["blender", ORRERY],
  async run({ size = SIZE }) {
    for (const scene of SCENES) await compare(scene, size);
    return [];
  },
};
