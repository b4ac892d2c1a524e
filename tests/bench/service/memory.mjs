// Memory limit under attack, and latency of other clients.

import { createHash } from "node:crypto";
import net from "node:net";
import { kVictim, open_loop } from "./blockade.mjs";
import { Client } from "./client.mjs";
import { many_attributes_exr, put_asset, text_png, tiny_jpeg } from "./pictures.mjs";
import {
  Gauges,
  kLayers,
  memory_bound,
  mib,
  most,
  ms,
  new_picture,
  outcome,
  p99,
  pause,
  process_state,
  row,
  tally,
  with_service,
} from "./support.mjs";

const kPicture_ms = 1000;
const kAttackers = 16;
const kAddresses = 8;
const kSlow = 60; // connections that read or send slowly

const address = (i) => `127.0.0.${2 + (i % kAddresses)}`;
const pick = (list) => list[Math.floor(Math.random() * list.length)];
const json = (value) => ({ headers: { "Content-Type": "application/json" }, body: JSON.stringify(value) });

let number = 0;
function scene_of(objects, side = 64) {
  return {
    version: 1,
    title: `memory ${++number}`,
    camera: { type: "perspective", eye: [0, 0, 4], look_at: [0, 0, 0] },
    image: { width: side, height: side },
    materials: { m: { type: "rough" } },
    lights: [{ type: "directional", from: [1, 1, 1], intensity: [1, 1, 1] }],
    objects,
  };
}
const ball = () => [{ type: "sphere", center: [0, 0, 0], radius: 0.5 + Math.random(), material: "m" }];

// Returns an OBJ file of one polygon: one triangle per two bytes.
function polygon(corners) {
  const fan = " 3 2".repeat(500);
  return `v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2${fan.repeat(corners / 1000)}\n`;
}

// Returns an OBJ file of a sheet without duplicate vertices.
function sheet(side) {
  const lines = [];
  for (let y = 0; y <= side; ++y) for (let x = 0; x <= side; ++x) lines.push(`v ${x} ${y} ${(x * y) % 7}`);
  for (let y = 0; y < side; ++y)
    for (let x = 0; x < side; ++x) {
      const a = y * (side + 1) + x + 1;
      lines.push(`f ${a} ${a + 1} ${a + side + 2} ${a + side + 1}`);
    }
  return lines.join("\n") + "\n";
}

const kNested = `[${Array(330_000).fill("[[1]]").join(",")}]`;
const kLongName = "x".repeat(4_000_000);
const kNumbers = `[${Array(900_000).fill("1").join(",")}]`;

async function put(port, text) {
  const client = new Client(port);
  const id = createHash("sha256").update(text).digest("hex");
  const answer = await client.ask(`/v1/assets/${id}`, { method: "PUT", body: text });
  client.leave();
  if (answer.status >= 300) throw new Error(`the asset was answered ${outcome(answer)}: ${answer.text?.()}`);
  return id;
}

// Returns functions that make the next request of an attacker.
function requests(assets) {
  const render = (scene, options = {}, headers = {}) => {
    const request = json({ scene, render: options });
    return { path: "/v1/render", method: "POST", ...request, headers: { ...request.headers, ...headers } };
  };
  const mesh = (more = {}) => [{ type: "mesh", asset: pick(assets), material: "m", ...more }];
  const structures = ["list", "boxes", "bvh", "octree", "kd-sah", "grid", "obb-tree"];
  return [
    () => render(scene_of(mesh())),
    () => render(scene_of(mesh({ crease_degrees: 40 }))),
    () => render(scene_of(mesh()), { accelerator: pick(structures), precision: "double" }),
    () => render(scene_of(ball(), 4096)),
    () => render(scene_of(ball(), 4096), {}, { Accept: "image/x-exr" }),
    () => render(scene_of(ball(), 2900), { layers: ["depth", "normal"] }, { Accept: "image/x-exr" }),
    () => render(scene_of(ball(), 390), kLayers, { Accept: "image/x-exr" }),
    () => ({ path: "/v1/scenes", method: "POST", ...json(scene_of(mesh())) }),
    () => ({ path: "/v1/render", method: "POST", headers: { "Content-Type": "application/json" }, body: kNested }),
    () => ({ path: "/v1/render", method: "POST", headers: { "Content-Type": "application/json" }, body: kNumbers }),
    () => ({ path: "/v1/jobs", method: "POST", ...json({ scene: scene_of(mesh()), frames: 50 }) }),
    () => ({ path: "/v1/jobs", method: "POST", ...json({ scene: scene_of(ball(), 4096), frames: 50 }) }),
    () => ({ path: `/v1/assets/${pick(assets)}` }),
    () => ({ path: "/v1/shares", method: "POST", headers: { "Content-Type": "application/json" }, body: kNumbers }),
    () => ({ path: "/v1/scenes", method: "POST", ...json({ ...scene_of([]), materials: { m: { type: kLongName } } }) }),
    () => put_asset(tiny_jpeg(++number)),
    () => put_asset(text_png(++number)),
    () => put_asset(many_attributes_exr(++number, 40_000)),
  ];
}

