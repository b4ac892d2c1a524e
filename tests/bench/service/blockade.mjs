// Isolation of clients: small pictures stay fast while other clients attack.

import { Client } from "./client.mjs";
import { kAttacks } from "./attacks.mjs";
import { FrameReader } from "../daemon.mjs";
import {
  memory_bound,
  mib,
  ms,
  outcome,
  new_picture,
  p99,
  pause,
  percent,
  process_state,
  row,
  tally,
  with_service,
} from "./support.mjs";
import { once } from "node:events";
import http from "node:http";
import { Worker } from "node:worker_threads";

const kPeriod_ms = 100; // period of small pictures and of orbit frames
const kPicture_ms = 1000;
const kHealth_ms = 50;
export const kVictim = "127.0.0.200";

// Numbers of attackers and of their addresses.
const kForces = [
  { count: 1, addresses: 1 },
  { count: 16, addresses: 1 },
  { count: 16, addresses: 8 },
];

function forces_of([, , , count]) {
  return count ? [...kForces, { count, addresses: 1 }, { count, addresses: 8 }] : kForces;
}

// Sends a request every kPeriod_ms, whether or not the last response has arrived. Returns stop(), which
// resolves to all responses.
export function open_loop(port, path_of, address) {
  const answers = [];
  const timer = setInterval(async () => {
    const client = new Client(port, address);
    answers.push(client.ask(path_of()).finally(() => client.leave()));
  }, kPeriod_ms);
  return async () => {
    clearInterval(timer);
    return Promise.all(answers);
  };
}

// Watches an orbit of ten frames per second. Returns stop(), which returns the number of frames received.
function watch(port, path) {
  let frames = 0;
  const reader = new FrameReader(() => ++frames);
  const headers = { Accept: "application/x-orrery-frames" };
  const request = http.get({ host: "127.0.0.1", port, path, headers, localAddress: kVictim, agent: false });
  request.on("response", (response) => response.on("data", (chunk) => reader.add(chunk)).on("error", () => {}));
  request.on("error", () => {});
  return () => {
    request.destroy();
    return frames;
  };
}

let number = 0;

// Starts an attack. Returns stop(), which resolves to the outcomes of the attackers' requests.
function attack({ port }, [name], { count, addresses }) {
  const workerData = { port, name, count, addresses };
  const worker = new Worker(new URL("attackers.mjs", import.meta.url), { workerData });
  const failed = new Promise((_, reject) => worker.on("error", reject));
  return async () => {
    worker.postMessage("stop");
    const [statuses] = await Promise.race([once(worker, "message"), failed]);
    return statuses;
  };
}

async function try_attack(service, paper, one, force, seconds) {
  const stop_watching = watch(service.port, `${paper}/orbit?fps=10&frames=3600&width=200&height=200&seed=${++number}`);
  await pause(300);
  const small = open_loop(service.port, () => new_picture(paper, 64, 1), kVictim);
  const health = open_loop(service.health_port, () => "/healthz", kVictim);
  const stop_attack = attack(service, one, force);
  let resident = 0;
  for (const end = performance.now() + 1000 * seconds; performance.now() < end; await pause(50))
    resident = Math.max(resident, process_state(service.pid).resident);
  const [pictures, pings] = await Promise.all([small(), health()]);
  const frames = stop_watching();
  const attackers = tally(await stop_attack());
  const bad = pictures.filter(({ status }) => status !== 200);
  const times = (answers) => answers.map((answer) => answer.ms ?? Infinity);
  return {
    name: `${one[0]}, ${force.count} from ${force.addresses}`,
    picture: p99(times(pictures)),
    bad,
    health: p99(times(pings)),
    frames: frames / (10 * seconds),
    resident,
    bound: await memory_bound(service.port),
    attackers,
  };
}

const worst_of = (tries, value) => tries.reduce((a, b) => (value(b) > value(a) ? b : a));
const told = (one, text) => `${text} (${one.name})`;

function rows_of(tries) {
  const picture = worst_of(tries, (t) => t.picture);
  const health = worst_of(tries, (t) => t.health);
  const frames = worst_of(tries, (t) => -t.frames);
  const bad = tries.flatMap((t) => t.bad);
  const resident = worst_of(tries, (t) => t.resident);
  return [
    row(
      "small picture p99, worst attack",
      `<= ${kPicture_ms} ms`,
      told(picture, ms(picture.picture)),
      picture.picture <= kPicture_ms,
    ),
    row("small pictures refused", "0", bad.length ? tally(bad.map(outcome)) : "0", bad.length === 0),
    row("frames of a viewer, worst attack", ">= 50 %", told(frames, percent(frames.frames)), frames.frames >= 0.5),
    row(
      "/healthz p99, worst attack",
      `<= ${kHealth_ms} ms`,
      told(health, ms(health.health)),
      health.health <= kHealth_ms,
    ),
    row(
      "memory, most",
      `<= ${mib(resident.bound)}`,
      told(resident, mib(resident.resident)),
      resident.resident <= resident.bound,
    ),
  ];
}

function tell(one) {
  const bad = one.bad.length > 0 ? `, not 200: ${tally(one.bad.map(outcome))}` : "";
  console.log(
    `  ${one.name}: ${ms(one.picture)}${bad}, frames ${percent(one.frames)}, health ${ms(one.health)}, ` +
      `${mib(one.resident)}, attackers got ${one.attackers}`,
  );
}

// Starts a new service for each attack, as jobs would outlive it.
async function run({ seconds }) {
  const wanted = process.env.BENCH_ATTACK ?? "";
  const tries = [];
  for (const one of kAttacks.filter(([name]) => name.includes(wanted)))
    for (const force of forces_of(one)) {
      tries.push(await with_service((service, { paper }) => try_attack(service, paper, one, force, seconds)));
      tell(tries.at(-1));
    }
  return {
    rows: rows_of(tries),
    remark: `${kAttacks.length} attacks, alone, 16 at once from one address and from 8, some 180 at once`,
  };
}

export const kBlockade = {
  name: "blockade",
  what: "small pictures, an orbit and /healthz while others ask for all they can",
  seconds: 3,
  run,
};
