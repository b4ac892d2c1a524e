#!/usr/bin/env node
// Tests the page in Chromium with its own daemon: viewing, moving, options, warnings.

import assert from "node:assert/strict";
import { after } from "node:test";
import {
  axeViolations,
  canvasDigest,
  drag,
  eventually,
  hashOf,
  middle,
  near,
  packageFile,
  pageTests,
  rest,
  startBoth,
} from "./support.mjs";

const { daemon, browser } = await startBoth(after);

const pageTest = pageTests(browser, daemon);

pageTest("the page opens with an orbit of the scene `paper`", "", async (page) => {
  const seen = new Set();
  await eventually("five different frames", async () => seen.add(await canvasDigest(page)).size >= 5);
  const state = await eventually("a link to this view", async () => {
    const hash = await hashOf(page);
    return Number(hash.az) > 0 && hash;
  });
  assert.equal(state.scene, "paper");
  assert.equal(state.playing, "1");
  assert.match(await page.title(), /orrery$/);
  assert.equal(await page.locator('#gallery [aria-selected="true"]').getAttribute("data-name"), "paper");
  assert.match(await page.locator("#hud-fps").textContent(), /^\d+\.\d$/);
  for (const field of ["render", "encode"]) assert.match(await page.locator(`#hud-${field}`).textContent(), / ms$/);
  assert.match(await page.locator("#hud-rays").textContent(), /\d/);
});

pageTest("the motion of a scene plays and pauses with the orbit", "scene=orrery&speed=1&samples=1", async (page) => {
  await eventually("the motion's time in the link", async () => Number((await hashOf(page)).t) > 0.3);
  await page.locator("#play").click();
  const still = await rest(page);
  const time = Number((await hashOf(page)).t);
  assert.ok(time > 0.3 && time <= 12, `${time} s`);
  await page.locator("#stage").focus();
  await page.keyboard.press("Space");
  await eventually("frames again", async () => (await canvasDigest(page)) !== still);
  await eventually("a later time of the motion", async () => Number((await hashOf(page)).t) > time);
});

pageTest("pause stops the orbit and Space starts it again", "", async (page) => {
  await page.locator("#play").click();
  const still = await rest(page);
  await page.waitForTimeout(700);
  assert.equal(await canvasDigest(page), still);
  assert.equal((await hashOf(page)).playing, "0");
  await page.locator("#stage").focus();
  await page.keyboard.press("Space");
  await eventually("frames again", async () => (await canvasDigest(page)) !== still);
  assert.equal(await page.locator("#play").getAttribute("aria-label"), "Pause");
});

pageTest("a drag over the stage's height turns the view by 360 degrees", "playing=0", async (page) => {
  const before = await rest(page);
  const height = await drag(page, -60, 30);
  const afterDrag = await rest(page);
  assert.notEqual(afterDrag, before);
  const state = await hashOf(page);
  near(state.az, (60 * 360) / height, 0.2, "azimuth");
  near(state.el, (30 * 360) / height, 0.2, "elevation");
  const box = await page.locator("#stage").boundingBox();
  const width = Number(afterDrag.split("x")[0]);
  near(width, box.width, 1, "width of the still image");
});

pageTest(
  "previews are requested one at a time and get coarser if they are slow",
  "playing=0&samples=4",
  async (page) => {
    await rest(page);
    const { width } = await page.locator("#stage").boundingBox();
    // Counts requests inside the page, because the driver may report a request before the previous request
    // has ended.
    await page.evaluate(() => {
      const realFetch = window.fetch;
      window.previews = [];
      window.flying = window.mostInFlight = 0;
      window.fetch = async (...call) => {
        const [path, query] = String(call[0]).split("?");
        if (!path.endsWith("/frame.png")) return realFetch(...call);
        window.previews.push(Object.fromEntries(new URLSearchParams(query)));
        window.mostInFlight = Math.max(window.mostInFlight, (window.flying += 1));
        try {
          await new Promise((resolve) => setTimeout(resolve, 150));
          return await realFetch(...call);
        } finally {
          window.flying -= 1;
        }
      };
    });
    await page.evaluate(() => {
      const button = document.querySelector('[data-do="right"]');
      // Clicks without pauses, so that the view does not come to rest.
      for (let n = 0; n < 4; n += 1) button.click();
    });
    const atRest = await rest(page);
    const previews = await page.evaluate(() => window.previews);
    assert.ok(previews.length >= 3, `${previews.length} previews`);
    const last = previews.at(-1);
    assert.ok(last.width < previews[0].width && last.width >= width / 4, `${previews[0].width}, then ${last.width}`);
    assert.equal(last.samples, "1");
    assert.equal(await page.evaluate(() => window.mostInFlight), 1);
    near(atRest.split("x")[0], width, 1, "width at rest");
    assert.match(await page.locator("#hud-rmse").textContent(), /, 4 samples$/);
  },
);

