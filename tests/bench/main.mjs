// Runs the benchmarks and prints their table. Ratios are theirs / ours: above 1, orrery is better.

import { writeFileSync } from "node:fs";
import { loadavg } from "node:os";
import { existsProgram, ORRERY } from "./command.mjs";
import { BUDGETS } from "./budgets.mjs";
import { CANCEL } from "./cancel.mjs";
import { CYCLES } from "./cycles.mjs";
import { CYCLES_THRESHOLD } from "./cycles_threshold.mjs";
import { DRAG } from "./drag.mjs";
import { EMBREE } from "./embree.mjs";
import { FLAKE_VS_POVRAY } from "./flake_vs_povray.mjs";
import { measure } from "./measure.mjs";
import { MODELS } from "./models.mjs";
import { MOTION } from "./motion.mjs";
import { NOISE } from "./noise.mjs";
import { ORBIT_HTTP } from "./orbit_http.mjs";
import { PAPER_VS_POVRAY } from "./paper_vs_povray.mjs";
import { SCAN_LINE } from "./scan_line.mjs";
import { measureService } from "./service.mjs";
import { SLOW_CLIENTS } from "./slow_clients.mjs";
import { STAGES } from "./stages.mjs";
import { REPORTS as STRUCTURE_REPORTS } from "./structures.mjs";

// Benchmarks. Each has
//   name; what: one line
//   cost: "CPU s" (processor seconds of the whole process) or "wall s"
//   reach, aim: required and desired ratio (null: none)
//   needs: required programs
//   start() -> {ours(), theirs(), stop(), remark}. One call of ours() or theirs() is one run: {cost, cpuS}.
const BENCHMARKS = [NOISE, PAPER_VS_POVRAY, FLAKE_VS_POVRAY, ORBIT_HTTP, ...STAGES, ...MOTION, ...SCAN_LINE, ...MODELS];

const REPORTS = [EMBREE, CYCLES, CYCLES_THRESHOLD, BUDGETS, ...STRUCTURE_REPORTS, CANCEL, DRAG, SLOW_CLIENTS];
const ALL = [...BENCHMARKS, ...REPORTS];

const QUIET_LOAD = 0.3; // maximum load average of an idle machine
const USAGE =
  "usage: tests/bench/run [NAME...] [--pairs N] [--json FILE] [--charts FOLDER] [--list]\n" +
  "                       [--meshes FOLDER] [--triangles N]      embree: additional mesh files, size of generated meshes\n" +
  "                       [--seeds N] [--samples N] [--size N]   cycles: pairs of seeds, maximum samples, image side in pixels\n" +
  "                       [--bounces]                            cycles: compare means by path length\n" +
  "       tests/bench/run service [PROPERTY...]   the service under load, half an hour for all properties";

function fail(message) {
  console.error(`bench: ${message}\n${USAGE}`);
  process.exit(2);
}

function wholeNumber(option, word) {
  const value = Number(word);
  return Number.isInteger(value) && value > 0 ? value : fail(`${option}: must be an integer > 0`);
}

// Returns true if `word` is the name or its prefix before a hyphen. "reordering" selects all reordering
// benchmarks.
const goesBy = ({ name }, word) => name === word || name.startsWith(`${word}-`);

// Integer options that only some benchmarks use. The benchmarks have their own defaults.
const COUNTS = { "--triangles": "triangles", "--seeds": "seeds", "--samples": "samples", "--size": "size" };

function readArguments(words) {
  const options = {
    names: [],
    pairs: 7,
    json: null,
    charts: "build/charts",
    meshes: null,
    list: false,
    bounces: false,
  };
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === "--list") options.list = true;
    else if (words[i] === "--bounces") options.bounces = true;
    else if (words[i] in COUNTS) options[COUNTS[words[i]]] = wholeNumber(words[i], words[++i]);
    else if (words[i] === "--meshes") options.meshes = words[++i] ?? fail("--meshes: folder is missing");
    else if (words[i] === "--pairs") options.pairs = wholeNumber(words[i], words[++i]);
    else if (words[i] === "--json") options.json = words[++i];
    else if (words[i] === "--charts") options.charts = words[++i];
    else if (words[i].startsWith("-")) fail(`unknown option ${words[i]}`);
    else if (ALL.some((b) => goesBy(b, words[i]))) options.names.push(words[i]);
    else fail(`unknown benchmark ${words[i]}; must be one of ${ALL.map((b) => b.name).join(", ")}`);
  }
  if (options.json === undefined) fail("--json: file name is missing");
  if (options.charts === undefined) fail("--charts: folder is missing");
  return options;
}

const COLUMNS = [
  ["name", 31, (r) => r.name],
  ["ours CPU s", 11, (r) => r.oursCpuS.toFixed(3)],
  ["theirs CPU s", 13, (r) => r.theirsCpuS.toFixed(3)],
  ["ratio", 8, (r) => r.ratio.toFixed(2)],
  ["min .. max", 18, (r) => `${r.ratioMin.toFixed(2)} .. ${r.ratioMax.toFixed(2)}`],
  ["reach", 7, (r) => r.reach ?? "-"],
  ["aim", 6, (r) => r.aim ?? "-"],
];

function tableRow(cellOf) {
  return COLUMNS.map(([name, width, value], i) => {
    const text = String(cellOf(name, value));
    return i === 0 ? text.padEnd(width) : text.padStart(width);
  }).join("");
}

function isMissing({ name, needs }) {
  const missing = needs.filter((program) => !existsProgram(program));
  if (missing.length > 0) console.log(`${name} skipped: ${missing.join(", ")} is not installed`);
  return missing.length > 0;
}

async function runBenchmark(benchmark, pairs) {
  if (isMissing(benchmark)) return null;
  try {
    const result = await measure(benchmark, pairs);
    console.log(tableRow((_, value) => value(result)));
    return result;
  } catch (error) {
    console.log(`${benchmark.name} failed: ${error.message}`);
    process.exitCode = 1;
    return null;
  }
}

async function main() {
  if (process.argv[2] === "service") return measureService(process.argv.slice(3));
  const options = readArguments(process.argv.slice(2));
  if (options.list) {
    for (const { name, what } of ALL) console.log(`${name.padEnd(31)}${what}`);
    console.log(`${"service".padEnd(31)}the service under load, only if selected; see \`service --list\``);
    return;
  }
  if (!existsProgram(ORRERY)) fail(`${ORRERY} is not built`);
  const load = loadavg()[0];
  if (load > QUIET_LOAD) console.log(`warning: the machine is not idle (load average ${load.toFixed(2)})`);
  const isChosen = (b) => options.names.length === 0 || options.names.some((name) => goesBy(b, name));
  const chosenOf = (all) => all.filter(isChosen);
  const chosen = chosenOf(BENCHMARKS);
  if (chosen.length > 0) console.log(tableRow((name) => name));
  const results = [];
  for (const benchmark of chosen) {
    const result = await runBenchmark(benchmark, options.pairs);
    if (result) results.push(result);
  }
  for (const { name, what, cost, runs, remark } of results)
    console.log(`${name}: ${what}; ${runs} pairs, ratio of ${cost}${remark ? `; ${remark}` : ""}`);
  for (const report of chosenOf(REPORTS)) if (!isMissing(report)) results.push(...((await report.run(options)) ?? []));
  if (options.json) writeFileSync(options.json, JSON.stringify(results, null, 2) + "\n");
}

await main();
