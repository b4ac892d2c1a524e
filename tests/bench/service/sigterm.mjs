// SIGTERM under load: open requests must get complete responses, /readyz must report draining, and the exit
// status must be 0.

import { Client, headerOf } from "./client.mjs";
import { closedLoop, most, ms, newPicture, noneRow, outcome, pause, row, tally, withService } from "./support.mjs";

const CLIENTS = 32;
const GRACE_S = 30;

// Returns true for a complete response: an image, or a rejection with Retry-After.
const isWhole = (answer) =>
  answer.status === 200 || (answer.status === 503 && headerOf(answer, "Retry-After") !== undefined);

// Polls /readyz until connections are refused. Resolves to the responses as "STATUS STATE".
async function watchReadiness(service) {
  const client = new Client(service.healthPort);
  const said = [];
  for (let i = 0; i < 100_000; ++i) {
    const answer = await client.ask("/readyz");
    if (answer.failure === "refused") break;
    if (!answer.failure) said.push(`${answer.status} ${JSON.parse(answer.text()).status}`);
    await pause(5);
  }
  client.leave();
  return said;
}

async function oneEnd() {
  return withService(async (service, scenes) => {
    const answers = [];
    const onAnswer = (answer) => {
      answers.push(answer);
      return answer.failure !== "refused";
    };
    const load = closedLoop(service.port, CLIENTS, () => newPicture(scenes.paper, 200, 16), onAnswer);
    await pause(800 + 400 * Math.random());
    const signalled = performance.now();
    service.signal();
    const said = watchReadiness(service);
    const code = await service.gone;
    const took = performance.now() - signalled;
    await load.all;
    const before = answers.filter((a) => a.sent !== null && a.sent < signalled);
    const after = answers.filter((a) => a.sent !== null && a.sent >= signalled);
    return { before, after, code, took, said: await said };
  });
}

const wholeRow = (what, answers) =>
  noneRow(
    `${what} (${answers.length}): no complete response`,
    answers.filter((answer) => !isWhole(answer)),
  );

async function run({ times }) {
  const ends = [];
  for (let i = 0; i < times; ++i) ends.push(await oneEnd());
  const after = ends.flatMap((end) => end.after);
  const kept = after.filter(({ first }) => !first);
  const inTime = ends.every(({ code, took }) => code === 0 && took <= 1000 * GRACE_S);
  const draining = ends.filter(({ said }) => said.includes("503 draining")).length;
  const laterStatuses = ends
    .flatMap(({ said }) => said.slice(said.indexOf("503 draining")))
    .filter((s) => s !== "503 draining");
  const slowest = most(ends.map(({ took }) => took));
  const exits = `${tally(ends.map(({ code }) => `exit ${code}`))}; at most ${ms(slowest)}`;
  const ready = `${draining} of ${times}${laterStatuses.length > 0 ? `; later: ${tally(laterStatuses)}` : ""}`;
  return {
    rows: [
      wholeRow(
        "requests before the signal",
        ends.flatMap((end) => end.before),
      ),
      wholeRow(
        "requests after the signal, new connections",
        after.filter(({ first }) => first),
      ),
      row(`exit status 0 within ${GRACE_S} s, ${times} times`, "all", exits, inTime),
      row(
        "/readyz answers 503 draining after the signal, and nothing else before the exit",
        "all",
        ready,
        draining === times && laterStatuses.length === 0,
      ),
    ],
    // Without target: a server may close a keep-alive connection between requests (RFC 9112, 9.3.1).
    remark: `requests after the signal, old connections: ${tally(kept.map(outcome))}`,
  };
}

export const SIGTERM = { name: "sigterm", what: `SIGTERM under the load of ${CLIENTS} clients`, times: 10, run };
