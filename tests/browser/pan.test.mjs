#!/usr/bin/env node
// Tests panning. Points at the distance of the target must stay under the pointer in every gesture.

import assert from "node:assert/strict";
import { after } from "node:test";
import { drag, eventually, hashOf, middle, near, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

// Scene with a small white ball at the look-at point, on a black background.
const white = [1, 1, 1];
const ball = (camera) =>
  JSON.stringify({
    version: 1,
    camera: { type: "perspective", eye: [3, 5, 9], look_at: [1, 2, 3], up: [0.2, 1, 0], ...camera },
    image: { width: 600, height: 600 },
    ambient: white,
    background: [0, 0, 0],
    materials: { chalk: { type: "rough", ka: white, kd: white, ks: [0, 0, 0], shininess: 1 } },
    objects: [{ type: "sphere", center: [1, 2, 3], radius: 0.1, material: "chalk" }],
  });

async function postBall(camera) {
  const headers = { "Content-Type": "application/json" };
  const response = await fetch(`${daemon.url}v1/scenes`, { method: "POST", headers, body: ball(camera) });
  assert.ok(response.ok, await response.clone().text());
  return (await response.json()).id;
}

// Returns the position of the ball on the stage, in pixels from its middle.
async function ballAt(page) {
  await rest(page);
  return page.evaluate(() => {
    const canvas = document.getElementById("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let [count, x, y] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] < 20) continue;
      ((count += 1), (x += (i / 4) % canvas.width), (y += Math.floor(i / 4 / canvas.width)));
    }
    const scale = canvas.clientHeight / canvas.height;
    return { x: scale * (x / count - (canvas.width - 1) / 2), y: scale * (y / count - (canvas.height - 1) / 2) };
  });
}

async function at(page, x, y, what) {
  const ball = await ballAt(page);
  near(ball.x, x, 1.5, `${what}, across`);
  near(ball.y, y, 1.5, `${what}, down`);
}

async function openBall(page, camera, view) {
  const id = await postBall(camera);
  await page.evaluate((hash) => (location.hash = hash), `scene=${id}&playing=0&samples=1&${view}`);
  await eventually("the ball", async () => (await hashOf(page)).scene === id);
  await openedBall(page);
}

const openedBall = (page) => page.waitForFunction(() => document.title.startsWith("Untitled scene"));

const still = { reducedMotion: "reduce" };

pageTest(
  "a drag with the right button, Shift or Ctrl pans with the pointer",
  "playing=0",
  async (page) => {
    await rest(page);
    await openBall(page, {}, "az=50&el=20&dist=1.5");
    await at(page, 0, 0, "initially");
    await drag(page, 80, 40, undefined, "right");
    await at(page, 80, 40, "right button");
    for (const key of ["Shift", "Control", "Meta"]) {
      await page.keyboard.down(key);
      await drag(page, -60, 30);
      await page.keyboard.up(key);
      await at(page, 20, 70, key);
      await drag(page, 60, -30, undefined, "right");
    }
    const { pan, az } = await hashOf(page);
    assert.match(pan, /^-?[\d.e-]+,-?[\d.e-]+,-?[\d.e-]+$/);
    assert.equal(az, "50", "a pan does not turn the view");
    const link = await page.locator("#download").evaluate((link) => {
      link.dispatchEvent(new Event("focus"));
      return new URL(link.href).searchParams.get("pan");
    });
    assert.equal(link.split(",").length, 3);
    await drag(page, 100, 0);
    await at(page, 80, 40, "turned about the moved target").then(
      () => assert.fail("the view turned about the ball and not about the moved target"),
      () => {},
    );
    const { x, y } = await middle(page);
    await page.mouse.dblclick(x, y);
    await at(page, 0, 0, "reset");
    assert.equal((await hashOf(page)).pan, undefined);
  },
  still,
);

pageTest(
  "an orthographic view pans with the pointer, and Back restores the pan",
  "playing=0",
  async (page) => {
    await rest(page);
    await openBall(page, { type: "orthographic", height: 4 }, "dist=0.5");
    await drag(page, -50, 90, undefined, "right");
    await at(page, -50, 90, "right button");
    const panned = await hashOf(page);
    await page.locator("#gallery button").nth(1).click();
    await rest(page);
    assert.equal((await hashOf(page)).pan, undefined, "another scene starts with its own view");
    await page.goBack();
    await openedBall(page);
    assert.equal((await hashOf(page)).pan, panned.pan);
    await at(page, -50, 90, "after going back");
  },
  still,
);

pageTest(
  "Ctrl+arrow pans, and pan mode makes plain drags and arrows pan",
  "playing=0",
  async (page) => {
    await rest(page);
    await openBall(page, {}, "");
    const { height } = await middle(page);
    await page.locator("#stage").focus();
    await page.keyboard.press("Control+ArrowRight");
    await at(page, -height / 8, 0, "ctrl and arrow");
    await page.keyboard.press("Control+Shift+ArrowLeft");
    await at(page, -height / 8 + height / 8 / 22.5, 0, "a fine step back");
    await page.locator('[data-do="reset"]').click();
    await rest(page);
    await page.locator("#pan").click();
    assert.equal(await page.locator("#pan").getAttribute("aria-pressed"), "true");
    await drag(page, 70, -20);
    await at(page, 70, -20, "drag");
    await page.getByRole("button", { name: "Pan up" }).click();
    await at(page, 70, -20 + height / 8, "button");
    await page.locator("#stage").focus();
    await page.keyboard.press("ArrowDown");
    await at(page, 70, -20, "arrow");
    await page.locator("#pan").click();
    await page.getByRole("button", { name: "Turn up" }).click();
    await rest(page);
    near((await hashOf(page)).el, 22.5, 0.11, "turned again");
  },
  still,
);

pageTest(
  "a two-finger drag pans and zooms at once",
  "playing=0",
  async (page, context) => {
    await rest(page);
    await openBall(page, {}, "");
    const { x, y } = await middle(page);
    const device = await context.newCDPSession(page);
    const touch = (type, points) =>
      device.send("Input.dispatchTouchEvent", {
        type,
        touchPoints: points.map(([dx, dy], id) => ({ x: x + dx, y: y + dy, id })),
      });
    await touch("touchStart", [
      [-40, 0],
      [40, 0],
    ]);
    for (const part of [0.25, 0.5, 0.75, 1])
      await touch("touchMove", [
        [-40 + 60 * part, 30 * part],
        [40 + 60 * part, 30 * part],
      ]);
    await touch("touchEnd", []);
    await at(page, 60, 30, "both fingers moved");
    near((await hashOf(page)).dist, 1, 0.002, "distance");
    await touch("touchStart", [
      [20, 30],
      [100, 30],
    ]);
    for (const gap of [50, 60, 80])
      await touch("touchMove", [
        [60 - gap, 30],
        [60 + gap, 30],
      ]);
    await touch("touchEnd", []);
    await at(page, 60, 30, "pinched about the ball");
    near((await hashOf(page)).dist, 0.5, 0.002, "distance after a pinch");
  },
  { hasTouch: true, ...still },
);
