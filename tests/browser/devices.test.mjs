#!/usr/bin/env node
// Tests the page on phones and tablets, with forced colours, and with the keyboard only.

import assert from "node:assert/strict";
import { after } from "node:test";
import { axeViolations, eventually, hashOf, middle, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const touch = (width, height) => ({
  viewport: { width, height },
  isMobile: true,
  hasTouch: true,
  reducedMotion: "reduce",
});

pageTest(
  "long numbers fit into the width of a phone's stage",
  "playing=0",
  async (page) => {
    await rest(page);
    const outside = await page.evaluate(() => {
      const long = {
        fps: "30.0",
        render: "12345 ms",
        encode: "1234 ms",
        rays: "999M",
        size: "1312 × 1312, draft",
        skipped: "999",
        rmse: "0.00012, 4096 samples",
      };
      for (const [name, text] of Object.entries(long)) document.getElementById(`hud-${name}`).textContent = text;
      const { left, right } = document.querySelector(".frame").getBoundingClientRect();
      const boxes = [...document.querySelectorAll("#hud dt, #hud dd")].map((each) => each.getBoundingClientRect());
      return boxes.filter((box) => box.left < left || box.right > right).length;
    });
    assert.equal(outside, 0);
  },
  touch(360, 740),
);

// Swipes a finger by (dx, dy) pixels from the middle of the stage.
async function swipe(page, dx, dy) {
  const device = await page.context().newCDPSession(page);
  const { x, y } = await middle(page);
  const at = (part) => [{ x: x + part * dx, y: y + part * dy }];
  await device.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
  for (let part = 0.1; part < 1.05; part += 0.1)
    await device.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(part) });
  await device.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

pageTest(
  "on a phone in landscape, a vertical swipe scrolls and a horizontal swipe turns the view",
  "playing=0",
  async (page) => {
    await rest(page);
    await swipe(page, 0, -100);
    await eventually("scrolling of the page", () => page.evaluate(() => scrollY > 50));
    await page.waitForTimeout(500); // inertial scrolling ends
    await rest(page);
    const scrolled = await hashOf(page);
    assert.deepEqual([scrolled.az, scrolled.el], ["0", "0"]);
    await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
    await swipe(page, -80, 0);
    await eventually("a turn of the view", async () => Number((await hashOf(page)).az) > 20);
    assert.equal(await page.evaluate(() => scrollY), 0);
  },
  touch(740, 360),
);

pageTest(
  "on a phone in portrait, a vertical swipe turns the view",
  "playing=0",
  async (page) => {
    await rest(page);
    await swipe(page, 0, 60);
    await eventually("a larger elevation", async () => Number((await hashOf(page)).el) > 20);
    assert.equal(await page.evaluate(() => scrollY), 0);
  },
  touch(360, 740),
);

for (const [device, options, present, absent] of [
  ["a mouse", {}, /right-drag.*scroll.*Shift/, /finger|pinch/],
  ["a phone", touch(360, 740), /Drag to turn.*two fingers.*pinch/, /shift|ctrl|scroll|right-drag|arrow/i],
  ["a phone in landscape", touch(740, 360), /Drag sideways.*two fingers.*pinch/, /shift|ctrl|scroll|right-drag|arrow/i],
]) {
  pageTest(
    `the hint names the gestures of ${device}`,
    "playing=0",
    async (page) => {
      const hint = await page.locator("#hint").textContent();
      assert.match(hint, present);
      assert.doesNotMatch(hint, absent);
    },
    options,
  );
}

// Returns the visible controls smaller than 44 x 44 pixels.
const small = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("button, a.button, select, input")]
      .map((control) => ({ control, box: control.getBoundingClientRect() }))
      .filter(({ control, box }) => control.checkVisibility() && (box.width < 44 || box.height < 44))
      .map(
        ({ control, box }) =>
          `${control.id || control.dataset.do || control.textContent}: ${box.width} x ${box.height}`,
      ),
  );

