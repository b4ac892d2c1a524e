#!/usr/bin/env node
// Checks the table of systems: every key, sample scene and test that it names exists, and docs/systems.md is current.

import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { drawSystems, findTests, kGroups, kRoot } from "./systems.mjs";

const read = (path) => readFileSync(join(kRoot, path), "utf8");
const schema = read("scenes/schema/scene.json");
const routes = ["scenes", "render", "jobs", "explain", "charts", "frame", "frame_jobs", "orbit"]
  .map((name) => read(`server/routes/${name}.cpp`))
  .join("\n");
const options = read("core/plan/options.cpp");
const tests = findTests();
const problems = [];

function checkReach(id, words) {
  for (const [, word] of words.matchAll(/`([^`]+)`/g)) {
    const route = /^(GET|POST) (.+)$/.exec(word);
    const found = route
      ? routes.includes(`"${route[1]}", "${route[2]}"`)
      : word === "--stats" || schema.includes(`"${word}"`) || options.includes(`.key = "${word}"`);
    if (!found) problems.push(`${id}: unknown key, type or path \`${word}\``);
  }
}

for (const [, rows] of kGroups)
  for (const [id, , reach, samples, names] of rows) {
    checkReach(id, reach);
    for (const name of samples.split(", ").filter(Boolean))
      if (!existsSync(join(kRoot, `scenes/${name}.json`))) problems.push(`${id}: missing scene ${name}`);
    for (const name of names.split(", ")) if (!tests.has(name)) problems.push(`${id}: missing test ${name}`);
  }
if (read("docs/systems.md") !== drawSystems(tests))
  problems.push("docs/systems.md: not current; run node tests/lint/systems.mjs > docs/systems.md");
if (problems.length > 0) {
  console.error(problems.join("\n"));
  process.exit(1);
}
