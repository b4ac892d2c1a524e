// CPU time to the same error, compared with Cycles. Pictures differ only in the seed. Both renderers are
// unbiased, so half the mean squared difference of two such pictures is the mean squared error of one. Their
// agreement is printed too.

import { mkdirSync, writeFileSync } from "node:fs";
import { compare_path_lengths } from "./cycles_bounces.mjs";
import { agreement, print_agreement, print_defaults } from "./cycles_bias.mjs";
import { chart } from "./chart.mjs";
import { kOrrery } from "./command.mjs";
import { median, show_progress } from "./measure.mjs";
import { block_means, mean_product } from "./picture.mjs";
import { start_renderers } from "./renderers.mjs";

const kScenes = [
  { name: "cornell", title: "the Cornell box", file: "scenes/cornell-box.json" },
  { name: "stones", title: "glass, metal and chalk under a picture of a sky", file: "scenes/image-sky/stones.json" },
];
const kBounces = 8;
const kSize = 512,
  kPairs = 2,
  kLeastSamples = 4,
  kMostSamples = 256;
const kBlocks = [1, 4, 32]; // sides in pixels; blocks reveal smoothed or spread errors
const kTargets = [0.02, 0.01, 0.005],
  kReach = 3,
  kAim = 6; // root mean squared errors of a pixel
const kRenderers = ["ours", "theirs"],
  kNames = { ours: "orrery", theirs: "Cycles" };
const kDefaultsSeeds = 1000; // seed offset, so that the noise is independent of the fair pictures

const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
const block_name = (side) => (side === 1 ? "pixel" : `${side}x${side}`);
const squared_error = (a, b) => mean_product(a, b, a, b) / 2;

// Renders two pictures with each renderer, in the order ABBA.
async function two_of_each(renderers, order, seeds) {
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
  const squared_errors = kBlocks.map((side) => squared_error(block_means(a, side), block_means(b, side)));
  return { samples, cpu_s: mean(runs.map(({ cpu_s }) => cpu_s)), squared_errors };
}

// Estimates the set-up time (conversion, building, writing), which does not depend on the number of samples.
// Extrapolates the CPU time from 1 sample and the largest count to 0 samples. Returns it, and the rows of
// more than one sample without it.
function without_setup([one, ...rows]) {
  const most = rows.at(-1),
    a_sample = (most.cpu_s - one.cpu_s) / (most.samples - one.samples);
  const setup_s = one.cpu_s - a_sample;
  return { setup_s, rows: rows.map((row) => ({ ...row, cpu_s: row.cpu_s - setup_s })) };
}

// Returns {setup_s, rows, pictures} for each renderer. The pictures are those of the largest sample count.
async function measure_pair(renderers, counts, pair) {
  const seeds = [2 * pair + 1, 2 * pair + 2];
  const rows = { ours: [], theirs: [] },
    pictures = {};
  for (const samples of [1, ...counts]) {
    show_progress(`cycles: pair ${pair + 1}, ${samples} samples`);
    const runs = await two_of_each(renderers, { samples, bounces: kBounces }, seeds);
    for (const side of kRenderers) {
      rows[side].push(summary(samples, runs[side]));
      pictures[side] = runs[side].map(({ picture }) => picture);
    }
  }
  return Object.fromEntries(
    kRenderers.map((side) => [side, { ...without_setup(rows[side]), pictures: pictures[side] }]),
  );
}

async function measure_defaults(renderers, samples, pair, setup_s) {
  show_progress(`cycles: pair ${pair + 1}, Blender's defaults`);
  const runs = [];
  for (const seed of [2 * pair + 1, 2 * pair + 2])
    runs.push(await renderers.theirs({ samples, bounces: kBounces, preset: "defaults", seed: kDefaultsSeeds + seed }));
  const { cpu_s, squared_errors } = summary(samples, runs);
  return { cpu_s: cpu_s - setup_s, squared_errors, pictures: runs.map(({ picture }) => picture) };
}

