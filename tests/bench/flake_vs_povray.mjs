import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { cpuRun, orreryCommand, povrayCommand, runCommand } from "./command.mjs";
import { povrayScene } from "./povray_scene.mjs";

const FOLDER = "build/bench-scenes";
const LEVEL = 4; // 7,381 spheres
const SIDE = 1024,
  DEPTH = 5;

function start() {
  mkdirSync(FOLDER, { recursive: true });
  const json = `${FOLDER}/sphereflake.json`,
    pov = `${FOLDER}/sphereflake.pov`;
  runCommand(["node", "scenes/generate-sphereflake.mjs", String(LEVEL), json]);
  writeFileSync(pov, povrayScene(JSON.parse(readFileSync(json, "utf8")), 1, DEPTH));
  return {
    ours: () => cpuRun(orreryCommand(json, SIDE, SIDE, DEPTH)),
    theirs: () => cpuRun(povrayCommand(pov, SIDE, SIDE)),
  };
}

export const FLAKE_VS_POVRAY = {
  name: "flake-vs-povray",
  what: "7,381 spheres of gold, 1024x1024, 3 lights, depth 5, one sample, one thread, compared with POV-Ray",
  cost: "CPU s",
  reach: 5,
  aim: 10,
  needs: ["povray"],
  start,
};
