// Overload by a factor of ten: the goodput stays, other requests are rejected at once.

import { monitorEventLoopDelay } from "node:perf_hooks";
import { open_loop } from "./open_loop.mjs";
import {
  Gauges,
  closed_loop,
  kRendersAtOnce,
  mean,
  mib,
  most,
  ms,
  new_picture,
  none_row,
  outcome,
  p99,
  pause,
  percent,
  process_state,
  quantile,
  row,
  sparkline,
  tally,
  with_service,
} from "./support.mjs";
import { cpu_seconds } from "../daemon.mjs";

const kTimes = 10; // multiple of the capacity
const kTurns = 4;
const kGoodput = 0.9;
const kRefusal_ms = 20;
const kMemory = 1.1;

const picture = (scenes) => new_picture(scenes.paper, 200, 64); // about 30 ms of one core

// Runs `work`. Resolves to its result, the cores used by the service and by this process, and the p99 delay
// of this process's timers in ms.
async function watched(service, work) {
  const delay = monitorEventLoopDelay({ resolution: 1 });
  const start = performance.now();
  const theirs = cpu_seconds(service.pid);
  const ours = process.cpuUsage();
  delay.enable();
  const result = await work();
  delay.disable();
  const seconds = (performance.now() - start) / 1000;
  const { user, system } = process.cpuUsage(ours);
  return {
    result,
    service_cores: (cpu_seconds(service.pid) - theirs) / seconds,
    generator_cores: (user + system) / 1e6 / seconds,
    late_ms: delay.percentile(99) / 1e6,
  };
}

// Resolves to the pictures per second with one client per render slot.
async function peak_rate(service, scenes, seconds) {
  let good = 0;
  const load = closed_loop(
    service.port,
    kRendersAtOnce,
    () => picture(scenes),
    ({ status }) => {
      if (status === 200) ++good;
    },
  );
  await pause(1000 * seconds);
  const rate = good / seconds;
  await load.stop();
  return { rate };
}

// Runs `work` and samples the resident bytes less the stored bytes. Resolves to {result, memory}.
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
  const watching = watch();
  const result = await work();
  going = false;
  await watching;
  return { result, memory: seen };
}

function rows_of(peaks, loads) {
  const answers = loads.flatMap((load) => load.answers);
  const refused = answers.filter(({ status }) => status === 503 || status === 429);
  const plain = refused.filter(({ retry_after }) => !/^\d+$/.test(retry_after ?? ""));
  const other = answers.filter(({ status }) => status !== 200 && status !== 503 && status !== 429);
  const broken = other.filter(({ failure }) => failure);
  const odd = other.filter(({ failure }) => !failure);
  const times = refused.map((answer) => answer.ms);
  const refusals_fit = plain.length + odd.length === 0;
  const shares = loads.map(({ good_rate }, i) => good_rate / peaks[i].rate);
  const share = quantile(shares, 0.5);
  const a_cpu_s =
    mean(loads.map((load) => load.good_rate / load.service_cores)) /
    mean(peaks.map((peak) => peak.rate / peak.service_cores));
  const before = peaks[0].memory.at(-1);
  const memory = loads.flatMap((load) => load.memory);
  const growth = most(memory) / before;
  const rate_of = (list) => mean(list.map(({ rate }) => rate));
  const range = `${percent(Math.min(...shares))} .. ${percent(most(shares))}`;
  const goodput = `${percent(share)} (${range}) of ${rate_of(peaks).toFixed(1)}/s`;
  const memory_text = `${percent(growth)} (${mib(before)}, at most ${mib(most(memory))}) ${sparkline(memory)}`;
  return [
    row(
      `goodput at ${rate_of(loads).toFixed(0)} requests/s`,
      `>= ${percent(kGoodput)} of peak`,
      goodput,
      share >= kGoodput,
    ),
    row(
      "pictures a CPU second of the service",
      `>= ${percent(kGoodput)} of the peak's`,
      percent(a_cpu_s),
      a_cpu_s >= kGoodput,
    ),
    row(
      `${refused.length} refusals: 503/429 with Retry-After`,
      "all",
      refusals_fit ? "all" : `${plain.length} without; ${tally(odd.map(outcome))}`,
      refusals_fit,
    ),
    row(
      "refusals: p99",
      `<= ${kRefusal_ms} ms`,
      `${ms(p99(times))} (p50 ${ms(quantile(times, 0.5))}, max ${ms(most(times))})`,
      p99(times) <= kRefusal_ms,
    ),
    row("resident memory relative to the first peak", `<= ${percent(kMemory)}`, memory_text, growth <= kMemory),
    none_row("connections broken", broken),
  ];
}

// Alternates peak and overload, so that other load on the machine affects both.
async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const gauges = new Gauges(service);
    const turn_s = seconds / kTurns;
    const peaks = [];
    const loads = [];
    const observe = async (work) => {
      const { result, ...cores } = await watched(service, () => with_memory(service, gauges, work));
      return { ...result.result, memory: result.memory, ...cores };
    };
    await peak_rate(service, scenes, 2); // warm-up
    for (let i = 0; i < kTurns; ++i) {
      peaks.push(await observe(() => peak_rate(service, scenes, Math.max(2, turn_s / 2))));
      loads.push(await observe(() => open_loop(service.port, kTimes * peaks[i].rate, turn_s, () => picture(scenes))));
    }
    gauges.close();
    const sum = (list, key) => mean(list.map((one) => one[key]));
    const cores = (list) => {
      const [theirs, ours] = ["service_cores", "generator_cores"].map((key) => sum(list, key).toFixed(2));
      return `service ${theirs}, clients ${ours} cores`;
    };
    return {
      rows: rows_of(peaks, loads),
      remark:
        `at the peak: ${cores(peaks)}; overloaded: ${cores(loads)}, whose own timers were late by p99 ` +
        `${ms(sum(loads, "late_ms"))}; memory is resident less what the stores hold`,
    };
  });
}

export const kOverload = {
  name: "overload",
  what: `${kTimes} times the requests that can be answered`,
  seconds: 60,
  run,
};
