#!/usr/bin/env node
// Pasted scenes, and the page after a lost connection, an eviction, or in a hidden tab.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import {
  canvas_digest,
  eventually,
  hash_of,
  open_page,
  rest,
  skip_without_browser,
  start_browser,
  start_daemon,
} from "./support.mjs";

skip_without_browser();
const browser = await start_browser();
after(() => browser.close());

// Declares a test that runs `body(page, daemon)` with its own daemon.
function daemon_test(name, hash, body) {
  test(name, async () => {
    const daemon = await start_daemon();
    const { page, faults, close } = await open_page(browser, `${daemon.url}#${hash}`);
    try {
      await body(page, daemon);
      // Error statuses and lost connections are expected.
      assert.deepEqual(
        faults.filter((fault) => !/Failed to load resource|net::ERR_/.test(fault)),
        [],
      );
    } finally {
      await close();
      await daemon.stop();
    }
  });
}

const selection = (page) =>
  page.locator("#text").evaluate((field) => field.value.slice(field.selectionStart, field.selectionEnd));

async function apply(page, edit) {
  await page.locator("#tab-json").click();
  const text = await page.locator("#text").inputValue();
  await page.locator("#text").fill(edit(text));
  await page.locator("#apply").click();
}

daemon_test(
  "what is wrong in a pasted scene is named, and a click leads there",
  "playing=0&samples=1",
  async (page) => {
    const before = await rest(page);
    const card = page.locator("#text-problem");
    await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": -77'));
    await card.waitFor({ state: "visible" });
    assert.match(await card.textContent(), /\/objects\/0\/radius/);
    assert.match(await card.locator(".request").textContent(), /Request \S{4,}/);
    await card.locator("button.place").first().click();
    assert.equal(await selection(page), "-77");

    await apply(page, (text) => text.replace('"radius": -77', '"raduis": 1'));
    await eventually("the unknown key", async () => /raduis/.test(await card.textContent()));
    await card.locator("button.place", { hasText: "raduis" }).click();
    assert.equal(await selection(page), '"raduis"');

    await apply(page, () => '{\n  "version": 1,\n  "camera" 2\n}');
    await eventually("the malformed line", async () => /line 3/.test(await card.textContent()));
    await card.locator("button.place").click();
    const caret = await page.locator("#text").evaluate((field) => field.selectionStart);
    assert.ok(caret >= 18 && caret <= 31, `the caret is at ${caret}`);
    assert.equal(await canvas_digest(page), before, "the picture stays");
  },
);

daemon_test("what is wrong is marked beside the text while it is typed, and nothing is applied", "playing=0&samples=1", async (page) => {
  const before = await rest(page);
  const hash = await hash_of(page);
  const [card, text, wrong] = ["#text-problem", "#text", "#lines .wrong"].map((name) => page.locator(name));
  await page.locator("#tab-json").click();
  const good = await text.inputValue();
  const bad = good.replace(/"radius": 0\.5/, '"radius": -77').replace(/"shininess": 100/, '"shininess": "x"');
  const line_of = (part) => String(bad.slice(0, bad.indexOf(part)).split("\n").length);
  await text.fill(bad);
  await wrong.first().waitFor();
  const marked = await wrong.allTextContents();
  assert.deepEqual(new Set(marked), new Set([line_of("-77"), line_of('"x"')]));
  assert.match(await wrong.first().getAttribute("title"), /number/);
  assert.match(await wrong.first().getAttribute("aria-label"), /^Line \d+: /);
  assert.equal(await text.getAttribute("aria-invalid"), "true");
  await card.locator("button.place", { hasText: "radius" }).click();
  assert.equal(await selection(page), "-77");

  await text.fill('{\n  "version": 1,\n  "camera" 2\n}');
  await eventually("the malformed line", async () => (await wrong.allTextContents()).join() === "3");
  assert.deepEqual(await page.locator("#lines span").allTextContents(), ["1", "2", "3", "4"]);

  await text.fill(good.replace(/"radius": 0\.5/, '"radius": 0.25'));
  await card.waitFor({ state: "hidden" });
  assert.equal(await wrong.count(), 0);
  assert.equal(await text.getAttribute("aria-invalid"), "false");
  assert.equal(await canvas_digest(page), before);
  assert.deepEqual(await hash_of(page), hash);
});

