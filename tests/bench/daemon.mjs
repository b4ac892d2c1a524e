// Runs a service process for a benchmark, and sends single requests to it.

import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import http from "node:http";
import { ORRERY } from "./command.mjs";

const START_MS = 20_000;

// Resolves to the two ports in the first lines of the service's output.
function readPorts(child) {
  return new Promise((resolve, reject) => {
    let output = "";
    const timer = setTimeout(() => reject(new Error(`orrery serve printed no ports; output: ${output}`)), START_MS);
    child.stdout.on("data", (bytes) => {
      output += bytes;
      const match = /http:\/\/\S+:(\d+)\s[^\n]* port (\d+)\n/.exec(output);
      if (!match) return;
      clearTimeout(timer);
      resolve({ port: Number(match[1]), healthPort: Number(match[2]) });
    });
    child.once("error", reject);
    child.once("close", (code) => reject(new Error(`orrery serve exited with status ${code}`)));
  });
}

// Starts a service on these ports, or on free ports if they are 0. Resolves to {port, healthPort, pid, gone,
// signal(), stop()}. `gone` resolves to the exit status, or null after a signal.
export async function startService(words = [], { port = 0, healthPort = 0 } = {}) {
  const child = spawn(ORRERY, ["serve", "--port", `${port}`, "--health-port", `${healthPort}`, ...words.map(String)], {
    stdio: ["ignore", "pipe", "ignore"],
  });
  const gone = new Promise((resolve) => child.once("close", resolve));
  const signal = () => child.kill("SIGTERM");
  const stop = async () => {
    signal();
    const timer = setTimeout(() => child.kill("SIGKILL"), 5000);
    await gone;
    clearTimeout(timer);
  };
  try {
    const ports = await readPorts(child);
    return { ...ports, pid: child.pid, gone, signal, stop };
  } catch (error) {
    child.kill("SIGKILL");
    throw error;
  }
}

// Returns the processor seconds of a running process, from the kernel's clock ticks of 10 ms.
export function cpuSeconds(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

// Sends a request on a new connection. Resolves to the response before its body is read.
export function send(port, method, path, headers = {}, body = undefined) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: "127.0.0.1", port, method, path, headers, agent: false }, resolve);
    request.on("error", reject).end(body);
  });
}

export async function readText(response) {
  let text = "";
  for await (const chunk of response) text += chunk;
  return text;
}

// Posts a scene file. Resolves to the scene's id.
export async function postScene(port, path) {
  const json = { "Content-Type": "application/json" };
  const response = await send(port, "POST", "/v1/scenes", json, readFileSync(path));
  const text = await readText(response);
  if (response.statusCode >= 300) throw new Error(`POST /v1/scenes: ${response.statusCode} ${text}`);
  return JSON.parse(text).id;
}

// Parser of a stream of [length of the header, 4 bytes][header][PNG]. Calls `onFrame` with each header once
// its image has arrived. Stores no images.
export class FrameReader {
  #begun = Buffer.alloc(0); // start of an incomplete header
  #header = null;
  #missingBytes = 0; // missing bytes of the current PNG

  constructor(onFrame) {
    this.onFrame = onFrame;
  }

  add(chunk) {
    while (chunk.length > 0) {
      if (this.#missingBytes > 0) {
        const taken = Math.min(this.#missingBytes, chunk.length);
        this.#missingBytes -= taken;
        chunk = chunk.subarray(taken);
        if (this.#missingBytes === 0) this.onFrame(this.#header);
        continue;
      }
      chunk = this.#begun.length > 0 ? Buffer.concat([this.#begun, chunk]) : chunk;
      const headerEnd = chunk.length < 4 ? Infinity : 4 + chunk.readUInt32BE(0);
      if (chunk.length < headerEnd) {
        this.#begun = chunk;
        return;
      }
      this.#header = JSON.parse(chunk.toString("utf8", 4, headerEnd));
      this.#missingBytes = this.#header.bytes;
      this.#begun = Buffer.alloc(0);
      chunk = chunk.subarray(headerEnd);
    }
  }
}
