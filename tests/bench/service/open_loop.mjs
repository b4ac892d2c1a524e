import { Client, header_of } from "./client.mjs";
import { pause } from "./support.mjs";

const kMostWaiting = 4000; // requests of ours without an answer: more than a service may keep

// Sends `rate` requests a second, whether or not those before are answered. Resolves to all answers.
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
