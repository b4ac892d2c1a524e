#!/usr/bin/env node
// Refinement of the picture at rest: passes, progress and cancellation by input. Jobs are simulated.

import assert from "node:assert/strict";
import { after } from "node:test";
import {
  canvas_digest,
  drag,
  eventually,
  hold_refinement,
  page_tests,
  rest,
  start_both,
} from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

const kFull = 879; // width of the stage in these tests, in pixels
const is_frame = (url) => url.pathname.endsWith("/frame.png");
const is_refinement = (url) => url.pathname.endsWith("/refinement");
const samples_of = (url) => Number(url.searchParams.get("samples"));

// Passes pictures on as if a full-size sample took `ms`. Returns the list of samples of full-size requests.
async function watch(page, ms = 1) {
  const asked = [];
  await page.route(is_frame, async (route) => {
    const url = new URL(route.request().url());
    const width = Number(url.searchParams.get("width"));
    if (width > kFull / 2 + 1) asked.push(samples_of(url));
    const response = await route.fetch();
    const dur = ms * samples_of(url) * (width / kFull) ** 2;
    const headers = { ...response.headers(), "server-timing": `render;dur=${dur}`, "cache-control": "no-store" };
    await route.fulfill({ response, headers });
  });
  return asked;
}

// Splits a refinement stream into frames {header, png}.
function frames_of(body) {
  const frames = [];
  for (let at = 0; at < body.length;) {
    const png = at + 4 + body.readUInt32BE(at);
    const header = JSON.parse(body.subarray(at + 4, png));
    frames.push({ header, png: body.subarray(png, png + header.bytes) });
    at = png + header.bytes;
  }
  return frames;
}
function body_of(frames) {
  return Buffer.concat(
    frames.flatMap(({ header, png }) => {
      const text = Buffer.from(JSON.stringify(header));
      const length = Buffer.alloc(4);
      length.writeUInt32BE(text.length);
      return [length, text, png];
    }),
  );
}

// Passes refinements on through `change(frames)`. Returns the list of requests as {samples, passes}.
async function watch_refinements(page, change = (frames) => frames) {
  const asked = [];
  await page.route(is_refinement, async (route) => {
    const response = await route.fetch();
    const frames = frames_of(await response.body());
    asked.push({
      samples: samples_of(new URL(route.request().url())),
      passes: frames.map(({ header }) => header.samples),
    });
    await route.fulfill({ response, body: body_of(change(frames)) });
  });
  return asked;
}

const look_elsewhere = (page) => page.locator('[data-do="left"]').click();
const still = { reducedMotion: "reduce" };
const progress_texts = (page) =>
  page.evaluateHandle(() => {
    const bar = document.getElementById("busy");
    const texts = [];
    new MutationObserver(() => texts.push(bar.ariaValueText)).observe(bar, { attributes: true });
    return texts;
  });

page_test(
  "at rest the picture gets finer up to 64 samples, or to the number chosen, by one stream",
  "playing=0&samples=1",
  async (page) => {
    const coarse = await rest(page);
    const asked = await watch(page);
    const refined = await watch_refinements(page);
    const told = await progress_texts(page);
    await page.locator("#samples").selectOption("0");
    await eventually("64 samples", async () => refined.length === 1);
    assert.notEqual(await rest(page), coarse);
    assert.deepEqual(refined, [{ samples: 64, passes: [2, 4, 8, 16, 32, 64] }]);
    assert.match(await page.locator("#hud-rmse").textContent(), /^0\.\d+, 64 samples$/);
    const error_of = (text) => /^\d+ of 64 samples · error ([\d.e-]+)/.exec(text)?.[1];
    const errors = (await told.jsonValue()).map(error_of).filter(Boolean);
    assert.ok(errors.length >= 5, errors.join());
    assert.ok(Number(errors.at(-1)) < Number(errors[0]) / 4, `the error falls: ${errors}`);
    await page.locator("#samples").selectOption("16");
    await eventually("16 samples", async () => refined.length === 2);
    await rest(page);
    assert.deepEqual(refined[1], { samples: 16, passes: [16] }, "the service has kept that pass");
    await page.route(is_frame, (route) => route.fulfill({ status: 429, json: { title: "Too many requests" } }));
    await look_elsewhere(page);
    await eventually("another view", async () => refined.length === 3);
    await rest(page);
    assert.deepEqual(refined[2], { samples: 16, passes: [2, 4, 8, 16] });
    assert.deepEqual(asked, [], "nothing is rendered beside the stream");
  },
  { ...still, expected: /status of 429/ },
);

