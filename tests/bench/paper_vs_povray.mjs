import { cpuRun, orreryCommand, povrayCommand } from "./command.mjs";

export const PAPER_VS_POVRAY = {
  name: "paper-vs-povray",
  what: "the scene `paper`, 3000x3000, depth 5, one sample, one thread, compared with POV-Ray",
  cost: "CPU s",
  reach: 12,
  aim: 20,
  needs: ["povray"],
  start: () => ({
    ours: () => cpuRun(orreryCommand("scenes/paper.json", 3000, 3000, 5)),
    theirs: () => cpuRun(povrayCommand("tests/bench/paper.pov", 3000, 3000)),
  }),
};
