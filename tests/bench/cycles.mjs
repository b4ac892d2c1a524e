// Compares the CPU time to equal error with Cycles. Both renderers are unbiased, so half the mean squared
// difference of two images with different seeds is the mean squared error of one image. Also prints how well
// the renderers agree.

import { mkdirSync, writeFileSync } from "node:fs";
import { comparePathLengths } from "./cycles_bounces.mjs";
import { agreement, printAgreement, printDefaults } from "./cycles_bias.mjs";
import { chart } from "./chart.mjs";
import { ORRERY } from "./command.mjs";
import { median, showProgress } from "./measure.mjs";
import { blockMeans, meanProduct } from "./picture.mjs";
import { startRenderers } from "./renderers.mjs";

const SCENES = [
  { name: "cornell", title: "the Cornell box", file: "scenes/cornell-box.json" },
  { name: "stones", title: "glass, metal and chalk under an image of a sky", file: "scenes/image-sky/stones.json" },
];
const BOUNCES = 8;
const SIZE = 512,
  PAIRS = 2,
  LEAST_SAMPLES = 4,
  MOST_SAMPLES = 256;
const BLOCKS = [1, 4, 32]; // sides in pixels; larger blocks reveal correlated errors
const TARGETS = [0.02, 0.01, 0.005],
  REACH = 3,
  AIM = 6; // root mean squared errors of a pixel, required ratio and desired ratio
const RENDERERS = ["ours", "theirs"],
  NAMES = { ours: "orrery", theirs: "Cycles" };
const DEFAULTS_SEEDS = 1000; // seed offset, so that this noise is independent of the fair images

const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
const blockName = (side) => (side === 1 ? "pixel" : `${side}x${side}`);
const squaredError = (a, b) => meanProduct(a, b, a, b) / 2;

// Renders two images with each renderer, in the order ABBA.
async function twoOfEach(renderers, order, seeds) {
  const runs = { ours: [], theirs: [] };
  for (const [side, i] of [
    ["ours", 0],
    ["theirs", 0],
    ["theirs", 1],
    ["ours", 1],
  ])
    runs[side].push(await renderers[side]({ ...order, seed: seeds[i] }));
  return runs;
}

function summary(samples, runs) {
  const [a, b] = runs.map(({ picture }) => picture);
  const squaredErrors = BLOCKS.map((side) => squaredError(blockMeans(a, side), blockMeans(b, side)));
  return { samples, cpuS: mean(runs.map(({ cpuS }) => cpuS)), squaredErrors };
}

// Estimates the set-up time (conversion, building, writing), which does not depend on the number of samples.
// Extrapolates the CPU time of 1 sample and of the largest count to 0 samples. Returns the set-up time, and
// the other rows with this time subtracted.
function withoutSetup([one, ...rows]) {
  const most = rows.at(-1),
    aSample = (most.cpuS - one.cpuS) / (most.samples - one.samples);
  const setupS = one.cpuS - aSample;
  return { setupS, rows: rows.map((row) => ({ ...row, cpuS: row.cpuS - setupS })) };
}

// Returns {setupS, rows, pictures} for each renderer. The images have the largest sample count.
async function measurePair(renderers, counts, pair) {
  const seeds = [2 * pair + 1, 2 * pair + 2];
  const rows = { ours: [], theirs: [] },
    pictures = {};
  for (const samples of [1, ...counts]) {
    showProgress(`cycles: pair ${pair + 1}, ${samples} samples`);
    const runs = await twoOfEach(renderers, { samples, bounces: BOUNCES }, seeds);
    for (const side of RENDERERS) {
      rows[side].push(summary(samples, runs[side]));
      pictures[side] = runs[side].map(({ picture }) => picture);
    }
  }
  return Object.fromEntries(RENDERERS.map((side) => [side, { ...withoutSetup(rows[side]), pictures: pictures[side] }]));
}

async function measureDefaults(renderers, samples, pair, setupS) {
  showProgress(`cycles: pair ${pair + 1}, Blender's defaults`);
  const runs = [];
  for (const seed of [2 * pair + 1, 2 * pair + 2])
    runs.push(await renderers.theirs({ samples, bounces: BOUNCES, preset: "defaults", seed: DEFAULTS_SEEDS + seed }));
  const { cpuS, squaredErrors } = summary(samples, runs);
  return { cpuS: cpuS - setupS, squaredErrors, pictures: runs.map(({ picture }) => picture) };
}

