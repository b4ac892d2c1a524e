import { cpu_run, orrery_command, povray_command } from "./command.mjs";

export const kPaperVsPovray = {
  name: "paper-vs-povray",
  what: "the paper's scene, 3000x3000, depth 5, one sample, one thread, against POV-Ray",
  cost: "CPU s",
  reach: 12,
  aim: 20,
  needs: ["povray"],
  start: () => ({
    ours: () => cpu_run(orrery_command("scenes/paper.json", 3000, 3000, 5)),
    theirs: () => cpu_run(povray_command("tests/bench/paper.pov", 3000, 3000)),
  }),
};
