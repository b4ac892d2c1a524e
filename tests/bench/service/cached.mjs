// Request rate for one cached picture, as 304 and in full, compared with a static file.

import { spawnSync } from "node:child_process";
import { Client, header_of } from "./client.mjs";
import { closed_loop, pause, row, with_service } from "./support.mjs";
import { exists_program } from "../command.mjs";

const kConnections = 8;
const kNotModified = 5000;
const kWhole = 1500; // requests per second

// Runs wrk with one thread: the service shares the cores with it.
function by_wrk(port, path, headers, seconds) {
  const words = ["-t1", `-c${kConnections}`, `-d${Math.ceil(seconds)}s`];
  for (const [name, value] of Object.entries(headers)) words.push("-H", `${name}: ${value}`);
  const done = spawnSync("wrk", [...words, `http://127.0.0.1:${port}${path}`], { encoding: "utf8" });
  const rate = /Requests\/sec: +([\d.]+)/.exec(done.stdout);
  if (!rate) throw new Error(`wrk: ${done.stdout}${done.stderr}`);
  const bad = /Non-2xx or 3xx responses: (\d+)|Socket errors: (.*)/.exec(done.stdout);
  return { rate: Number(rate[1]), bad: bad?.[0] ?? "" };
}

async function by_clients(port, path, headers, seconds) {
  let count = 0,
    bad = 0;
  const load = closed_loop(
    port,
    kConnections,
    () => path,
    ({ status }) => {
      ++count;
      if (status !== 200 && status !== 304) ++bad;
    },
    0,
    { headers },
  );
  await pause(1000 * seconds);
  await load.stop();
  return { rate: count / seconds, bad: bad > 0 ? `${bad} other answers` : "" };
}

async function run({ seconds }) {
  const has_wrk = exists_program("wrk");
  const rate_of = has_wrk ? by_wrk : by_clients;
  return with_service(async (service, scenes) => {
    const picture = `${scenes.paper}/frame.png?width=64&height=64`;
    const client = new Client(service.port);
    const first = await client.ask(picture);
    client.leave();
    const etag = header_of(first, "ETag");
    const measure = (path, headers) => rate_of(service.port, path, headers, seconds / 4);
    const icon = await measure("/favicon.svg", {});
    const limits = await measure("/v1/limits", {});
    const not_modified = await measure(picture, { "If-None-Match": etag });
    const whole = await measure(picture, {});
    const told = ({ rate, bad }) => `${Math.round(rate)}/s${bad ? ` (${bad})` : ""}`;
    const relative = (one) => `${told(one)}, ${(one.rate / icon.rate).toFixed(2)} of the icon's`;
    return {
      rows: [
        row("304 to If-None-Match", `>= ${kNotModified}/s`, relative(not_modified), not_modified.rate >= kNotModified),
        row(
          `the same 64x64 picture, ${first.total - first.body_at} bytes`,
          `>= ${kWhole}/s`,
          relative(whole),
          whole.rate >= kWhole,
        ),
        row("/favicon.svg", "", told(icon), null),
        row("/v1/limits", "", relative(limits), null),
      ],
      remark: `${kConnections} connections of ${has_wrk ? "wrk" : "a client in JavaScript"}`,
    };
  });
}

export const kCached = {
  name: "cached",
  what: "requests a second for a picture that is known",
  seconds: 40,
  run,
};
