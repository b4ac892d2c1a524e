import { Client, headerOf } from "./client.mjs";
import { pause } from "./support.mjs";

const MOST_WAITING = 4000; // limit of open requests, longer than any queue of the service

// Sends `rate` requests per second for `seconds`, without waiting for responses. Stops early at MOST_WAITING
// open requests. Resolves to {answers, goodRate, rate}:
//   answers: outcomes {status, failure, ms, sent, retryAfter} of all requests
//   goodRate: responses per second that had status 200 and arrived while requests were sent
//   rate: requests per second actually sent
export async function openLoop(port, rate, seconds, pathOf) {
  const idle = [];
  const all = [];
  let waiting = 0;
  const ask = async () => {
    const client = idle.pop() ?? new Client(port);
    ++waiting;
    const answer = await client.ask(pathOf());
    --waiting;
    if (client.isConnected) idle.push(client);
    const { status, failure, ms, sent } = answer;
    return { status, failure, ms, sent, retryAfter: answer.head && headerOf(answer, "Retry-After") };
  };
  const start = performance.now();
  const count = Math.round(rate * seconds);
  while (all.length < count && waiting < MOST_WAITING) {
    const due = Math.min(count, ((performance.now() - start) / 1000) * rate);
    while (all.length < due) all.push(ask());
    await pause(1);
  }
  const tookS = (performance.now() - start) / 1000;
  const answers = await Promise.all(all);
  for (const client of idle) client.leave();
  const good = answers.filter((a) => a.status === 200 && a.sent + a.ms < start + 1000 * tookS).length;
  return { answers, goodRate: good / tookS, rate: answers.length / tookS };
}
