// Runs external programs and measures their processor time.

import { spawnSync } from "node:child_process";

export const ORRERY = process.env.TEST_ORRERY ?? "build/orrery";

export function existsProgram(name) {
  return spawnSync("bash", ["-c", 'command -v "$1"', "bash", name]).status === 0;
}

// Runs a command and discards its output. bash reports the wall, user and system seconds of all threads of
// the command, to the millisecond. Throws Error if the command fails.
export function runCommand(command) {
  const script = 'TIMEFORMAT="%3R %3U %3S"; time "$@" >/dev/null 2>&1';
  const done = spawnSync("bash", ["-c", script, "bash", ...command], { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`${command.join(" ")} exited with status ${done.status}`);
  const [wallS, userS, systemS] = done.stderr.trim().split(" ").map(Number);
  return { wallS, cpuS: userS + systemS };
}

// Runs a command. The cost of the run is its processor time.
export function cpuRun(command) {
  const { cpuS } = runCommand(command);
  return { cost: cpuS, cpuS };
}

// Returns the command that renders with orrery or POV-Ray: one thread, one sample per pixel, no image
// written. `width` and `height` are in pixels.
export function orreryCommand(scene, width, height, depth) {
  const options = { width, height, depth, samples: 1, threads: 1 };
  const words = Object.entries(options).flatMap(([name, value]) => [`--${name}`, String(value)]);
  return [ORRERY, "render", scene, ...words];
}
export function povrayCommand(scene, width, height) {
  return ["povray", `+I${scene}`, `+W${width}`, `+H${height}`, "+WT1", "-A", "-D", "-GA", "-F"];
}
