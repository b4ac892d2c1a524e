// Long mixed traffic: memory, threads and descriptors stay constant.

import { mkdirSync, writeFileSync } from "node:fs";
import { Client } from "./client.mjs";
import { acts_on } from "./traffic.mjs";
import {
  Gauges,
  mean,
  mib,
  none_row,
  outcome,
  pause,
  percent,
  process_state,
  row,
  sparkline,
  tally,
  with_service,
} from "./support.mjs";

const kSample_s = 10;
const kSamples = 30; // every 10 s, more often in a short run
const kMemory = 1.05;
const kFew = 3;
// Stores so small that each new scene or asset soon evicts another.
const kStore = ["--store-bytes", 8 << 20, "--asset-bytes", 1 << 20, "--asset-store-bytes", 1 << 20];
const kFile = "build/charts/soak.json"; // data of the sparklines

// Repeats `act` until the deadline, with pauses so that the machine is busy but not overloaded.
async function keep_on(act, port, deadline, answers) {
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
  const every_ms = 1000 * Math.min(kSample_s, seconds / kSamples);
  while (performance.now() < deadline) {
    const { stored } = await gauges.read();
    samples.push({ at_s: performance.now() / 1000, stored, ...process_state(service.pid) });
    await pause(every_ms);
  }
  gauges.close();
  return samples;
}

// Compares the mean of the last third of the samples with that of the middle third.
function trend_row(samples, key, tell, allowed, target) {
  const values = samples.map((one) => one[key]);
  const { middle, last } = thirds(values);
  const measured = `${tell(middle)} -> ${tell(last)} (${percent(last / middle - 1)})  ${sparkline(values)}`;
  return row(`${key}, last third relative to the middle third`, target, measured, last <= allowed(middle));
}

function rows_of(samples, answers) {
  const share = percent(kMemory - 1);
  const few = [(value) => value.toFixed(1), (middle) => middle + kFew, `<= ${kFew} more`];
  const wrong = answers.filter(({ status, failure }) => failure || (status >= 500 && status !== 503));
  return [
    trend_row(samples, "resident", mib, (middle) => kMemory * middle, `<= ${share} more`),
    trend_row(samples, "threads", ...few),
    trend_row(samples, "descriptors", ...few),
    none_row(`${answers.length} answers: 5xx other than 503, or none`, wrong),
  ];
}

async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const deadline = performance.now() + 1000 * seconds;
    const answers = [];
    const sampling = sample(service, deadline, seconds);
    const acts = acts_on(scenes, service.port);
    await Promise.all(acts.map((act) => keep_on(act, service.port, deadline, answers)));
    const samples = await sampling;
    mkdirSync("build/charts", { recursive: true });
    writeFileSync(kFile, JSON.stringify(samples));
    return {
      rows: rows_of(samples, answers),
      remark: `answers: ${tally(answers.map(outcome))}; figures in ${kFile}`,
    };
  }, kStore);
}

export const kSoak = {
  name: "soak",
  what: "memory, threads and descriptors under mixed traffic",
  seconds: 1200,
  run,
};
