// Attack worker: a separate thread, so that attackers' responses do not delay other clients' responses.
// Worker data: {port, name, count, addresses}. Attacks until a message arrives, then posts the outcomes of
// all requests.

import { parentPort, workerData } from "node:worker_threads";
import { Client } from "./client.mjs";
import { ATTACKS } from "./attacks.mjs";
import { outcome, pause } from "./support.mjs";

const { port, name, count, addresses } = workerData;
let number = 0;
let going = true;

const JSON_HEADERS = { "Content-Type": "application/json" };

// Runs one client. After each response, sends a new request. Does not read streams.
async function attackOnce(client, [, ask, scene], statuses) {
  let id = null;
  if (scene) {
    const body = JSON.stringify(scene(++number));
    const answer = await client.ask("/v1/scenes", { method: "POST", headers: JSON_HEADERS, body });
    id = answer.status < 300 ? JSON.parse(answer.text()).id : "nosuch";
  }
  while (going) {
    const { path, ...request } = ask(++number, id);
    if ((request.body?.length ?? 0) > 65536)
      throw new Error(`attack ${name}: body must be at most 65536 bytes (got ${request.body.length})`);
    const answer = await client.ask(path, request);
    statuses.push(outcome(answer));
    if (answer.failure || path.includes("/orbit")) return;
    if (answer.status !== 200) await pause(20);
  }
}

const one = ATTACKS.find(([named]) => named === name);
const statuses = [];
const clients = Array.from({ length: count }, (_, i) => new Client(port, `127.0.0.${2 + (i % addresses)}`));
const all = Promise.all(clients.map((client) => attackOnce(client, one, statuses)));
parentPort.once("message", async () => {
  going = false;
  clients.forEach((client) => client.leave());
  await all;
  parentPort.postMessage(statuses);
});
