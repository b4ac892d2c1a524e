// A running service.

import { spawn } from "node:child_process";
import { kOrrery } from "./command.mjs";

// Starts a service on a free port, with more words of the command line; resolves to {port, pid, stop()}.
export async function start_service(words) {
  const child = spawn(kOrrery, ["serve", "--port", "0", "--health-port", "0", "--quiet", ...words], {
    stdio: ["ignore", "pipe", "ignore"],
  });
  const gone = new Promise((resolve) => child.once("close", resolve));
  const port = await new Promise((resolve, reject) => {
    let output = "";
    child.stdout.on("data", (bytes) => {
      output += bytes;
      const match = /http:\/\/\S+:(\d+)/.exec(output);
      if (match) resolve(Number(match[1]));
    });
    child.once("error", reject);
    child.once("close", (code) => reject(new Error(`orrery serve ended with ${code}`)));
  });
  const stop = async () => {
    child.kill("SIGTERM");
    await gone;
  };
  return { port, pid: child.pid, stop };
}
