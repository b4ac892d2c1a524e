import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import http from "node:http";
import { kOrrery } from "./command.mjs";
import { start_service } from "./service.mjs";

const kScene = "scenes/paper.json"; // 600x600
const kFrames = 300, kThreads = 2;

// ---- without HTTP: the command line's orbit renders and encodes the same frames

function command_line_run() {
  const words = ["orbit", kScene, "--frames", kFrames, "--threads", kThreads, "--discard", "--stats=json"];
  const done = spawnSync(kOrrery, words.map(String), { encoding: "utf8" });
  if (done.status !== 0) throw new Error(`orrery orbit ended with ${done.status}: ${done.stderr}`);
  const { seconds, cpu_s } = JSON.parse(done.stdout);
  return { cost: seconds, cpu_s };
}

// ---- with HTTP

// Processor seconds of a running process (Linux: clock ticks of 10 ms, and the runs take seconds).
function cpu_seconds(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

function send(port, method, path, headers, body) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: "127.0.0.1", port, method, path, headers, agent: false }, resolve);
    request.on("error", reject).end(body);
  });
}

async function post_scene(port) {
  const json = { "Content-Type": "application/json" };
  const response = await send(port, "POST", "/v1/scenes", json, readFileSync(kScene));
  let text = "";
  for await (const chunk of response) text += chunk;
  if (response.statusCode >= 300) throw new Error(`POST /v1/scenes: ${response.statusCode} ${text}`);
  return JSON.parse(text).id;
}

// Counts the frames of a stream of [length of the header, 4 bytes][header][PNG]; keeps no picture.
class FrameCounter {
  frames = 0;
  skipped = 0;
  #begun = Buffer.alloc(0); // of a header that has not arrived whole
  #picture_bytes = 0; // of the current PNG, still to come

  add(chunk) {
    while (chunk.length > 0) {
      if (this.#picture_bytes > 0) {
        const taken = Math.min(this.#picture_bytes, chunk.length);
        this.#picture_bytes -= taken;
        chunk = chunk.subarray(taken);
        continue;
      }
      chunk = this.#begun.length > 0 ? Buffer.concat([this.#begun, chunk]) : chunk;
      const header_end = chunk.length < 4 ? Infinity : 4 + chunk.readUInt32BE(0);
      if (chunk.length < header_end) {
        this.#begun = chunk;
        return;
      }
      const header = JSON.parse(chunk.toString("utf8", 4, header_end));
      ++this.frames;
      this.skipped = header.skipped;
      this.#picture_bytes = header.bytes;
      this.#begun = Buffer.alloc(0);
      chunk = chunk.subarray(header_end);
    }
  }
}

// A service of its own for each run: nothing is left over from the one before.
async function http_run() {
  const service = await start_service(["--threads", String(kThreads)]);
  try {
    const id = await post_scene(service.port);
    const cpu_before = cpu_seconds(service.pid);
    const start = process.hrtime.bigint();
    const path = `/v1/scenes/${id}/orbit?frames=${kFrames}&fps=0`;
    const response = await send(service.port, "GET", path, { Accept: "application/x-orrery-frames" });
    const counter = new FrameCounter();
    for await (const chunk of response) counter.add(chunk);
    const seconds = Number(process.hrtime.bigint() - start) / 1e9;
    if (counter.frames !== kFrames || counter.skipped !== 0)
      throw new Error(`the orbit sent ${counter.frames} of ${kFrames} frames and skipped ${counter.skipped}`);
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
