// Time from a stop request, as after a client's disconnect, to the end of each stage of the work.

import { spawnSync } from "node:child_process";

const kProgram = "build/cancel";
const kTimes = Number(process.env.BENCH_CANCELS ?? 20);
const kTarget_ms = 100;

const kWidths = [24, 10, 11, 13, 9, 9];
const cells = (values) => values.map((v, i) => (i === 0 ? v.padEnd(kWidths[i]) : v.padStart(kWidths[i]))).join("");

export const kCancel = {
  name: "cancel",
  what: `each stage stopped ${kTimes} times, at moments spread over its length: what it goes on after that`,
  needs: [kProgram],
  async run() {
    const done = spawnSync(kProgram, [String(kTimes)], { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
    if (done.status !== 0) throw new Error(`${kProgram} ended with ${done.status}`);
    const rows = done.stdout
      .trim()
      .split("\n")
      .map((line) => JSON.parse(line));
    console.log("\n" + cells(["stage", "whole ms", "cancelled", "done before", "p50 ms", "most ms"]));
    for (const r of rows.sort((a, b) => b.most_ms - a.most_ms)) {
      const [whole, p50, most] = [r.whole_ms, r.p50_ms, r.most_ms].map((value) => value.toFixed(1));
      console.log(cells([r.stage, whole, String(r.cancelled), String(r.done_before), p50, most]));
    }
    console.log(`aim: most at most ${kTarget_ms} ms`);
  },
};