page_test(
  "finer pictures that would take too long are left out, unless they were asked for",
  "playing=0&samples=1&az=50",
  async (page) => {
    await rest(page);
    const slowly = (frames) =>
      frames.map(({ header, png }, at) => {
        const traced = header.samples - (frames[at - 1]?.header.samples ?? 0);
        return { header: { ...header, render_ms: 400 * traced }, png };
      });
    const refined = await watch_refinements(page, slowly);
    await page.locator("#samples").selectOption("0");
    await eventually("a refinement", async () => refined.length === 1);
    await rest(page);
    assert.match(await page.locator("#hud-rmse").textContent(), /, 32 samples$/, "64 samples would take 25.6 s");
    await page.locator("#samples").selectOption("64");
    await eventually("64 samples", async () =>
      / 64 samples$/.test(await page.locator("#hud-rmse").textContent()),
    );
  },
  still,
);

page_test(
  "an input stops what is being refined, and an estimate calls itself one",
  "playing=0&samples=1&az=60",
  async (page) => {
    await rest(page);
    await watch_refinements(page, (frames) =>
      frames.map(({ header, png }) => ({ header: { ...header, render_ms: 100 * header.samples }, png })),
    );
    await hold_refinement(page, 16);
    await page.locator("#samples").selectOption("64");
    const bar = page.getByRole("progressbar");
    await eventually("an estimate", async () =>
      /^16 of 64 samples · error 0\.\d+ · about \d+ s left$/.test((await bar.getAttribute("aria-valuetext")) ?? ""),
    );
    assert.equal(await bar.getAttribute("aria-valuenow"), null, "nothing was measured");
    assert.equal(await page.locator("#progress").textContent(), await bar.getAttribute("aria-valuetext"));
    const stopped = await page.evaluate(() => {
      document.getElementById("stage").dispatchEvent(new WheelEvent("wheel", { deltaY: 100, cancelable: true }));
      return window.signals.at(-1).aborted;
    });
    assert.equal(stopped, true, "at once, not only when the view rests again");
  },
  still,
);

page_test("figures of the error move nothing", "playing=0&samples=1", async (page) => {
  await rest(page);
  const box = () => page.locator("#stage").boundingBox();
  for (const width of [1280, 1000, 900, 700, 390]) {
    await page.setViewportSize({ width, height: 800 });
    await page.locator("#samples").selectOption("1");
    await rest(page);
    const before = await box();
    await page.locator("#samples").selectOption("4");
    await eventually("an error", async () => /samples/.test(await page.locator("#hud-rmse").textContent()));
    await rest(page);
    assert.deepEqual(await box(), before, `${width} pixels`);
  }
});

// Rejects refinements as if they exceeded the limit of a request.
const refuse_refinements = (page) =>
  page.route(is_refinement, (route) => route.fulfill({ status: 422, json: { title: "Too much", detail: "request_rays" } }));

// Simulates the service's jobs: sends `events`, and records `posted` and `deleted` jobs.
async function play_jobs(page) {
  const jobs = { posted: [], deleted: [], events: [] };
  const at = (state) => ({ id: "j1", frames: 1, frames_done: 0, tiles: 200, elapsed_s: 2, ...state });
  await page.route("**/v1/jobs", (route) => {
    jobs.posted.push(route.request().postDataJSON());
    const headers = { Location: "/v1/jobs/j1" };
    return route.fulfill({ status: 202, headers, json: at({ state: "waiting", tiles_done: 0 }) });
  });
  await page.route("**/v1/jobs/j1", (route) => {
    jobs.deleted.push(route.request().method());
    return route.fulfill({ status: 204 });
  });
  // All events come in one body. The page must read them in turn, and reject a body that lacks the last one.
  await page.route("**/v1/jobs/j1/events", (route) => {
    const lines = jobs.events.map(([name, state], id) => `id: ${id}\nevent: ${name}\ndata: ${JSON.stringify(at(state))}\n\n`);
    return route.fulfill({ contentType: "text/event-stream", body: `: hello\n\n${lines.join("")}` });
  });
  return jobs;
}

