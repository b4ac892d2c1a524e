// Long mixed traffic: memory, threads and descriptors must not grow.

import { mkdirSync, writeFileSync } from "node:fs";
import { Client } from "./client.mjs";
import { actsOn } from "./traffic.mjs";
import {
  Gauges,
  mean,
  mib,
  noneRow,
  outcome,
  pause,
  percent,
  processState,
  row,
  sparkline,
  tally,
  withService,
} from "./support.mjs";

const SAMPLE_S = 10;
const SAMPLES = 30; // minimum number of samples, for short runs
const MEMORY = 1.05;
const FEW = 3;
// Stores so small that scenes and assets are soon evicted.
const STORE = ["--scene-cache-bytes", 8 << 20, "--asset-bytes", 1 << 20, "--asset-store-bytes", 1 << 20];
const FILE = "build/charts/soak.json"; // all samples

// Repeats `act` until the deadline, with random pauses that keep the machine below overload.
async function keepOn(act, port, deadline, answers) {
  const client = new Client(port);
  while (performance.now() < deadline) {
    for (const { status, failure } of await act(client)) answers.push({ status, failure });
    await pause(60 * Math.random());
  }
  client.leave();
}

const thirds = (values) => {
  const third = Math.floor(values.length / 3);
  return { middle: mean(values.slice(third, 2 * third)), last: mean(values.slice(2 * third)) };
};

async function sample(service, deadline, seconds) {
  const gauges = new Gauges(service);
  const samples = [];
  const everyMs = 1000 * Math.min(SAMPLE_S, seconds / SAMPLES);
  while (performance.now() < deadline) {
    const { stored } = await gauges.read();
    samples.push({ atS: performance.now() / 1000, stored, ...processState(service.pid) });
    await pause(everyMs);
  }
  gauges.close();
  return samples;
}

// Returns a row that compares the mean of the last third of the samples with the mean of the middle third.
function trendRow(samples, key, tell, allowed, target) {
  const values = samples.map((one) => one[key]);
  const { middle, last } = thirds(values);
  const measured = `${tell(middle)} -> ${tell(last)} (${percent(last / middle - 1)})  ${sparkline(values)}`;
  return row(`${key}, last third relative to the middle third`, target, measured, last <= allowed(middle));
}

function rowsOf(samples, answers) {
  const share = percent(MEMORY - 1);
  const few = [(value) => value.toFixed(1), (middle) => middle + FEW, `<= ${FEW} more`];
  const wrong = answers.filter(({ status, failure }) => failure || (status >= 500 && status !== 503));
  return [
    trendRow(samples, "resident", mib, (middle) => MEMORY * middle, `<= ${share} more`),
    trendRow(samples, "threads", ...few),
    trendRow(samples, "descriptors", ...few),
    noneRow(`${answers.length} requests: failed, or 5xx other than 503`, wrong),
  ];
}

async function run({ seconds }) {
  return withService(async (service, scenes) => {
    const deadline = performance.now() + 1000 * seconds;
    const answers = [];
    const sampling = sample(service, deadline, seconds);
    const acts = actsOn(scenes, service.port);
    await Promise.all(acts.map((act) => keepOn(act, service.port, deadline, answers)));
    const samples = await sampling;
    mkdirSync("build/charts", { recursive: true });
    writeFileSync(FILE, JSON.stringify(samples));
    return {
      rows: rowsOf(samples, answers),
      remark: `outcomes: ${tally(answers.map(outcome))}; samples: ${FILE}`,
    };
  }, STORE);
}

export const SOAK = {
  name: "soak",
  what: "memory, threads and descriptors under mixed traffic",
  seconds: 1200,
  run,
};
