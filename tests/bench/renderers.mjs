// Renders of one scene by ours and by Blender's Cycles.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { kOrrery } from "./command.mjs";
import { read_exr } from "./picture.mjs";

const kThreads = 2; // for both, so that the number of cores favours neither
const kAnswer = /^rendered (\S+)$/;

// Starts Blender once, which takes a second. Its other output is skipped.
function start_blender(scene) {
  const words = ["-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "-P", "tests/bench/cycles_scene.py"];
  const child = spawn("blender", [...words, "--", scene], { stdio: ["pipe", "pipe", "ignore"] });
  child.stdin.on("error", () => {}); // reported by render()
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

// Returns {ours(order), theirs(order), stop()}. An order is {samples, seed, bounces, preset, threshold,
// error}:
//   bounces: reflections before the last light; 0 is direct light
//   preset ("fair" or "defaults") and threshold (noise): for Cycles only
//   error, in display values: replaces samples, for ours only
// The result is {cpu_s, picture}, where cpu_s counts all threads and includes building. Ours adds its
// statistics.
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
