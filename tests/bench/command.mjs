// External programs and their processor time.

import { spawnSync } from "node:child_process";

export const kOrrery = process.env.TEST_ORRERY ?? "build/orrery";

export function exists_program(name) {
  return spawnSync("bash", ["-c", 'command -v "$1"', "bash", name]).status === 0;
}

// Runs a command and discards its output. bash reports the user and system seconds of all its threads, as
// counted by the kernel, to the millisecond. Throws Error if the command fails.
export function run_command(command) {
  const script = 'TIMEFORMAT="%3R %3U %3S"; time "$@" >/dev/null 2>&1';
  const done = spawnSync("bash", ["-c", script, "bash", ...command], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${command.join(" ")} ended with ${done.status}`);
  const [wall_s, user_s, system_s] = done.stderr.trim().split(" ").map(Number);
  return { wall_s, cpu_s: user_s + system_s };
}

// Runs a command. The cost of the run is its processor time.
export function cpu_run(command) {
  const { cpu_s } = run_command(command);
  return { cost: cpu_s, cpu_s };
}

// Returns the command of ours or of POV-Ray: one thread, one sample per pixel, no picture written. `width`
// and `height` in pixels.
export function orrery_command(scene, width, height, depth) {
  const options = { width, height, depth, samples: 1, threads: 1 };
  const words = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
  return [kOrrery, "render", scene, ...words];
}
export function povray_command(scene, width, height) {
  return ["povray", `+I${scene}`, `+W${width}`, `+H${height}`, "+WT1", "-A", "-D", "-GA", "-F"];
}
