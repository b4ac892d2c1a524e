// Time from a client's disconnect to the end of its request in the service.

import { Client, headerOf } from "./client.mjs";
import { putAsset, tinyJpeg } from "./pictures.mjs";
import {
  Gauges,
  closedLoop,
  decodersOf,
  RENDERS_AT_ONCE,
  most,
  ms,
  newPicture,
  p99,
  pause,
  row,
  until,
  withService,
} from "./support.mjs";
import { cpuSeconds } from "../daemon.mjs";

const RUNNING_MS = 100;
const WAITING_MS = 50;

const isIdle = ({ running, waiting }) => running + waiting === 0;

function report(what, times, targetMs) {
  const lost = times.filter(Number.isNaN).length;
  const worst = most(times);
  if (times.length === 0)
    return row(what, `all <= ${targetMs} ms`, "every response arrived before the disconnect", false);
  const measured = lost > 0 ? `${lost} did not end within 30 s` : `max ${ms(worst)}, p99 ${ms(p99(times))}`;
  return row(
    `${what} (${times.length} disconnects)`,
    `all <= ${targetMs} ms`,
    measured,
    lost === 0 && worst <= targetMs,
  );
}

// Requests an image and disconnects when `ready()` has resolved. Resolves to the milliseconds from the
// disconnect until `done(gauges)`, to NaN after a timeout, or to null if the response arrived before the
// disconnect.
async function leaveOnce(service, gauges, path, ready, done) {
  const client = new Client(service.port);
  const answer = client.ask(path);
  await ready();
  client.leave();
  const took = await gauges.until(done);
  const { failure } = await answer;
  return failure === "left" ? took : null;
}

const isTime = (value) => value !== null;

// Disconnects 0 to 10 ms after the start of a render that takes seconds.
async function leaveTracing(service, gauges, scenes, times) {
  const took = [];
  for (let i = 0; i < times; ++i) {
    const scene = i % 2 === 0 ? scenes.paper : scenes.flake;
    const ready = async () => {
      await gauges.until(({ running }) => running > 0);
      await pause(10 * Math.random());
    };
    took.push(await leaveOnce(service, gauges, newPicture(scene, 600, 512), ready, isIdle));
  }
  return took.filter(isTime);
}

// Disconnects at moments spread over the render and the encoding of a 4000x4000 image.
async function leaveLarge(service, gauges, scenes, times) {
  const client = new Client(service.port);
  const whole = await client.ask(newPicture(scenes.paper, 4000, 1));
  const wholeMs = whole.ms;
  client.leave();
  const took = [];
  for (let i = 0; i < times; ++i) {
    const ready = () => pause((wholeMs * (i + 0.5)) / times);
    took.push(await leaveOnce(service, gauges, newPicture(scenes.paper, 4000, 1), ready, isIdle));
  }
  const part = (name) =>
    Number(new RegExp(`${name};dur=([\\d.]+)`).exec(headerOf(whole, "Server-Timing"))[1]).toFixed(0);
  return {
    took: took.filter(isTime),
    parts: `${part("render")} ms of rendering and ${part("encode")} ms of encoding`,
  };
}

// Disconnects while queued. Long renders of the same client take all slots, so that new requests stay queued.
async function leaveWaiting(service, gauges, scenes, times) {
  const count = 4 * RENDERS_AT_ONCE;
  const load = closedLoop(
    service.port,
    count,
    () => newPicture(scenes.paper, 600, 1024),
    () => {},
  );
  const took = [];
  for (let i = 0; i < times; ++i) {
    let before = {};
    await gauges.until((now) => {
      before = now;
      return now.running === RENDERS_AT_ONCE && now.running + now.waiting === count;
    });
    const ready = () => gauges.until(({ running, waiting }) => running + waiting === count + 1);
    took.push(
      await leaveOnce(
        service,
        gauges,
        newPicture(scenes.paper, 64, 1),
        ready,
        ({ leftQueue }) => leftQueue > before.leftQueue,
      ),
    );
  }
  await load.stop();
  return took.filter(isTime);
}

const eachMsUntil = (holds) => until(() => pause(1).then(holds));

// Disconnects while an image file is decoded. Decoding takes seconds.
async function leaveDecoding(service, times) {
  const took = [];
  for (let i = 0; i < times; ++i) {
    const client = new Client(service.port);
    const { path, ...request } = putAsset(tinyJpeg(i, 60));
    const answer = client.ask(path, request);
    await eachMsUntil(() => decodersOf(service.pid).length > 0);
    await pause(200 * Math.random());
    client.leave();
    const ended = await eachMsUntil(() => decodersOf(service.pid).length === 0);
    if ((await answer).failure === "left") took.push(ended);
  }
  return took;
}

// Options for a single, unlimited queue, in which short renders wait behind long ones.
const ONE_LANE = ["--interactive-rays", 1e12, "--max-queued-rays", 1e12];

async function run({ times }) {
  return withService(async (service, scenes) => {
    const gauges = new Gauges(service);
    const tracing = await leaveTracing(service, gauges, scenes, times);
    const before = cpuSeconds(service.pid);
    await pause(500);
    const leftOver = (cpuSeconds(service.pid) - before) / 0.5;
    const waiting = await leaveWaiting(service, gauges, scenes, times);
    await gauges.until(isIdle);
    const decoding = await leaveDecoding(service, Math.ceil(times / 20));
    const large = await leaveLarge(service, gauges, scenes, Math.ceil(times / 20));
    gauges.close();
    return {
      rows: [
        report("disconnect while rendering: time until no render runs", tracing, RUNNING_MS),
        report("disconnect while queued: time until removed from the queue", waiting, WAITING_MS),
        report("disconnect while decoding: time until no decoder runs", decoding, RUNNING_MS),
        report("disconnect from a 16-megapixel image: time until no render runs", large.took, RUNNING_MS),
      ],
      remark:
        `the service used ${leftOver.toFixed(2)} cores after the cancelled renders; ` +
        `the 16-megapixel image takes ${large.parts}; times include requests of /metrics`,
    };
  }, ONE_LANE);
}

export const LEAVES = {
  name: "leaves",
  what: "cancellation of renders and decodings after a disconnect",
  times: 1000,
  run,
};
