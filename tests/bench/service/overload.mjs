// Tenfold overload: goodput must not drop, and excess requests must be rejected at once.

import { monitorEventLoopDelay } from "node:perf_hooks";
import { openLoop } from "./open_loop.mjs";
import {
  Gauges,
  closedLoop,
  RENDERS_AT_ONCE,
  mean,
  mib,
  most,
  ms,
  newPicture,
  noneRow,
  outcome,
  p99,
  pause,
  percent,
  processState,
  quantile,
  row,
  sparkline,
  tally,
  withService,
} from "./support.mjs";
import { cpuSeconds } from "../daemon.mjs";

const TIMES = 10; // request rate relative to the peak
const TURNS = 4;
const GOODPUT = 0.9;
const REFUSAL_MS = 20;
const MEMORY = 1.1;

const picture = (scenes) => newPicture(scenes.paper, 200, 64); // about 30 ms of CPU time

// Runs `work`. Resolves to {result, serviceCores, generatorCores, lateMs}: the result of `work`, the mean
// numbers of cores used by the service and by this process, and the p99 delay of this process's timers in ms.
async function watched(service, work) {
  const delay = monitorEventLoopDelay({ resolution: 1 });
  const start = performance.now();
  const theirs = cpuSeconds(service.pid);
  const ours = process.cpuUsage();
  delay.enable();
  const result = await work();
  delay.disable();
  const seconds = (performance.now() - start) / 1000;
  const { user, system } = process.cpuUsage(ours);
  return {
    result,
    serviceCores: (cpuSeconds(service.pid) - theirs) / seconds,
    generatorCores: (user + system) / 1e6 / seconds,
    lateMs: delay.percentile(99) / 1e6,
  };
}

// Resolves to {rate}: images per second with RENDERS_AT_ONCE clients.
async function peakRate(service, scenes, seconds) {
  let good = 0;
  const load = closedLoop(
    service.port,
    RENDERS_AT_ONCE,
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

// Runs `work`. Resolves to {result, memory}. `memory`: samples of the service's resident bytes minus the
// bytes in its stores, one every 250 ms.
async function withMemory(service, gauges, work) {
  const seen = [];
  let going = true;
  const watch = async () => {
    while (going) {
      const { stored } = await gauges.read();
      seen.push(processState(service.pid).resident - stored);
      await pause(250);
    }
  };
  const watching = watch();
  const result = await work();
  going = false;
  await watching;
  return { result, memory: seen };
}

function rowsOf(peaks, loads) {
  const answers = loads.flatMap((load) => load.answers);
  const refused = answers.filter(({ status }) => status === 503 || status === 429);
  const plain = refused.filter(({ retryAfter }) => !/^\d+$/.test(retryAfter ?? ""));
  const other = answers.filter(({ status }) => status !== 200 && status !== 503 && status !== 429);
  const broken = other.filter(({ failure }) => failure);
  const odd = other.filter(({ failure }) => !failure);
  const times = refused.map((answer) => answer.ms);
  const refusalsFit = plain.length + odd.length === 0;
  const shares = loads.map(({ goodRate }, i) => goodRate / peaks[i].rate);
  const share = quantile(shares, 0.5);
  const aCpuS =
    mean(loads.map((load) => load.goodRate / load.serviceCores)) /
    mean(peaks.map((peak) => peak.rate / peak.serviceCores));
  const before = peaks[0].memory.at(-1);
  const memory = loads.flatMap((load) => load.memory);
  const growth = most(memory) / before;
  const rateOf = (list) => mean(list.map(({ rate }) => rate));
  const range = `${percent(Math.min(...shares))} .. ${percent(most(shares))}`;
  const goodput = `${percent(share)} (${range}) of ${rateOf(peaks).toFixed(1)}/s`;
  const memoryText = `${percent(growth)} (${mib(before)}, at most ${mib(most(memory))}) ${sparkline(memory)}`;
  return [
    row(
      `goodput at ${rateOf(loads).toFixed(0)} requests/s`,
      `>= ${percent(GOODPUT)} of peak`,
      goodput,
      share >= GOODPUT,
    ),
    row("images per CPU second of the service", `>= ${percent(GOODPUT)} of peak`, percent(aCpuS), aCpuS >= GOODPUT),
    row(
      `${refused.length} rejections: 503 or 429, with Retry-After`,
      "all",
      refusalsFit ? "all" : `${plain.length} without Retry-After; other statuses: ${tally(odd.map(outcome))}`,
      refusalsFit,
    ),
    row(
      "p99 of rejections",
      `<= ${REFUSAL_MS} ms`,
      `${ms(p99(times))} (p50 ${ms(quantile(times, 0.5))}, max ${ms(most(times))})`,
      p99(times) <= REFUSAL_MS,
    ),
    row("resident memory relative to the first peak", `<= ${percent(MEMORY)}`, memoryText, growth <= MEMORY),
    noneRow("failed requests", broken),
  ];
}

// Alternates peak and overload, so that other load of the machine affects both equally.
async function run({ seconds }) {
  return withService(async (service, scenes) => {
    const gauges = new Gauges(service);
    const turnS = seconds / TURNS;
    const peaks = [];
    const loads = [];
    const observe = async (work) => {
      const { result, ...cores } = await watched(service, () => withMemory(service, gauges, work));
      return { ...result.result, memory: result.memory, ...cores };
    };
    await peakRate(service, scenes, 2); // warm-up
    for (let i = 0; i < TURNS; ++i) {
      peaks.push(await observe(() => peakRate(service, scenes, Math.max(2, turnS / 2))));
      loads.push(await observe(() => openLoop(service.port, TIMES * peaks[i].rate, turnS, () => picture(scenes))));
    }
    gauges.close();
    const sum = (list, key) => mean(list.map((one) => one[key]));
    const cores = (list) => {
      const [theirs, ours] = ["serviceCores", "generatorCores"].map((key) => sum(list, key).toFixed(2));
      return `service ${theirs}, clients ${ours} cores`;
    };
    return {
      rows: rowsOf(peaks, loads),
      remark:
        `peak: ${cores(peaks)}; overload: ${cores(loads)}; p99 delay of the clients' timers: ` +
        `${ms(sum(loads, "lateMs"))}; memory: resident bytes minus bytes in the stores`,
    };
  });
}

export const OVERLOAD = {
  name: "overload",
  what: `goodput and rejections at ${TIMES} times the peak rate`,
  seconds: 60,
  run,
};
