#!/usr/bin/env node
// Tests overlay images and budgets during orbits, scene changes, key presses and typing.

import assert from "node:assert/strict";
import { after } from "node:test";
import { charted, drag, eventually, hashOf, pageTests, quickCharts, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const still = { reducedMotion: "reduce" };
const text = (page, id) => page.locator(`#${id}`).textContent();

pageTest(
  "messages are above the overlay, and an orbit hides the overlay",
  "playing=0",
  async (page) => {
    await charted(page);
    for (const id of ["notice", "stage-problem", "hint"]) {
      const onTop = await page.evaluate((name) => {
        document.getElementById("overlay").style.pointerEvents = "auto"; // lets elementFromPoint() hit it
        const part = document.getElementById(name);
        Object.assign(part.style, { pointerEvents: "auto", minHeight: "20px" });
        part.hidden = false;
        const { x, y, width, height } = part.getBoundingClientRect();
        const hit = part.contains(document.elementFromPoint(x + width / 2, y + height / 2));
        part.hidden = true;
        return hit;
      }, id);
      assert.ok(onTop, id);
    }
    await page.locator("#play").click();
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await eventually("frames", async () => Number((await hashOf(page)).az) > 0);
  },
  still,
);

pageTest(
  "a link to another technique or scene drops the chart and its overlay",
  "playing=0",
  async (page) => {
    await charted(page);
    await page.evaluate(() => (location.hash += "&technique=raycast"));
    await page.locator("#make-chart").waitFor({ state: "visible" });
    assert.equal(await page.locator("#overlay").isVisible(), false);
    await charted(page);
    await page.route(/scenes\/0{64}/, () => {}); // never responds
    await page.evaluate((id) => (location.hash = `scene=${id}`), "0".repeat(64));
    await page.locator("#overlay").waitFor({ state: "hidden" });
    assert.equal(await page.locator("#stop").isVisible(), false);
    for (const key of ["r", "e"]) await page.keyboard.press(key);
  },
  still,
);

pageTest(
  "keys R and E do nothing in the gallery and behind a dialog",
  "playing=0",
  async (page) => {
    await charted(page);
    const held = async (key, id) => {
      await page.keyboard.down(key);
      const pressed = await page.locator(`#${id}`).getAttribute("aria-pressed");
      await page.keyboard.up(key);
      return pressed;
    };
    assert.equal(await held("e", "bound"), "true");
    await page.locator('#gallery [tabindex="0"]').focus();
    for (const [key, id] of [
      ["e", "bound"],
      ["r", "reference"],
    ])
      assert.equal(await held(key, id), "false");
    await page.locator("#show-chart").click();
    for (const [key, id] of [
      ["e", "bound"],
      ["r", "reference"],
    ])
      assert.equal(await held(key, id), "false");
  },
  still,
);

pageTest(
  "a finished chart leaves the focus in the editor",
  "playing=0",
  async (page) => {
    await quickCharts(page);
    await rest(page);
    await page.locator("#tab-json").click();
    await page.locator("#text").focus();
    await page.locator("#make-chart").evaluate((button) => button.click());
    await page.locator("#overlay").waitFor({ state: "visible" });
    assert.equal(await page.evaluate(() => document.activeElement.id), "text");
  },
  still,
);

pageTest("an orbit ignores budgets, and choosing a budget pauses the orbit", "seconds=0.3&speed=1", async (page) => {
  await drag(page, 50, 0, async () => {
    await rest(page);
    assert.equal(await text(page, "budget-status"), "");
  });
  await page.getByRole("button", { name: "2 s" }).click();
  await eventually("the budget", async () => /^Limit (met|missed): /.test(await text(page, "budget-status")));
  const { playing, seconds } = await hashOf(page);
  assert.deepEqual([playing, seconds], ["0", "2"]);
});

pageTest(
  "while a budget render is pending, the error map shows the image without the budget",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.route("**/frame.png?*seconds=2*", () => {}); // never responds
    await page.getByRole("button", { name: "2 s" }).click();
    await page.keyboard.down("e");
    await page.locator('#overlay[data-shows$="view=bound"]').waitFor({ state: "visible" });
  },
  still,
);
