// Measures the latency of normal clients during attacks by a thousand slow clients (slowhttptest). Normal
// clients request the page every 50 ms on new connections.

import { spawn } from "node:child_process";
import { readdirSync } from "node:fs";
import http from "node:http";
import { setTimeout as sleep } from "node:timers/promises";
import { startService } from "./daemon.mjs";

const SECONDS = Number(process.env.BENCH_ATTACK_S ?? 60); // duration of each attack
const CONNECTIONS = 1000,
  RATE = 200; // new connections per second
const EVERY_MS = 50;
const SPARE = 4; // file descriptors for normal clients

// Modes of slowhttptest with the attacked path.
const ATTACKS = [
  { mode: "-H", name: "slow heads", path: "/", more: [] },
  { mode: "-B", name: "slow bodies", path: "/v1/scenes", more: [] },
  {
    mode: "-X",
    name: "slow readers",
    path: "/scenes/sphereflake-3.json",
    more: ["-k", "5", "-w", "512", "-y", "1024"],
  },
  { mode: "-R", name: "ranges", path: "/", more: ["-t", "GET"] },
];

const descriptors = (pid) => readdirSync(`/proc/${pid}/fd`).length;

// Sends one normal request. Resolves to {ok, ms}.
function ask(port) {
  const start = performance.now();
  return new Promise((resolve) => {
    const done = (ok) => resolve({ ok, ms: performance.now() - start });
    const request = http.get({ host: "127.0.0.1", port, path: "/", agent: false, timeout: 10_000 }, (response) => {
      response
        .on("error", () => done(false))
        .on("end", () => done(response.statusCode === 200))
        .resume();
    });
    request.on("timeout", () => request.destroy()).on("error", () => done(false));
  });
}

// Repeats the attack until `end`, because slowhttptest exits once all its connections are closed. Resolves to
// the number of runs.
async function attackUntil(end, port, { mode, path, more }) {
  const words = [
    mode,
    "-c",
    CONNECTIONS,
    "-r",
    RATE,
    "-i",
    5,
    "-u",
    `http://127.0.0.1:${port}${path}`,
    "-v",
    0,
    ...more,
  ];
  let runs = 0;
  while (performance.now() < end) {
    const seconds = Math.max(1, Math.round((end - performance.now()) / 1000));
    const child = spawn("slowhttptest", [...words, "-l", seconds].map(String), { stdio: "ignore" });
    await new Promise((resolve) => child.once("close", resolve));
    ++runs;
  }
  return runs;
}

async function sampleUntil(end, port, pid) {
  const asked = [];
  let most = 0;
  while (performance.now() < end) {
    asked.push(ask(port));
    most = Math.max(most, descriptors(pid));
    await sleep(EVERY_MS);
  }
  return { answers: await Promise.all(asked), most };
}

// Resolves to the seconds until the number of descriptors is back to `before`, or to Infinity after 30 s.
async function backAfter(pid, before) {
  const start = performance.now();
  const seconds = () => (performance.now() - start) / 1000;
  while (seconds() < 30) {
    if (descriptors(pid) <= before + SPARE) return seconds();
    await sleep(100);
  }
  return Infinity;
}

async function measure(attack) {
  const service = await startService([]);
  try {
    for (let i = 0; i < 20; ++i) await ask(service.port);
    const before = descriptors(service.pid);
    const end = performance.now() + SECONDS * 1000;
    const [runs, { answers, most }] = await Promise.all([
      attackUntil(end, service.port, attack),
      sampleUntil(end, service.port, service.pid),
    ]);
    const backS = await backAfter(service.pid, before);
    const ms = answers.map((answer) => answer.ms).sort((a, b) => a - b);
    const quantile = (q) => ms[Math.min(ms.length - 1, Math.floor(q * ms.length))];
    const served = answers.filter((answer) => answer.ok).length;
    return {
      runs,
      asked: ms.length,
      served,
      p50: quantile(0.5),
      p99: quantile(0.99),
      worst: ms.at(-1),
      before,
      most,
      backS,
    };
  } finally {
    await service.stop();
  }
}

const COLUMNS = [14, 7, 8, 10, 9, 9, 9, 13, 8];
const row = (cells) => cells.map((cell, i) => (i === 0 ? cell.padEnd(COLUMNS[i]) : cell.padStart(COLUMNS[i]))).join("");

export const SLOW_CLIENTS = {
  name: "slow-clients",
  what: `latency of normal clients during ${CONNECTIONS} slowhttptest connections, ${SECONDS} s in each mode`,
  needs: ["slowhttptest"],
  async run() {
    console.log(
      "\n" + row(["attack", "runs", "requests", "served %", "p50 ms", "p99 ms", "max ms", "descriptors", "back s"]),
    );
    for (const attack of ATTACKS) {
      const r = await measure(attack);
      const cells = [(100 * r.served) / r.asked, r.p50, r.p99, r.worst].map((value) => value.toFixed(1));
      console.log(
        row([attack.name, String(r.runs), String(r.asked), ...cells, `${r.before}..${r.most}`, r.backS.toFixed(1)]),
      );
    }
    console.log("served: status 200 for GET / every 50 ms on new connections; aims: 100 %, p99 at most 250 ms,");
    console.log("descriptors back within 15 s; runs: slowhttptest restarts once all its connections are closed");
  },
};
