// Request rates for a cached image, answered by 304 or with the body, relative to a static file.

import { spawnSync } from "node:child_process";
import { Client, headerOf } from "./client.mjs";
import { closedLoop, pause, row, withService } from "./support.mjs";
import { existsProgram } from "../command.mjs";

const CONNECTIONS = 8;
const NOT_MODIFIED = 5000; // requests per second
const WHOLE = 1500; // requests per second

// Measures with wrk. Uses one thread, because wrk shares the cores with the service.
function byWrk(port, path, headers, seconds) {
  const words = ["-t1", `-c${CONNECTIONS}`, `-d${Math.ceil(seconds)}s`];
  for (const [name, value] of Object.entries(headers)) words.push("-H", `${name}: ${value}`);
  const done = spawnSync("wrk", [...words, `http://127.0.0.1:${port}${path}`], { encoding: "utf8" });
  const rate = /Requests\/sec: +([\d.]+)/.exec(done.stdout);
  if (!rate) throw new Error(`wrk: ${done.stdout}${done.stderr}`);
  const bad = /Non-2xx or 3xx responses: (\d+)|Socket errors: (.*)/.exec(done.stdout);
  return { rate: Number(rate[1]), bad: bad?.[0] ?? "" };
}

async function byClients(port, path, headers, seconds) {
  let count = 0,
    bad = 0;
  const load = closedLoop(
    port,
    CONNECTIONS,
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
  return { rate: count / seconds, bad: bad > 0 ? `${bad} responses other than 200 and 304` : "" };
}

async function run({ seconds }) {
  const hasWrk = existsProgram("wrk");
  const rateOf = hasWrk ? byWrk : byClients;
  return withService(async (service, scenes) => {
    const picture = `${scenes.paper}/frame.png?width=64&height=64`;
    const client = new Client(service.port);
    const first = await client.ask(picture);
    client.leave();
    const etag = headerOf(first, "ETag");
    const measure = (path, headers) => rateOf(service.port, path, headers, seconds / 4);
    const icon = await measure("/favicon.svg", {});
    const limits = await measure("/v1/limits", {});
    const notModified = await measure(picture, { "If-None-Match": etag });
    const whole = await measure(picture, {});
    const shown = ({ rate, bad }) => `${Math.round(rate)}/s${bad ? ` (${bad})` : ""}`;
    const relative = (one) => `${shown(one)}, ${(one.rate / icon.rate).toFixed(2)} x the rate of /favicon.svg`;
    return {
      rows: [
        row(
          "cached 64x64 image, 304 for If-None-Match",
          `>= ${NOT_MODIFIED}/s`,
          relative(notModified),
          notModified.rate >= NOT_MODIFIED,
        ),
        row(
          `cached 64x64 image, 200 with ${first.total - first.bodyAt} bytes`,
          `>= ${WHOLE}/s`,
          relative(whole),
          whole.rate >= WHOLE,
        ),
        row("/favicon.svg", "", shown(icon), null),
        row("/v1/limits", "", relative(limits), null),
      ],
      remark: `${CONNECTIONS} connections of ${hasWrk ? "wrk" : "the JavaScript client"}`,
    };
  });
}

export const CACHED = {
  name: "cached",
  what: "requests per second for a cached image",
  seconds: 40,
  run,
};