for (const [width, height] of [
  [360, 740],
  [740, 360],
  [1024, 768],
]) {
  pageTest(
    `every control is at least 44 pixels wide and high on ${width} x ${height}`,
    "playing=0",
    async (page) => {
      await rest(page);
      assert.deepEqual(await small(page), []);
      await page.locator("#tab-json").click();
      await page.locator("#text").fill('{"version": 1, "camera": 3, "lights": 4}');
      await page.locator("#text-problem button.place").nth(1).waitFor();
      await page.evaluate(() => (location.hash = "scene=nosuch"));
      await page.locator("#stage-problem .actions button").first().waitFor();
      await page.evaluate(() => (document.getElementById("notice").hidden = false));
      assert.deepEqual(await small(page), []);
    },
    { ...touch(width, height), expected: /status of (404|422)/ },
  );
}

pageTest(
  "selected items are marked in forced colours",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.locator("#pan").click();
    const border = (selector) =>
      page
        .locator(selector)
        .first()
        .evaluate((element) => {
          const { borderTopWidth, borderTopColor } = getComputedStyle(element);
          return { borderTopWidth, borderTopColor };
        });
    for (const [chosen, other] of [
      ['#gallery [aria-selected="true"]', '#gallery [aria-selected="false"]'],
      ['.tabs [aria-selected="true"]', '.tabs [aria-selected="false"]'],
      ["#pan", '[data-do="up"]'],
    ]) {
      const [there, elsewhere] = [await border(chosen), await border(other)];
      assert.equal(there.borderTopWidth, "3px", chosen);
      assert.notEqual(there.borderTopColor, elsewhere.borderTopColor, chosen);
    }
  },
  { forcedColors: "active" },
);

pageTest("the gallery is one tab stop, and keys move the focus in it", "playing=0", async (page) => {
  await rest(page);
  const options = page.locator('#gallery [role="option"]');
  const count = await options.count();
  assert.ok(count > 20);
  const focused = () =>
    page.evaluate(() => {
      const all = [...document.querySelectorAll('#gallery [role="option"]')];
      return all.indexOf(document.activeElement);
    });
  await page.locator("#tab-scenes").focus();
  const press = async (key) => (await page.keyboard.press(key), focused());
  assert.equal(await press("Tab"), 0);
  assert.equal(await press("ArrowDown"), 1);
  assert.equal(await press("ArrowRight"), 2);
  assert.equal(await press("ArrowUp"), 1);
  assert.equal(await press("End"), count - 1);
  assert.equal(await press("ArrowDown"), count - 1);
  assert.equal(await press("Home"), 0);
  const found = await press("h");
  assert.equal(await options.nth(found).getAttribute("data-name"), "mirrors", "Hall of mirrors");
  assert.equal(await press("Shift+Tab"), -1, "the previous tab stop is outside of the gallery");
  assert.equal(await press("Tab"), found);
  assert.equal((await hashOf(page)).scene, "paper", "moving the focus selects no scene");
  await page.keyboard.press("Enter");
  await eventually("the scene", async () => (await hashOf(page)).scene === "mirrors");
  assert.equal(await page.locator('#gallery [aria-selected="true"]').getAttribute("data-name"), "mirrors");
  assert.deepEqual(await axeViolations(page), []);
});

pageTest(
  "the card lists and counts all errors of a scene",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.locator("#tab-json").click();
    const card = page.locator("#text-problem");
    const wrong = Array.from(
      { length: 6 },
      () => '{ "type": "sphere", "center": [0, 0, 0], "radius": -1, "material": "m" }',
    );
    const scene = `{ "version": 1, "camera": { "eye": [0, 0, 4], "look_at": [0, 0, 0] },
      "image": { "width": 60, "height": 40 }, "materials": { "m": { "type": "rough" } }, "objects": [${wrong}] }`;
    await page.locator("#text").fill(scene);
    await card.locator("button.place").nth(5).waitFor();
    const places = await card.locator("button.place").count();
    assert.match(await card.textContent(), new RegExp(`${places} errors`));
    const hidden = await card.evaluate(
      (box) =>
        [box, ...box.querySelectorAll("*")].filter(
          (part) => part.scrollHeight > part.clientHeight + 1 && getComputedStyle(part).overflowY !== "visible",
        ).length,
    );
    assert.equal(hidden, 0, "the card does not scroll");
  },
  { expected: /status of 422/ },
);
