// Driver of a program that runs both sides of a comparison. The program's first output line is facts in JSON.
// Each input line requests a run: "ours" or "theirs", and the kind of run if there are several. The program
// replies with the CPU seconds of the run.

import { spawn } from "node:child_process";
import { createInterface } from "node:readline";

// Starts the program. Resolves to {facts, ours(), theirs(), stop()}.
export async function start_two_sided(program, words) {
  const child = spawn(program, words, { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => child.once("close", resolve));
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const next_line = async () => {
    const { value, done } = await lines.next();
    if (done) throw new Error(`${program} ended with ${await ended}`);
    return value;
  };
  let facts;
  try {
    facts = JSON.parse(await next_line());
  } catch (error) {
    child.kill();
    throw error;
  }
  const run = async (side, kind) => {
    child.stdin.write(kind ? `${side} ${kind}\n` : `${side}\n`);
    const cpu_s = Number(await next_line());
    return { cost: cpu_s, cpu_s };
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
