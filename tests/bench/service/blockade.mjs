// Isolation of clients: latency of one client's small images while other clients attack.

import { Client } from "./client.mjs";
import { ATTACKS } from "./attacks.mjs";
import { FrameReader } from "../daemon.mjs";
import {
  memoryBound,
  mib,
  ms,
  outcome,
  newPicture,
  p99,
  pause,
  percent,
  processState,
  row,
  tally,
  withService,
} from "./support.mjs";
import { once } from "node:events";
import http from "node:http";
import { Worker } from "node:worker_threads";

const PERIOD_MS = 100; // period of small images and of orbit frames
const PICTURE_MS = 1000;
const HEALTH_MS = 50;
export const VICTIM = "127.0.0.200";

// Numbers of attackers and of local addresses that they use.
const FORCES = [
  { count: 1, addresses: 1 },
  { count: 16, addresses: 1 },
  { count: 16, addresses: 8 },
];

function forcesOf([, , , count]) {
  return count ? [...FORCES, { count, addresses: 1 }, { count, addresses: 8 }] : FORCES;
}

// Sends a request every PERIOD_MS without waiting for the previous response. Returns stop(), which resolves
// to all responses.
export function openLoop(port, pathOf, address) {
  const answers = [];
  const timer = setInterval(async () => {
    const client = new Client(port, address);
    answers.push(client.ask(pathOf()).finally(() => client.leave()));
  }, PERIOD_MS);
  return async () => {
    clearInterval(timer);
    return Promise.all(answers);
  };
}

// Streams an orbit. Returns stop(), which returns the number of frames received.
function watch(port, path) {
  let frames = 0;
  const reader = new FrameReader(() => ++frames);
  const headers = { Accept: "application/x-orrery-frames" };
  const request = http.get({ host: "127.0.0.1", port, path, headers, localAddress: VICTIM, agent: false });
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

async function tryAttack(service, paper, one, force, seconds) {
  const stopWatching = watch(service.port, `${paper}/orbit?fps=10&frames=3600&width=200&height=200&seed=${++number}`);
  await pause(300);
  const small = openLoop(service.port, () => newPicture(paper, 64, 1), VICTIM);
  const health = openLoop(service.healthPort, () => "/healthz", VICTIM);
  const stopAttack = attack(service, one, force);
  let resident = 0;
  for (const end = performance.now() + 1000 * seconds; performance.now() < end; await pause(50))
    resident = Math.max(resident, processState(service.pid).resident);
  const [pictures, pings] = await Promise.all([small(), health()]);
  const frames = stopWatching();
  const attackers = tally(await stopAttack());
  const bad = pictures.filter(({ status }) => status !== 200);
  const times = (answers) => answers.map((answer) => answer.ms ?? Infinity);
  return {
    name: `${one[0]}, ${force.count} from ${force.addresses}`,
    picture: p99(times(pictures)),
    bad,
    health: p99(times(pings)),
    frames: frames / (10 * seconds),
    resident,
    bound: await memoryBound(service.port),
    attackers,
  };
}

const worstOf = (tries, value) => tries.reduce((a, b) => (value(b) > value(a) ? b : a));
const withName = (one, text) => `${text} (${one.name})`;

function rowsOf(tries) {
  const picture = worstOf(tries, (t) => t.picture);
  const health = worstOf(tries, (t) => t.health);
  const frames = worstOf(tries, (t) => -t.frames);
  const bad = tries.flatMap((t) => t.bad);
  const resident = worstOf(tries, (t) => t.resident);
  return [
    row(
      "p99 of small images, worst attack",
      `<= ${PICTURE_MS} ms`,
      withName(picture, ms(picture.picture)),
      picture.picture <= PICTURE_MS,
    ),
    row("small images not answered with 200", "0", bad.length ? tally(bad.map(outcome)) : "0", bad.length === 0),
    row(
      "frames received by a viewer, worst attack",
      ">= 50 %",
      withName(frames, percent(frames.frames)),
      frames.frames >= 0.5,
    ),
    row(
      "p99 of /healthz, worst attack",
      `<= ${HEALTH_MS} ms`,
      withName(health, ms(health.health)),
      health.health <= HEALTH_MS,
    ),
    row(
      "maximum resident memory, worst attack",
      `<= ${mib(resident.bound)}`,
      withName(resident, mib(resident.resident)),
      resident.resident <= resident.bound,
    ),
  ];
}

function tell(one) {
  const bad = one.bad.length > 0 ? `, not 200: ${tally(one.bad.map(outcome))}` : "";
  console.log(
    `  ${one.name}: ${ms(one.picture)}${bad}, frames ${percent(one.frames)}, health ${ms(one.health)}, ` +
      `${mib(one.resident)}, outcomes of attackers: ${one.attackers}`,
  );
}

// Starts a new service for each attack, because the jobs of an attack would continue during the next attack.
async function run({ seconds }) {
  const wanted = process.env.BENCH_ATTACK ?? "";
  const tries = [];
  for (const one of ATTACKS.filter(([name]) => name.includes(wanted)))
    for (const force of forcesOf(one)) {
      tries.push(await withService((service, { paper }) => tryAttack(service, paper, one, force, seconds)));
      tell(tries.at(-1));
    }
  return {
    rows: rowsOf(tries),
    remark:
      `${ATTACKS.length} attacks, each by 1 client, 16 clients of one address, and 16 clients of 8 addresses; ` +
      "some also by 180 clients",
  };
}

export const BLOCKADE = {
  name: "blockade",
  what: "latency of small images, an orbit and /healthz under attacks of other clients",
  seconds: 3,
  run,
};
