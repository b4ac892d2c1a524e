// Health checks while the pool and the queue are full.

import { Client } from "./client.mjs";
import { closed_loop, most, ms, new_picture, none_row, p99, pause, percent, row, with_service } from "./support.mjs";

const kClients = 100; // more than the slots and the queue hold
const kEvery_ms = 20;
const kTarget_ms = 50;

// Sends a request every `every_ms` on a new connection, whether or not the last response has arrived.
async function probe(port, path, seconds, every_ms = kEvery_ms) {
  const answers = [];
  const start = performance.now();
  const count = (1000 * seconds) / every_ms;
  for (let i = 0; i < count; ++i) {
    const asked = performance.now();
    const client = new Client(port);
    const answered = client.ask(path).then((answer) => {
      client.leave();
      return { ...answer, ms: performance.now() - asked };
    });
    answers.push(answered);
    await pause(Math.max(0, start + (i + 1) * every_ms - performance.now()));
  }
  return Promise.all(answers);
}

function report(what, answers) {
  const times = answers.map((answer) => answer.ms);
  const bad = answers.filter((answer) => answer.status !== 200);
  return [
    row(
      `${what}: p99 of ${answers.length}`,
      `<= ${kTarget_ms} ms`,
      `${ms(p99(times))} (max ${ms(most(times))})`,
      p99(times) <= kTarget_ms,
    ),
    none_row(`${what}: failures`, bad),
  ];
}

// Queue options: one waiting picture fills the queue, however large it is.
const kShortQueue = ["--queue-rays", 1, "--interactive-rays", 1e12];

async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const load = closed_loop(
      service.port,
      kClients,
      () => new_picture(scenes.paper, 600, 64),
      () => {},
      200,
    );
    await pause(1000);
    const [apart, main, ready] = await Promise.all([
      probe(service.health_port, "/healthz", seconds),
      probe(service.port, "/healthz", seconds),
      probe(service.health_port, "/readyz", seconds, 500),
    ]);
    await load.stop();
    const full = ready.filter((answer) => answer.status === 503).length / ready.length;
    return {
      rows: [...report("/healthz, health port", apart), ...report("/healthz, main port", main)],
      remark: `the queue was full in ${percent(full)} of the looks; each probe makes a connection, which is timed too`,
    };
  }, kShortQueue);
}

export const kHealth = { name: "health", what: "/healthz while pool and queue are full", seconds: 60, run };
