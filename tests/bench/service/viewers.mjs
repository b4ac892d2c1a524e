// Ten viewers of one orbit: a slow viewer must not delay the others, and each frame must be rendered once.

import net from "node:net";
import { most, ms, pause, percent, quantile, row, withService } from "./support.mjs";
import { FrameReader, send } from "../daemon.mjs";

const FPS = 20;
const OTHERS = 9;
const SLOW_BYTES_PER_S = 1024;
const PERIOD_MS = 1000 / FPS;
const TARGET_MS = 1.5 * PERIOD_MS;
const ONCE = 1.05;

const ACCEPT = "application/x-orrery-frames";

// Receives all frames. Resolves to [{at, key, frame, skipped}]: time of arrival in ms, identity of the
// render, frame number, and total number of frames skipped so far.
async function watch(port, path) {
  const frames = [];
  const reader = new FrameReader(({ frame, render_ms: renderMs, encode_ms: encodeMs, skipped }) =>
    // Two renders of the same frame differ in their times.
    frames.push({ at: performance.now(), key: `${frame} ${renderMs} ${encodeMs}`, frame, skipped }),
  );
  const response = await send(port, "GET", path, { Accept: ACCEPT });
  if (response.statusCode !== 200) throw new Error(`GET ${path}: status ${response.statusCode}`);
  for await (const chunk of response) reader.add(chunk);
  return frames;
}

// Receives SLOW_BYTES_PER_S. Returns stop(), which returns {bytes, cutS}: the number of bytes received, and
// the seconds until the service closed the connection, or null if it did not.
function watchSlowly(port, path) {
  const start = performance.now();
  let bytes = 0,
    cutS = null;
  const socket = net.connect(port, "127.0.0.1", () =>
    socket.write(`GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: ${ACCEPT}\r\n\r\n`),
  );
  socket.on("readable", () => {}); // data is read by the timer below
  socket.on("error", () => {});
  socket.on("close", () => (cutS ??= (performance.now() - start) / 1000));
  const timer = setInterval(() => {
    const few = Math.min(SLOW_BYTES_PER_S / 10, socket.readableLength) | 0;
    bytes += (few > 0 && socket.read(few)?.length) || 0;
  }, 100);
  return () => {
    clearInterval(timer);
    const seen = { bytes, cutS };
    socket.destroy();
    return seen;
  };
}

function rowsOf(viewers, lone) {
  const gapsOf = (frames) => frames.slice(1).map(({ at }, i) => at - frames[i].at);
  const p95s = viewers.map((frames) => quantile(gapsOf(frames), 0.95));
  const renders = new Set(viewers.flat().map(({ key }) => key)).size;
  const seen = new Set(viewers.flat().map(({ frame }) => frame)).size;
  const skipped = most(viewers.map((frames) => frames.at(-1).skipped));
  const loneP95 = quantile(gapsOf(lone), 0.95);
  const share = renders / lone.length;
  return [
    row(
      `p95 of frame intervals, ${OTHERS} fast viewers`,
      `<= ${TARGET_MS} ms`,
      `worst ${ms(most(p95s))} (single viewer: ${ms(loneP95)})`,
      most(p95s) <= TARGET_MS,
    ),
    row(
      "renders relative to a single viewer",
      `<= ${percent(ONCE)}`,
      `${percent(share)}: ${renders} renders of ${seen} frames`,
      share <= ONCE,
    ),
    row("maximum frames skipped by a fast viewer", "", String(skipped), null),
  ];
}

async function run({ seconds }) {
  return withService(async (service, scenes) => {
    const path = `${scenes.paper}/orbit?fps=${FPS}&frames=${Math.round(FPS * seconds)}`;
    const lone = await watch(service.port, path);
    const stopSlow = watchSlowly(service.port, path);
    await pause(100);
    const viewers = await Promise.all(Array.from({ length: OTHERS }, () => watch(service.port, path)));
    const slow = stopSlow();
    const end = slow.cutS === null ? "stayed connected" : `was disconnected after ${slow.cutS.toFixed(1)} s`;
    return {
      rows: rowsOf(viewers, lone),
      remark: `the slow viewer received ${slow.bytes} bytes and ${end}; frames of 600x600 pixels`,
    };
  });
}

export const VIEWERS = {
  name: "viewers",
  what: `frame intervals of ${OTHERS + 1} viewers of an orbit, one of them slow`,
  seconds: 20,
  run,
};
