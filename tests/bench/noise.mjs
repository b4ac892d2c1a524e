import { cpuRun, orreryCommand } from "./command.mjs";

const COMMAND = orreryCommand("scenes/paper.json", 3000, 3000, 5);

// Measures how far chance moves a ratio from 1.
export const NOISE = {
  name: "noise",
  what: "the scene `paper` compared with itself: deviation of the ratio from 1 by chance",
  cost: "CPU s",
  reach: null,
  aim: null,
  needs: [],
  start: () => ({ ours: () => cpuRun(COMMAND), theirs: () => cpuRun(COMMAND) }),
};
