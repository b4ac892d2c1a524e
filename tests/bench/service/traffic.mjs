// Client actions for mixed traffic. An action takes the Client to use and resolves to its responses.

import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import net from "node:net";
import { FLAKE, PAPER, newPicture, pause } from "./support.mjs";
import { FrameReader, send } from "../daemon.mjs";

const number = (below) => Math.floor(below * Math.random());
const json = { "Content-Type": "application/json" };

// Returns an action that stores a new scene and renders it. One in four scenes stays stored until eviction,
// the others are deleted.
function scenesComeAndGo() {
  const scene = JSON.parse(readFileSync(number(2) ? PAPER : FLAKE, "utf8"));
  return async (client) => {
    scene.title = `Scene ${Math.random()}`;
    const posted = await client.ask("/v1/scenes", {
      method: "POST",
      headers: json,
      body: JSON.stringify(scene),
    });
    if (posted.status !== 201) return [posted];
    const address = `/v1/scenes/${JSON.parse(posted.text()).id}`;
    const picture = await client.ask(newPicture(address, 64 + number(128), 1));
    const explained = await client.ask(`${address}/explain`);
    const rest = number(4) === 0 ? [] : [await client.ask(address, { method: "DELETE" })];
    return [posted, picture, explained, ...rest];
  };
}

function pictures(scenes) {
  return async (client) => {
    const address = number(2) ? scenes.paper : scenes.flake;
    const known = await client.ask(`${address}/frame.png?width=96&height=96&azimuth=${10 * number(36)}`);
    const fresh = await client.ask(newPicture(address, 32 + number(300), 1 + number(4)));
    const head = await client.ask(`${address}/frame.png?width=96&height=96`, { method: "HEAD" });
    const body = JSON.stringify({
      scene_id: address.slice("/v1/scenes/".length),
      image: { width: 80, height: 60 },
    });
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
    const reader = new FrameReader(() => ++frames);
    const until = performance.now() + number(2000);
    for await (const chunk of response) {
      if (binary) reader.add(chunk);
      if (performance.now() > until) break; // disconnects
    }
    return [{ status: response.statusCode }];
  };
}

const BAD = [
  ["/v1/scenes", { method: "POST", headers: json, body: '{"version": 1, "objects": [' }],
  ["/v1/scenes", { method: "POST", headers: json, body: '{"version": 1, "objects": [{"type": "ball"}], "rest": 1}' }],
  ["/v1/scenes/0000", {}],
  ["/v1/nothing/here?x=1", {}],
  ["/v1/scenes", { method: "PATCH" }],
  ["/v1/render", { method: "POST", headers: { ...json, "Content-Encoding": "gzip" }, body: "{}" }],
  [`/${"x".repeat(4000)}`, {}],
  ["/healthz", { headers: { "X-Long": "y".repeat(20_000) } }],
];

function badRequests(scenes, port) {
  return async (client) => {
    const [path, request] = BAD[number(BAD.length)];
    const nonsense = net.connect(port, "127.0.0.1", () => nonsense.end("GET\0 / HTTP/9\r\nfoo\r\n\r\n"));
    await new Promise((resolve) => nonsense.on("error", resolve).on("close", resolve).resume());
    return [await client.ask(path, request), await client.ask(`${scenes.paper}/frame.png?widht=9`)];
  };
}

function assets() {
  return async (client) => {
    const size = 1 + number(4) / 7 + Math.random();
    const body = `v 0 0 0\nv ${size} 0 0\nv 0 ${size} 0\nf 1 2 3\n`;
    const sha = createHash("sha256").update(body).digest("hex");
    const path = `/v1/assets/${sha}`;
    return [await client.ask(path, { method: "PUT", body }), await client.ask(path), await client.ask("/favicon.svg")];
  };
}

function leaving(scenes) {
  return async (client) => {
    const answer = client.ask(newPicture(scenes.flake, 400, 16));
    await pause(number(200));
    client.leave();
    await answer;
    return [];
  };
}

// Returns the actions, one per client.
export function actsOn(scenes, port) {
  const watching = Array.from({ length: 3 }, () => orbits(scenes, port));
  const drawing = [pictures(scenes), pictures(scenes), leaving(scenes)];
  return [scenesComeAndGo(), scenesComeAndGo(), ...drawing, ...watching, assets(), badRequests(scenes, port)];
}
