// Time from the start of the process to the first response 200 of /readyz.

import { Client } from "./client.mjs";
import { most, ms, quantile, row } from "./support.mjs";
import { startService } from "../daemon.mjs";

const TARGET_MS = 200;
const LIMIT_MS = 20_000;

async function oneStart() {
  const start = performance.now();
  const service = await startService();
  const client = new Client(service.healthPort);
  try {
    for (;;) {
      const { status } = await client.ask("/readyz");
      const took = performance.now() - start;
      if (status === 200) return took;
      if (took > LIMIT_MS) throw new Error("service: not ready after 20 s");
    }
  } finally {
    client.leave();
    await service.stop();
  }
}

async function run({ times }) {
  const starts = [];
  for (let i = 0; i < times; ++i) starts.push(await oneStart());
  const median = quantile(starts, 0.5);
  const worst = most(starts);
  return {
    rows: [
      row(
        `start to first 200 of /readyz, ${times} starts`,
        `<= ${TARGET_MS} ms`,
        `p50 ${ms(median)}, max ${ms(worst)}`,
        worst <= TARGET_MS,
      ),
    ],
  };
}

export const START = { name: "start", what: "time until the service is ready", times: 20, run };