// Fits the line log error = log a + b log seconds by least squares. Returns {slope: b, seconds(error)}.
function fit(rows, block) {
  const x = rows.map(({ cpuS }) => Math.log(cpuS)),
    y = rows.map((row) => Math.log(row.squaredErrors[block]) / 2);
  const meanX = mean(x),
    meanY = mean(y);
  const slope = mean(x.map((v, i) => (v - meanX) * (y[i] - meanY))) / mean(x.map((v) => (v - meanX) ** 2));
  return { slope, seconds: (error) => Math.exp(meanX + (Math.log(error) - meanY) / slope) };
}

// Returns the median seconds and the mean squared errors over all pairs, one row per sample count.
function pooled(pairs, side) {
  return pairs[0][side].rows.map(({ samples }, i) => ({
    samples,
    cpuS: median(pairs.map((pair) => pair[side].rows[i].cpuS)),
    squaredErrors: BLOCKS.map((_, block) => mean(pairs.map((pair) => pair[side].rows[i].squaredErrors[block]))),
  }));
}

const WIDTHS = [9, 12, 12, 12, 12, 14, 12, 12, 12];
const line = (values) => values.map((v, i) => String(v).padStart(WIDTHS[i])).join("");

function printErrors(rows, pairs) {
  const head = RENDERERS.flatMap((side) => [`${side} CPU s`, ...BLOCKS.map(blockName)]);
  console.log(line(["samples", ...head]));
  rows.ours.forEach(({ samples }, i) => {
    const cells = RENDERERS.flatMap((side) => {
      const { cpuS, squaredErrors } = rows[side][i];
      return [cpuS.toFixed(3), ...squaredErrors.map((e) => Math.sqrt(e).toFixed(6))];
    });
    console.log(line([samples, ...cells]));
  });
  for (const side of RENDERERS) {
    const slope = (block) => median(pairs.map((pair) => fit(pair[side].rows, block).slope));
    const slopes = BLOCKS.map((_, block) => slope(block).toFixed(3));
    const setup = median(pairs.map((pair) => pair[side].setupS));
    const power = `error is proportional to CPU time to the power of ${slopes.join(", ")}`;
    console.log(`${side}: ${power}; ${setup.toFixed(3)} s of set-up excluded`);
  }
}

// Compares the CPU seconds that the renderers need for the error `target / side` in blocks of side x side
// pixels. With independent pixels, blocks reach this error at the same time as pixels reach `target`.
function ratioRow(scene, pairs, rows, block, target) {
  const side = BLOCKS[block],
    error = target / side;
  const seconds = Object.fromEntries(
    RENDERERS.map((one) => [one, pairs.map((pair) => fit(pair[one].rows, block).seconds(error))]),
  );
  const ratios = seconds.theirs.map((theirs, i) => theirs / seconds.ours[i]);
  const isBeyond = RENDERERS.some((one) => {
    const reached = rows[one].map(({ squaredErrors }) => Math.sqrt(squaredErrors[block]));
    return error > Math.max(...reached) || error < Math.min(...reached);
  });
  const where = side === 1 ? "a pixel" : `means of ${blockName(side)} pixels`;
  return {
    name: `cycles-${scene.name}-${target}${side === 1 ? "" : `-${blockName(side)}`}`,
    what: `${scene.title} to a root mean squared error of ${error} in ${where}`,
    cost: "CPU s",
    ratio: median(ratios),
    ratioMin: Math.min(...ratios),
    ratioMax: Math.max(...ratios),
    reach: REACH,
    aim: AIM,
    runs: pairs.length,
    oursCpuS: median(seconds.ours),
    theirsCpuS: median(seconds.theirs),
    remark: isBeyond ? "extrapolated by the fitted lines" : undefined,
  };
}

const ratioLine = (name, ours, theirs, ratio, range) =>
  name.padEnd(31) + ours.padStart(11) + theirs.padStart(13) + ratio.padStart(8) + range.padStart(18);

