// SIGTERM under load: earlier requests get complete responses, /readyz reports draining, the exit status is
// 0.

import { Client, header_of } from "./client.mjs";
import { closed_loop, most, ms, new_picture, none_row, outcome, pause, row, tally, with_service } from "./support.mjs";

const kClients = 32;
const kGrace_s = 30;

const is_whole = (answer) =>
  answer.status === 200 || (answer.status === 503 && header_of(answer, "Retry-After") !== undefined);

// Resolves to the responses of /readyz until the service is gone.
async function watch_readiness(service) {
  const client = new Client(service.health_port);
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

async function one_end() {
  return with_service(async (service, scenes) => {
    const answers = [];
    const on_answer = (answer) => {
      answers.push(answer);
      return answer.failure !== "refused";
    };
    const load = closed_loop(service.port, kClients, () => new_picture(scenes.paper, 200, 16), on_answer);
    await pause(800 + 400 * Math.random());
    const signalled = performance.now();
    service.signal();
    const said = watch_readiness(service);
    const code = await service.gone;
    const took = performance.now() - signalled;
    await load.all;
    const before = answers.filter((a) => a.sent !== null && a.sent < signalled);
    const after = answers.filter((a) => a.sent !== null && a.sent >= signalled);
    return { before, after, code, took, said: await said };
  });
}

const whole_row = (what, answers) =>
  none_row(
    `${what}, ${answers.length}: not answered whole`,
    answers.filter((answer) => !is_whole(answer)),
  );

async function run({ times }) {
  const ends = [];
  for (let i = 0; i < times; ++i) ends.push(await one_end());
  const after = ends.flatMap((end) => end.after);
  const kept = after.filter(({ first }) => !first);
  const in_time = ends.every(({ code, took }) => code === 0 && took <= 1000 * kGrace_s);
  const told = ends.filter(({ said }) => said.includes("503 draining")).length;
  const told_wrong = ends
    .flatMap(({ said }) => said.slice(said.indexOf("503 draining")))
    .filter((s) => s !== "503 draining");
  const slowest = most(ends.map(({ took }) => took));
  const exits = `${tally(ends.map(({ code }) => `exit ${code}`))}; at most ${ms(slowest)}`;
  const ready = `${told} of ${times}${told_wrong.length > 0 ? `; then ${tally(told_wrong)}` : ""}`;
  return {
    rows: [
      whole_row(
        "asked before the signal",
        ends.flatMap((end) => end.before),
      ),
      whole_row(
        "on connections made after it",
        after.filter(({ first }) => first),
      ),
      row(`exit 0 within ${kGrace_s} s, ${times} times`, "all", exits, in_time),
      row("/readyz said 503 draining meanwhile", "all", ready, told === times && told_wrong.length === 0),
    ],
    // A client must expect that a keep-alive connection closes before its next request (RFC 9112, 9.3.1).
    remark: `asked after the signal on a connection from before: ${tally(kept.map(outcome))}`,
  };
}

export const kSigterm = { name: "sigterm", what: `SIGTERM while ${kClients} clients ask`, times: 10, run };
