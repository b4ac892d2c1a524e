// Rolling restarts behind a balancer (HAProxy) without retries. Two services are stopped by SIGTERM and
// started again in turn, while clients request pictures through the balancer.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { exists_program } from "../command.mjs";
import { start_service } from "../daemon.mjs";
import { Client } from "./client.mjs";
import { free_port } from "./free_port.mjs";
import { kPaper, none_row, outcome, p99, pause, row, ms } from "./support.mjs";

const kClients = 16;
const kAnswers = 30_000;
const kDrain_s = 1; // drain delay of the service; the balancer checks every 100 ms
const kEvery = 20; // one in kEvery pictures is new, the others are cached

const backend = ({ port, health_port }, i) =>
  `  server s${i} 127.0.0.1:${port} check port ${health_port} inter 100 fall 1 rise 1`;

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

async function start_balancer(port, services) {
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

async function until_ready(health_port) {
  const client = new Client(health_port);
  for (let i = 0; i < 1000; ++i) {
    const answer = await client.ask("/readyz");
    if (answer.status === 200) return client.leave();
    await pause(20);
  }
  throw new Error("the service does not get ready");
}

// Sends requests in a loop until stop(). Each request has the scene in its body, as the services share no
// scenes.
function load(port, answers) {
  const scene = JSON.parse(readFileSync(kPaper));
  const json = { "Content-Type": "application/json" };
  let going = true;
  let asked = 0;
  const run = async (client) => {
    while (going) {
      const seed = ++asked % kEvery === 0 ? asked : 0;
      const body = JSON.stringify({ scene, image: { width: 32, height: 32 }, render: { seed } });
      answers.push(await client.ask("/v1/render", { method: "POST", headers: json, body }));
    }
    client.leave();
  };
  const all = Promise.all(Array.from({ length: kClients }, () => run(new Client(port))));
  return {
    stop: async () => {
      going = false;
      await all;
    },
  };
}

async function run({ times }) {
  if (!exists_program("haproxy")) throw new Error("haproxy is not installed: script/setup --bench");
  const port = await free_port();
  const words = ["--drain-delay-seconds", kDrain_s, "--trusted-proxies", "127.0.0.1"];
  const services = [await start_service(words), await start_service(words)];
  for (const service of services) await until_ready(service.health_port);
  const balancer = await start_balancer(port, services);
  const answers = [];
  const exits = [];
  try {
    await pause(500);
    const clients = load(port, answers);
    for (let i = 0; i < times; ++i) {
      const service = services[i % 2];
      service.signal();
      exits.push(await service.gone);
      services[i % 2] = await start_service(words, service);
      await until_ready(service.health_port);
      await pause(300); // time for the balancer to notice, else both would be down
    }
    while (answers.length < kAnswers) await pause(20);
    await clients.stop();
  } finally {
    await balancer.stop();
    for (const service of services) await service.stop();
  }
  const bad = answers.filter((answer) => outcome(answer) !== 200);
  const clean = exits.filter((code) => code === 0).length;
  return {
    rows: [
      row(
        `asked while ${times} services were started again`,
        `>= ${kAnswers}`,
        answers.length,
        answers.length >= kAnswers,
      ),
      none_row("not answered by a picture", bad),
      row("services that ended with 0", `${times}`, clean, clean === times),
    ],
    remark: `p99 ${ms(p99(answers.filter((a) => a.ms).map((a) => a.ms)))}, through HAProxy without retries`,
  };
}

export const kRestarts = {
  name: "restarts",
  what: `rolling restarts behind HAProxy, ${kClients} clients`,
  times: 20,
  run,
};
