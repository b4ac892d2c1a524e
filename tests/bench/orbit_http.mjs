import { spawnSync } from "node:child_process";
import { ORRERY } from "./command.mjs";
import { FrameReader, cpuSeconds, postScene, send, startService } from "./daemon.mjs";

const SCENE = "scenes/paper.json"; // 600x600
const FRAMES = 300,
  THREADS = 2;

// ---- without HTTP: `orrery orbit` renders and encodes the same frames

function commandLineRun() {
  const words = ["orbit", SCENE, "--frames", FRAMES, "--threads", THREADS, "--discard", "--stats=json"];
  const done = spawnSync(ORRERY, words.map(String), { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`orrery orbit exited with status ${done.status}: ${done.stderr}`);
  const { seconds, cpu_s: cpuS } = JSON.parse(done.stdout);
  return { cost: seconds, cpuS };
}

// ---- with HTTP

// Starts a new service for each run, so that no state carries over.
async function httpRun() {
  const service = await startService(["--threads", THREADS, "--quiet"]);
  try {
    const id = await postScene(service.port, SCENE);
    const cpuBefore = cpuSeconds(service.pid);
    const start = process.hrtime.bigint();
    const path = `/v1/scenes/${id}/orbit?frames=${FRAMES}&fps=0`;
    const response = await send(service.port, "GET", path, { Accept: "application/x-orrery-frames" });
    let frames = 0,
      skipped = 0;
    const reader = new FrameReader((header) => {
      ++frames;
      skipped = header.skipped;
    });
    for await (const chunk of response) reader.add(chunk);
    const seconds = Number(process.hrtime.bigint() - start) / 1e9;
    if (frames !== FRAMES || skipped !== 0)
      throw new Error(`received ${frames} of ${FRAMES} frames, ${skipped} skipped`);
    return { cost: seconds, cpuS: cpuSeconds(service.pid) - cpuBefore };
  } finally {
    await service.stop();
  }
}

export const ORBIT_HTTP = {
  name: "orbit-http",
  what: `${FRAMES} frames of an orbit, 600x600, two threads, over HTTP compared with the command line`,
  cost: "wall s",
  reach: 0.9,
  aim: 0.97,
  needs: [],
  start: () => ({ ours: httpRun, theirs: async () => commandLineRun() }),
};
