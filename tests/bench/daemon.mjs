// Service process of a benchmark, and single requests to it.

import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import http from "node:http";
import { kOrrery } from "./command.mjs";

const kStart_ms = 20_000;

// Resolves to the two ports in the service's first lines.
function read_ports(child) {
  return new Promise((resolve, reject) => {
    let output = "";
    const timer = setTimeout(() => reject(new Error(`orrery serve named no ports; it said: ${output}`)), kStart_ms);
    child.stdout.on("data", (bytes) => {
      output += bytes;
      const match = /http:\/\/\S+:(\d+)\s[^\n]* port (\d+)\n/.exec(output);
      if (!match) return;
      clearTimeout(timer);
      resolve({ port: Number(match[1]), health_port: Number(match[2]) });
    });
    child.once("error", reject);
    child.once("close", (code) => reject(new Error(`orrery serve ended with ${code}`)));
  });
}

// Starts a service on these ports (0: free ones). Resolves to {port, health_port, pid, gone, signal(),
// stop()}. `gone` resolves to the exit status, or null after a signal.
export async function start_service(words = [], { port = 0, health_port = 0 } = {}) {
  const child = spawn(
    kOrrery,
    ["serve", "--port", `${port}`, "--health-port", `${health_port}`, ...words.map(String)],
    {
      stdio: ["ignore", "pipe", "ignore"],
    },
  );
  const gone = new Promise((resolve) => child.once("close", resolve));
  const signal = () => child.kill("SIGTERM");
  const stop = async () => {
    signal();
    const timer = setTimeout(() => child.kill("SIGKILL"), 5000);
    await gone;
    clearTimeout(timer);
  };
  try {
    const ports = await read_ports(child);
    return { ...ports, pid: child.pid, gone, signal, stop };
  } catch (error) {
    child.kill("SIGKILL");
    throw error;
  }
}

// Returns the processor seconds of a running process (Linux: clock ticks of 10 ms).
export function cpu_seconds(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

// Sends a request on a new connection. Resolves to the response, whose body is not read yet.
export function send(port, method, path, headers = {}, body = undefined) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: "127.0.0.1", port, method, path, headers, agent: false }, resolve);
    request.on("error", reject).end(body);
  });
}

export async function read_text(response) {
  let text = "";
  for await (const chunk of response) text += chunk;
  return text;
}

// Posts a scene file. Resolves to the scene's id.
export async function post_scene(port, path) {
  const json = { "Content-Type": "application/json" };
  const response = await send(port, "POST", "/v1/scenes", json, readFileSync(path));
  const text = await read_text(response);
  if (response.statusCode >= 300) throw new Error(`POST /v1/scenes: ${response.statusCode} ${text}`);
  return JSON.parse(text).id;
}

// Parser of a stream of [length of the header, 4 bytes][header][PNG]. Calls `on_frame` with each header once
// its picture has arrived. Stores no picture.
export class FrameReader {
  #begun = Buffer.alloc(0); // start of an incomplete header
  #header = null;
  #picture_bytes = 0; // missing bytes of the current PNG

  constructor(on_frame) {
    this.on_frame = on_frame;
  }

  add(chunk) {
    while (chunk.length > 0) {
      if (this.#picture_bytes > 0) {
        const taken = Math.min(this.#picture_bytes, chunk.length);
        this.#picture_bytes -= taken;
        chunk = chunk.subarray(taken);
        if (this.#picture_bytes === 0) this.on_frame(this.#header);
        continue;
      }
      chunk = this.#begun.length > 0 ? Buffer.concat([this.#begun, chunk]) : chunk;
      const header_end = chunk.length < 4 ? Infinity : 4 + chunk.readUInt32BE(0);
      if (chunk.length < header_end) {
        this.#begun = chunk;
        return;
      }
      this.#header = JSON.parse(chunk.toString("utf8", 4, header_end));
      this.#picture_bytes = this.#header.bytes;
      this.#begun = Buffer.alloc(0);
      chunk = chunk.subarray(header_end);
    }
  }
}
