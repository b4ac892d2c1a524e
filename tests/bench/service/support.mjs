// Shared parts of the service benchmarks.

import { readFileSync, readdirSync } from "node:fs";
import { availableParallelism } from "node:os";
import { Client } from "./client.mjs";
import { postScene, startService } from "../daemon.mjs";

export const PAPER = "scenes/paper.json";
export const FLAKE = "scenes/sphereflake-3.json"; // 820 spheres and a plane

export const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Starts a service with two scenes, calls `work(service, {paper, flake})` with the paths of the scenes, and
// stops the service.
export async function withService(work, words = []) {
  const service = await startService(words);
  try {
    const path = async (scene) => `/v1/scenes/${await postScene(service.port, scene)}`;
    return await work(service, { paper: await path(PAPER), flake: await path(FLAKE) });
  } finally {
    await service.stop();
  }
}

// Default limit of concurrent renders in the service.
export const RENDERS_AT_ONCE = 2 * availableParallelism();

let seed = 0;
// Returns the path of an image with a new seed, which no cache contains.
export const newPicture = (scene, side, samples) =>
  `${scene}/frame.png?width=${side}&height=${side}&samples=${samples}&seed=${++seed}`;

// ---- statistics and formats

export function quantile(values, share) {
  if (values.length === 0) return NaN;
  const sorted = Float64Array.from(values).sort();
  return sorted[Math.min(sorted.length - 1, Math.ceil(share * sorted.length) - 1)];
}
export const p99 = (values) => quantile(values, 0.99);
export const most = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
export const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
export const ms = (value) => `${value.toFixed(value < 10 ? 2 : 1)} ms`;
export const percent = (share) => `${(100 * share).toFixed(1)} %`;
export const mib = (bytes) => `${(bytes / 2 ** 20).toFixed(1)} MiB`;

// Returns a line of at most 60 bars that shows every n-th value, scaled from the minimum to the maximum.
export function sparkline(values) {
  const step = Math.max(1, Math.ceil(values.length / 60));
  const some = values.filter((_, i) => i % step === 0);
  const low = Math.min(...some);
  const high = most(some);
  const bars = "▁▂▃▄▅▆▇█";
  return some.map((v) => bars[high > low ? Math.round(((v - low) / (high - low)) * 7) : 0]).join("");
}

// Returns the number of occurrences of each word, like "200: 12, refused: 3".
export function tally(words) {
  const counts = new Map();
  for (const word of words) counts.set(word, (counts.get(word) ?? 0) + 1);
  return [...counts].map(([word, count]) => `${word}: ${count}`).join(", ") || "none";
}
export const outcome = (answer) => answer.failure ?? answer.status;

// Returns a row of the table. `met` is null if there is no target.
export const row = (what, target, measured, met) => ({ what, target, measured, met });

// Returns a row that counts unwanted responses. The target is 0.
export const noneRow = (what, bad) =>
  row(what, "0", bad.length === 0 ? "0" : tally(bad.map(outcome)), bad.length === 0);

// ---- state of the service, from /proc and /metrics

const statusOf = (pid) => readFileSync(`/proc/${pid}/status`, "utf8");
const residentOf = (pid) => 1024 * Number(/VmRSS:\s*(\d+)/.exec(statusOf(pid))?.[1] ?? 0);

// Returns the process ids of the service's decoders.
export function decodersOf(pid) {
  const children = (task) => {
    try {
      return readFileSync(`/proc/${pid}/task/${task}/children`, "utf8").split(" ").filter(Boolean);
    } catch {
      return []; // the thread has ended
    }
  };
  return readdirSync(`/proc/${pid}/task`).flatMap(children);
}

// Returns {resident, threads, descriptors} of the service. `resident`: bytes, including decoder processes.
export function processState(pid) {
  let resident = residentOf(pid);
  for (const decoder of decodersOf(pid)) {
    try {
      resident += residentOf(decoder);
    } catch {
      // The decoder has ended.
    }
  }
  return {
    resident,
    threads: Number(/Threads:\s*(\d+)/.exec(statusOf(pid))[1]),
    descriptors: readdirSync(`/proc/${pid}/fd`).length,
  };
}

// Calls `holds()` repeatedly. Resolves to the milliseconds until a call resolves to true, or to NaN after
// `limitMs`.
export async function until(holds, limitMs = 30_000) {
  for (const start = performance.now(); ;) {
    const held = await holds();
    const took = performance.now() - start;
    if (held) return took;
    if (took > limitMs) return NaN;
  }
}

// Reader of the service's metrics on one connection. The service closes the connection after 15 s without
// requests.
export class Gauges {
  constructor(service) {
    this.client = new Client(service.healthPort);
  }

  async read() {
    const answer = await this.client.ask("/metrics");
    if (answer.status !== 200) throw new Error(`/metrics: ${outcome(answer)}`);
    const text = answer.text();
    const value = (name) => Number(new RegExp(`^${name.replace(/[{}]/g, "\\$&")} (\\S+)`, "m").exec(text)[1]);
    const stored = [...text.matchAll(/^orrery_stored_bytes\{[^}]*\} (\S+)/gm)];
    return {
      running: value("orrery_renders_running"),
      waiting: value("orrery_renders_waiting"),
      leftQueue: value('orrery_cancelled_total{stage="queue"}'),
      stored: stored.reduce((sum, match) => sum + Number(match[1]), 0),
    };
  }

  // Resolves to the milliseconds until `holds(gauges)` is true, or to NaN after `limitMs`.
  until(holds, limitMs) {
    return until(async () => holds(await this.read()), limitMs);
  }

  close() {
    this.client.leave();
  }
}

// Resolves to the service's memory limit in bytes (memory_bytes) plus 10 %.
export async function memoryBound(port) {
  const limits = JSON.parse((await new Client(port).ask("/v1/limits")).text());
  return 1.1 * limits.memory_bytes;
}

// Options for an image with all layers.
export const LAYERS = { layers: ["depth", "normal", "position", "uv", "object", "footprint"] };

// ---- load

// Runs `count` clients until stop(). Each client sends a new request after each response.
//   pathOf(): path of the next request
//   onAnswer(answer): called for each response, returns false to stop the client
//   restMs: pause of a client after a status other than 200
//   request: options of all requests, see Client.ask()
export function closedLoop(port, count, pathOf, onAnswer, restMs = 0, request = {}) {
  let going = true;
  const clients = Array.from({ length: count }, () => new Client(port));
  const run = async (client) => {
    while (going) {
      const answer = await client.ask(pathOf(), request);
      if (answer.failure === "left" || onAnswer(answer) === false) return;
      if (restMs > 0 && answer.status !== 200 && going) await pause(restMs);
    }
  };
  const all = Promise.all(clients.map(run));
  const stop = async () => {
    going = false;
    for (const client of clients) client.leave();
    await all;
  };
  return { all, stop };
}