async function attack(client, makers, statuses, goes_on) {
  while (goes_on()) {
    const { path, ...request } = pick(makers)();
    const answer = await client.ask(path, request);
    statuses.push(outcome(answer));
    if (answer.status !== 200) await pause(20);
  }
}

// Opens connections that read an asset or send a body, and then stall.
function slow_connections(port, asset) {
  return Array.from({ length: kSlow }, (_, i) => {
    const socket = net.connect({ host: "127.0.0.1", port, localAddress: address(i) });
    socket.on("error", () => {});
    if (i % 4 > 0) {
      socket.write(`GET /v1/assets/${asset} HTTP/1.1\r\nHost: x\r\n\r\n`);
      socket.pause();
    } else {
      socket.write(`PUT /v1/assets/${"a".repeat(64)} HTTP/1.1\r\nHost: x\r\nContent-Length: 60000000\r\n\r\n`);
      socket.write(Buffer.alloc(50_000_000, "x"));
    }
    return socket;
  });
}

async function run({ seconds }) {
  return with_service(async (service, { paper }) => {
    const assets = [await put(service.port, polygon(8_000_000)), await put(service.port, sheet(500))];
    const bound = await memory_bound(service.port);
    const gauges = new Gauges(service);
    const small = open_loop(service.port, () => new_picture(paper, 64, 1), kVictim);
    const statuses = [];
    let going = true;
    const clients = Array.from({ length: kAttackers }, (_, i) => new Client(service.port, address(i)));
    const attacks = clients.map((client) => attack(client, requests(assets), statuses, () => going));
    let slow = [];
    const resident = [];
    const end = performance.now() + 1000 * seconds;
    for (let i = 0; performance.now() < end; ++i, await pause(50)) {
      if (i % 200 === 0) {
        slow.forEach((socket) => socket.destroy());
        slow = slow_connections(service.port, assets[0]);
      }
      resident.push(process_state(service.pid).resident);
    }
    going = false;
    slow.forEach((socket) => socket.destroy());
    clients.forEach((client) => client.leave());
    await Promise.all(attacks);
    const pictures = await small();
    await gauges.until(({ running, waiting }) => running + waiting === 0);
    const bad = pictures.filter(({ status }) => status !== 200);
    const times = pictures.map((answer) => answer.ms ?? Infinity);
    return {
      rows: [
        row("memory, most", `<= ${mib(bound)}`, mib(most(resident)), most(resident) <= bound),
        row("small picture p99", `<= ${kPicture_ms} ms`, ms(p99(times)), p99(times) <= kPicture_ms),
        row("small pictures refused", "0", bad.length ? tally(bad.map(outcome)) : "0", bad.length === 0),
      ],
      remark: `${statuses.length} requests of attackers got ${tally(statuses)}`,
    };
  });
}

export const kMemory = {
  name: "memory",
  what: "memory, and small pictures, while others ask for all the memory they can",
  seconds: 60,
  run,
};
