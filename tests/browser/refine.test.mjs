#!/usr/bin/env node
// The picture at rest: finer and finer, with its progress, stopped by the first touch. What a job would measure is
// played by the test.

import assert from "node:assert/strict";
import { after } from "node:test";
import {
  canvas_digest,
  drag,
  eventually,
  page_tests,
  rest,
  start_both,
} from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

const kFull = 879; // pixels, the width of the stage in these tests' window
const is_frame = (url) => url.pathname.endsWith("/frame.png");
const samples_of = (url) => url.searchParams.get("samples");

// Passes pictures on as if a full one had taken `ms(samples)`, and notes the samples that full ones are asked with.
async function watch(page, ms = () => 1) {
  const asked = [];
  await page.route(is_frame, async (route) => {
    const url = new URL(route.request().url());
    const width = Number(url.searchParams.get("width"));
    if (width > kFull / 2 + 1) asked.push(samples_of(url));
    const response = await route.fetch();
    const dur = ms(Number(samples_of(url))) * (width / kFull) ** 2;
    const headers = { ...response.headers(), "server-timing": `render;dur=${dur}`, "cache-control": "no-store" };
    await route.fulfill({ response, headers });
  });
  return asked;
}

const look_elsewhere = (page) => page.locator('[data-do="left"]').click();
const still = { reducedMotion: "reduce" };

page_test(
  "at rest the picture gets finer up to 64 samples, or to the number chosen",
  "playing=0&samples=1",
  async (page) => {
    const asked = await watch(page);
    await page.reload(); // so that the page has measured nothing but what the test plays
    const coarse = await rest(page);
    asked.length = 0;
    await page.locator("#samples").selectOption("0");
    await eventually("64 samples", async () => asked.includes("64"));
    assert.notEqual(await rest(page), coarse);
    assert.deepEqual(asked, ["4", "16", "64"], "what is there already is not asked for again");
    asked.length = 0;
    await page.locator("#samples").selectOption("16");
    await eventually("16 samples", async () => asked.includes("16"));
    await rest(page);
    assert.deepEqual(asked, ["1", "4", "16"]);
    asked.length = 0;
    await look_elsewhere(page);
    await eventually("16 samples", async () => asked.includes("16"));
    await rest(page);
    assert.deepEqual(asked, ["1", "4", "16"]);
  },
  still,
);

page_test(
  "finer pictures that would take too long are left out, unless they were asked for",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    let jobs = 0;
    await page.route("**/v1/jobs", (route) => ((jobs += 1), route.fulfill({ status: 404, body: "{}" })));
    const asked = await watch(page, (samples) => 400 * samples);
    await look_elsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("0");
    await eventually("16 samples", async () => asked.includes("16"));
    await rest(page);
    assert.deepEqual(asked, ["1", "4", "16"], "64 samples would take 25.6 s");
    assert.equal(jobs, 1, "a service without jobs is not asked again");
    await page.locator("#samples").selectOption("64");
    await eventually("64 samples", async () => asked.includes("64"));
  },
  { ...still, expected: /status of 404/ },
);

page_test(
  "an input stops what is being refined, and an estimate calls itself one",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await page.route("**/v1/jobs", (route) => route.fulfill({ status: 404, body: "{}" }));
    await watch(page, (samples) => 100 * samples);
    const hanging = [];
    await page.evaluate(() => {
      const real_fetch = window.fetch;
      window.signals = [];
      window.fetch = (path, options) => {
        if (options?.signal) window.signals.push(options.signal);
        return real_fetch(path, options);
      };
    });
    await page.route(
      (url) => is_frame(url) && samples_of(url) === "64",
      (route) => hanging.push(route.request()),
    );
    await look_elsewhere(page);
    await rest(page);
    const failed = page.waitForEvent("requestfailed", (request) => hanging.includes(request));
    await page.locator("#samples").selectOption("0");
    const bar = page.getByRole("progressbar");
    await eventually("an estimate", async () => {
      const text = hanging.length > 0 && (await bar.getAttribute("aria-valuetext"));
      return /^16 of 64 samples · about [1-9] s left$/.test(text);
    });
    assert.equal(await bar.getAttribute("aria-valuenow"), null, "nothing was measured");
    assert.equal(await page.locator("#progress").textContent(), await bar.getAttribute("aria-valuetext"));
    const stopped = await page.evaluate(() => {
      document.getElementById("stage").dispatchEvent(new WheelEvent("wheel", { deltaY: 100, cancelable: true }));
      return window.signals.at(-1).aborted;
    });
    assert.equal(stopped, true, "at once, not only when the view rests again");
    await failed;
    assert.equal(hanging.length, 1);
  },
  { ...still, expected: /status of 404/ },
);

// Plays the service's jobs. Each runs until `finish()`; `told` sends an event to it.
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
  // Events come as one body: the page is to read them in turn, and a body that ends without the last one as broken.
  await page.route("**/v1/jobs/j1/events", (route) => {
    const lines = jobs.events.map(([name, state], id) => `id: ${id}\nevent: ${name}\ndata: ${JSON.stringify(at(state))}\n\n`);
    return route.fulfill({ contentType: "text/event-stream", body: `: hello\n\n${lines.join("")}` });
  });
  return jobs;
}

page_test(
  "what takes long is a job, which says how far it is",
  "playing=0&samples=1&az=30",
  async (page) => {
    const coarse = await rest(page);
    await watch(page, (samples) => 100 * samples);
    const jobs = await play_jobs(page);
    jobs.events = [
      ["progress", { state: "running", tiles_done: 50, remaining_s: 40 }],
      ["progress", { state: "running", tiles_done: 86, remaining_s: 2.2 }],
      ["frame", { state: "running", tiles_done: 200, frames_done: 1 }],
      ["done", { state: "done", tiles_done: 200, frames_done: 1, remaining_s: 0 }],
    ];
    // The picture comes late, so that the bar can be looked at.
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
    assert.ok(texts.includes("25 4 of 16 samples · 25 % · 40 s left"), texts.join("\n"));
    assert.ok(texts.includes("43 4 of 16 samples · 43 % · 3 s left"), texts.join("\n"));
    assert.deepEqual(jobs.deleted, [], "a job that is done is not cancelled");
    assert.equal(await page.getByRole("progressbar").isVisible(), false);
  },
  still,
);

page_test(
  "an input cancels the job",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, (samples) => 400 * samples);
    const jobs = await play_jobs(page);
    await page.route("**/v1/jobs/j1/events", () => {}); // never answers
    await look_elsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("4");
    await eventually("a job", async () => jobs.posted.length === 1);
    await drag(page, 40, 0);
    await eventually("its end", async () => jobs.deleted.length >= 1);
    assert.deepEqual(new Set(jobs.deleted), new Set(["DELETE"]));
  },
  still,
);

page_test(
  "a job that failed says why",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, (samples) => 400 * samples);
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
  still,
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
