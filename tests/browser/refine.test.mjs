#!/usr/bin/env node
// Tests refinement of the still image: passes, progress and cancellation by input. Jobs are simulated.

import assert from "node:assert/strict";
import { after } from "node:test";
import { canvasDigest, drag, eventually, holdRefinement, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const FULL = 879; // width of the stage in these tests, in pixels
const isFrame = (url) => url.pathname.endsWith("/frame.png");
const isRefinement = (url) => url.pathname.endsWith("/refinement");
const samplesOf = (url) => Number(url.searchParams.get("samples"));

// Forwards images and reports a render time of `ms` milliseconds per sample in full size. Returns a list to
// which the sample count of each full-size request is appended.
async function watch(page, ms = 1) {
  const requested = [];
  await page.route(isFrame, async (route) => {
    const url = new URL(route.request().url());
    const width = Number(url.searchParams.get("width"));
    if (width > FULL / 2 + 1) requested.push(samplesOf(url));
    const response = await route.fetch();
    const dur = ms * samplesOf(url) * (width / FULL) ** 2;
    const headers = { ...response.headers(), "server-timing": `render;dur=${dur}`, "cache-control": "no-store" };
    await route.fulfill({ response, headers });
  });
  return requested;
}

// Splits a refinement stream into frames {header, png}.
function framesOf(body) {
  const frames = [];
  for (let at = 0; at < body.length;) {
    const png = at + 4 + body.readUInt32BE(at);
    const header = JSON.parse(body.subarray(at + 4, png));
    frames.push({ header, png: body.subarray(png, png + header.bytes) });
    at = png + header.bytes;
  }
  return frames;
}
function bodyOf(frames) {
  return Buffer.concat(
    frames.flatMap(({ header, png }) => {
      const text = Buffer.from(JSON.stringify(header));
      const length = Buffer.alloc(4);
      length.writeUInt32BE(text.length);
      return [length, text, png];
    }),
  );
}

// Forwards refinements with their frames replaced by change(frames). Returns a list to which each request is
// appended as {samples, passes}.
async function watchRefinements(page, change = (frames) => frames) {
  const requested = [];
  await page.route(isRefinement, async (route) => {
    const response = await route.fetch();
    const frames = framesOf(await response.body());
    requested.push({
      samples: samplesOf(new URL(route.request().url())),
      passes: frames.map(({ header }) => header.samples),
    });
    await route.fulfill({ response, body: bodyOf(change(frames)) });
  });
  return requested;
}

const lookElsewhere = (page) => page.locator('[data-do="left"]').click();
const still = { reducedMotion: "reduce" };
const progressTexts = (page) =>
  page.evaluateHandle(() => {
    const bar = document.getElementById("busy");
    const texts = [];
    new MutationObserver(() => texts.push(bar.ariaValueText)).observe(bar, { attributes: true });
    return texts;
  });

pageTest(
  "one stream refines the still image to 64 or the chosen number of samples",
  "playing=0&samples=1",
  async (page) => {
    const coarse = await rest(page);
    const requested = await watch(page);
    const refined = await watchRefinements(page);
    const progress = await progressTexts(page);
    await page.locator("#samples").selectOption("0");
    await eventually("64 samples", async () => refined.length === 1);
    assert.notEqual(await rest(page), coarse);
    assert.deepEqual(refined, [{ samples: 64, passes: [2, 4, 8, 16, 32, 64] }]);
    assert.match(await page.locator("#hud-rmse").textContent(), /^0\.\d+, 64 samples$/);
    const errorOf = (text) => /^\d+ of 64 samples · error ([\d.e-]+)/.exec(text)?.[1];
    const errors = (await progress.jsonValue()).map(errorOf).filter(Boolean);
    assert.ok(errors.length >= 5, errors.join());
    assert.ok(Number(errors.at(-1)) < Number(errors[0]) / 4, `the error decreases: ${errors}`);
    await page.locator("#samples").selectOption("16");
    await eventually("16 samples", async () => refined.length === 2);
    await rest(page);
    assert.deepEqual(refined[1], { samples: 16, passes: [16] }, "the service has cached this pass");
    await page.route(isFrame, (route) => route.fulfill({ status: 429, json: { title: "Too many requests" } }));
    await lookElsewhere(page);
    await eventually("another view", async () => refined.length === 3);
    await rest(page);
    assert.deepEqual(refined[2], { samples: 16, passes: [2, 4, 8, 16] });
    assert.deepEqual(requested, [], "only the stream renders images");
  },
  { ...still, expected: /status of 429/ },
);

pageTest(
  "refinement skips passes that take too long unless samples were chosen",
  "playing=0&samples=1&az=50",
  async (page) => {
    await rest(page);
    const slowly = (frames) =>
      frames.map(({ header, png }, at) => {
        const traced = header.samples - (frames[at - 1]?.header.samples ?? 0);
        return { header: { ...header, render_ms: 400 * traced }, png };
      });
    const refined = await watchRefinements(page, slowly);
    await page.locator("#samples").selectOption("0");
    await eventually("a refinement", async () => refined.length === 1);
    await rest(page);
    assert.match(await page.locator("#hud-rmse").textContent(), /, 32 samples$/, "64 samples would take 25.6 s");
    await page.locator("#samples").selectOption("64");
    await eventually("64 samples", async () => / 64 samples$/.test(await page.locator("#hud-rmse").textContent()));
  },
  still,
);

pageTest(
  "the remaining time of a refinement is marked as an estimate, and input cancels it",
  "playing=0&samples=1&az=60",
  async (page) => {
    await rest(page);
    await watchRefinements(page, (frames) =>
      frames.map(({ header, png }) => ({ header: { ...header, render_ms: 100 * header.samples }, png })),
    );
    await holdRefinement(page, 16);
    await page.locator("#samples").selectOption("64");
    const bar = page.getByRole("progressbar");
    await eventually("an estimate", async () =>
      /^16 of 64 samples · error 0\.\d+ · about \d+ s left$/.test((await bar.getAttribute("aria-valuetext")) ?? ""),
    );
    assert.equal(await bar.getAttribute("aria-valuenow"), null, "an estimated time has no value");
    assert.equal(await page.locator("#progress").textContent(), await bar.getAttribute("aria-valuetext"));
    const stopped = await page.evaluate(() => {
      document.getElementById("stage").dispatchEvent(new WheelEvent("wheel", { deltaY: 100, cancelable: true }));
      return window.signals.at(-1).aborted;
    });
    assert.equal(stopped, true, "cancelled before the view rests again");
  },
  still,
);

pageTest("showing the error does not move the stage", "playing=0&samples=1", async (page) => {
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

// Rejects refinements as if they exceeded the ray limit of a request.
const refuseRefinements = (page) =>
  page.route(isRefinement, (route) =>
    route.fulfill({ status: 422, json: { title: "Too much", detail: "request_rays" } }),
  );

// Simulates the service's jobs: sends `events`, and records `posted` and `deleted` jobs.
async function playJobs(page) {
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
  // All events are in one body. The page must process them in order and reject a body without the final
  // event.
  await page.route("**/v1/jobs/j1/events", (route) => {
    const lines = jobs.events.map(
      ([name, state], id) => `id: ${id}\nevent: ${name}\ndata: ${JSON.stringify(at(state))}\n\n`,
    );
    return route.fulfill({ contentType: "text/event-stream", body: `: hello\n\n${lines.join("")}` });
  });
  return jobs;
}

pageTest(
  "an image that exceeds the request limit is rendered as a job with progress",
  "playing=0&samples=1&az=30",
  async (page) => {
    const coarse = await rest(page);
    await watch(page, 400);
    await refuseRefinements(page);
    const jobs = await playJobs(page);
    jobs.events = [
      ["progress", { state: "running", tiles_done: 50, remaining_s: 40 }],
      ["progress", { state: "running", tiles_done: 86, remaining_s: 2.2 }],
      ["frame", { state: "running", tiles_done: 200, frames_done: 1 }],
      ["done", { state: "done", tiles_done: 200, frames_done: 1, remaining_s: 0 }],
    ];
    // Records the values and texts of the progress bar.
    const progress = await page.evaluateHandle(() => {
      const bar = document.getElementById("busy");
      const texts = [];
      new MutationObserver(() => texts.push([bar.ariaValueNow, bar.ariaValueText])).observe(bar, { attributes: true });
      return texts;
    });
    await page.route("**/v1/jobs/j1/frames/0.png", async (route) => {
      const { scene_id: sceneId, image } = jobs.posted.at(-1);
      const query = `azimuth=7&width=${image.width}&height=${image.height}`;
      const response = await route.fetch({ url: `${daemon.url}v1/scenes/${sceneId}/frame.png?${query}` });
      return route.fulfill({ response });
    });
    await lookElsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("16");
    await eventually("a job", async () => jobs.posted.length === 1);
    assert.notEqual(await rest(page), coarse);
    const [{ camera, image, render }] = jobs.posted;
    assert.deepEqual(camera, { azimuth_degrees: 7.5, elevation_degrees: 0, distance: 1 });
    assert.ok(image.width > 600);
    assert.deepEqual(render, { samples: 16 });
    const texts = (await progress.jsonValue()).map((pair) => pair.join(" "));
    assert.ok(texts.includes("25 1 of 16 samples · 25 % · 40 s left"), texts.join("\n"));
    assert.ok(texts.includes("43 1 of 16 samples · 43 % · 3 s left"), texts.join("\n"));
    assert.deepEqual(jobs.deleted, [], "a finished job is not cancelled");
    assert.equal(await page.getByRole("progressbar").isVisible(), false);
  },
  { ...still, expected: /status of 422/ },
);

pageTest(
  "input cancels the job",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, 1000);
    await refuseRefinements(page);
    const jobs = await playJobs(page);
    await page.route("**/v1/jobs/j1/events", () => {}); // never responds
    await lookElsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("4");
    await eventually("a job", async () => jobs.posted.length === 1);
    await drag(page, 40, 0);
    await eventually("the end of the job", async () => jobs.deleted.length >= 1);
    assert.deepEqual(new Set(jobs.deleted), new Set(["DELETE"]));
  },
  { ...still, expected: /status of 422/ },
);

pageTest(
  "a failed job reports the reason",
  "playing=0&samples=1",
  async (page) => {
    await rest(page);
    await watch(page, 1000);
    await refuseRefinements(page);
    const jobs = await playJobs(page);
    const error = { status: 500, title: "Out of luck", detail: "No light today.", request_id: "r77" };
    jobs.events = [["failed", { state: "failed", tiles_done: 3, error }]];
    await lookElsewhere(page);
    await rest(page);
    await page.locator("#samples").selectOption("4");
    const card = page.locator("#stage-problem");
    await card.waitFor({ state: "visible" });
    for (const text of ["Out of luck", "No light today.", "r77"]) assert.ok((await card.textContent()).includes(text));
    assert.deepEqual(jobs.deleted, []);
  },
  { ...still, expected: /status of 422/ },
);

pageTest("finer images fade in", "playing=0&samples=1", async (page) => {
  const coarse = await rest(page);
  const seen = await page.evaluateHandle(() => {
    const stage = document.getElementById("stage");
    const fading = [];
    new MutationObserver(() => fading.push(stage.hasAttribute("data-fading"))).observe(stage, { attributes: true });
    return fading;
  });
  await page.locator("#samples").selectOption("4");
  await eventually("the finer image", async () => (await rest(page)) !== coarse);
  assert.ok((await seen.jsonValue()).includes(true));
  assert.equal(await canvasDigest(page), await rest(page), "the image does not change after the fade");
});