// Fits the line log error = log a + b log seconds by least squares. Returns {slope: b, seconds(error)}.
function fit(rows, block) {
  const x = rows.map(({ cpu_s }) => Math.log(cpu_s)),
    y = rows.map((row) => Math.log(row.squared_errors[block]) / 2);
  const mean_x = mean(x),
    mean_y = mean(y);
  const slope = mean(x.map((v, i) => (v - mean_x) * (y[i] - mean_y))) / mean(x.map((v) => (v - mean_x) ** 2));
  return { slope, seconds: (error) => Math.exp(mean_x + (Math.log(error) - mean_y) / slope) };
}

// Returns the median seconds and the mean squared errors over all pairs.
function pooled(pairs, side) {
  return pairs[0][side].rows.map(({ samples }, i) => ({
    samples,
    cpu_s: median(pairs.map((pair) => pair[side].rows[i].cpu_s)),
    squared_errors: kBlocks.map((_, block) => mean(pairs.map((pair) => pair[side].rows[i].squared_errors[block]))),
  }));
}

const kWidths = [9, 12, 12, 12, 12, 14, 12, 12, 12];
const line = (values) => values.map((v, i) => String(v).padStart(kWidths[i])).join("");

function print_errors(rows, pairs) {
  const head = kRenderers.flatMap((side) => [`${side} CPU s`, ...kBlocks.map(block_name)]);
  console.log(line(["samples", ...head]));
  rows.ours.forEach(({ samples }, i) => {
    const cells = kRenderers.flatMap((side) => {
      const { cpu_s, squared_errors } = rows[side][i];
      return [cpu_s.toFixed(3), ...squared_errors.map((e) => Math.sqrt(e).toFixed(6))];
    });
    console.log(line([samples, ...cells]));
  });
  for (const side of kRenderers) {
    const slope = (block) => median(pairs.map((pair) => fit(pair[side].rows, block).slope));
    const slopes = kBlocks.map((_, block) => slope(block).toFixed(3));
    const setup = median(pairs.map((pair) => pair[side].setup_s));
    const power = `error goes as CPU time to the power of ${slopes.join(", ")}`;
    console.log(`${side}: ${power}; ${setup.toFixed(3)} s of set-up left out`);
  }
}

// Compares the CPU seconds to the error `target / side` in blocks of that side. Independent pixels reach it
// at the same time as `target`.
function ratio_row(scene, pairs, rows, block, target) {
  const side = kBlocks[block],
    error = target / side;
  const seconds = Object.fromEntries(
    kRenderers.map((one) => [one, pairs.map((pair) => fit(pair[one].rows, block).seconds(error))]),
  );
  const ratios = seconds.theirs.map((theirs, i) => theirs / seconds.ours[i]);
  const is_beyond = kRenderers.some((one) => {
    const reached = rows[one].map(({ squared_errors }) => Math.sqrt(squared_errors[block]));
    return error > Math.max(...reached) || error < Math.min(...reached);
  });
  const where = side === 1 ? "a pixel" : `means of ${block_name(side)} pixels`;
  return {
    name: `cycles-${scene.name}-${target}${side === 1 ? "" : `-${block_name(side)}`}`,
    what: `${scene.title} to a root mean squared error of ${error} in ${where}`,
    cost: "CPU s",
    ratio: median(ratios),
    ratio_min: Math.min(...ratios),
    ratio_max: Math.max(...ratios),
    reach: kReach,
    aim: kAim,
    runs: pairs.length,
    ours_cpu_s: median(seconds.ours),
    theirs_cpu_s: median(seconds.theirs),
    remark: is_beyond ? "beyond what was measured, by the fitted lines" : undefined,
  };
}

const ratio_line = (name, ours, theirs, ratio, range) =>
  name.padEnd(31) + ours.padStart(11) + theirs.padStart(13) + ratio.padStart(8) + range.padStart(18);