function printRatios(ratios) {
  console.log(`\n${ratioLine("CPU seconds to error", "ours", "theirs", "ratio", "min .. max")}`);
  for (const { name, oursCpuS, theirsCpuS, ratio, ratioMin, ratioMax, remark } of ratios) {
    const values = [oursCpuS, theirsCpuS, ratio, ratioMin, ratioMax];
    const [ours, theirs, middle, least, most] = values.map((value) => value.toFixed(2));
    console.log(ratioLine(name, ours, theirs, middle, `${least} .. ${most}`) + (remark ? `  ${remark}` : ""));
  }
  console.log(`required ratio ${REACH}, desired ${AIM}; errors of blocks are divided by their side`);
}

function draw(file, scene, rows, size) {
  const panels = BLOCKS.map((side, block) => ({
    title: side === 1 ? "one pixel" : `means of ${blockName(side)} pixels`,
    x: "CPU seconds",
    y: "root mean squared error",
    series: RENDERERS.map((one) => ({
      line: true,
      points: rows[one].map(({ samples, cpuS, squaredErrors }) => ({
        x: cpuS,
        y: Math.sqrt(squaredErrors[block]),
        label: `${NAMES[one]}, ${samples} samples`,
      })),
    })),
  }));
  const title = `${scene.title[0].toUpperCase()}${scene.title.slice(1)}: error against CPU time`;
  const note = `${size}x${size}, ${BOUNCES} bounces, box filter, no clamping; left and down is better`;
  writeFileSync(
    file,
    chart({ title, note, panels, columns: panels.length, names: RENDERERS.map((one) => NAMES[one]) }),
  );
}

async function measure(scene, pairCount, counts, size) {
  const renderers = startRenderers(scene.file, size),
    pairs = [],
    defaults = [];
  try {
    await twoOfEach(renderers, { samples: 1, bounces: BOUNCES }, [1, 2]); // warm-up
    for (let pair = 0; pair < pairCount; ++pair) {
      pairs.push(await measurePair(renderers, counts, pair));
      defaults.push(await measureDefaults(renderers, counts.at(-1), pair, pairs[pair].theirs.setupS));
    }
  } finally {
    showProgress("");
    await renderers.stop();
  }
  return { pairs, defaults };
}

function countsTo(most) {
  const counts = [];
  for (let samples = LEAST_SAMPLES; samples <= most; samples *= 2) counts.push(samples);
  if (counts.length < 2) throw new Error(`--samples: must be at least ${2 * LEAST_SAMPLES}`);
  return counts;
}

async function compareErrors(scene, { seeds = PAIRS, samples = MOST_SAMPLES, size = SIZE, charts }) {
  const counts = countsTo(samples);
  if (size % Math.max(...BLOCKS) !== 0) throw new Error(`--size: must be a multiple of ${Math.max(...BLOCKS)}`);
  const { pairs, defaults } = await measure(scene, seeds, counts, size);
  const rows = { ours: pooled(pairs, "ours"), theirs: pooled(pairs, "theirs") };
  console.log(
    `\n${scene.title}, ${size}x${size}, ${BOUNCES} bounces, two threads: root mean squared error of linear R,`,
  );
  console.log(`G and B, by pixel and by means of blocks; pairs of seeds: ${pairs.length}`);
  printErrors(rows, pairs);
  const ratios = BLOCKS.flatMap((_, block) => TARGETS.map((target) => ratioRow(scene, pairs, rows, block, target)));
  printRatios(ratios);
  const found = agreement(pairs, BLOCKS);
  printAgreement(found, BLOCKS.map(blockName));
  printDefaults(defaults, counts.at(-1), found, rows.theirs.at(-1));
  mkdirSync(charts, { recursive: true });
  const chartFile = `${charts}/cycles-${scene.name}.svg`;
  draw(chartFile, scene, rows, size);
  console.log(`chart: ${chartFile}`);
  return ratios;
}

export const CYCLES = {
  name: "cycles",
  what: "CPU time to equal error compared with Cycles (Blender 3.4), and difference of the means",
  needs: ["blender", ORRERY],
  async run(options) {
    try {
      if (options.bounces) return await comparePathLengths(SCENES[0].file, options);
      const rows = [];
      for (const scene of SCENES) rows.push(...(await compareErrors(scene, options)));
      return rows;
    } catch (error) {
      console.log(`cycles failed: ${error.message}`);
      process.exitCode = 1;
      return [];
    }
  },
};
