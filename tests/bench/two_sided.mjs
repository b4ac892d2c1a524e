// Drives a program that runs both sides of a comparison. The first line of its output contains facts as JSON.
// Each input line requests a run with "ours" or "theirs", followed by the kind of run if there are several.
// The program replies with the CPU seconds of the run.

import { spawn } from "node:child_process";
import { createInterface } from "node:readline";

// Starts the program. Resolves to {facts, ours(), theirs(), stop()}.
export async function startTwoSided(program, words) {
  const child = spawn(program, words, { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => child.once("close", resolve));
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const nextLine = async () => {
    const { value, done } = await lines.next();
    if (done) throw new Error(`${program} exited with status ${await ended}`);
    return value;
  };
  let facts;
  try {
    facts = JSON.parse(await nextLine());
  } catch (error) {
    child.kill();
    throw error;
  }
  const run = async (side, kind) => {
    child.stdin.write(kind ? `${side} ${kind}\n` : `${side}\n`);
    const cpuS = Number(await nextLine());
    return { cost: cpuS, cpuS };
  };
  return {
    facts,
    ours: (kind) => run("ours", kind),
    theirs: (kind) => run("theirs", kind),
    stop: async () => {
      child.stdin.end();
      await ended;
    },
  };
}
