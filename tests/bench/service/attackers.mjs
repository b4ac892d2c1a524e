// Attack worker, in its own thread so that its responses delay no other client's. Its data is {port, name,
// count, addresses}. Attacks until a message arrives, then posts the outcomes of its requests.

import { parentPort, workerData } from "node:worker_threads";
import { Client } from "./client.mjs";
import { kAttacks } from "./attacks.mjs";
import { outcome, pause } from "./support.mjs";

const { port, name, count, addresses } = workerData;
let number = 0;
let going = true;

const kJson = { "Content-Type": "application/json" };

// Runs one client, which sends a new request after each response and reads no streams.
async function attack_once(client, [, ask, scene], statuses) {
  let id = null;
  if (scene) {
    const body = JSON.stringify(scene(++number));
    const answer = await client.ask("/v1/scenes", { method: "POST", headers: kJson, body });
    id = answer.status < 300 ? JSON.parse(answer.text()).id : "nosuch";
  }
  while (going) {
    const { path, ...request } = ask(++number, id);
    if ((request.body?.length ?? 0) > 65536) throw new Error(`the attack has ${request.body.length} bytes`);
    const answer = await client.ask(path, request);
    statuses.push(outcome(answer));
    if (answer.failure || path.includes("/orbit")) return;
    if (answer.status !== 200) await pause(20);
  }
}

const one = kAttacks.find(([named]) => named === name);
const statuses = [];
const clients = Array.from({ length: count }, (_, i) => new Client(port, `127.0.0.${2 + (i % addresses)}`));
const all = Promise.all(clients.map((client) => attack_once(client, one, statuses)));
parentPort.once("message", async () => {
  going = false;
  clients.forEach((client) => client.leave());
  await all;
  parentPort.postMessage(statuses);
});
