import { cpu_run, orrery_command } from "./command.mjs";

const kCommand = orrery_command("scenes/paper.json", 3000, 3000, 5);

// Deviation of a ratio from 1 by chance.
export const kNoise = {
  name: "noise",
  what: "the paper's scene against itself: how far from 1 chance alone takes a ratio",
  cost: "CPU s",
  reach: null,
  aim: null,
  needs: [],
  start: () => ({ ours: () => cpu_run(kCommand), theirs: () => cpu_run(kCommand) }),
};
