// Service benchmarks under load: tests/bench/run service [PROPERTY...]. Prints a table of properties with
// target, measurement and verdict. Only a failed measurement is an error, not a missed target.

import { writeFileSync } from "node:fs";
import { availableParallelism, loadavg } from "node:os";
import { exists_program, kOrrery } from "./command.mjs";
import { kBlockade } from "./service/blockade.mjs";
import { kCached } from "./service/cached.mjs";
import { kHealth } from "./service/health.mjs";
import { kLeaves } from "./service/leaves.mjs";
import { kMemory } from "./service/memory.mjs";
import { kOverload } from "./service/overload.mjs";
import { kRestarts } from "./service/restarts.mjs";
import { kSigterm } from "./service/sigterm.mjs";
import { kSoak } from "./service/soak.mjs";
import { kStart } from "./service/start.mjs";
import { kViewers } from "./service/viewers.mjs";

// Properties. Each has name; what: one line; seconds or times: default duration or repetitions; and
// run({seconds, times}), which resolves to {rows, remark}. A row is {what, target, measured, met}.
const kProperties = [
  kBlockade,
  kMemory,
  kHealth,
  kOverload,
  kLeaves,
  kSigterm,
  kRestarts,
  kViewers,
  kCached,
  kStart,
  kSoak,
];

const kUsage =
  "usage: tests/bench/run service [PROPERTY...] [--seconds N] [--times N] [--json FILE] [--list]\n" +
  "  --seconds  of each that takes its time; --times: of each that is done again and again";

function fail(message) {
  console.error(`bench: ${message}\n${kUsage}`);
  process.exit(2);
}

function read_arguments(words) {
  const options = { names: [], seconds: null, times: null, json: null, list: false };
  const number = (word, value) => {
    if (!(Number(value) > 0)) fail(`${word} expects a number > 0`);
    return Number(value);
  };
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === "--list") options.list = true;
    else if (words[i] === "--seconds") options.seconds = number(words[i], words[++i]);
    else if (words[i] === "--times") options.times = Math.ceil(number(words[i], words[++i]));
    else if (words[i] === "--json") options.json = words[++i] ?? fail("--json expects a file name");
    else if (kProperties.some(({ name }) => name === words[i])) options.names.push(words[i]);
    else fail(`no property is called ${words[i]}; there are ${kProperties.map((p) => p.name).join(", ")}`);
  }
  return options;
}

const kWidths = [11, 58, 22];
const line = (cells) => cells.map((cell, i) => (i < kWidths.length ? cell.padEnd(kWidths[i]) : cell)).join(" ");
const verdict = ({ met }) => (met === null ? "" : met ? "met: " : "MISSED: ");

async function measure(property, options) {
  const amount = { seconds: options.seconds ?? property.seconds, times: options.times ?? property.times };
  const { rows, remark } = await property.run(amount);
  for (const row of rows) console.log(line([property.name, row.what, row.target, verdict(row) + row.measured]));
  if (remark) console.log(`  ${property.name}: ${remark}`);
  return rows.map((row) => ({ property: property.name, ...row }));
}

export async function measure_service(words) {
  const options = read_arguments(words);
  if (options.list) {
    for (const { name, what } of kProperties) console.log(line([name, what]));
    return;
  }
  if (!exists_program(kOrrery)) fail(`${kOrrery} is not built`);
  const cores = availableParallelism();
  const load = loadavg()[0].toFixed(2);
  console.log(`${cores} cores, which service and clients share; load before: ${load}`);
  console.log(line(["property", "what", "target", "measured"]));
  const rows = [];
  for (const property of kProperties) {
    if (options.names.length > 0 && !options.names.includes(property.name)) continue;
    try {
      rows.push(...(await measure(property, options)));
    } catch (error) {
      console.log(`${property.name} failed: ${error.message}`);
      process.exitCode = 1;
    }
  }
  if (options.json) writeFileSync(options.json, JSON.stringify(rows, null, 2) + "\n");
}
