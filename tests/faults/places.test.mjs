#!/usr/bin/env node
// Checks that every fault of faults.mjs applies. Its `from` must occur exactly once in its file and differ
// from `to`, and the sources of its target must define its tests.

import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { faults } from "./faults.mjs";
import { kRoot, planted } from "./planted.mjs";

// Returns the text of all sources of a test executable.
function sourcesOf(target) {
  const folder = join(kRoot, "tests", target.replace(/^test_/, ""));
  if (!existsSync(folder)) return "";
  return readdirSync(folder)
    .filter((name) => name.endsWith(".cpp"))
    .map((name) => readFileSync(join(folder, name), "utf8"))
    .join("\n");
}

// Returns true if the sources define the test suite of a pattern.
const names = (sources, pattern) =>
  pattern
    .split(".")[0]
    .split("/")
    .some((suite) => sources.includes(`(${suite},`));

function problemOf(fault) {
  const { problem } = planted(fault);
  if (problem) return problem;
  const sources = sourcesOf(fault.target);
  const unknown = fault.tests.filter((pattern) => !names(sources, pattern));
  return unknown.length > 0 ? `${fault.target} has no test ${unknown.join(", ")}` : "";
}

let problems = 0;
for (const fault of faults) {
  const problem = problemOf(fault);
  if (!problem) continue;
  ++problems;
  console.error(`${fault.fault}: ${fault.about}: ${problem}`);
}
console.log(`${faults.length} faults, ${problems} do not apply`);
process.exitCode = problems ? 1 : 0;
