import { Client, header_of } from "./client.mjs";
import { pause } from "./support.mjs";

const kMostWaiting = 4000; // limit of open requests, more than a service queues

// Sends `rate` requests per second, whether or not earlier ones have a response. Resolves to {answers,
// good_rate, rate}.
export async function open_loop(port, rate, seconds, path_of) {
  const idle = [];
  const all = [];
  let waiting = 0;
  const ask = async () => {
    const client = idle.pop() ?? new Client(port);
    ++waiting;
    const answer = await client.ask(path_of());
    --waiting;
    if (client.is_connected) idle.push(client);
    const { status, failure, ms, sent } = answer;
    return { status, failure, ms, sent, retry_after: answer.head && header_of(answer, "Retry-After") };
  };
  const start = performance.now();
  const count = Math.round(rate * seconds);
  while (all.length < count && waiting < kMostWaiting) {
    const due = Math.min(count, ((performance.now() - start) / 1000) * rate);
    while (all.length < due) all.push(ask());
    await pause(1);
  }
  const took_s = (performance.now() - start) / 1000;
  const answers = await Promise.all(all);
  for (const client of idle) client.leave();
  const good = answers.filter((a) => a.status === 200 && a.sent + a.ms < start + 1000 * took_s).length;
  return { answers, good_rate: good / took_s, rate: answers.length / took_s };
}