daemon_test("a late answer about an older text is dropped", "playing=0&samples=1", async (page) => {
  await rest(page);
  await page.locator("#tab-json").click();
  const good = await page.locator("#text").inputValue();
  const held = [];
  await page.route("**/v1/scenes", (route) => {
    const is_check = /"radius": (-77|0\.75)/.test(route.request().postData()); // others: gallery
    return is_check ? void held.push(route) : route.continue();
  });
  await page.locator("#text").fill(good.replace(/"radius": 0\.5/, '"radius": -77'));
  await eventually("the first check", () => held.length === 1);
  await page.locator("#text").fill(good.replace(/"radius": 0\.5/, '"radius": 0.75'));
  await eventually("the second check", () => held.length === 2);
  const answer_to = (route) => page.waitForResponse((response) => response.request() === route.request());
  const consent = answer_to(held[1]);
  await held[1].continue();
  assert.ok((await consent).ok());
  const refusal = answer_to(held[0]);
  await held[0].continue();
  assert.equal((await refusal).status(), 422);
  await page.waitForTimeout(200);
  assert.equal(await page.locator("#text-problem").isVisible(), false);
  assert.equal(await page.locator("#lines .wrong").count(), 0);
});

daemon_test("the line numbers go with a text of any length", "playing=0&samples=1", async (page) => {
  await rest(page);
  await page.locator("#tab-json").click();
  await page.locator("#text").fill(`{\n${"\n".repeat(5000)}"version": 1, "camera": 2}`);
  await page.locator("#text-problem .place").first().click();
  const numbers = await eventually("the last lines", async () => {
    const shown = (await page.locator("#lines span").allTextContents()).map(Number);
    return shown.at(-1) === 5002 && shown;
  });
  assert.ok(numbers.length < 100, `${numbers.length} rows`);
  const offset = await page.evaluate(() => {
    const rows = [...document.querySelectorAll("#lines span")];
    const text = document.getElementById("text");
    const row = rows.at(-1).getBoundingClientRect();
    const height = Number.parseFloat(getComputedStyle(text).lineHeight);
    const top = text.getBoundingClientRect().top + text.clientTop + 10 + 5001 * height - text.scrollTop;
    return row.top - top;
  });
  assert.ok(Math.abs(offset) <= 1, `the last number is ${offset} pixels from its line`);
});

daemon_test("a pasted scene is shown, and back leads to the one before", "playing=0&samples=1", async (page) => {
  const before = await rest(page);
  await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": 0.25'));
  await eventually("another picture", async () => (await canvas_digest(page)) !== before);
  assert.match((await hash_of(page)).scene, /^[0-9a-f]{64}$/);
  assert.equal(await page.locator("#text-problem").isVisible(), false);
  const own = await rest(page);
  await page.goBack();
  await eventually("the first scene", async () => (await canvas_digest(page)) === before);
  await page.goForward();
  await eventually("the pasted scene", async () => (await canvas_digest(page)) === own);
  assert.match(await page.locator("#text").inputValue(), /"radius": 0\.25/);
});

daemon_test("an edit that another scene replaces can be brought back", "playing=0&samples=1", async (page) => {
  await page.locator("#tab-json").click();
  await page.locator("#text").fill("my edit");
  await page.locator("#tab-scenes").click();
  await page.locator("#gallery button").nth(1).click();
  await page.locator("#tab-json").click();
  await eventually("the other scene", async () => (await page.locator("#text").inputValue()) !== "my edit");
  await page.locator("#text").fill("a newer one");
  await page.locator("#restore").click();
  assert.equal(await page.locator("#text").inputValue(), "my edit");
  await page.locator("#restore").click();
  assert.equal(await page.locator("#text").inputValue(), "a newer one");
});

daemon_test("a forgotten scene is posted again", "playing=0&samples=1", async (page, daemon) => {
  const before = await rest(page);
  const link = await page.locator("#download").getAttribute("href");
  const scene = /v1\/scenes\/[0-9a-f]+/.exec(link)[0];
  await fetch(daemon.url + scene, { method: "DELETE" });
  assert.equal((await fetch(daemon.url + scene)).status, 404);
  await page.locator("#size").selectOption("1280x720");
  await eventually("a new picture", async () => (await canvas_digest(page)).startsWith("1280x720 "));
  await page.locator("#size").selectOption("fit");
  await eventually("the first picture", async () => (await canvas_digest(page)) === before);
});

