// Ten viewers of one orbit: a slow one delays no other, and each frame is rendered once.

import net from "node:net";
import { most, ms, pause, percent, quantile, row, with_service } from "./support.mjs";
import { FrameReader, send } from "../daemon.mjs";

const kFps = 20;
const kOthers = 9;
const kSlow_bytes_per_s = 1024;
const kPeriod_ms = 1000 / kFps;
const kTarget_ms = 1.5 * kPeriod_ms;
const kOnce = 1.05;

const kAccept = "application/x-orrery-frames";

// Reads all frames. Resolves to [{at, key, frame, skipped}].
async function watch(port, path) {
  const frames = [];
  const reader = new FrameReader(({ frame, render_ms, encode_ms, skipped }) =>
    // The key identifies a render: two renders of one frame take different times.
    frames.push({ at: performance.now(), key: `${frame} ${render_ms} ${encode_ms}`, frame, skipped }),
  );
  const response = await send(port, "GET", path, { Accept: kAccept });
  if (response.statusCode !== 200) throw new Error(`the orbit was answered with ${response.statusCode}`);
  for await (const chunk of response) reader.add(chunk);
  return frames;
}

// Reads a little every 0.1 s. Returns stop(), which returns the bytes received and cut_s, the seconds until
// the service closed the connection, or null.
function watch_slowly(port, path) {
  const start = performance.now();
  let bytes = 0,
    cut_s = null;
  const socket = net.connect(port, "127.0.0.1", () =>
    socket.write(`GET ${path} HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: ${kAccept}\r\n\r\n`),
  );
  socket.on("readable", () => {}); // read by the timer below
  socket.on("error", () => {});
  socket.on("close", () => (cut_s ??= (performance.now() - start) / 1000));
  const timer = setInterval(() => {
    const few = Math.min(kSlow_bytes_per_s / 10, socket.readableLength) | 0;
    bytes += (few > 0 && socket.read(few)?.length) || 0;
  }, 100);
  return () => {
    clearInterval(timer);
    const told = { bytes, cut_s };
    socket.destroy();
    return told;
  };
}

function rows_of(viewers, lone) {
  const gaps_of = (frames) => frames.slice(1).map(({ at }, i) => at - frames[i].at);
  const p95s = viewers.map((frames) => quantile(gaps_of(frames), 0.95));
  const renders = new Set(viewers.flat().map(({ key }) => key)).size;
  const seen = new Set(viewers.flat().map(({ frame }) => frame)).size;
  const skipped = most(viewers.map((frames) => frames.at(-1).skipped));
  const lone_p95 = quantile(gaps_of(lone), 0.95);
  const share = renders / lone.length;
  return [
    row(
      `frame gap p95 of the ${kOthers} others`,
      `<= ${kTarget_ms} ms`,
      `worst ${ms(most(p95s))} (a lone viewer ${ms(lone_p95)})`,
      most(p95s) <= kTarget_ms,
    ),
    row(
      "renders relative to a single viewer",
      `<= ${percent(kOnce)}`,
      `${percent(share)}: ${renders} of ${seen} frames`,
      share <= kOnce,
    ),
    row("frames that one of them missed", "", String(skipped), null),
  ];
}

async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const path = `${scenes.paper}/orbit?fps=${kFps}&frames=${Math.round(kFps * seconds)}`;
    const lone = await watch(service.port, path);
    const stop_slow = watch_slowly(service.port, path);
    await pause(100);
    const viewers = await Promise.all(Array.from({ length: kOthers }, () => watch(service.port, path)));
    const slow = stop_slow();
    const end = slow.cut_s === null ? "stayed connected" : `was cut off after ${slow.cut_s.toFixed(1)} s`;
    return {
      rows: rows_of(viewers, lone),
      remark: `the slow one took ${slow.bytes} bytes and ${end}; pictures of 600x600`,
    };
  });
}

export const kViewers = {
  name: "viewers",
  what: `${kOthers + 1} viewers of an orbit, one of them slow`,
  seconds: 20,
  run,
};
