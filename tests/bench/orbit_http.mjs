import { spawnSync } from "node:child_process";
import { kOrrery } from "./command.mjs";
import { FrameReader, cpu_seconds, post_scene, send, start_service } from "./daemon.mjs";

const kScene = "scenes/paper.json"; // 600x600
const kFrames = 300,
  kThreads = 2;

// ---- without HTTP: the command line's orbit renders and encodes the same frames

function command_line_run() {
  const words = ["orbit", kScene, "--frames", kFrames, "--threads", kThreads, "--discard", "--stats=json"];
  const done = spawnSync(kOrrery, words.map(String), { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`orrery orbit ended with ${done.status}: ${done.stderr}`);
  const { seconds, cpu_s } = JSON.parse(done.stdout);
  return { cost: seconds, cpu_s };
}

// ---- with HTTP

// Starts a new service for each run, so that no state carries over.
async function http_run() {
  const service = await start_service(["--threads", kThreads, "--quiet"]);
  try {
    const id = await post_scene(service.port, kScene);
    const cpu_before = cpu_seconds(service.pid);
    const start = process.hrtime.bigint();
    const path = `/v1/scenes/${id}/orbit?frames=${kFrames}&fps=0`;
    const response = await send(service.port, "GET", path, { Accept: "application/x-orrery-frames" });
    let frames = 0,
      skipped = 0;
    const reader = new FrameReader((header) => {
      ++frames;
      skipped = header.skipped;
    });
    for await (const chunk of response) reader.add(chunk);
    const seconds = Number(process.hrtime.bigint() - start) / 1e9;
    if (frames !== kFrames || skipped !== 0)
      throw new Error(`the orbit sent ${frames} of ${kFrames} frames and skipped ${skipped}`);
    return { cost: seconds, cpu_s: cpu_seconds(service.pid) - cpu_before };
  } finally {
    await service.stop();
  }
}

export const kOrbitHttp = {
  name: "orbit-http",
  what: `${kFrames} frames of an orbit, 600x600, two threads, through HTTP against without it`,
  cost: "wall s",
  reach: 0.9,
  aim: 0.97,
  needs: [],
  start: () => ({ ours: http_run, theirs: async () => command_line_run() }),
};
