// Time from a client's disconnect to the end of its work.

import { Client, header_of } from "./client.mjs";
import { put_asset, tiny_jpeg } from "./pictures.mjs";
import {
  Gauges,
  closed_loop,
  decoders_of,
  kRendersAtOnce,
  most,
  ms,
  new_picture,
  p99,
  pause,
  row,
  until,
  with_service,
} from "./support.mjs";
import { cpu_seconds } from "../daemon.mjs";

const kRunning_ms = 100;
const kWaiting_ms = 50;

const is_idle = ({ running, waiting }) => running + waiting === 0;

function report(what, times, target_ms) {
  const lost = times.filter(Number.isNaN).length;
  const worst = most(times);
  if (times.length === 0) return row(what, `all <= ${target_ms} ms`, "nobody left in time", false);
  const measured = lost > 0 ? `${lost} never ended` : `max ${ms(worst)}, p99 ${ms(p99(times))}`;
  return row(`${what}, ${times.length} times`, `all <= ${target_ms} ms`, measured, lost === 0 && worst <= target_ms);
}

// Requests a picture and disconnects after `ready`. Resolves to the milliseconds until the gauges are `done`,
// or to null if the response came first.
async function leave_once(service, gauges, path, ready, done) {
  const client = new Client(service.port);
  const answer = client.ask(path);
  await ready();
  client.leave();
  const took = await gauges.until(done);
  const { failure } = await answer;
  return failure === "left" ? took : null;
}

const is_time = (value) => value !== null;

// Disconnects during tracing: some milliseconds into a picture that takes seconds.
async function leave_tracing(service, gauges, scenes, times) {
  const took = [];
  for (let i = 0; i < times; ++i) {
    const scene = i % 2 === 0 ? scenes.paper : scenes.flake;
    const ready = async () => {
      await gauges.until(({ running }) => running > 0);
      await pause(10 * Math.random());
    };
    took.push(await leave_once(service, gauges, new_picture(scene, 600, 512), ready, is_idle));
  }
  return took.filter(is_time);
}

// Disconnects at moments spread over a picture of the largest size, encoding included.
async function leave_large(service, gauges, scenes, times) {
  const client = new Client(service.port);
  const whole = await client.ask(new_picture(scenes.paper, 4000, 1));
  const whole_ms = whole.ms;
  client.leave();
  const took = [];
  for (let i = 0; i < times; ++i) {
    const ready = () => pause((whole_ms * (i + 0.5)) / times);
    took.push(await leave_once(service, gauges, new_picture(scenes.paper, 4000, 1), ready, is_idle));
  }
  const part = (name) =>
    Number(new RegExp(`${name};dur=([\\d.]+)`).exec(header_of(whole, "Server-Timing"))[1]).toFixed(0);
  return {
    took: took.filter(is_time),
    parts: `${part("render")} ms of tracing and ${part("encode")} ms of encoding`,
  };
}

// Disconnects while queued. The long pictures have cost this client its slots, so none of its new ones starts.
async function leave_waiting(service, gauges, scenes, times) {
  const count = 4 * kRendersAtOnce;
  const load = closed_loop(
    service.port,
    count,
    () => new_picture(scenes.paper, 600, 1024),
    () => {},
  );
  const took = [];
  for (let i = 0; i < times; ++i) {
    let before = {};
    await gauges.until((now) => {
      before = now;
      return now.running === kRendersAtOnce && now.running + now.waiting === count;
    });
    const ready = () => gauges.until(({ running, waiting }) => running + waiting === count + 1);
    took.push(
      await leave_once(
        service,
        gauges,
        new_picture(scenes.paper, 64, 1),
        ready,
        ({ left_queue }) => left_queue > before.left_queue,
      ),
    );
  }
  await load.stop();
  return took.filter(is_time);
}

const each_ms_until = (holds) => until(() => pause(1).then(holds));

// Disconnects while a picture file is decoded, which takes seconds.
async function leave_decoding(service, times) {
  const took = [];
  for (let i = 0; i < times; ++i) {
    const client = new Client(service.port);
    const { path, ...request } = put_asset(tiny_jpeg(i, 60));
    const answer = client.ask(path, request);
    await each_ms_until(() => decoders_of(service.pid).length > 0);
    await pause(200 * Math.random());
    client.leave();
    const ended = await each_ms_until(() => decoders_of(service.pid).length === 0);
    if ((await answer).failure === "left") took.push(ended);
  }
  return took;
}

// Options for one lane of unlimited length, in which long pictures keep short ones waiting.
const kOneLane = ["--interactive-rays", 1e12, "--queue-rays", 1e12];

async function run({ times }) {
  return with_service(async (service, scenes) => {
    const gauges = new Gauges(service);
    const tracing = await leave_tracing(service, gauges, scenes, times);
    const before = cpu_seconds(service.pid);
    await pause(500);
    const left_over = (cpu_seconds(service.pid) - before) / 0.5;
    const waiting = await leave_waiting(service, gauges, scenes, times);
    await gauges.until(is_idle);
    const decoding = await leave_decoding(service, Math.ceil(times / 20));
    const large = await leave_large(service, gauges, scenes, Math.ceil(times / 20));
    gauges.close();
    return {
      rows: [
        report("left while traced: until no work runs", tracing, kRunning_ms),
        report("left while queued: until its work is given up", waiting, kWaiting_ms),
        report("left while a file is decoded: until no decoder runs", decoding, kRunning_ms),
        report("left any time in 16 Mpixel: until no work runs", large.took, kRunning_ms),
      ],
      remark:
        `the service took ${left_over.toFixed(2)} cores after those that were traced; ` +
        `16 Mpixel take ${large.parts}; times include asking /metrics`,
    };
  }, kOneLane);
}

export const kLeaves = {
  name: "leaves",
  what: "clients that leave while their picture is traced or waits",
  times: 1000,
  run,
};
