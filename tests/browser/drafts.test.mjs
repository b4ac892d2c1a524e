#!/usr/bin/env node
// Contents of the stage from the click on a sample scene, in a browser slowed down four times.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { eventually, kRoot, open_page, rest, start_both } from "./support.mjs";
import { drag_for, log_stage, pick, scene_names, slow_down } from "./stage_log.mjs";

const { daemon, browser } = await start_both(after);
const kHeavy = ["cornell-box", "depth-of-field", "lamps", "glass"];

async function open() {
  const opened = await open_page(browser, `${daemon.url}#scene=paper`, { viewport: { width: 1440, height: 900 }, before: log_stage });
  await slow_down(opened.page, 4);
  return opened;
}

const first_picture = (page, name) => eventually(`a picture of ${name}`, () => page.evaluate(() => window.stage_log.find(({ width }) => width > 0)));

test("a scene that is chosen is seen at once: its thumbnail, then a draft, never the scene before", async () => {
  const { page, faults, close } = await open();
  const names = await scene_names(page);
  assert.ok(names.length >= 30);
  for (const name of names.filter((each) => each !== "paper")) {
    assert.ok(existsSync(join(kRoot, `scenes/thumbnails/${name}.webp`)), `${name} has no thumbnail`);
    await pick(page, name);
    await first_picture(page, name);
    const log = await page.evaluate(() => window.stage_log);
    assert.deepEqual(new Set(log.map(({ scene }) => scene)), new Set([name]));
    const first = log.findIndex(({ width }) => width > 0);
    assert.ok(first > 0, `${name}: the picture before is gone in the frame after the click`);
    const thumbnails = new Set(log.slice(0, first).map(({ thumbnail }) => thumbnail));
    thumbnails.delete(""); // the thumbnail may still be loading
    assert.ok([...thumbnails].every((file) => file === `${name}.webp`), [...thumbnails].join());
  }
  assert.deepEqual(faults, []);
  await close();
});

test("pictures that follow the hand, and those of an orbit, are never under a quarter of the stage's width", async () => {
  const { page, faults, close } = await open();
  const least = await page.locator("#stage").evaluate((stage) => Math.ceil(stage.clientWidth / 4));
  for (const name of kHeavy) {
    await pick(page, name);
    await first_picture(page, name);
    const widths = (await drag_for(page, 700)).map(([, width]) => width);
    await eventually("frames of the orbit", () => page.evaluate(() => window.pictures.length > 5));
    widths.push(...(await page.evaluate(() => window.pictures.map(([, width]) => width))));
    assert.ok(Math.min(...widths) >= least, `${name}: ${Math.min(...widths)} pixels of at least ${least}`);
  }
  assert.deepEqual(faults, []);
  await close();
});

test("a path-traced scene is refined pass by pass, and the download is the picture on the stage", async () => {
  const log_progress = (page) =>
    page.addInitScript(() => {
      window.progress = [];
      addEventListener("DOMContentLoaded", () => {
        const bar = document.getElementById("busy");
        new MutationObserver(() => window.progress.push(bar.ariaValueText)).observe(bar, { attributes: true });
      });
    });
  const options = { viewport: { width: 700, height: 500 }, before: log_progress };
  const { page, faults, close } = await open_page(browser, `${daemon.url}#scene=cornell-box&playing=0&samples=4`, options);
  await rest(page);
  const progress = await page.evaluate(() => window.progress);
  for (const pass of ["1 of 4 samples", "2 of 4 samples"])
    assert.ok(progress.some((text) => text?.startsWith(pass)), `${pass}: ${progress}`);
  const same = await page.evaluate(async () => {
    const canvas = document.getElementById("canvas");
    const bitmap = await createImageBitmap(await (await fetch(document.getElementById("download").href)).blob());
    const other = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    other.drawImage(bitmap, 0, 0);
    const bytes = (context) => context.getImageData(0, 0, bitmap.width, bitmap.height).data.join();
    return canvas.width === bitmap.width && bytes(canvas.getContext("2d")) === bytes(other);
  });
  assert.ok(same, "the download is the picture on the stage");
  assert.deepEqual(faults, []);
  await close();
});