pageTest(
  "a rejected preview is not requested again before Retry-After",
  "playing=0&samples=4",
  async (page) => {
    await rest(page);
    let requests = 0;
    await page.route("**/frame.png?*", (route) => {
      requests += 1;
      return route.fulfill({ status: 429, headers: { "Retry-After": "60" }, json: { title: "Too many requests" } });
    });
    for (let n = 0; n < 4; n += 1) await page.locator('[data-do="right"]').click();
    await rest(page);
    assert.equal(requests, 1);
  },
  { expected: /status of 429/ },
);

pageTest(
  "a permanent error replaces the retry notice",
  "playing=0",
  async (page) => {
    await rest(page);
    let status = 429;
    await page.route("**/frame.png?*", (route) => route.fulfill({ status, json: { title: "Out of luck" } }));
    await page.locator("#size").selectOption("half");
    await page.locator("#notice").waitFor({ state: "visible" });
    status = 500;
    await page.locator("#stage-problem").waitFor({ state: "visible" });
    assert.equal(await page.locator("#notice").isVisible(), false);
  },
  { expected: /status of (429|500)/ },
);

pageTest("after a drag, the orbit continues at the new elevation", "speed=30", async (page) => {
  const height = await drag(page, 0, 40);
  const state = await eventually("the new elevation", async () => {
    const hash = await hashOf(page);
    return Math.abs(Number(hash.el) - (40 * 360) / height) < 0.06 && hash;
  });
  await eventually("more of the orbit", async () => {
    const hash = await hashOf(page);
    return hash.el === state.el && Number(hash.az) > Number(state.az) + 5;
  });
});

pageTest(
  "the orbit waits while a drag is held",
  "",
  async (page) => {
    await page.locator("#play").click();
    await eventually("frames", async () => Number((await hashOf(page)).az) > 0);
    let held = "";
    await drag(page, 50, 0, async () => (held = await rest(page)));
    await eventually("frames after the drag", async () => (await canvasDigest(page)) !== held);
  },
  { reducedMotion: "reduce" },
);

pageTest(
  "wheel, keys and buttons move the view",
  "playing=0",
  async (page) => {
    const { x, y } = await middle(page);
    const stateAfter = async (action) => {
      await action();
      await rest(page);
      return hashOf(page);
    };
    await rest(page);
    await page.mouse.move(x, y);
    near((await stateAfter(() => page.mouse.wheel(0, 100))).dist, 1 / 0.95, 0.002, "one notch away from the target");
    near((await stateAfter(() => page.mouse.wheel(0, -100))).dist, 1, 0.002, "and back");
    await page.locator("#stage").focus();
    near((await stateAfter(() => page.keyboard.press("ArrowRight"))).az, 22.5, 0.11, "arrow right");
    near((await stateAfter(() => page.keyboard.press("ArrowUp"))).el, 22.5, 0.11, "arrow up");
    near((await stateAfter(() => page.keyboard.press("Shift+ArrowDown"))).el, 21.5, 0.11, "a fine step down");
    near((await stateAfter(() => page.keyboard.press("Shift+ArrowUp"))).el, 22.5, 0.11, "and up");
    const shifted = { modifiers: ["Shift"] };
    near((await stateAfter(() => page.locator('[data-do="right"]').click(shifted))).az, 23.5, 0.11, "by a button");
    near((await stateAfter(() => page.locator('[data-do="left"]').click(shifted))).az, 22.5, 0.11, "and back");
    await page.locator("#stage").focus();
    assert.ok((await stateAfter(() => page.keyboard.press("PageUp"))).dist < 0.9, "PageUp comes closer");
    near((await stateAfter(() => page.locator('[data-do="left"]').click())).az, 0, 0.11, "button left");
    assert.ok((await stateAfter(() => page.locator('[data-do="farther"]').click())).dist > 0.95, "button zoom out");
    const reset = await stateAfter(() => page.mouse.dblclick(x, y));
    assert.deepEqual([reset.az, reset.el, reset.dist], ["0", "0", "1"]);
    for (let n = 0; n < 8; n += 1) await page.locator('[data-do="up"]').click();
    await rest(page);
    assert.ok(Number((await hashOf(page)).el) < 90, "the view stops short of the pole");
  },
  { reducedMotion: "reduce" },
);

