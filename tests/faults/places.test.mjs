#!/usr/bin/env node
// Every fault of faults.mjs can still be put in: its text stands exactly once in its file and is changed, and its
// tests are in the sources of its target.

import {existsSync, readdirSync, readFileSync} from "node:fs";
import {join} from "node:path";

import {faults} from "./faults.mjs";
import {kRoot, planted} from "./planted.mjs";

// The text of a script, or of all sources of an executable.
function sourcesOf(target) {
  if (target.endsWith(".mjs")) return existsSync(join(kRoot, target)) ? readFileSync(join(kRoot, target), "utf8") : "";
  const folder = join(kRoot, "tests", target.replace(/^test_/, ""));
  if (!existsSync(folder)) return "";
  return readdirSync(folder).filter((name) => name.endsWith(".cpp"))
    .map((name) => readFileSync(join(folder, name), "utf8")).join("\n");
}

// Whether the sources have a test of that name, or for a pattern, a suite.
const names = (sources, pattern) =>
  sources.includes(`test("${pattern}"`) ||
  pattern.split(".")[0].split("/").some((suite) => sources.includes(`(${suite},`));

function problemOf(fault) {
  const {problem} = planted(fault);
  if (problem) return problem;
  const sources = sourcesOf(fault.target);
  const unknown = fault.tests.filter((pattern) => !names(sources, pattern));
  return unknown.length > 0 ? `${fault.target} has no ${unknown.join(", ")}` : "";
}

let problems = 0;
for (const fault of faults) {
  const problem = problemOf(fault);
  if (!problem) continue;
  ++problems;
  console.error(`${fault.fault}: ${fault.about}: ${problem}`);
}
console.log(`${faults.length} faults, ${problems} cannot be put in`);
process.exitCode = problems ? 1 : 0;
