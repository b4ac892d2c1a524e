#!/usr/bin/env node
// Checks the web page, the scripts for Node and the documents with ESLint, Prettier, html-validate and
// CSpell. Skipped if one of them is not in node_modules. --fix lets ESLint and Prettier change the files.

import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const SKIPPED = 77;
const fixes = process.argv.includes("--fix");

// [package, arguments]. The configuration of each tool lists the files.
const tools = [
  ["eslint", fixes ? ["--fix", "."] : ["--max-warnings", "0", "."]],
  ["prettier", fixes ? ["--write", "--log-level", "warn", "."] : ["--check", "."]],
  ["html-validate", ["web/index.html"]],
  ["cspell", ["lint", "--no-progress"]],
];

const folderOf = (name) => join(root, "node_modules", name);

// Returns the path of a package's program.
function programOf(name) {
  const { bin } = JSON.parse(readFileSync(join(folderOf(name), "package.json"), "utf8"));
  return join(folderOf(name), typeof bin === "string" ? bin : bin[name]);
}

const missing = tools.map(([name]) => name).filter((name) => !existsSync(folderOf(name)));
if (missing.length > 0) {
  console.log(`skipped: ${missing.join(", ")} not found in node_modules; run "npm ci" or script/setup`);
  process.exit(SKIPPED);
}

for (const [name, args] of tools) {
  console.log(`${name} ${args.join(" ")}`);
  const { status } = spawnSync(process.execPath, [programOf(name), ...args], { cwd: root, stdio: "inherit" });
  if (status !== 0) process.exitCode = 1;
}
