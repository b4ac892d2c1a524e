// Measures the time from a stop request, such as a client's disconnect, to the end of each stage.

import { spawnSync } from "node:child_process";

const PROGRAM = "build/cancel";
const TIMES = Number(process.env.BENCH_CANCELS ?? 20);
const TARGET_MS = 100;

const WIDTHS = [24, 10, 11, 13, 9, 9];
const cells = (values) => values.map((v, i) => (i === 0 ? v.padEnd(WIDTHS[i]) : v.padStart(WIDTHS[i]))).join("");

export const CANCEL = {
  name: "cancel",
  what: `time from a stop request to the end of each stage, ${TIMES} requests spread over its duration`,
  needs: [PROGRAM],
  async run() {
    const done = spawnSync(PROGRAM, [String(TIMES)], { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
    if (done.status !== 0) throw new Error(`${PROGRAM} exited with status ${done.status}`);
    const rows = done.stdout
      .trim()
      .split("\n")
      .map((line) => JSON.parse(line));
    console.log("\n" + cells(["stage", "full ms", "cancelled", "completed", "p50 ms", "max ms"]));
    for (const r of rows.sort((a, b) => b.most_ms - a.most_ms)) {
      const [whole, p50, most] = [r.whole_ms, r.p50_ms, r.most_ms].map((value) => value.toFixed(1));
      console.log(cells([r.stage, whole, String(r.cancelled), String(r.done_before), p50, most]));
    }
    console.log(`aim: at most ${TARGET_MS} ms`);
  },
};
