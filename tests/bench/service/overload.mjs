// Ten times as many requests as can be answered: goodput stays, the rest is turned away at once.

import { monitorEventLoopDelay } from "node:perf_hooks";
import { Client, header_of } from "./client.mjs";
import {
  Gauges, closed_loop, kRendersAtOnce, mean, mib, most, ms, new_picture, outcome, p99, pause, percent, process_state, quantile, row,
  sparkline, tally, with_service,
} from "./support.mjs";
import { cpu_seconds } from "../daemon.mjs";

const kTimes = 10; // the capacity
const kTurns = 4;
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
  return { rate };
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

// Resident bytes less those that the stores hold, read again and again while `work` runs.
async function with_memory(service, gauges, work) {
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
  return { result, memory: seen };
}

function rows_of(peaks, loads) {
  const answers = loads.flatMap((load) => load.answers);
  const refused = answers.filter(({ status }) => status === 503 || status === 429);
  const plain = refused.filter(({ retry_after }) => !/^\d+$/.test(retry_after ?? ""));
  const other = answers.filter(({ status }) => status !== 200 && status !== 503 && status !== 429);
  const broken = other.filter(({ failure }) => failure), odd = other.filter(({ failure }) => !failure);
  const times = refused.map((answer) => answer.ms), refusals_fit = plain.length + odd.length === 0;
  const shares = loads.map(({ good_rate }, i) => good_rate / peaks[i].rate), share = quantile(shares, 0.5);
  const a_cpu_s = mean(loads.map((load) => load.good_rate / load.service_cores)) / mean(peaks.map((peak) => peak.rate / peak.service_cores));
  const before = peaks[0].memory.at(-1), memory = loads.flatMap((load) => load.memory), growth = most(memory) / before;
  const goodput = `${percent(share)} (${percent(Math.min(...shares))} .. ${percent(most(shares))}) of ${mean(peaks.map(({ rate }) => rate)).toFixed(1)}/s`;
  const memory_told = `${percent(growth)} (${mib(before)}, at most ${mib(most(memory))}) ${sparkline(memory)}`;
  return [
    row(`goodput at ${mean(loads.map(({ rate }) => rate)).toFixed(0)} requests/s`, `>= ${percent(kGoodput)} of peak`, goodput, share >= kGoodput),
    row("pictures a CPU second of the service", `>= ${percent(kGoodput)} of the peak's`, percent(a_cpu_s), a_cpu_s >= kGoodput),
    row(`${refused.length} refusals: 503/429 with Retry-After`, "all", refusals_fit ? "all" : `${plain.length} without; ${tally(odd.map(outcome))}`, refusals_fit),
    row("refusals: p99", `<= ${kRefusal_ms} ms`, `${ms(p99(times))} (p50 ${ms(quantile(times, 0.5))}, max ${ms(most(times))})`, p99(times) <= kRefusal_ms),
    row("resident memory beside that at the first peak", `<= ${percent(kMemory)}`, memory_told, growth <= kMemory),
    row("connections broken", "0", tally(broken.map(outcome)), broken.length === 0),
  ];
}

// The peak and the overload in turns: others on this machine take as much from the one as from the other.
async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const gauges = new Gauges(service), turn_s = seconds / kTurns, peaks = [], loads = [];
    const observe = async (work) => {
      const { result, ...cores } = await watched(service, () => with_memory(service, gauges, work));
      return { ...result.result, memory: result.memory, ...cores };
    };
    await peak_rate(service, scenes, 2); // warms up
    for (let i = 0; i < kTurns; ++i) {
      peaks.push(await observe(() => peak_rate(service, scenes, Math.max(2, turn_s / 2))));
      loads.push(await observe(() => open_loop(service.port, kTimes * peaks[i].rate, turn_s, () => picture(scenes))));
    }
    gauges.close();
    const sum = (list, key) => mean(list.map((one) => one[key]));
    const cores = (list) => `service ${sum(list, "service_cores").toFixed(2)}, clients ${sum(list, "generator_cores").toFixed(2)} cores`;
    return {
      rows: rows_of(peaks, loads),
      remark:
        `at the peak: ${cores(peaks)}; overloaded: ${cores(loads)}, whose own timers were late by p99 ${ms(sum(loads, "late_ms"))}; ` +
        "memory is resident less what the stores hold",
    };
  });
}

export const kOverload = { name: "overload", what: `${kTimes} times the requests that can be answered`, seconds: 60, run };
