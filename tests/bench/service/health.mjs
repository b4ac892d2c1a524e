// Latency of health checks while all render slots are taken and the queue is full.

import { Client } from "./client.mjs";
import { closedLoop, most, ms, newPicture, noneRow, p99, pause, percent, row, withService } from "./support.mjs";

const CLIENTS = 100; // more than slots plus queue entries
const EVERY_MS = 20;
const TARGET_MS = 50;

// Sends a request every `everyMs` ms on a new connection, without waiting for the previous response. Resolves
// to all responses. The `ms` of a response includes the time to connect.
async function probe(port, path, seconds, everyMs = EVERY_MS) {
  const answers = [];
  const start = performance.now();
  const count = (1000 * seconds) / everyMs;
  for (let i = 0; i < count; ++i) {
    const asked = performance.now();
    const client = new Client(port);
    const answered = client.ask(path).then((answer) => {
      client.leave();
      return { ...answer, ms: performance.now() - asked };
    });
    answers.push(answered);
    await pause(Math.max(0, start + (i + 1) * everyMs - performance.now()));
  }
  return Promise.all(answers);
}

function report(what, answers) {
  const times = answers.map((answer) => answer.ms);
  const bad = answers.filter((answer) => answer.status !== 200);
  return [
    row(
      `${what}: p99 of ${answers.length} requests`,
      `<= ${TARGET_MS} ms`,
      `${ms(p99(times))} (max ${ms(most(times))})`,
      p99(times) <= TARGET_MS,
    ),
    noneRow(`${what}: failures`, bad),
  ];
}

// Options for a queue that is full as soon as one image of any size waits.
const SHORT_QUEUE = ["--max-queued-rays", 1, "--interactive-rays", 1e12];

async function run({ seconds }) {
  return withService(async (service, scenes) => {
    const load = closedLoop(
      service.port,
      CLIENTS,
      () => newPicture(scenes.paper, 600, 64),
      () => {},
      200,
    );
    await pause(1000);
    const [apart, main, ready] = await Promise.all([
      probe(service.healthPort, "/healthz", seconds),
      probe(service.port, "/healthz", seconds),
      probe(service.healthPort, "/readyz", seconds, 500),
    ]);
    await load.stop();
    const full = ready.filter((answer) => answer.status === 503).length / ready.length;
    return {
      rows: [...report("/healthz, health port", apart), ...report("/healthz, main port", main)],
      remark: `/readyz reported a full queue in ${percent(full)} of its responses; times include the connection`,
    };
  }, SHORT_QUEUE);
}

export const HEALTH = { name: "health", what: "latency of /healthz while slots and queue are full", seconds: 60, run };
