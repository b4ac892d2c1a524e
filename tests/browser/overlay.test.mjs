#!/usr/bin/env node
// Overlay pictures and budgets, interrupted by orbits, other scenes, other keys and typing.

import assert from "node:assert/strict";
import { after } from "node:test";
import { charted, drag, eventually, hash_of, page_tests, quick_charts, rest, start_both } from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

const still = { reducedMotion: "reduce" };
const text = (page, id) => page.locator(`#${id}`).textContent();

page_test(
  "what the page has to say lies over the pictures of stops, and an orbit takes their place",
  "playing=0",
  async (page) => {
    await charted(page);
    for (const id of ["notice", "stage-problem", "hint"]) {
      const on_top = await page.evaluate((name) => {
        document.getElementById("overlay").style.pointerEvents = "auto"; // lets elementFromPoint() hit it
        const part = document.getElementById(name);
        Object.assign(part.style, { pointerEvents: "auto", minHeight: "20px" });
        part.hidden = false;
        const { x, y, width, height } = part.getBoundingClientRect();
        const hit = part.contains(document.elementFromPoint(x + width / 2, y + height / 2));
        part.hidden = true;
        return hit;
      }, id);
      assert.ok(on_top, id);
    }
    await page.locator("#play").click();
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await eventually("frames", async () => Number((await hash_of(page)).az) > 0);
  },
  still,
);

page_test(
  "a link to another technique or scene takes the chart and its pictures away",
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

page_test(
  "R and E are letters of the list of scenes, and mean nothing behind a dialog",
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
    for (const [key, id] of [["e", "bound"], ["r", "reference"]]) assert.equal(await held(key, id), "false");
    await page.locator("#show-chart").click();
    for (const [key, id] of [["e", "bound"], ["r", "reference"]]) assert.equal(await held(key, id), "false");
  },
  still,
);

page_test(
  "a chart leaves the focus to who writes meanwhile",
  "playing=0",
  async (page) => {
    await quick_charts(page);
    await rest(page);
    await page.locator("#tab-json").click();
    await page.locator("#text").focus();
    await page.locator("#make-chart").evaluate((button) => button.click());
    await page.locator("#overlay").waitFor({ state: "visible" });
    assert.equal(await page.evaluate(() => document.activeElement.id), "text");
  },
  still,
);

page_test(
  "an orbit keeps no budget, and ends where one is chosen",
  "seconds=0.3&speed=1",
  async (page) => {
    await drag(page, 50, 0, async () => {
      await rest(page);
      assert.equal(await text(page, "told"), "");
    });
    await page.getByRole("button", { name: "2 s" }).click();
    await eventually("the budget", async () => /^Limit (kept|missed): /.test(await text(page, "told")));
    const { playing, seconds } = await hash_of(page);
    assert.deepEqual([playing, seconds], ["0", "2"]);
  },
);

page_test(
  "before a picture is made to its budget, the bound is that of the one without",
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
