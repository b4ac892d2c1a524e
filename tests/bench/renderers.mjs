// Renders one scene with orrery and with Blender's Cycles.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { ORRERY } from "./command.mjs";
import { readExr } from "./picture.mjs";

const THREADS = 2; // for both renderers, so that the number of cores favours neither
const ANSWER = /^rendered (\S+)$/;

// Starts Blender once, because its start takes a second. Ignores other output of Blender.
function startBlender(scene) {
  const words = ["-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "-P", "tests/bench/cycles_scene.py"];
  const child = spawn("blender", [...words, "--", scene], { stdio: ["pipe", "pipe", "ignore"] });
  child.stdin.on("error", () => {}); // reported by render()
  const ended = new Promise((resolve) => child.once("close", resolve));
  const lines = createInterface({ input: child.stdout })[Symbol.asyncIterator]();
  const render = async (order) => {
    child.stdin.write(JSON.stringify(order) + "\n");
    for (;;) {
      const { value, done } = await lines.next();
      if (done) throw new Error(`blender exited with status ${await ended}`);
      const answer = value.match(ANSWER);
      if (answer) return { cpuS: Number(answer[1]) };
    }
  };
  const stop = async () => {
    child.stdin.end();
    await ended;
  };
  return { render, stop };
}

function renderOurs(scene, { samples, error, seed, bounces, size, out }) {
  const goal = error ? { error, space: "display" } : { samples };
  const options = { width: size, height: size, depth: bounces + 1, ...goal, seed, threads: THREADS };
  const words = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
  const done = spawnSync(ORRERY, ["render", scene, ...words, "--stats=json", "-o", out], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${ORRERY} exited with status ${done.status}: ${done.stderr}`);
  const stats = JSON.parse(done.stdout);
  return { cpuS: stats.render_cpu_s, stats };
}

// Returns {ours(order), theirs(order), stop()}. An order is {samples, seed, bounces, preset, threshold,
// error}:
//   bounces: maximum number of indirect bounces; 0 allows only direct light
//   preset ("fair" or "defaults") and threshold (noise): for Cycles only
//   error, in display values: replaces samples, for ours only
// Both return {cpuS, picture}, where cpuS counts all threads and includes building. ours() also returns
// {stats}, the parsed output of --stats.
export function startRenderers(scene, size) {
  const folder = mkdtempSync(join(tmpdir(), "renderers-"));
  const out = join(folder, "picture.exr");
  const blender = startBlender(scene);
  const render = async (by, order) => {
    const cost = await by({ preset: "fair", ...order, size, threads: THREADS, out });
    return { ...cost, picture: readExr(out) };
  };
  return {
    ours: (order) => render((full) => renderOurs(scene, full), order),
    theirs: (order) => render(blender.render, order),
    stop: async () => {
      await blender.stop();
      rmSync(folder, { recursive: true });
    },
  };
}