pageTest(
  "a pinch zooms and a drag with one finger turns the view",
  "playing=0",
  async (page, context) => {
    await rest(page);
    const { x, y } = await middle(page);
    const device = await context.newCDPSession(page);
    const touch = (type, points) =>
      device.send("Input.dispatchTouchEvent", {
        type,
        touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })),
      });
    await touch("touchStart", [
      [x - 40, y],
      [x + 40, y],
    ]);
    for (const gap of [50, 60, 80])
      await touch("touchMove", [
        [x - gap, y],
        [x + gap, y],
      ]);
    await touch("touchEnd", []);
    await rest(page);
    near((await hashOf(page)).dist, 0.5, 0.02, "fingers twice as far apart");
    await touch("touchStart", [[x, y]]);
    for (const dx of [10, 20, 40]) await touch("touchMove", [[x - dx, y]]);
    await touch("touchEnd", []);
    await rest(page);
    assert.ok(Number((await hashOf(page)).az) > 10);
  },
  { hasTouch: true, reducedMotion: "reduce" },
);

pageTest(
  "a link opens its view, and Back returns to the previous scene",
  "scene=paper&az=40&el=10&dist=1.2&speed=45&playing=0&samples=4",
  async (page) => {
    await rest(page);
    const { az, el, dist, speed, samples } = await hashOf(page);
    assert.deepEqual({ az, el, dist, speed, samples }, { az: "40", el: "10", dist: "1.2", speed: "45", samples: "4" });
    assert.equal(await page.locator("#samples").inputValue(), "4");
    const before = await canvasDigest(page);
    const other = page.locator('#gallery button:not([data-name="paper"])').first();
    const name = await other.getAttribute("data-name");
    await other.click();
    await eventually("the other scene", async () => (await canvasDigest(page)) !== before);
    assert.equal((await hashOf(page)).scene, name);
    await page.goBack();
    await eventually("the first view again", async () => (await canvasDigest(page)) === before);
    const back = await hashOf(page);
    assert.deepEqual([back.scene, back.az], ["paper", "40"]);
  },
);

pageTest("the image has the chosen technique and size", "playing=0", async (page) => {
  const before = await rest(page);
  await page.locator("#size").selectOption("1280x720");
  await eventually("the size", async () => (await canvasDigest(page)).startsWith("1280x720 "));
  await page.locator("#size").selectOption("fit");
  await eventually("the first size", async () => (await canvasDigest(page)) === before);
  const answer = page.waitForResponse((response) => response.url().includes("technique=raycast"));
  await page.locator("#technique").selectOption("raycast");
  assert.equal((await answer).status(), 200);
  assert.equal((await hashOf(page)).technique, "raycast");
});

pageTest(
  "prefers-reduced-motion opens the page paused",
  "scene=paper&playing=1&samples=1",
  async (page) => {
    const still = await rest(page);
    await page.waitForTimeout(500);
    assert.equal(await canvasDigest(page), still);
    assert.equal(await page.locator("#play").getAttribute("aria-label"), "Play");
  },
  { reducedMotion: "reduce" },
);

