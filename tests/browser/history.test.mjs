#!/usr/bin/env node
// Tests Back, Forward and edited URLs: the page must show the state in the URL.

import assert from "node:assert/strict";
import { after } from "node:test";
import { canvasDigest, eventually, hashOf, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const playLabel = (page) => page.locator("#play").getAttribute("aria-label");
const shows = (page) => page.locator("#stage").getAttribute("data-shows");
const pick = (page, name) => page.locator(`#gallery button[data-name="${name}"]`).click();
const frames = (page) => page.locator('#stage[data-shows="stream"]').waitFor();

// Fails unless button, URL and stage show that the orbit is paused.
async function assertPaused(page) {
  const before = await rest(page);
  await page.waitForTimeout(700);
  assert.equal(await canvasDigest(page), before);
  assert.equal(await shows(page), "still");
  assert.equal(await playLabel(page), "Play");
  assert.equal((await hashOf(page)).playing, "0");
}

async function assertPlaying(page) {
  await frames(page);
  const { az } = await hashOf(page);
  await eventually("a turn of the view", async () => (await hashOf(page)).az !== az);
  assert.equal(await playLabel(page), "Pause");
  assert.equal((await hashOf(page)).playing, "1");
}

pageTest("Back to a paused scene pauses the orbit", "scene=paper&playing=0", async (page) => {
  await rest(page);
  await pick(page, "shape-sphere");
  await page.waitForFunction(() => document.title.startsWith("Sphere"));
  await rest(page);
  await page.locator("#play").click();
  await assertPlaying(page);
  await page.goBack();
  await eventually("the first scene", async () => (await hashOf(page)).scene === "paper");
  await assertPaused(page);
  await page.goForward();
  await eventually("the second scene", async () => (await hashOf(page)).scene === "shape-sphere");
  await assertPlaying(page);
});

pageTest("an edited URL pauses and plays the same scene", "scene=paper&playing=0", async (page) => {
  await rest(page);
  const edit = (from, to) =>
    page.evaluate(([before, now]) => (location.hash = location.hash.replace(before, now)), [from, to]);
  await edit("playing=0", "playing=1");
  await assertPlaying(page);
  await edit("playing=1", "playing=0");
  await assertPaused(page);
});
