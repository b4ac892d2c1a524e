// Service benchmarks under load: tests/bench/run service [PROPERTY...]. Prints a table of properties with
// target, measurement and verdict. A failed measurement is an error, but a missed target is not.

import { writeFileSync } from "node:fs";
import { availableParallelism, loadavg } from "node:os";
import { existsProgram, ORRERY } from "./command.mjs";
import { BLOCKADE } from "./service/blockade.mjs";
import { CACHED } from "./service/cached.mjs";
import { HEALTH } from "./service/health.mjs";
import { LEAVES } from "./service/leaves.mjs";
import { MEMORY } from "./service/memory.mjs";
import { OVERLOAD } from "./service/overload.mjs";
import { RESTARTS } from "./service/restarts.mjs";
import { SIGTERM } from "./service/sigterm.mjs";
import { SOAK } from "./service/soak.mjs";
import { START } from "./service/start.mjs";
import { VIEWERS } from "./service/viewers.mjs";

// Properties. Each is {name, what, seconds or times, run}. `what` is one line, `seconds` and `times` are the
// default duration and repetitions. run({seconds, times}) resolves to {rows, remark}. A row is {what, target,
// measured, met}.
const PROPERTIES = [BLOCKADE, MEMORY, HEALTH, OVERLOAD, LEAVES, SIGTERM, RESTARTS, VIEWERS, CACHED, START, SOAK];

const USAGE =
  "usage: tests/bench/run service [PROPERTY...] [--seconds N] [--times N] [--json FILE] [--list]\n" +
  "  --seconds: duration of timed properties; --times: number of repetitions of the other properties";

function fail(message) {
  console.error(`bench: ${message}\n${USAGE}`);
  process.exit(2);
}

function readArguments(words) {
  const options = { names: [], seconds: null, times: null, json: null, list: false };
  const number = (word, value) => {
    if (!(Number(value) > 0)) fail(`${word}: must be a number > 0`);
    return Number(value);
  };
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === "--list") options.list = true;
    else if (words[i] === "--seconds") options.seconds = number(words[i], words[++i]);
    else if (words[i] === "--times") options.times = Math.ceil(number(words[i], words[++i]));
    else if (words[i] === "--json") options.json = words[++i] ?? fail("--json: file name is missing");
    else if (PROPERTIES.some(({ name }) => name === words[i])) options.names.push(words[i]);
    else fail(`unknown property ${words[i]}; must be one of ${PROPERTIES.map((p) => p.name).join(", ")}`);
  }
  return options;
}

const WIDTHS = [11, 58, 22];
const line = (cells) => cells.map((cell, i) => (i < WIDTHS.length ? cell.padEnd(WIDTHS[i]) : cell)).join(" ");
const verdict = ({ met }) => (met === null ? "" : met ? "met: " : "MISSED: ");

async function measure(property, options) {
  const amount = { seconds: options.seconds ?? property.seconds, times: options.times ?? property.times };
  const { rows, remark } = await property.run(amount);
  for (const row of rows) console.log(line([property.name, row.what, row.target, verdict(row) + row.measured]));
  if (remark) console.log(`  ${property.name}: ${remark}`);
  return rows.map((row) => ({ property: property.name, ...row }));
}

export async function measureService(words) {
  const options = readArguments(words);
  if (options.list) {
    for (const { name, what } of PROPERTIES) console.log(line([name, what]));
    return;
  }
  if (!existsProgram(ORRERY)) fail(`${ORRERY} is not built`);
  const cores = availableParallelism();
  const load = loadavg()[0].toFixed(2);
  console.log(`${cores} cores, shared by service and clients; load average before: ${load}`);
  console.log(line(["property", "what", "target", "measured"]));
  const rows = [];
  for (const property of PROPERTIES) {
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
