// Runs the benchmarks and prints their table. A ratio above 1 means that ours is better.

import { writeFileSync } from "node:fs";
import { loadavg } from "node:os";
import { exists_program, kOrrery } from "./command.mjs";
import { kBudgets } from "./budgets.mjs";
import { kCancel } from "./cancel.mjs";
import { kCycles } from "./cycles.mjs";
import { kCyclesThreshold } from "./cycles_threshold.mjs";
import { kDrag } from "./drag.mjs";
import { kEmbree } from "./embree.mjs";
import { kFlakeVsPovray } from "./flake_vs_povray.mjs";
import { measure } from "./measure.mjs";
import { kMotion } from "./motion.mjs";
import { kNoise } from "./noise.mjs";
import { kOrbitHttp } from "./orbit_http.mjs";
import { kPaperVsPovray } from "./paper_vs_povray.mjs";
import { measure_service } from "./service.mjs";
import { kSlowClients } from "./slow_clients.mjs";
import { kStages } from "./stages.mjs";
import { kReports as kStructureReports } from "./structures.mjs";

// Benchmarks. Each has
//   name; what: one line
//   cost: "CPU s" (processor seconds of the whole process) or "wall s"
//   reach, aim: required and desired ratio (null: none)
//   needs: required programs
//   start() -> {ours(), theirs(), stop(), remark}. One call of ours() or theirs() is one run: {cost, cpu_s}.
const kBenchmarks = [kNoise, kPaperVsPovray, kFlakeVsPovray, kOrbitHttp, ...kStages, ...kMotion];

const kReports = [kEmbree, kCycles, kCyclesThreshold, kBudgets, ...kStructureReports, kCancel, kDrag, kSlowClients];
const kAll = [...kBenchmarks, ...kReports];

const kQuietLoad = 0.3; // load average of a busy machine
const kUsage =
  "usage: tests/bench/run [NAME...] [--pairs N] [--json FILE] [--charts FOLDER] [--list]\n" +
  "                       [--meshes FOLDER] [--triangles N]      of embree: mesh files beside those that are made, one size\n" +
  "                       [--seeds N] [--samples N] [--size N]   of cycles: pairs of seeds, most samples, pixels a side\n" +
  "                       [--bounces]                            of cycles: means by path length instead\n" +
  "       tests/bench/run service [PROPERTY...]   the service under load, half an hour for all";

function fail(message) {
  console.error(`bench: ${message}\n${kUsage}`);
  process.exit(2);
}

function whole_number(option, word) {
  const value = Number(word);
  return Number.isInteger(value) && value > 0 ? value : fail(`${option} expects a whole number > 0`);
}

// Returns whether `word` is the name or a prefix of it: "embree" selects all of them.
const goes_by = ({ name }, word) => name === word || name.startsWith(`${word}-`);

// Count options of some benchmarks, which have their own defaults.
const kCounts = { "--triangles": "triangles", "--seeds": "seeds", "--samples": "samples", "--size": "size" };

function read_arguments(words) {
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
    else if (words[i] in kCounts) options[kCounts[words[i]]] = whole_number(words[i], words[++i]);
    else if (words[i] === "--meshes") options.meshes = words[++i] ?? fail("--meshes expects a folder");
    else if (words[i] === "--pairs") options.pairs = whole_number(words[i], words[++i]);
    else if (words[i] === "--json") options.json = words[++i];
    else if (words[i] === "--charts") options.charts = words[++i];
    else if (words[i].startsWith("-")) fail(`unknown option ${words[i]}`);
    else if (kAll.some((b) => goes_by(b, words[i]))) options.names.push(words[i]);
    else fail(`no benchmark is called ${words[i]}; there are ${kAll.map((b) => b.name).join(", ")}`);
  }
  if (options.json === undefined) fail("--json expects a file name");
  if (options.charts === undefined) fail("--charts expects a folder");
  return options;
}

const kColumns = [
  ["name", 31, (r) => r.name],
  ["ours CPU s", 11, (r) => r.ours_cpu_s.toFixed(3)],
  ["theirs CPU s", 13, (r) => r.theirs_cpu_s.toFixed(3)],
  ["ratio", 8, (r) => r.ratio.toFixed(2)],
  ["min .. max", 18, (r) => `${r.ratio_min.toFixed(2)} .. ${r.ratio_max.toFixed(2)}`],
  ["reach", 7, (r) => r.reach ?? "-"],
  ["aim", 6, (r) => r.aim ?? "-"],
];

function table_row(cell_of) {
  return kColumns
    .map(([name, width, value], i) => {
      const text = String(cell_of(name, value));
      return i === 0 ? text.padEnd(width) : text.padStart(width);
    })
    .join("");
}

function is_missing({ name, needs }) {
  const missing = needs.filter((program) => !exists_program(program));
  if (missing.length > 0) console.log(`${name} skipped: ${missing.join(", ")} is not installed`);
  return missing.length > 0;
}

async function run_benchmark(benchmark, pairs) {
  if (is_missing(benchmark)) return null;
  try {
    const result = await measure(benchmark, pairs);
    console.log(table_row((_, value) => value(result)));
    return result;
  } catch (error) {
    console.log(`${benchmark.name} failed: ${error.message}`);
    process.exitCode = 1;
    return null;
  }
}

async function main() {
  if (process.argv[2] === "service") return measure_service(process.argv.slice(3));
  const options = read_arguments(process.argv.slice(2));
  if (options.list) {
    for (const { name, what } of kAll) console.log(`${name.padEnd(31)}${what}`);
    console.log(`${"service".padEnd(31)}the service under load, only if named; \`service --list\` tells more`);
    return;
  }
  if (!exists_program(kOrrery)) fail(`${kOrrery} is not built`);
  const load = loadavg()[0];
  if (load > kQuietLoad) console.log(`warning: the machine is not idle, its load is ${load.toFixed(2)}`);
  const is_chosen = (b) => options.names.length === 0 || options.names.some((name) => goes_by(b, name));
  const chosen_of = (all) => all.filter(is_chosen);
  const chosen = chosen_of(kBenchmarks);
  if (chosen.length > 0) console.log(table_row((name) => name));
  const results = [];
  for (const benchmark of chosen) {
    const result = await run_benchmark(benchmark, options.pairs);
    if (result) results.push(result);
  }
  for (const { name, what, cost, runs, remark } of results)
    console.log(`${name}: ${what}; ${runs} pairs, ratio of ${cost}${remark ? `; ${remark}` : ""}`);
  for (const report of chosen_of(kReports))
    if (!is_missing(report)) results.push(...((await report.run(options)) ?? []));
  if (options.json) writeFileSync(options.json, JSON.stringify(results, null, 2) + "\n");
}

await main();
