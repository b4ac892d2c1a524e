// Time from the start of the process to the first 200 of /readyz.

import { Client } from "./client.mjs";
import { most, ms, quantile, row } from "./support.mjs";
import { start_service } from "../daemon.mjs";

const kTarget_ms = 200;
const kLimit_ms = 20_000;

async function one_start() {
  const start = performance.now();
  const service = await start_service();
  const client = new Client(service.health_port);
  try {
    for (;;) {
      const { status } = await client.ask("/readyz");
      const took = performance.now() - start;
      if (status === 200) return took;
      if (took > kLimit_ms) throw new Error("not ready in 20 s");
    }
  } finally {
    client.leave();
    await service.stop();
  }
}

async function run({ times }) {
  const starts = [];
  for (let i = 0; i < times; ++i) starts.push(await one_start());
  const median = quantile(starts, 0.5);
  const worst = most(starts);
  return {
    rows: [
      row(
        `spawn to /readyz 200, ${times} starts`,
        `<= ${kTarget_ms} ms`,
        `p50 ${ms(median)}, max ${ms(worst)}`,
        worst <= kTarget_ms,
      ),
    ],
  };
}

export const kStart = { name: "start", what: "time until the service is ready", times: 20, run };