function print_ratios(ratios) {
  console.log(`\n${ratio_line("CPU seconds to an error of", "ours", "theirs", "ratio", "min .. max")}`);
  for (const { name, ours_cpu_s, theirs_cpu_s, ratio, ratio_min, ratio_max, remark } of ratios) {
    const values = [ours_cpu_s, theirs_cpu_s, ratio, ratio_min, ratio_max];
    const [ours, theirs, middle, least, most] = values.map((value) => value.toFixed(2));
    console.log(ratio_line(name, ours, theirs, middle, `${least} .. ${most}`) + (remark ? `  ${remark}` : ""));
  }
  console.log(`reach ${kReach}, aim ${kAim} each; blocks: to that error divided by their side`);
}

function draw(file, scene, rows, size) {
  const panels = kBlocks.map((side, block) => ({
    title: side === 1 ? "one pixel" : `means of ${block_name(side)} pixels`,
    x: "CPU seconds",
    y: "root mean squared error",
    series: kRenderers.map((one) => ({
      line: true,
      points: rows[one].map(({ samples, cpu_s, squared_errors }) => ({
        x: cpu_s,
        y: Math.sqrt(squared_errors[block]),
        label: `${kNames[one]}, ${samples} samples`,
      })),
    })),
  }));
  const title = `${scene.title[0].toUpperCase()}${scene.title.slice(1)}: error against CPU time`;
  const note = `${size}x${size}, ${kBounces} bounces, box filter, nothing clamped; further left and down is better`;
  writeFileSync(
    file,
    chart({ title, note, panels, columns: panels.length, names: kRenderers.map((one) => kNames[one]) }),
  );
}

async function measure(scene, pair_count, counts, size) {
  const renderers = start_renderers(scene.file, size),
    pairs = [],
    defaults = [];
  try {
    await two_of_each(renderers, { samples: 1, bounces: kBounces }, [1, 2]); // warm-up
    for (let pair = 0; pair < pair_count; ++pair) {
      pairs.push(await measure_pair(renderers, counts, pair));
      defaults.push(await measure_defaults(renderers, counts.at(-1), pair, pairs[pair].theirs.setup_s));
    }
  } finally {
    show_progress("");
    await renderers.stop();
  }
  return { pairs, defaults };
}

function counts_to(most) {
  const counts = [];
  for (let samples = kLeastSamples; samples <= most; samples *= 2) counts.push(samples);
  if (counts.length < 2) throw new Error(`--samples expects at least ${2 * kLeastSamples}`);
  return counts;
}

async function compare_errors(scene, { seeds = kPairs, samples = kMostSamples, size = kSize, charts }) {
  const counts = counts_to(samples);
  if (size % Math.max(...kBlocks) !== 0) throw new Error(`--size expects a multiple of ${Math.max(...kBlocks)}`);
  const { pairs, defaults } = await measure(scene, seeds, counts, size);
  const rows = { ours: pooled(pairs, "ours"), theirs: pooled(pairs, "theirs") };
  console.log(
    `\n${scene.title}, ${size}x${size}, ${kBounces} bounces, two threads: root mean squared error of linear R,`,
  );
  console.log(`G and B, by pixel and by means of blocks; pairs of seeds: ${pairs.length}`);
  print_errors(rows, pairs);
  const ratios = kBlocks.flatMap((_, block) => kTargets.map((target) => ratio_row(scene, pairs, rows, block, target)));
  print_ratios(ratios);
  const found = agreement(pairs, kBlocks);
  print_agreement(found, kBlocks.map(block_name));
  print_defaults(defaults, counts.at(-1), found, rows.theirs.at(-1));
  mkdirSync(charts, { recursive: true });
  const chart_file = `${charts}/cycles-${scene.name}.svg`;
  draw(chart_file, scene, rows, size);
  console.log(`chart: ${chart_file}`);
  return ratios;
}

export const kCycles = {
  name: "cycles",
  what: "CPU time to equal error compared with Cycles (Blender 3.4), and agreement of the means",
  needs: ["blender", kOrrery],
  async run(options) {
    try {
      if (options.bounces) return await compare_path_lengths(kScenes[0].file, options);
      const rows = [];
      for (const scene of kScenes) rows.push(...(await compare_errors(scene, options)));
      return rows;
    } catch (error) {
      console.log(`cycles failed: ${error.message}`);
      process.exitCode = 1;
      return [];
    }
  },
};
