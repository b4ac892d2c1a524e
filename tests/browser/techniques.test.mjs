#!/usr/bin/env node
// Tests the dialog that shows a view by every technique.

import assert from "node:assert/strict";
import { after } from "node:test";
import { axeViolations, eventually, pageTests, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

pageTest(
  "the dialog renders the view by every technique and wipes between two",
  "scene=paper&playing=0",
  async (page) => {
    await page.locator("#show-history").click();
    const dialog = page.locator("#history");
    const cards = dialog.locator("figure");
    await eventually("cards", async () => (await cards.count()) === 7);
    await dialog.locator(".wipe").waitFor({ state: "visible" });
    const texts = await cards.locator("figcaption").allTextContents();
    const figures = await cards.locator(".figures").allTextContents();
    assert.deepEqual(
      texts.map((text) => text.trim().split(/\s+/)[0]),
      ["flat", "gouraud", "phong", "raycast", "whitted", "distributed", "path"],
    );
    assert.match(texts[4], /Whitted 1980/);
    assert.match(texts[4], /Does not show soft shadows, interreflection, or caustics\./);
    for (const text of figures.slice(0, -1)) assert.match(text, /^\d+ ms · .*difference 0\.\d+$/);
    assert.match(figures.at(-1), /rays · reference$/);
    const difference = (text) => Number(/difference ([\d.e-]+)/.exec(text)[1]);
    assert.ok(difference(figures[0]) > difference(figures[5]), "flat polygons differ more than distributed rays");
    assert.deepEqual(await axeViolations(page), []);

    const sides = () =>
      dialog.locator(".pair canvas").evaluateAll((canvases) => canvases.map((canvas) => canvas.toDataURL()));
    const [left, right] = await sides();
    assert.notEqual(left, right);
    await dialog.locator("select").first().selectOption("flat");
    assert.notEqual((await sides())[0], left);
    await dialog.locator("input[type=range]").fill("20");
    const clip = await dialog
      .locator(".pair canvas")
      .first()
      .evaluate((canvas) => getComputedStyle(canvas).clipPath);
    assert.match(clip, /80%/);
    await dialog.locator("button.primary").click();
    await dialog.waitFor({ state: "hidden" });
  },
);