page_test(
  "what is too much for a stream is a job, which says how far it is",
  "playing=0&samples=1&az=30",
  async (page) => {
    const coarse = await rest(page);
    await watch(page, 400);
    await refuse_refinements(page);
    const jobs = await play_jobs(page);
    jobs.events = [
      ["progress", { state: "running", tiles_done: 50, remaining_s: 40 }],
      ["progress", { state: "running", tiles_done: 86, remaining_s: 2.2 }],
      ["frame", { state: "running", tiles_done: 200, frames_done: 1 }],
      ["done", { state: "done", tiles_done: 200, frames_done: 1, remaining_s: 0 }],
    ];
    // Records the values and texts of the progress bar.
    const told = await page.evaluateHandle(() => {
      const bar = document.getElementById("busy");
      const texts = [];
      new MutationObserver(() => texts.push([bar.ariaValueNow, bar.ariaValueText])).observe(bar, { attributes: true });
      return texts;
    });
    await page.route("**/v1/jobs/j1/frames/0.png", async (route) => {
      const { scene_id, image } = jobs.posted.at(-1);
      const query = `azimuth=7&width=${image.width}&height=${image.height}`;
      const response = await route.fetch({ url: `${daemon.url}v1/scenes/${scene_id}/frame.png?${query}` });
      return route.fulfill({ response });
    });
    await look_elsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("16");
    await eventually("a job", async () => jobs.posted.length === 1);
    assert.notEqual(await rest(page), coarse);
    const [{ camera, image, render }] = jobs.posted;
    assert.deepEqual(camera, { azimuth_degrees: 7.5, elevation_degrees: 0, distance: 1 });
    assert.ok(image.width > 600);
    assert.deepEqual(render, { samples: 16 });
    const texts = (await told.jsonValue()).map((pair) => pair.join(" "));
    assert.ok(texts.includes("25 1 of 16 samples · 25 % · 40 s left"), texts.join("\n"));
    assert.ok(texts.includes("43 1 of 16 samples · 43 % · 3 s left"), texts.join("\n"));
    assert.deepEqual(jobs.deleted, [], "a job that is done is not cancelled");
    assert.equal(await page.getByRole("progressbar").isVisible(), false);
  },
  { ...still, expected: /status of 422/ },
);

page_test(
  "an input cancels the job",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, 1000);
    await refuse_refinements(page);
    const jobs = await play_jobs(page);
    await page.route("**/v1/jobs/j1/events", () => {}); // never responds
    await look_elsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("4");
    await eventually("a job", async () => jobs.posted.length === 1);
    await drag(page, 40, 0);
    await eventually("its end", async () => jobs.deleted.length >= 1);
    assert.deepEqual(new Set(jobs.deleted), new Set(["DELETE"]));
  },
  { ...still, expected: /status of 422/ },
);

page_test(
  "a job that failed says why",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, 1000);
    await refuse_refinements(page);
    const jobs = await play_jobs(page);
    const error = { status: 500, title: "Out of luck", detail: "No light today.", request_id: "r77" };
    jobs.events = [["failed", { state: "failed", tiles_done: 3, error }]];
    await look_elsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("4");
    const card = page.locator("#stage-problem");
    await card.waitFor({ state: "visible" });
    for (const text of ["Out of luck", "No light today.", "r77"]) assert.ok((await card.textContent()).includes(text));
    assert.deepEqual(jobs.deleted, []);
  },
  { ...still, expected: /status of 422/ },
);

page_test("finer pictures take over little by little", "playing=0&samples=1", async (page) => {
  const coarse = await rest(page);
  const seen = await page.evaluateHandle(() => {
    const stage = document.getElementById("stage");
    const fading = [];
    new MutationObserver(() => fading.push(stage.hasAttribute("data-fading"))).observe(stage, { attributes: true });
    return fading;
  });
  await page.locator("#samples").selectOption("4");
  await eventually("the finer picture", async () => (await rest(page)) !== coarse);
  assert.ok((await seen.jsonValue()).includes(true));
  assert.equal(await canvas_digest(page), await rest(page), "it stays once it is there");
});
