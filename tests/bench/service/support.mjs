// Shared parts of the service benchmarks.

import { readFileSync, readdirSync } from "node:fs";
import { availableParallelism } from "node:os";
import { Client } from "./client.mjs";
import { post_scene, start_service } from "../daemon.mjs";

export const kPaper = "scenes/paper.json";
export const kFlake = "scenes/sphereflake-3.json"; // few objects; 820 spheres

export const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Starts a service with two scenes, calls `work(service, {paper, flake})` with the paths of the scenes, and
// stops the service.
export async function with_service(work, words = []) {
  const service = await start_service(words);
  try {
    const path = async (scene) => `/v1/scenes/${await post_scene(service.port, scene)}`;
    return await work(service, { paper: await path(kPaper), flake: await path(kFlake) });
  } finally {
    await service.stop();
  }
}

// Default limit of concurrent renders in the service.
export const kRendersAtOnce = 2 * availableParallelism();

let seed = 0;
// Returns the address of a picture with a new seed.
export const new_picture = (scene, side, samples) =>
  `${scene}/frame.png?width=${side}&height=${side}&samples=${samples}&seed=${++seed}`;

// ---- numbers

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

// Returns up to 60 of the values as bars, from the minimum to the maximum.
export function sparkline(values) {
  const step = Math.max(1, Math.ceil(values.length / 60));
  const some = values.filter((_, i) => i % step === 0);
  const low = Math.min(...some);
  const high = most(some);
  const bars = "▁▂▃▄▅▆▇█";
  return some.map((v) => bars[high > low ? Math.round(((v - low) / (high - low)) * 7) : 0]).join("");
}

// Counts equal words: "200: 12, refused: 3".
export function tally(words) {
  const counts = new Map();
  for (const word of words) counts.set(word, (counts.get(word) ?? 0) + 1);
  return [...counts].map(([word, count]) => `${word}: ${count}`).join(", ") || "none";
}
export const outcome = (answer) => answer.failure ?? answer.status;

// Returns a row of the table. `met` is null if there is no target.
export const row = (what, target, measured, met) => ({ what, target, measured, met });

// Returns a row for unwanted responses, whose target is 0.
export const none_row = (what, bad) =>
  row(what, "0", bad.length === 0 ? "0" : tally(bad.map(outcome)), bad.length === 0);

// ---- state of the service, from the kernel and its metrics

const status_of = (pid) => readFileSync(`/proc/${pid}/status`, "utf8");
const resident_of = (pid) => 1024 * Number(/VmRSS:\s*(\d+)/.exec(status_of(pid))?.[1] ?? 0);

// Returns the ids of the service's decoder processes.
export function decoders_of(pid) {
  const children = (task) => {
    try {
      return readFileSync(`/proc/${pid}/task/${task}/children`, "utf8").split(" ").filter(Boolean);
    } catch {
      return []; // the thread has ended
    }
  };
  return readdirSync(`/proc/${pid}/task`).flatMap(children);
}

// Returns {resident, threads, descriptors}. `resident`: bytes, with the service's decoders.
export function process_state(pid) {
  let resident = resident_of(pid);
  for (const decoder of decoders_of(pid)) {
    try {
      resident += resident_of(decoder);
    } catch {
      // The decoder has ended.
    }
  }
  return {
    resident,
    threads: Number(/Threads:\s*(\d+)/.exec(status_of(pid))[1]),
    descriptors: readdirSync(`/proc/${pid}/fd`).length,
  };
}

// Resolves to the milliseconds until `holds()` resolves to true, or to NaN after `limit_ms`.
export async function until(holds, limit_ms = 30_000) {
  for (const start = performance.now(); ;) {
    const held = await holds();
    const took = performance.now() - start;
    if (held) return took;
    if (took > limit_ms) return NaN;
  }
}

// Reader of the service's metrics on one connection, which the service closes after 15 s without requests.
export class Gauges {
  constructor(service) {
    this.client = new Client(service.health_port);
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
      left_queue: value('orrery_given_up_total{stage="queue"}'),
      stored: stored.reduce((sum, match) => sum + Number(match[1]), 0),
    };
  }

  // Resolves to the milliseconds until `holds(gauges)` is true, or to NaN after `limit_ms`.
  until(holds, limit_ms) {
    return until(async () => holds(await this.read()), limit_ms);
  }

  close() {
    this.client.leave();
  }
}

// Resolves to the service's memory limit (memory_bytes) plus a tolerance of 10 %, in bytes.
export async function memory_bound(port) {
  const limits = JSON.parse((await new Client(port).ask("/v1/limits")).text());
  return 1.1 * limits.memory_bytes;
}

// Options of a picture with all layers, which needs a film of sums.
export const kLayers = { layers: ["depth", "normal", "position", "uv", "object", "footprint"] };

// ---- load

// Runs `count` clients that send a request after each response, until stop(). `path_of()` returns the next
// path. `on_answer` gets each response and returns false to stop the client. After a status other than 200, a
// client pauses for `rest_ms`. `request`: options such as headers of all requests.
export function closed_loop(port, count, path_of, on_answer, rest_ms = 0, request = {}) {
  let going = true;
  const clients = Array.from({ length: count }, () => new Client(port));
  const run = async (client) => {
    while (going) {
      const answer = await client.ask(path_of(), request);
      if (answer.failure === "left" || on_answer(answer) === false) return;
      if (rest_ms > 0 && answer.status !== 200 && going) await pause(rest_ms);
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