daemon_test(
  "the page says that the service is gone, and goes on when it is back",
  "",
  async (page, daemon) => {
    await eventually("frames", async () => Number((await hash_of(page)).az) > 0);
    await daemon.stop();
    const notice = page.locator("#notice");
    await notice.waitFor({ state: "visible" });
    assert.match(await notice.textContent(), /Trying again in \d+ s/);
    const frozen = await canvas_digest(page);
    const revived = await start_daemon(new URL(daemon.url).port);
    try {
      await eventually("frames again", async () => (await canvas_digest(page)) !== frozen);
      assert.equal(await notice.isVisible(), false);
    } finally {
      await revived.stop();
    }
  },
);

// Calls `answer(route)` for posted scenes that contain `words`.
const on_post = (page, words, answer) =>
  page.route(/v1\/scenes$/, (route) =>
    route.request().postData()?.includes(words) ? answer(route) : route.continue(),
  );
const late = async (route) => {
  await new Promise((resolve) => setTimeout(resolve, 1500));
  await route.continue();
};

const shows = (page) => page.locator("#stage").getAttribute("data-shows");
const pick = (page, name) => page.locator(`#gallery button[data-name="${name}"]`).click();
const title = (page, start) => page.waitForFunction((text) => document.title.startsWith(text), start);

daemon_test("as long as a scene is on its way, no other is shown for it", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await on_post(page, '"Glass"', late);
  await pick(page, "glass");
  await page.locator("#samples").selectOption("4");
  await page.setViewportSize({ width: 1000, height: 700 });
  await page.locator('[data-do="left"]').click();
  await page.waitForTimeout(700);
  assert.equal(await shows(page), null);
  await title(page, "Glass");
  await rest(page);
  const { scene, az, samples } = await hash_of(page);
  assert.deepEqual([scene, az, samples], ["glass", "0", "4"]);
  await page.reload();
  const again = await rest(page);
  assert.equal((await hash_of(page)).scene, "glass");
  assert.equal(await canvas_digest(page), again);
});

daemon_test("back from a scene that never came marks the one that is shown", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await on_post(page, '"Glass"', (route) => route.fulfill({ status: 404, body: "gone" }));
  await pick(page, "glass");
  const card = page.locator("#stage-problem");
  await card.waitFor({ state: "visible" });
  await page.setViewportSize({ width: 1000, height: 700 });
  await page.waitForTimeout(400);
  assert.equal(await shows(page), null);
  assert.equal(await card.isVisible(), true);
  await page.goBack();
  await rest(page);
  assert.equal(await page.locator('#gallery [aria-selected="true"]').getAttribute("data-name"), "paper");
  assert.equal(await card.isVisible(), false);
});

daemon_test("the scene picked last stays, whatever is posted late", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await on_post(page, '"radius": 0.25', late);
  await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": 0.25'));
  await page.locator("#tab-scenes").click();
  await pick(page, "glass");
  await title(page, "Glass");
  const picked = await rest(page);
  await page.waitForTimeout(2000);
  assert.equal((await hash_of(page)).scene, "glass");
  assert.equal(await rest(page), picked);
});

daemon_test("a forgotten scene that is posted late replaces no other", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await page.route(/refinement.*samples=4/, (route) => route.fulfill({ status: 404, body: "{}" }), { times: 1 });
  await on_post(page, "The paper's scene", late);
  const again = page.waitForRequest((request) => request.postData()?.includes("The paper's scene"));
  await page.locator("#samples").selectOption("4");
  await again;
  await pick(page, "glass");
  await title(page, "Glass");
  const picked = await rest(page);
  await page.waitForTimeout(2000);
  assert.equal(await rest(page), picked);
});

daemon_test("a hidden tab asks for nothing and goes on when it is seen again", "", async (page) => {
  const show = (visibility) =>
    page.evaluate((state) => {
      Object.defineProperty(document, "visibilityState", { get: () => state, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, visibility);
  const digest = () => canvas_digest(page);
  const first = await digest();
  await eventually("frames", async () => (await digest()) !== first);
  await show("hidden");
  await page.waitForTimeout(500); // draws pending frames
  const frozen = await digest();
  await page.waitForTimeout(500);
  assert.equal(await digest(), frozen);
  await show("visible");
  await eventually("frames again", async () => (await digest()) !== frozen);
});

daemon_test("a link to a scene that nobody knows says so", "playing=0&samples=1", async (page) => {
  await page.evaluate((id) => (location.hash = `scene=${id}`), "0".repeat(64));
  const card = page.locator("#stage-problem");
  await card.waitFor({ state: "visible" });
  await page.locator("#gallery button").first().click();
  await card.waitFor({ state: "hidden" });
});
