import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { cpu_run, orrery_command, povray_command, run_command } from "./command.mjs";
import { povray_scene } from "./povray_scene.mjs";

const kFolder = "build/bench-scenes";
const kLevel = 4; // 7,381 spheres
const kSide = 1024,
  kDepth = 5;

function start() {
  mkdirSync(kFolder, { recursive: true });
  const json = `${kFolder}/sphereflake.json`,
    pov = `${kFolder}/sphereflake.pov`;
  run_command(["node", "scenes/generate-sphereflake.mjs", String(kLevel), json]);
  writeFileSync(pov, povray_scene(JSON.parse(readFileSync(json, "utf8")), 1, kDepth));
  return {
    ours: () => cpu_run(orrery_command(json, kSide, kSide, kDepth)),
    theirs: () => cpu_run(povray_command(pov, kSide, kSide)),
  };
}

export const kFlakeVsPovray = {
  name: "flake-vs-povray",
  what: "7,381 spheres of gold, 1024x1024, 3 lights, depth 5, one sample, one thread, against POV-Ray",
  cost: "CPU s",
  reach: 5,
  aim: 10,
  needs: ["povray"],
  start,
};
