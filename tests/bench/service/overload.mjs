// Ten times as many requests as can be answered: goodput stays, the rest is turned away at once.

import { monitorEventLoopDelay } from "node:perf_hooks";
import { Client, header_of } from "./client.mjs";
import {
  Gauges, closed_loop, kRendersAtOnce, mib, most, ms, new_picture, outcome, p99, pause, percent, process_state, row, tally, with_service,
} from "./support.mjs";
import { cpu_seconds } from "../daemon.mjs";

const kTimes = 10; // the capacity
const kGoodput = 0.9, kRefusal_ms = 20, kMemory = 1.1;
const kMostWaiting = 4000; // requests of ours without an answer: more than a service may keep

const picture = (scenes) => new_picture(scenes.paper, 200, 16); // some 30 ms of one core

// Cores that the service and this process take while `work` runs, and how late this process's own timers are.
async function watched(service, work) {
  const delay = monitorEventLoopDelay({ resolution: 1 }), start = performance.now();
  const theirs = cpu_seconds(service.pid), ours = process.cpuUsage();
  delay.enable();
  const result = await work();
  delay.disable();
  const seconds = (performance.now() - start) / 1000, { user, system } = process.cpuUsage(ours);
  return {
    result,
    service_cores: (cpu_seconds(service.pid) - theirs) / seconds,
    generator_cores: (user + system) / 1e6 / seconds,
    late_ms: delay.percentile(99) / 1e6,
  };
}

// Pictures a second when as many clients ask as pictures are made at once.
async function peak_rate(service, scenes, seconds) {
  let good = 0;
  const load = closed_loop(service.port, kRendersAtOnce, () => picture(scenes), ({ status }) => {
    if (status === 200) ++good;
  });
  await pause(1000 * seconds);
  const rate = good / seconds;
  await load.stop();
  return rate;
}

// Sends `rate` requests a second, whether or not those before are answered. Resolves to all answers.
async function open_loop(port, rate, seconds, path_of) {
  const idle = [], all = [];
  let waiting = 0;
  const ask = async () => {
    const client = idle.pop() ?? new Client(port);
    ++waiting;
    const answer = await client.ask(path_of());
    --waiting;
    idle.push(client);
    return { status: answer.status, failure: answer.failure, ms: answer.ms, sent: answer.sent, retry_after: answer.head && header_of(answer, "Retry-After") };
  };
  const start = performance.now(), count = Math.round(rate * seconds);
  while (all.length < count && waiting < kMostWaiting) {
    const due = Math.min(count, ((performance.now() - start) / 1000) * rate);
    while (all.length < due) all.push(ask());
    await pause(1);
  }
  const took_s = (performance.now() - start) / 1000, answers = await Promise.all(all);
  for (const client of idle) client.leave();
  const good = answers.filter((a) => a.status === 200 && a.sent + a.ms < start + 1000 * took_s).length;
  return { answers, good_rate: good / took_s, rate: answers.length / took_s };
}

// Resident bytes less those that the stores hold, read again and again while `work` runs: the last and the most.
async function memory_of(service, gauges, work) {
  const seen = [];
  let going = true;
  const watch = async () => {
    while (going) {
      const { stored } = await gauges.read();
      seen.push(process_state(service.pid).resident - stored);
      await pause(250);
    }
  };
  const watching = watch(), result = await work();
  going = false;
  await watching;
  return { result, last: seen.at(-1), most: most(seen), first: seen[Math.min(4, seen.length - 1)] };
}

function rows_of({ answers, good_rate, rate }, peak, memory_peak, memory) {
  const refused = answers.filter(({ status }) => status === 503 || status === 429);
  const plain = refused.filter(({ retry_after }) => !/^\d+$/.test(retry_after ?? ""));
  const other = answers.filter(({ status }) => status !== 200 && status !== 503 && status !== 429);
  const broken = other.filter(({ failure }) => failure), odd = other.filter(({ failure }) => !failure);
  const times = refused.map((answer) => answer.ms), growth = memory.most / memory_peak.last;
  const not_plain = plain.length + odd.length === 0;
  return [
    row(`goodput at ${rate.toFixed(0)} requests/s`, `>= ${percent(kGoodput)} of peak`, `${good_rate.toFixed(1)}/s, ${percent(good_rate / peak)} of ${peak.toFixed(1)}/s`, good_rate >= kGoodput * peak),
    row(`${refused.length} refusals: 503/429 with Retry-After`, "all", not_plain ? "all" : `${plain.length} without; ${tally(odd.map(outcome))}`, not_plain),
    row("refusals: p99", `<= ${kRefusal_ms} ms`, `${ms(p99(times))} (max ${ms(most(times))})`, p99(times) <= kRefusal_ms),
    row("resident memory beside that at the peak", `<= ${percent(kMemory)}`, `${percent(growth)} (${mib(memory_peak.last)}, after 1 s ${mib(memory.first)}, at most ${mib(memory.most)})`, growth <= kMemory),
    row("connections broken", "0", tally(broken.map(outcome)), broken.length === 0),
  ];
}

async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const gauges = new Gauges(service), peak_s = Math.max(3, seconds / 4);
    await peak_rate(service, scenes, 2); // warms up
    const calm = await watched(service, () => memory_of(service, gauges, () => peak_rate(service, scenes, peak_s)));
    const peak = calm.result.result, path_of = () => picture(scenes);
    const busy = await watched(service, () =>
      memory_of(service, gauges, () => open_loop(service.port, kTimes * peak, seconds, path_of)));
    gauges.close();
    const cores = (one) => `service ${one.service_cores.toFixed(2)}, clients ${one.generator_cores.toFixed(2)} cores`;
    return {
      rows: rows_of(busy.result.result, peak, calm.result, busy.result),
      remark: `at the peak: ${cores(calm)}; overloaded: ${cores(busy)}, whose own timers were late by p99 ${ms(busy.late_ms)}; memory is resident less what the stores hold`,
    };
  });
}

export const kOverload = { name: "overload", what: `${kTimes} times the requests that can be answered`, seconds: 60, run };
