// Checks that the code compiles with a fault in it, without a build. The changed file is written to a
// temporary folder, which is first in the include path. The compiler checks a source that includes the file
// with -fsyntax-only and the flags of build/compile_commands.json.

import { spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { availableParallelism, tmpdir } from "node:os";
import { dirname, join } from "node:path";

import { kRoot, planted } from "./planted.mjs";

// Returns the sources that build/ compiles, as a map from their path to {command, directory}.
function readCommands() {
  const file = join(kRoot, "build/compile_commands.json");
  if (!existsSync(file)) throw new Error(`cannot find ${file}: run script/setup first`);
  const commands = new Map();
  for (const { file: compiled, command, directory } of JSON.parse(readFileSync(file, "utf8")))
    for (const source of sourcesOf(compiled))
      if (source.startsWith(`${kRoot}/core/`) || source.startsWith(`${kRoot}/server/`))
        commands.set(source.slice(kRoot.length + 1), { command, directory });
  return commands;
}

// Returns the sources that a file of a unity build includes, or the file itself.
const sourcesOf = (file) =>
  !file.includes("/Unity/")
    ? [file]
    : [...readFileSync(file, "utf8").matchAll(/^#include "([^"]+)"/gm)].map((match) => match[1]);

const includesOf = (path) =>
  [...readFileSync(join(kRoot, path), "utf8").matchAll(/^#include "([^"]+)"/gm)]
    .map((match) => match[1])
    .filter((target) => existsSync(join(kRoot, target)));

function reaches(path, target, seen = new Set()) {
  if (path === target) return true;
  if (seen.has(path)) return false;
  seen.add(path);
  return includesOf(path).some((next) => reaches(next, target, seen));
}

// Returns the source to compile for a fault in `file`: the file, the source of the same name, or a source
// that includes it. Sources in the same folder are preferred.
function sourceFor(file, commands) {
  const namesake = file.replace(/\.h$/, ".cpp");
  if (commands.has(namesake)) return namesake;
  const users = [...commands.keys()].filter((source) => reaches(source, file));
  return (
    users.find((source) => dirname(source) === dirname(file) && includesOf(source).includes(file)) ??
    users.find((source) => dirname(source) === dirname(file)) ??
    users[0]
  );
}

// Resolves to the first error message of a command, or to "" if it succeeds.
function complaintsFrom(command, args, cwd) {
  return new Promise((done) => {
    const child = spawn(command, args, { cwd, stdio: ["ignore", "ignore", "pipe"] });
    let output = "";
    child.stderr.on("data", (data) => {
      output += data;
    });
    child.on("close", (status) =>
      done(status === 0 ? "" : (output.split("\n").find((line) => /error/i.test(line)) ?? `status ${status}`)),
    );
  });
}

// Resolves to the compiler's first error, or to "" if the code compiles.
async function complaintsOf(fault, commands) {
  const { text, problem } = planted(fault);
  if (problem) return problem;
  const source = sourceFor(fault.file, commands);
  if (!source) return `no source includes ${fault.file}`;
  const folder = mkdtempSync(join(tmpdir(), "orrery-fault-"));
  try {
    const changed = join(folder, fault.file);
    mkdirSync(dirname(changed), { recursive: true });
    writeFileSync(changed, text);
    const { command, directory } = commands.get(source);
    const [compiler, ...flags] = command.slice(0, command.indexOf(" -o ")).split(" ");
    const read = source === fault.file ? changed : join(kRoot, source);
    return await complaintsFrom(
      "sh",
      ["-c", [compiler, `-I${folder}`, ...flags, "-w", "-fsyntax-only", read].join(" ")],
      directory,
    );
  } finally {
    rmSync(folder, { recursive: true });
  }
}

// Prints the faults that do not compile and resolves to the number of those that do.
export async function compileFaults(faults) {
  const commands = readCommands();
  const waiting = [...faults];
  let compiling = 0;
  const work = async () => {
    for (let fault = waiting.shift(); fault; fault = waiting.shift()) {
      const complaints = await complaintsOf(fault, commands);
      if (complaints) console.log(`DOES NOT COMPILE ${fault.fault}: ${fault.about}: ${complaints}`);
      else ++compiling;
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, work));
  return compiling;
}
