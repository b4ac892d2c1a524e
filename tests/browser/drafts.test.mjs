#!/usr/bin/env node
// Tests what the stage shows after a click on a sample scene, in a browser slowed down four times.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { eventually, ROOT, openPage, rest, startBoth } from "./support.mjs";
import { dragFor, logStage, pick, sceneNames, slowDown } from "./stage-log.mjs";

const { daemon, browser } = await startBoth(after);
const HEAVY = ["cornell-box", "depth-of-field", "lamps", "glass"];

async function open() {
  const opened = await openPage(browser, `${daemon.url}#scene=paper`, {
    viewport: { width: 1440, height: 900 },
    before: logStage,
  });
  await slowDown(opened.page, 4);
  return opened;
}

const firstPicture = (page, name) =>
  eventually(`an image of ${name}`, () => page.evaluate(() => window.stageLog.find(({ width }) => width > 0)));

test("a picked scene shows its thumbnail at once, then a draft, never the previous scene", async () => {
  const { page, faults, close } = await open();
  const names = await sceneNames(page);
  assert.ok(names.length >= 30);
  for (const name of names.filter((each) => each !== "paper")) {
    assert.ok(existsSync(join(ROOT, `scenes/thumbnails/${name}.webp`)), `${name} has no thumbnail`);
    await pick(page, name);
    await firstPicture(page, name);
    const log = await page.evaluate(() => window.stageLog);
    assert.deepEqual(new Set(log.map(({ scene }) => scene)), new Set([name]));
    const first = log.findIndex(({ width }) => width > 0);
    assert.ok(first > 0, `${name}: the previous image disappears in the frame after the click`);
    const thumbnails = new Set(log.slice(0, first).map(({ thumbnail }) => thumbnail));
    thumbnails.delete(""); // the thumbnail may still be loading
    assert.ok(
      [...thumbnails].every((file) => file === `${name}.webp`),
      [...thumbnails].join(),
    );
  }
  assert.deepEqual(faults, []);
  await close();
});

test("previews and orbit frames have at least a quarter of the stage's width", async () => {
  const { page, faults, close } = await open();
  const least = await page.locator("#stage").evaluate((stage) => Math.ceil(stage.clientWidth / 4));
  for (const name of HEAVY) {
    await pick(page, name);
    await firstPicture(page, name);
    const widths = (await dragFor(page, 700)).map(([, width]) => width);
    await eventually("frames of the orbit", () => page.evaluate(() => window.pictures.length > 5));
    widths.push(...(await page.evaluate(() => window.pictures.map(([, width]) => width))));
    assert.ok(Math.min(...widths) >= least, `${name}: ${Math.min(...widths)} pixels, at least ${least} expected`);
  }
  assert.deepEqual(faults, []);
  await close();
});

test("a path-traced scene is refined pass by pass, and the download equals the image on the stage", async () => {
  const logProgress = (page) =>
    page.addInitScript(() => {
      window.progress = [];
      addEventListener("DOMContentLoaded", () => {
        const bar = document.getElementById("busy");
        new MutationObserver(() => window.progress.push(bar.ariaValueText)).observe(bar, { attributes: true });
      });
    });
  const options = { viewport: { width: 700, height: 500 }, before: logProgress };
  const { page, faults, close } = await openPage(
    browser,
    `${daemon.url}#scene=cornell-box&playing=0&samples=4`,
    options,
  );
  await rest(page);
  const progress = await page.evaluate(() => window.progress);
  for (const pass of ["1 of 4 samples", "2 of 4 samples"])
    assert.ok(
      progress.some((text) => text?.startsWith(pass)),
      `${pass}: ${progress}`,
    );
  const same = await page.evaluate(async () => {
    const canvas = document.getElementById("canvas");
    const bitmap = await createImageBitmap(await (await fetch(document.getElementById("download").href)).blob());
    const other = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    other.drawImage(bitmap, 0, 0);
    const bytes = (context) => context.getImageData(0, 0, bitmap.width, bitmap.height).data.join();
    return canvas.width === bitmap.width && bytes(canvas.getContext("2d")) === bytes(other);
  });
  assert.ok(same, "the download equals the image on the stage");
  assert.deepEqual(faults, []);
  await close();
});
