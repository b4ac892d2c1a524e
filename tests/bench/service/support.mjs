// What the service's measurements share.

import { readFileSync, readdirSync } from "node:fs";
import { availableParallelism } from "node:os";
import { Client } from "./client.mjs";
import { post_scene, start_service } from "../daemon.mjs";

export const kPaper = "scenes/paper.json";
export const kFlake = "scenes/sphereflake-3.json"; // few objects; 820 spheres

export const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// Starts a service with two scenes, calls `work` with it and {paper, flake}, the paths of their pictures, and
// ends it.
export async function with_service(work, words = []) {
  const service = await start_service(words);
  try {
    const path = async (scene) => `/v1/scenes/${await post_scene(service.port, scene)}`;
    return await work(service, { paper: await path(kPaper), flake: await path(kFlake) });
  } finally {
    await service.stop();
  }
}

// Pictures at once, as the service's default is.
export const kRendersAtOnce = 2 * availableParallelism();

let seed = 0;
// Address of a picture that nobody asked for before.
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

// Up to 60 of the values as bars, from the least to the most.
export function sparkline(values) {
  const step = Math.max(1, Math.ceil(values.length / 60));
  const some = values.filter((_, i) => i % step === 0);
  const low = Math.min(...some);
  const high = most(some);
  const bars = "▁▂▃▄▅▆▇█";
  return some.map((v) => bars[high > low ? Math.round(((v - low) / (high - low)) * 7) : 0]).join("");
}

// How many of each: "200: 12, refused: 3".
export function tally(words) {
  const counts = new Map();
  for (const word of words) counts.set(word, (counts.get(word) ?? 0) + 1);
  return [...counts].map(([word, count]) => `${word}: ${count}`).join(", ") || "none";
}
export const outcome = (answer) => answer.failure ?? answer.status;

// One row of the table. `met` null: there is no target.
export const row = (what, target, measured, met) => ({ what, target, measured, met });

// A row for answers of which there should be none.
export const none_row = (what, bad) =>
  row(what, "0", bad.length === 0 ? "0" : tally(bad.map(outcome)), bad.length === 0);

// ---- the service as the kernel and its own metrics see it

const status_of = (pid) => readFileSync(`/proc/${pid}/status`, "utf8");
const resident_of = (pid) => 1024 * Number(/VmRSS:\s*(\d+)/.exec(status_of(pid))?.[1] ?? 0);

// Process ids of those that decode pictures for the service.
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

// `resident` has the memory of the service's decoders too.
export function process_state(pid) {
  let resident = resident_of(pid);
  for (const decoder of decoders_of(pid)) {
    try {
      resident += resident_of(decoder);
    } catch {
      // it has ended
    }
  }
  return {
    resident,
    threads: Number(/Threads:\s*(\d+)/.exec(status_of(pid))[1]),
    descriptors: readdirSync(`/proc/${pid}/fd`).length,
  };
}

// Milliseconds until `holds()` resolves to true; NaN if that takes longer than `limit_ms`.
export async function until(holds, limit_ms = 30_000) {
  for (const start = performance.now(); ;) {
    const held = await holds();
    const took = performance.now() - start;
    if (held) return took;
    if (took > limit_ms) return NaN;
  }
}

// Reads the service's metrics on a connection of its own, which the service closes after 15 s of rest.
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

  // Milliseconds until `holds` is true of the gauges; NaN if that takes longer than `limit_ms`.
  until(holds, limit_ms) {
    return until(async () => holds(await this.read()), limit_ms);
  }

  close() {
    this.client.leave();
  }
}

// Bytes that the service is said to take at most (memory_bytes), and what is granted beyond them.
export async function memory_bound(port) {
  const limits = JSON.parse((await new Client(port).ask("/v1/limits")).text());
  return 1.1 * limits.memory_bytes;
}

// Options of a picture with all layers, which films of sums hold.
export const kLayers = { layers: ["depth", "normal", "position", "uv", "object", "footprint"] };

// ---- load

// `count` clients that ask again as soon as they have an answer, until stop(). `path_of` gives the next address,
// `on_answer` gets each answer and says by false that this client is done. After an answer other than 200 a
// client rests for `rest_ms`. `request`: headers and the like of all.
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
