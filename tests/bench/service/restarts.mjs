// Rolling restarts behind a balancer (HAProxy) without retries. Two services are restarted alternately by
// SIGTERM, while clients request images through the balancer.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { existsProgram } from "../command.mjs";
import { startService } from "../daemon.mjs";
import { Client } from "./client.mjs";
import { freePort } from "./free_port.mjs";
import { PAPER, noneRow, outcome, p99, pause, row, ms } from "./support.mjs";

const CLIENTS = 16;
const ANSWERS = 30_000;
const DRAIN_S = 1; // drain delay of the service, longer than the balancer's check interval of 100 ms
const EVERY = 20; // one in EVERY images is new, the others are cached

const backend = ({ port, healthPort }, i) =>
  `  server s${i} 127.0.0.1:${port} check port ${healthPort} inter 100 fall 1 rise 1`;

const configuration = (port, services) => `
defaults
  mode http
  retries 0
  timeout connect 2s
  timeout client 60s
  timeout server 60s
  option forwardfor
listen orrery
  bind 127.0.0.1:${port}
  balance roundrobin
  option httpchk GET /readyz
  http-check expect status 200
${services.map(backend).join("\n")}
`;

async function startBalancer(port, services) {
  const folder = mkdtempSync(join(tmpdir(), "orrery-balancer-"));
  const file = join(folder, "haproxy.cfg");
  writeFileSync(file, configuration(port, services));
  const child = spawn("haproxy", ["-f", file, "-q"], { stdio: "ignore" });
  const gone = new Promise((resolve) => child.once("close", resolve));
  const stop = async () => {
    child.kill("SIGKILL");
    await gone;
    rmSync(folder, { recursive: true });
  };
  return { stop };
}

async function untilReady(healthPort) {
  const client = new Client(healthPort);
  for (let i = 0; i < 1000; ++i) {
    const answer = await client.ask("/readyz");
    if (answer.status === 200) return client.leave();
    await pause(20);
  }
  throw new Error("service: not ready after 20 s");
}

// Sends requests in a loop until stop(). Requests contain the scene, because the services do not share stored
// scenes.
function load(port, answers) {
  const scene = JSON.parse(readFileSync(PAPER));
  const json = { "Content-Type": "application/json" };
  let going = true;
  let asked = 0;
  const run = async (client) => {
    while (going) {
      const seed = ++asked % EVERY === 0 ? asked : 0;
      const body = JSON.stringify({ scene, image: { width: 32, height: 32 }, render: { seed } });
      answers.push(await client.ask("/v1/render", { method: "POST", headers: json, body }));
    }
    client.leave();
  };
  const all = Promise.all(Array.from({ length: CLIENTS }, () => run(new Client(port))));
  return {
    stop: async () => {
      going = false;
      await all;
    },
  };
}

async function run({ times }) {
  if (!existsProgram("haproxy")) throw new Error("haproxy is not installed; run script/setup --bench");
  const port = await freePort();
  const words = ["--drain-delay-seconds", DRAIN_S, "--trusted-proxies", "127.0.0.1"];
  const services = [await startService(words), await startService(words)];
  for (const service of services) await untilReady(service.healthPort);
  const balancer = await startBalancer(port, services);
  const answers = [];
  const exits = [];
  try {
    await pause(500);
    const clients = load(port, answers);
    for (let i = 0; i < times; ++i) {
      const service = services[i % 2];
      service.signal();
      exits.push(await service.gone);
      services[i % 2] = await startService(words, service);
      await untilReady(service.healthPort);
      await pause(300); // lets the balancer notice, otherwise both services would be down
    }
    while (answers.length < ANSWERS) await pause(20);
    await clients.stop();
  } finally {
    await balancer.stop();
    for (const service of services) await service.stop();
  }
  const bad = answers.filter((answer) => outcome(answer) !== 200);
  const clean = exits.filter((code) => code === 0).length;
  return {
    rows: [
      row(`requests during ${times} restarts`, `>= ${ANSWERS}`, answers.length, answers.length >= ANSWERS),
      noneRow("requests not answered with 200", bad),
      row("restarts with exit status 0", `${times}`, clean, clean === times),
    ],
    remark: `p99 ${ms(p99(answers.filter((a) => a.ms).map((a) => a.ms)))}, through HAProxy without retries`,
  };
}

export const RESTARTS = {
  name: "restarts",
  what: `rolling restarts behind HAProxy, ${CLIENTS} clients`,
  times: 20,
  run,
};
