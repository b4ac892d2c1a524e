// Ours and Blender's Cycles, asked for pictures of one scene in turn.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { kOrrery } from "./command.mjs";
import { read_exr } from "./picture.mjs";

const kThreads = 2; // of each, so that neither gains by a machine's number of cores
const kAnswer = /^rendered (\S+)$/;

// Blender is started once: it takes a second. Beside its answers it prints what is not for us.
function start_blender(scene) {
  const words = ["-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "-P", "tests/bench/cycles_scene.py"];
  const child = spawn("blender", [...words, "--", scene], { stdio: ["pipe", "pipe", "ignore"] });
  child.stdin.on("error", () => {}); // it ended: told below
  const ended = new Promise((resolve) => child.once("close", resolve));
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const render = async (order) => {
    child.stdin.write(JSON.stringify(order) + "\n");
    for (;;) {
      const { value, done } = await lines.next();
      if (done) throw new Error(`blender ended with ${await ended}`);
      const answer = value.match(kAnswer);
      if (answer) return { cpu_s: Number(answer[1]) };
    }
  };
  const stop = async () => {
    child.stdin.end();
    await ended;
  };
  return { render, stop };
}

function render_ours(scene, { samples, error, seed, bounces, size, out }) {
  const goal = error ? { error, space: "display" } : { samples };
  const options = { width: size, height: size, depth: bounces + 1, ...goal, seed, threads: kThreads };
  const words = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
  const done = spawnSync(kOrrery, ["render", scene, ...words, "--stats=json", "-o", out], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${kOrrery} ended with ${done.status}: ${done.stderr}`);
  const told = JSON.parse(done.stdout);
  return { cpu_s: told.render_cpu_s, told };
}

// Returns {ours(order), theirs(order), stop()}. An order is {samples, seed, bounces, preset}; bounces counts the
// reflections before the last light, so that 0 is direct light; preset is "fair" or "defaults" and concerns Cycles, as a
// noise threshold does; of ours an error on a display may be asked in place of samples. Its answer is {cpu_s, picture}:
// processor seconds of all threads, building included, and the picture; ours has what was told of it besides.
export function start_renderers(scene, size) {
  const folder = mkdtempSync(join(tmpdir(), "renderers-"));
  const out = join(folder, "picture.exr");
  const blender = start_blender(scene);
  const render = async (by, order) => {
    const cost = await by({ preset: "fair", ...order, size, threads: kThreads, out });
    return { ...cost, picture: read_exr(out) };
  };
  return {
    ours: (order) => render((full) => render_ours(scene, full), order),
    theirs: (order) => render(blender.render, order),
    stop: async () => {
      await blender.stop();
      rmSync(folder, { recursive: true });
    },
  };
}
