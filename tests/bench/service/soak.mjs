// Mixed traffic for long: memory, threads and descriptors stay where they are.

import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import net from "node:net";
import { Client } from "./client.mjs";
import { kFlake, kPaper, mean, mib, new_picture, pause, percent, process_state, row, sparkline, tally, with_service } from "./support.mjs";
import { FrameReader, send } from "../daemon.mjs";

const kSample_s = 10, kSamples = 30; // every 10 s, oftener in a short run
const kMemory = 1.05, kFew = 3;
const kFile = "build/charts/soak.json"; // the figures behind the sparklines

const number = (below) => Math.floor(below * Math.random());
const json = { "Content-Type": "application/json" };

// ---- what the clients do; each resolves to the statuses it got

// A scene that nobody posted before is kept, drawn, and removed, or left to be forgotten.
function scenes_come_and_go() {
  const scene = JSON.parse(readFileSync(number(2) ? kPaper : kFlake, "utf8"));
  return async (client) => {
    scene.title = `Scene ${Math.random()}`;
    const posted = await client.ask("/v1/scenes", { method: "POST", headers: json, body: JSON.stringify(scene) });
    if (posted.status !== 201) return [posted];
    const address = `/v1/scenes/${JSON.parse(posted.text()).id}`;
    const picture = await client.ask(new_picture(address, 64 + number(128), 1));
    const explained = await client.ask(`${address}/explain`);
    const rest = number(4) === 0 ? [] : [await client.ask(address, { method: "DELETE" })];
    return [posted, picture, explained, ...rest];
  };
}

function pictures(scenes) {
  return async (client) => {
    const address = number(2) ? scenes.paper : scenes.flake;
    const known = await client.ask(`${address}/frame.png?width=96&height=96&azimuth=${10 * number(36)}`);
    const fresh = await client.ask(new_picture(address, 32 + number(300), 1 + number(4)));
    const head = await client.ask(`${address}/frame.png?width=96&height=96`, { method: "HEAD" });
    const body = JSON.stringify({ scene_id: address.slice("/v1/scenes/".length), image: { width: 80, height: 60 } });
    const headers = { ...json, Accept: ["image/png", "image/jpeg", "image/x-exr"][number(3)] };
    return [known, fresh, head, await client.ask("/v1/render", { method: "POST", headers, body })];
  };
}

function orbits(scenes, port) {
  return async () => {
    let frames = 0;
    const path = `${scenes.paper}/orbit?fps=${5 + number(20)}&frames=60&width=120&height=120`;
    const response = await send(port, "GET", path, number(2) ? { Accept: "application/x-orrery-frames" } : {});
    const binary = response.headers["content-type"] === "application/x-orrery-frames";
    const reader = new FrameReader(() => ++frames), until = performance.now() + number(2000);
    for await (const chunk of response) {
      if (binary) reader.add(chunk);
      if (performance.now() > until) break; // which leaves
    }
    return [{ status: response.statusCode }];
  };
}

const kBad = [
  ["/v1/scenes", { method: "POST", headers: json, body: '{"version": 1, "objects": [' }],
  ["/v1/scenes", { method: "POST", headers: json, body: '{"version": 1, "objects": [{"type": "ball"}], "rest": 1}' }],
  ["/v1/scenes/0000", {}],
  ["/v1/nothing/here?x=1", {}],
  ["/v1/scenes", { method: "PATCH" }],
  ["/v1/render", { method: "POST", headers: { ...json, "Content-Encoding": "gzip" }, body: "{}" }],
  [`/${"x".repeat(4000)}`, {}],
  ["/healthz", { headers: { "X-Long": "y".repeat(20_000) } }],
];

function bad_requests(scenes, port) {
  return async (client) => {
    const [path, request] = kBad[number(kBad.length)];
    const nonsense = net.connect(port, "127.0.0.1", () => nonsense.end("GET\0 / HTTP/9\r\nfoo\r\n\r\n"));
    await new Promise((resolve) => nonsense.on("error", resolve).on("close", resolve).resume());
    return [await client.ask(path, request), await client.ask(`${scenes.paper}/frame.png?widht=9`)];
  };
}

function assets() {
  return async (client) => {
    const size = 1 + number(4) / 7 + Math.random();
    const body = `v 0 0 0\nv ${size} 0 0\nv 0 ${size} 0\nf 1 2 3\n`;
    const sha = createHash("sha256").update(body).digest("hex"), path = `/v1/assets/${sha}`;
    return [await client.ask(path, { method: "PUT", body }), await client.ask(path), await client.ask("/favicon.svg")];
  };
}

function leaving(scenes) {
  return async (client) => {
    const answer = client.ask(new_picture(scenes.flake, 400, 16));
    await pause(number(200));
    client.leave();
    await answer;
    return [];
  };
}

// ---- the run

// Does it again and again until the time is over, with rests: the machine is used, not overloaded.
async function keep_on(act, port, deadline, statuses) {
  const client = new Client(port);
  while (performance.now() < deadline) {
    for (const answer of await act(client)) statuses.push(answer.failure ?? answer.status);
    await pause(number(60));
  }
  client.leave();
}

const thirds = (values) => {
  const third = Math.floor(values.length / 3);
  return { middle: mean(values.slice(third, 2 * third)), last: mean(values.slice(2 * third)) };
};

async function sample(pid, deadline, seconds) {
  const samples = [], every_ms = 1000 * Math.min(kSample_s, seconds / kSamples);
  while (performance.now() < deadline) {
    samples.push({ at_s: process.uptime(), ...process_state(pid) });
    await pause(every_ms);
  }
  return samples;
}

function rows_of(samples, statuses) {
  const rows = ["resident", "threads", "descriptors"].map((key) => {
    const values = samples.map((s) => s[key]), { middle, last } = thirds(values), tell = key === "resident" ? mib : (v) => v.toFixed(1);
    const measured = `${tell(middle)} -> ${tell(last)} (${percent(last / middle - 1)})  ${sparkline(values)}`;
    if (key === "resident") return row("memory, last third beside the middle one", `<= ${percent(kMemory)}`, measured, last <= kMemory * middle);
    return row(`${key}, last third beside the middle one`, `<= ${kFew} more`, measured, last <= middle + kFew);
  });
  const wrong = statuses.filter((status) => typeof status === "string" || (status >= 500 && status !== 503));
  return [...rows, row(`${statuses.length} answers: 5xx other than 503, or none`, "0", wrong.length > 0 ? tally(wrong) : "0", wrong.length === 0)];
}

async function run({ seconds }) {
  return with_service(async (service, scenes) => {
    const acts = [scenes_come_and_go(), scenes_come_and_go(), pictures(scenes), pictures(scenes), assets(), leaving(scenes)];
    acts.push(bad_requests(scenes, service.port), ...Array.from({ length: 3 }, () => orbits(scenes, service.port)));
    const deadline = performance.now() + 1000 * seconds, statuses = [];
    const sampling = sample(service.pid, deadline, seconds);
    await Promise.all(acts.map((act) => keep_on(act, service.port, deadline, statuses)));
    const samples = await sampling;
    mkdirSync("build/charts", { recursive: true });
    writeFileSync(kFile, JSON.stringify(samples));
    return { rows: rows_of(samples, statuses), remark: `answers: ${tally(statuses)}; figures in ${kFile}` };
  });
}

export const kSoak = { name: "soak", what: "memory, threads and descriptors under mixed traffic", seconds: 1200, run };
