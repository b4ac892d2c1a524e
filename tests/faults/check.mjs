#!/usr/bin/env node
// Puts each fault of faults.mjs into a copy of the source tree and checks that the tests named there fail:
//   node tests/faults/check.mjs [FOLDER [FAULT...]]
// With numbers of faults, those alone. The copy and its build lie in FOLDER (source/ and build/, kept for the
// next run) or in a temporary folder.
// Exits with 1 if a fault is not caught, if it can no longer be put in, or if a test fails without any.

import {spawnSync} from "node:child_process";
import {existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {availableParallelism, tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {faults as all} from "./faults.mjs";

const kRoot = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const kTestMinutes = 2;  // a fault may also keep a test from ending
const kNamesShown = 4;

class Stop extends Error {}

function run(command, args, options = {}) {
  const result = spawnSync(command, args, {encoding: "utf8", maxBuffer: 1 << 28, ...options});
  const {error} = result;
  if (error && error.code !== "ETIMEDOUT") throw new Stop(`${command}: ${error.message}`);
  return {passed: result.status === 0, output: `${result.stdout ?? ""}${result.stderr ?? ""}`};
}

// Makes `to` hold what git sees in the working tree. Files that are the same already stay untouched, so that
// a second run builds little.
function copyTree(to) {
  const listed = run("git", ["-C", kRoot, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
  if (!listed.passed) throw new Stop(listed.output);
  const files = new Set(listed.output.split("\0").filter((file) => file && existsSync(join(kRoot, file))));
  for (const file of files) {
    const content = readFileSync(join(kRoot, file)), target = join(to, file);
    if (existsSync(target) && readFileSync(target).equals(content)) continue;
    mkdirSync(dirname(target), {recursive: true});
    writeFileSync(target, content);
  }
  for (const entry of readdirSync(to, {recursive: true, withFileTypes: true})) {
    const path = join(entry.parentPath ?? entry.path, entry.name);
    if (!entry.isDirectory() && !files.has(path.slice(to.length + 1))) rmSync(path);
  }
}

class Copy {
  constructor(folder) {
    this.source = join(folder, "source");
    this.build = join(folder, "build");
    // Paths below the folder do not count for ccache: every temporary folder profits from the last one.
    this.environment = {CCACHE_BASEDIR: folder, ...process.env, TEST_ORRERY: join(this.build, "orrery")};
    mkdirSync(this.source, {recursive: true});
    copyTree(this.source);
  }
  configure() {
    const flags = ["-DCMAKE_BUILD_TYPE=Release", "-DORRERY_LEVELS=host"];
    const done = run("cmake", ["-G", "Ninja", "-S", this.source, "-B", this.build, ...flags],
                     {env: this.environment});
    if (!done.passed) throw new Stop(`cannot configure the copy:\n${done.output}`);
  }
  buildTargets(targets) {
    const parallel = ["--parallel", String(availableParallelism())];
    return run("cmake", ["--build", this.build, ...parallel, "--target", "orrery", ...targets],
               {env: this.environment});
  }
  // Runs the tests that match the patterns; returns what ran, what failed, and the output.
  test(target, patterns) {
    const environment = {...this.environment};
    for (const name of Object.keys(environment)) if (name.startsWith("GTEST_")) delete environment[name];
    const filter = `--gtest_filter=${patterns.join(":")}`;
    const {passed, output} = run(join(this.build, "tests", target), [filter], {
      cwd: this.source, env: environment, timeout: kTestMinutes * 60_000, killSignal: "SIGKILL",
    });
    const names = (mark) =>
      [...output.matchAll(new RegExp(`^\\[ *${mark} *\\] ([^\\s,]+)`, "gm"))].map((match) => match[1]);
    const ran = names("RUN"), succeeded = new Set([...names("OK"), ...names("SKIPPED")]);
    return {passed, output, ran, failed: ran.filter((name) => !succeeded.has(name))};  // or did not end
  }
  // Calls act() while `fault` is in the copy.
  withFault({file, from, to}, act) {
    const path = join(this.source, file);
    const text = existsSync(path) ? readFileSync(path, "utf8") : "";
    const count = text.split(from).length - 1;
    if (count !== 1) return {caught: false, text: `its place stands ${count} times in ${file}, not once`};
    writeFileSync(path, text.replace(from, () => to));
    try {
      return act();
    } finally {
      writeFileSync(path, text);
    }
  }
}

// Whether a pattern of --gtest_filter matches.
const matches = (pattern, name) =>
  new RegExp(`^${pattern.replace(/[.+^${}()|[\]\\]/g, "\\$&").replace(/\*/g, ".*").replace(/\?/g, ".")}$`)
    .test(name);
const tail = (text) => text.trim().split("\n").slice(-30).join("\n");
const shown = (names) =>
  names.slice(0, kNamesShown).join(", ") +
  (names.length > kNamesShown ? ` and ${names.length - kNamesShown} more` : "");

// Without a fault every pattern names a test, and all of them pass.
function checkSound(copy, faults) {
  const patterns = new Map();
  for (const {target, tests} of faults) patterns.set(target, [...(patterns.get(target) ?? []), ...tests]);
  const built = copy.buildTargets([...patterns.keys()]);
  if (!built.passed) throw new Stop(`the copy does not build:\n${tail(built.output)}`);
  for (const [target, wanted] of patterns) {
    const {passed, output, ran} = copy.test(target, [...new Set(wanted)]);
    if (!passed) throw new Stop(`${target} fails without any fault:\n${tail(output)}`);
    const idle = wanted.filter((pattern) => !ran.some((name) => matches(pattern, name)));
    if (idle.length > 0) throw new Stop(`${target} has no test ${idle.join(", ")}`);
  }
}

function check(copy, fault) {
  return copy.withFault(fault, () => {
    const built = copy.buildTargets([fault.target]);
    if (!built.passed) return {caught: false, text: `does not build:\n${tail(built.output)}`};
    const {passed, failed} = copy.test(fault.target, fault.tests);
    const blind = fault.tests.filter((pattern) => !failed.some((name) => matches(pattern, name)));
    if (passed || blind.length > 0) return {caught: false, text: `passes ${blind.join(", ")}`};
    return {caught: true, text: `fails ${shown(failed)}`};
  });
}

function main(given, numbers) {
  const faults = numbers.length === 0 ? all : all.filter(({fault}) => numbers.includes(String(fault)));
  const folder = given ? resolve(given) : mkdtempSync(join(tmpdir(), "orrery-faults-"));
  try {
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
    const faces = new Set(faults.map(({fault}) => fault)).size;
    console.log(`faults: ${caught} of ${faults.length} caught, faces of ${faces}`);
    process.exitCode = caught === faults.length ? 0 : 1;
  } catch (error) {
    if (!(error instanceof Stop)) throw error;
    console.error(`faults: ${error.message}`);
    process.exitCode = 1;
  } finally {
    if (!given) rmSync(folder, {recursive: true, force: true});
  }
}

main(process.argv[2], process.argv.slice(3));