pageTest(
  "a narrow page does not scroll sideways",
  "playing=0",
  async (page) => {
    for (const tab of ["scenes", "json"]) {
      await page.locator(`#tab-${tab}`).click();
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(width <= 360, `${width} pixels with the tab ${tab}`);
    }
    const box = await page.locator("#stage").boundingBox();
    assert.ok(box.width > 320 && box.height > 320);
  },
  { viewport: { width: 360, height: 740 } },
);

for (const colorScheme of ["light", "dark"]) {
  for (const width of [1280, 360]) {
    pageTest(
      `axe reports no violation in ${colorScheme}, ${width} pixels wide`,
      "playing=0",
      async (page) => {
        if (!packageFile("axe-core/axe.min.js")) return console.log("axe-core is not installed: not checked");
        const check = async (where) => assert.deepEqual(await axeViolations(page), [], where);
        await rest(page);
        await check("scenes");
        await page.locator("#pan").click();
        await check("pan mode");
        await page.locator("#tab-json").click();
        await page.locator("#text").fill('{"version": 1, "camera": ');
        await page.locator("#lines .wrong").waitFor();
        await check("editor with an error");
        await page.route("**/frame.png?*", (route) =>
          route.fulfill({ status: 500, json: { title: "Out of luck", detail: "No light.", request_id: "r1" } }),
        );
        await page.locator("#size").selectOption("half"); // smaller, so that it does not become a job
        await page.locator("#stage-problem").waitFor({ state: "visible" });
        await check("error of the image");
        await page.unroute("**/frame.png?*");
        await page.route("**/frame.png?*", () => {}); // never responds
        await page.locator("#size").selectOption("fit");
        await page.locator("#size").selectOption("half");
        await page.getByRole("progressbar").waitFor();
        await page.waitForFunction(() => getComputedStyle(document.getElementById("busy")).opacity === "1");
        await check("progress");
      },
      { colorScheme, viewport: { width, height: 800 }, expected: /status of (400|500)/ },
    );
  }
}

const WARNING = "Nothing is hit; The camera is inside an object";

// Adds WARNING to the responses of images and orbits for which `ask(url)` is true.
async function warn(page, ask) {
  await page.route(/(frame\.png|orbit)\?/, async (route) => {
    if (!ask(new URL(route.request().url()))) return route.continue();
    const response = await route.fetch();
    return route.fulfill({ response, headers: { ...response.headers(), "orrery-warning": WARNING } });
  });
}

pageTest("the warning of an image is shown under the stage until the next image", "playing=0", async (page) => {
  await rest(page);
  const line = page.locator("#warning");
  assert.equal(await line.getAttribute("role"), "status");
  assert.equal(await line.textContent(), "");
  const stage = await page.locator("#stage").boundingBox();
  await warn(page, (url) => Number(url.searchParams.get("azimuth")) > 10);
  await page.locator('[data-do="right"]').click();
  await rest(page);
  await eventually("the warning", async () => (await line.textContent()) === `Warning: ${WARNING}`);
  const box = await line.boundingBox();
  assert.ok(box.y >= stage.y + stage.height && box.height > 10, "the warning is below the stage");
  assert.deepEqual(await page.locator("#stage").boundingBox(), stage, "the stage keeps its size");
  assert.deepEqual(await axeViolations(page), []);
  await page.locator('[data-do="reset"]').click();
  await rest(page);
  assert.equal(await line.textContent(), "");
});

pageTest("the warning of an orbit is shown under the stage", "playing=0", async (page) => {
  await rest(page);
  await page.route(/orbit\?/, async (route) => {
    const url = new URL(route.request().url());
    url.searchParams.set("frames", "2"); // the response is forwarded once it is complete
    const response = await route.fetch({ url: url.href });
    return route.fulfill({ response, headers: { ...response.headers(), "orrery-warning": WARNING } });
  });
  await page.locator("#play").click();
  await eventually("the warning", async () => (await page.locator("#warning").textContent()) === `Warning: ${WARNING}`);
});
