#!/usr/bin/env node
// Tests pasted scenes, and the page after a lost connection, after an eviction, and in a hidden tab.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import {
  canvasDigest,
  eventually,
  hashOf,
  openPage,
  rest,
  skipWithoutBrowser,
  startBrowser,
  startDaemon,
} from "./support.mjs";

skipWithoutBrowser();
const browser = await startBrowser();
after(() => browser.close());

// Declares a test that runs `body(page, daemon)` with its own daemon.
function daemonTest(name, hash, body) {
  test(name, async () => {
    const daemon = await startDaemon();
    const { page, faults, close } = await openPage(browser, `${daemon.url}#${hash}`);
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

daemonTest(
  "the card lists the errors of a pasted scene, and a click selects their place",
  "playing=0&samples=1",
  async (page) => {
    const before = await rest(page);
    const card = page.locator("#text-problem");
    await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": -77'));
    await card.waitFor({ state: "visible" });
    assert.match(await card.textContent(), /\/objects\/0\/radius/);
    assert.match(await card.locator(".request").textContent(), /Request ID \S{4,}/);
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
    assert.equal(await canvasDigest(page), before, "the image does not change");
  },
);

daemonTest("typing marks the lines with errors but does not apply the text", "playing=0&samples=1", async (page) => {
  const before = await rest(page);
  const hash = await hashOf(page);
  const [card, text, wrong] = ["#text-problem", "#text", "#lines .wrong"].map((name) => page.locator(name));
  await page.locator("#tab-json").click();
  const good = await text.inputValue();
  const bad = good.replace(/"radius": 0\.5/, '"radius": -77').replace(/"shininess": 100/, '"shininess": "x"');
  const lineOf = (part) => String(bad.slice(0, bad.indexOf(part)).split("\n").length);
  await text.fill(bad);
  await wrong.first().waitFor();
  const marked = await wrong.allTextContents();
  assert.deepEqual(new Set(marked), new Set([lineOf("-77"), lineOf('"x"')]));
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
  assert.equal(await canvasDigest(page), before);
  assert.deepEqual(await hashOf(page), hash);
});

daemonTest("a late response to an older text is dropped", "playing=0&samples=1", async (page) => {
  await rest(page);
  await page.locator("#tab-json").click();
  const good = await page.locator("#text").inputValue();
  const held = [];
  await page.route("**/v1/scenes", (route) => {
    // Holds only the checks of the two edited texts.
    const isCheck = /"radius": (-77|0\.75)/.test(route.request().postData());
    return isCheck ? void held.push(route) : route.continue();
  });
  await page.locator("#text").fill(good.replace(/"radius": 0\.5/, '"radius": -77'));
  await eventually("the first check", () => held.length === 1);
  await page.locator("#text").fill(good.replace(/"radius": 0\.5/, '"radius": 0.75'));
  await eventually("the second check", () => held.length === 2);
  const answerTo = (route) => page.waitForResponse((response) => response.request() === route.request());
  const consent = answerTo(held[1]);
  await held[1].continue();
  assert.ok((await consent).ok());
  const refusal = answerTo(held[0]);
  await held[0].continue();
  assert.equal((await refusal).status(), 422);
  await page.waitForTimeout(200);
  assert.equal(await page.locator("#text-problem").isVisible(), false);
  assert.equal(await page.locator("#lines .wrong").count(), 0);
});

daemonTest("line numbers follow the scrolling of a long text", "playing=0&samples=1", async (page) => {
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

daemonTest("a pasted scene is shown, and Back returns to the previous scene", "playing=0&samples=1", async (page) => {
  const before = await rest(page);
  await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": 0.25'));
  await eventually("another image", async () => (await canvasDigest(page)) !== before);
  assert.match((await hashOf(page)).scene, /^[0-9a-f]{64}$/);
  assert.equal(await page.locator("#text-problem").isVisible(), false);
  const own = await rest(page);
  await page.goBack();
  await eventually("the first scene", async () => (await canvasDigest(page)) === before);
  await page.goForward();
  await eventually("the pasted scene", async () => (await canvasDigest(page)) === own);
  assert.match(await page.locator("#text").inputValue(), /"radius": 0\.25/);
});

daemonTest("an edit replaced by another scene can be restored", "playing=0&samples=1", async (page) => {
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

daemonTest("an evicted scene is posted again", "playing=0&samples=1", async (page, daemon) => {
  const before = await rest(page);
  const link = await page.locator("#download").getAttribute("href");
  const scene = /v1\/scenes\/[0-9a-f]+/.exec(link)[0];
  await fetch(daemon.url + scene, { method: "DELETE" });
  assert.equal((await fetch(daemon.url + scene)).status, 404);
  await page.locator("#size").selectOption("1280x720");
  await eventually("a new image", async () => (await canvasDigest(page)).startsWith("1280x720 "));
  await page.locator("#size").selectOption("fit");
  await eventually("the first image", async () => (await canvasDigest(page)) === before);
});

daemonTest("the page reports a stopped service and continues when the service runs again", "", async (page, daemon) => {
  await eventually("frames", async () => Number((await hashOf(page)).az) > 0);
  await daemon.stop();
  const notice = page.locator("#notice");
  await notice.waitFor({ state: "visible" });
  assert.match(await notice.textContent(), /Retrying in \d+ s/);
  const frozen = await canvasDigest(page);
  const revived = await startDaemon(new URL(daemon.url).port);
  try {
    await eventually("frames again", async () => (await canvasDigest(page)) !== frozen);
    assert.equal(await notice.isVisible(), false);
  } finally {
    await revived.stop();
  }
});

// Calls `answer(route)` for posted scenes that contain `words`.
const onPost = (page, words, answer) =>
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

daemonTest("the stage stays empty while a scene is being opened", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await onPost(page, '"Glass"', late);
  await pick(page, "glass");
  await page.locator("#samples").selectOption("4");
  await page.setViewportSize({ width: 1000, height: 700 });
  await page.locator('[data-do="left"]').click();
  await page.waitForTimeout(700);
  assert.equal(await shows(page), null);
  await title(page, "Glass");
  await rest(page);
  const { scene, az, samples } = await hashOf(page);
  assert.deepEqual([scene, az, samples], ["glass", "0", "4"]);
  await page.reload();
  const again = await rest(page);
  assert.equal((await hashOf(page)).scene, "glass");
  assert.equal(await canvasDigest(page), again);
});

daemonTest(
  "Back from a scene that failed to open selects the previous scene in the gallery",
  "scene=paper&playing=0&samples=1",
  async (page) => {
    await rest(page);
    await onPost(page, '"Glass"', (route) => route.fulfill({ status: 404, body: "gone" }));
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
  },
);

daemonTest(
  "a late response does not replace the scene picked last",
  "scene=paper&playing=0&samples=1",
  async (page) => {
    await rest(page);
    await onPost(page, '"radius": 0.25', late);
    await apply(page, (text) => text.replace(/"radius": 0\.5/, '"radius": 0.25'));
    await page.locator("#tab-scenes").click();
    await pick(page, "glass");
    await title(page, "Glass");
    const picked = await rest(page);
    await page.waitForTimeout(2000);
    assert.equal((await hashOf(page)).scene, "glass");
    assert.equal(await rest(page), picked);
  },
);

daemonTest("a late repost does not replace the scene picked last", "scene=paper&playing=0&samples=1", async (page) => {
  await rest(page);
  await page.route(/refinement.*samples=4/, (route) => route.fulfill({ status: 404, body: "{}" }), { times: 1 });
  await onPost(page, "Mirror floor", late);
  const again = page.waitForRequest((request) => request.postData()?.includes("Mirror floor"));
  await page.locator("#samples").selectOption("4");
  await again;
  await pick(page, "glass");
  await title(page, "Glass");
  const picked = await rest(page);
  await page.waitForTimeout(2000);
  assert.equal(await rest(page), picked);
});

daemonTest("the orbit stops in a hidden tab and continues when the tab is visible", "", async (page) => {
  const show = (visibility) =>
    page.evaluate((state) => {
      Object.defineProperty(document, "visibilityState", { get: () => state, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }, visibility);
  const digest = () => canvasDigest(page);
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

daemonTest(
  "a link to an unknown scene shows an error until another scene is picked",
  "playing=0&samples=1",
  async (page) => {
    await page.evaluate((id) => (location.hash = `scene=${id}`), "0".repeat(64));
    const card = page.locator("#stage-problem");
    await card.waitFor({ state: "visible" });
    await page.locator("#gallery button").first().click();
    await card.waitFor({ state: "hidden" });
  },
);
