#!/usr/bin/env node
// Applies each fault of faults.mjs to a copy of the source tree and checks that its tests fail. Exits with 1 if a
// fault is not caught or does not apply, or if a test fails without a fault.
//
//   node tests/faults/check.mjs [OPTION...] [FAULT...]     all faults, or those with the given numbers
//     --folder FOLDER       folder of the copy and its build, kept for the next run (default: temporary)
//     --shard K/N           every Nth fault, starting with the Kth
//     --changed [REVISION]  faults in files that differ from REVISION (default: merge base with main)
//     --compile             only checks that each fault compiles with the flags of build/

import { spawnSync } from "node:child_process";
import {
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  utimesSync,
  writeFileSync,
} from "node:fs";
import { availableParallelism, tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { parseArgs } from "node:util";

import { compileFaults } from "./compile.mjs";
import { faults as all } from "./faults.mjs";
import { kRoot, planted } from "./planted.mjs";
import { unitsWith } from "./units.mjs";

const kTestMinutes = 2; // a fault may make a test hang
const kNamesShown = 4;
// Test executables that run the program.
const kTargetsOfTheProgram = ["test_commands", "test_http"];

class Stop extends Error {}

function run(command, args, options = {}) {
  const result = spawnSync(command, args, { encoding: "utf8", maxBuffer: 1 << 28, ...options });
  const { error } = result;
  if (error && error.code !== "ETIMEDOUT") throw new Stop(`${command}: ${error.message}`);
  return { passed: result.status === 0, output: `${result.stdout ?? ""}${result.stderr ?? ""}` };
}

function git(...args) {
  const done = run("git", ["-C", kRoot, ...args]);
  if (!done.passed) throw new Stop(`git ${args.join(" ")}: ${done.output.trim()}`);
  return done.output;
}

// ---- which faults ----

function changedFiles(revision) {
  const base = revision || git("merge-base", "main", "HEAD").trim();
  const untracked = git("ls-files", "-z", "--others", "--exclude-standard");
  return new Set(`${git("diff", "-z", "--name-only", base)}${untracked}`.split("\0").filter(Boolean));
}

// Assigns the faults to the shards round-robin, because neighbours in the list often need the same long
// build.
function shardOf(faults, text) {
  const [, k, n] = text.match(/^(\d+)\/(\d+)$/)?.map(Number) ?? [];
  if (!(k >= 1 && k <= n)) throw new Stop(`--shard: must be K/N with 1 <= K <= N (got ${text})`);
  return faults.filter((_, index) => index % n === k - 1);
}

function chosen(options, numbers) {
  let faults = numbers.length === 0 ? all : all.filter(({ fault }) => numbers.includes(String(fault)));
  if (options.changed !== undefined) {
    const changed = changedFiles(options.changed);
    faults = faults.filter(({ file }) => changed.has(file));
  }
  return options.shard === undefined ? faults : shardOf(faults, options.shard);
}

// Returns whether a pattern of --gtest_filter matches a name.
const matches = (pattern, name) =>
  new RegExp(
    `^${pattern
      .replace(/[.+^${}()|[\]\\]/g, "\\$&")
      .replace(/\*/g, ".*")
      .replace(/\?/g, ".")}$`,
  ).test(name);

// ---- the copy ----

// Copies the tracked and the untracked files of the working tree to the folder `to`. Equal files keep their time, so
// that a second run builds little.
function copyTree(to) {
  const listed = git("ls-files", "-z", "--cached", "--others", "--exclude-standard");
  const files = new Set(
    listed.split("\0").filter((file) => file && statSync(join(kRoot, file), { throwIfNoEntry: false })?.isFile()),
  );
  for (const file of files) {
    const content = readFileSync(join(kRoot, file)),
      target = join(to, file);
    if (existsSync(target) && readFileSync(target).equals(content)) continue;
    mkdirSync(dirname(target), { recursive: true });
    writeFileSync(target, content);
  }
  for (const entry of readdirSync(to, { recursive: true, withFileTypes: true })) {
    const path = join(entry.parentPath ?? entry.path, entry.name);
    if (!entry.isDirectory() && !files.has(path.slice(to.length + 1))) rmSync(path);
  }
}

class Copy {
  constructor(folder) {
    this.source = join(folder, "source");
    this.build = join(folder, "build");
    // With CCACHE_BASEDIR, ccache ignores the path of the folder, so a new temporary folder reuses earlier
    // objects.
    this.environment = {
      CCACHE_BASEDIR: folder,
      TEST_EXHAUSTIVE: "yes",
      ...process.env,
      TEST_ORRERY: join(this.build, "orrery"),
    };
    mkdirSync(this.source, { recursive: true });
    copyTree(this.source);
  }
  configure() {
    // Without unity builds a fault recompiles its own file only.
    const flags = ["-DCMAKE_BUILD_TYPE=Release", "-DORRERY_LEVELS=host", "-DORRERY_UNITY=OFF"];
    const done = run("cmake", ["-G", "Ninja", "-S", this.source, "-B", this.build, ...flags], {
      env: this.environment,
    });
    if (!done.passed) throw new Stop(`cannot configure the copy:\n${done.output}`);
  }
  buildTargets(targets) {
    const parallel = ["--parallel", String(availableParallelism())];
    const program = targets.some((target) => kTargetsOfTheProgram.includes(target)) ? ["orrery"] : [];
    return run("cmake", ["--build", this.build, ...parallel, "--target", ...program, ...targets], {
      env: this.environment,
    });
  }
  // Runs the tests that match the patterns. Returns {passed, output, ran, failed}; the last two are test names.
  test(target, patterns) {
    const environment = { ...this.environment };
    for (const name of Object.keys(environment)) if (name.startsWith("GTEST_")) delete environment[name];
    const filter = `--gtest_filter=${patterns.join(":")}`;
    const { passed, output } = run(join(this.build, "tests", target), [filter], {
      cwd: this.source,
      env: environment,
      timeout: kTestMinutes * 60_000,
      killSignal: "SIGKILL",
    });
    const names = (mark) =>
      [...output.matchAll(new RegExp(`^\\[ *${mark} *\\] ([^\\s,]+)`, "gm"))].map((match) => match[1]);
    const ran = names("RUN"),
      succeeded = new Set([...names("OK"), ...names("SKIPPED")]);
    // Includes tests that did not end.
    return { passed, output, ran, failed: ran.filter((name) => !succeeded.has(name)) };
  }
  // Calls act() while `fault` is applied to the copy.
  withFault(fault, act) {
    const { text, original, problem } = planted(fault, this.source);
    if (problem) return { caught: false, text: problem };
    this.change(fault, text);
    try {
      return act();
    } finally {
      this.change(fault, original);
    }
  }
  // Writes `text` to the file of the fault. If units.mjs lists units for it, the file keeps its modification
  // time and only these units are touched.
  change(fault, text) {
    const path = join(this.source, fault.file),
      { atime, mtime } = statSync(path),
      units = unitsWith(fault);
    writeFileSync(path, text);
    if (!units) return;
    utimesSync(path, atime, mtime);
    const now = new Date();
    const seen = this.units().filter((unit) => units.some((beginning) => unit.startsWith(beginning)));
    if (seen.length === 0) throw new Stop(`${fault.file}: no translation unit begins with ${units.join(", ")}`);
    for (const unit of seen) utimesSync(join(this.source, unit), now, now);
  }
  units() {
    return readdirSync(this.source, { recursive: true }).filter((path) => path.endsWith(".cpp"));
  }
}

// ---- the checks ----

const tail = (text) => text.trim().split("\n").slice(-30).join("\n");
const shown = (names) =>
  names.slice(0, kNamesShown).join(", ") +
  (names.length > kNamesShown ? ` and ${names.length - kNamesShown} more` : "");

// Checks that every pattern matches a test and that all tests pass without a fault.
function checkSound(copy, faults) {
  const patterns = new Map();
  for (const { target, tests } of faults) patterns.set(target, [...(patterns.get(target) ?? []), ...tests]);
  const built = copy.buildTargets([...patterns.keys()]);
  if (!built.passed) throw new Stop(`cannot build the copy:\n${tail(built.output)}`);
  for (const [target, wanted] of patterns) {
    const { passed, output, ran } = copy.test(target, [...new Set(wanted)]);
    if (!passed) throw new Stop(`${target} fails without a fault:\n${tail(output)}`);
    const idle = wanted.filter((pattern) => !ran.some((name) => matches(pattern, name)));
    if (idle.length > 0) throw new Stop(`${target} has no test ${idle.join(", ")}`);
  }
}

function check(copy, fault) {
  return copy.withFault(fault, () => {
    const built = copy.buildTargets([fault.target]);
    if (!built.passed) return { caught: false, text: `does not build:\n${tail(built.output)}` };
    const { passed, failed } = copy.test(fault.target, fault.tests);
    const blind = fault.tests.filter((pattern) => !failed.some((name) => matches(pattern, name)));
    if (passed || blind.length > 0) return { caught: false, text: `passes ${blind.join(", ")}` };
    return { caught: true, text: `fails ${shown(failed)}` };
  });
}

// Returns the number of faults that were caught.
function checkAll(faults, folder) {
  const copy = new Copy(folder);
  copy.configure();
  checkSound(copy, faults);
  let caught = 0;
  for (const fault of faults) {
    const verdict = check(copy, fault);
    caught += verdict.caught;
    const word = verdict.caught ? "caught" : "NOT CAUGHT";
    console.log(`${word} ${fault.fault}: ${fault.about}: ${verdict.text}`);
  }
  return caught;
}

// ---- the command line ----

// Accepts `--changed` with and without a revision.
function readArguments() {
  const args = process.argv.slice(2);
  const bare = args.indexOf("--changed");
  if (bare >= 0 && (bare + 1 === args.length || args[bare + 1].startsWith("-"))) args[bare] = "--changed=";
  const text = { type: "string" };
  return parseArgs({
    args,
    options: { folder: text, shard: text, changed: text, compile: { type: "boolean" } },
    allowPositionals: true,
  });
}

async function main() {
  const { values: options, positionals } = readArguments();
  const faults = chosen(options, positionals);
  const faces = new Set(faults.map(({ fault }) => fault)).size;
  if (options.compile) {
    const compiling = await compileFaults(faults);
    console.log(`faults: ${compiling} of ${faults.length} compile, variants of ${faces} mistakes`);
    return compiling === faults.length;
  }
  const folder = options.folder ? resolve(options.folder) : mkdtempSync(join(tmpdir(), "orrery-faults-"));
  try {
    const caught = faults.length === 0 ? 0 : checkAll(faults, folder);
    console.log(`faults: ${caught} of ${faults.length} caught, variants of ${faces} mistakes`);
    return caught === faults.length;
  } finally {
    if (!options.folder) rmSync(folder, { recursive: true, force: true });
  }
}

try {
  process.exitCode = (await main()) ? 0 : 1;
} catch (error) {
  if (!(error instanceof Stop) && !error.code?.startsWith("ERR_PARSE_ARGS")) throw error;
  console.error(`faults: ${error.message}`);
  process.exitCode = 1;
}
