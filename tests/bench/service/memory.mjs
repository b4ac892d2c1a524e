// Resident memory under attacks that allocate as much as possible, and latency of another client.

import { createHash } from "node:crypto";
import net from "node:net";
import { VICTIM, openLoop } from "./blockade.mjs";
import { Client } from "./client.mjs";
import { manyAttributesExr, putAsset, textPng, tinyJpeg } from "./pictures.mjs";
import {
  Gauges,
  LAYERS,
  memoryBound,
  mib,
  most,
  ms,
  newPicture,
  outcome,
  p99,
  pause,
  processState,
  row,
  tally,
  withService,
} from "./support.mjs";

const PICTURE_MS = 1000;
const ATTACKERS = 16;
const ADDRESSES = 8;
const SLOW = 60; // number of stalled connections

const address = (i) => `127.0.0.${2 + (i % ADDRESSES)}`;
const pick = (list) => list[Math.floor(Math.random() * list.length)];
const json = (value) => ({ headers: { "Content-Type": "application/json" }, body: JSON.stringify(value) });

let number = 0;
function sceneOf(objects, side = 64) {
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

// Returns an OBJ file of a single polygon. Each two bytes of the file make one triangle.
function polygon(corners) {
  const fan = " 3 2".repeat(500);
  return `v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2${fan.repeat(corners / 1000)}\n`;
}

// Returns an OBJ file of a grid of side x side quads that share vertices.
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

const NESTED = `[${Array(330_000).fill("[[1]]").join(",")}]`;
const LONG_NAME = "x".repeat(4_000_000);
const NUMBERS = `[${Array(900_000).fill("1").join(",")}]`;

async function put(port, text) {
  const client = new Client(port);
  const id = createHash("sha256").update(text).digest("hex");
  const answer = await client.ask(`/v1/assets/${id}`, { method: "PUT", body: text });
  client.leave();
  if (answer.status >= 300) throw new Error(`PUT /v1/assets: ${outcome(answer)}: ${answer.text?.()}`);
  return id;
}

// Returns the attackers' request generators. `assets`: ids of stored meshes.
function requests(assets) {
  const render = (scene, options = {}, headers = {}) => {
    const request = json({ scene, render: options });
    return { path: "/v1/render", method: "POST", ...request, headers: { ...request.headers, ...headers } };
  };
  const mesh = (more = {}) => [{ type: "mesh", asset: pick(assets), material: "m", ...more }];
  const structures = ["list", "boxes", "bvh", "octree", "kd-sah", "grid", "obb-tree"];
  return [
    () => render(sceneOf(mesh())),
    () => render(sceneOf(mesh({ crease_degrees: 40 }))),
    () => render(sceneOf(mesh()), { accelerator: pick(structures), precision: "double" }),
    () => render(sceneOf(ball(), 4096)),
    () => render(sceneOf(ball(), 4096), {}, { Accept: "image/x-exr" }),
    () => render(sceneOf(ball(), 2900), { layers: ["depth", "normal"] }, { Accept: "image/x-exr" }),
    () => render(sceneOf(ball(), 390), LAYERS, { Accept: "image/x-exr" }),
    () => ({ path: "/v1/scenes", method: "POST", ...json(sceneOf(mesh())) }),
    () => ({ path: "/v1/render", method: "POST", headers: { "Content-Type": "application/json" }, body: NESTED }),
    () => ({ path: "/v1/render", method: "POST", headers: { "Content-Type": "application/json" }, body: NUMBERS }),
    () => ({ path: "/v1/jobs", method: "POST", ...json({ scene: sceneOf(mesh()), frames: 50 }) }),
    () => ({ path: "/v1/jobs", method: "POST", ...json({ scene: sceneOf(ball(), 4096), frames: 50 }) }),
    () => ({ path: `/v1/assets/${pick(assets)}` }),
    () => ({ path: "/v1/shares", method: "POST", headers: { "Content-Type": "application/json" }, body: NUMBERS }),
    () => ({ path: "/v1/scenes", method: "POST", ...json({ ...sceneOf([]), materials: { m: { type: LONG_NAME } } }) }),
    () => putAsset(tinyJpeg(++number)),
    () => putAsset(textPng(++number)),
    () => putAsset(manyAttributesExr(++number, 40_000)),
  ];
}

async function attack(client, makers, statuses, goesOn) {
  while (goesOn()) {
    const { path, ...request } = pick(makers)();
    const answer = await client.ask(path, request);
    statuses.push(outcome(answer));
    if (answer.status !== 200) await pause(20);
  }
}

// Opens SLOW connections. Three of four connections stall while receiving an asset, the others while sending
// a body.
function slowConnections(port, asset) {
  return Array.from({ length: SLOW }, (_, i) => {
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
  return withService(async (service, { paper }) => {
    const assets = [await put(service.port, polygon(8_000_000)), await put(service.port, sheet(500))];
    const bound = await memoryBound(service.port);
    const gauges = new Gauges(service);
    const small = openLoop(service.port, () => newPicture(paper, 64, 1), VICTIM);
    const statuses = [];
    let going = true;
    const clients = Array.from({ length: ATTACKERS }, (_, i) => new Client(service.port, address(i)));
    const attacks = clients.map((client) => attack(client, requests(assets), statuses, () => going));
    let slow = [];
    const resident = [];
    const end = performance.now() + 1000 * seconds;
    for (let i = 0; performance.now() < end; ++i, await pause(50)) {
      if (i % 200 === 0) {
        slow.forEach((socket) => socket.destroy());
        slow = slowConnections(service.port, assets[0]);
      }
      resident.push(processState(service.pid).resident);
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
        row("maximum resident memory", `<= ${mib(bound)}`, mib(most(resident)), most(resident) <= bound),
        row("p99 of small images", `<= ${PICTURE_MS} ms`, ms(p99(times)), p99(times) <= PICTURE_MS),
        row("small images not answered with 200", "0", bad.length ? tally(bad.map(outcome)) : "0", bad.length === 0),
      ],
      remark: `outcomes of the ${statuses.length} attack requests: ${tally(statuses)}`,
    };
  });
}

export const MEMORY = {
  name: "memory",
  what: "memory, and latency of small images, under attacks that allocate memory",
  seconds: 60,
  run,
};
