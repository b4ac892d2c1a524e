#!/usr/bin/env node
// Page in Chromium with its own daemon: viewing, moving, options, warnings.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import {
  axe_violations,
  canvas_digest,
  drag,
  eventually,
  hash_of,
  kRoot,
  middle,
  near,
  package_file,
  page_tests,
  rest,
  start_both,
} from "./support.mjs";

const { daemon, browser } = await start_both(after);

const page_test = page_tests(browser, daemon);

page_test("the paper's scene turns as soon as the page is open", "", async (page) => {
  const seen = new Set();
  await eventually("five different frames", async () => seen.add(await canvas_digest(page)).size >= 5);
  const state = await eventually("a link to this view", async () => {
    const hash = await hash_of(page);
    return Number(hash.az) > 0 && hash;
  });
  assert.equal(state.scene, "paper");
  assert.equal(state.playing, "1");
  assert.match(await page.title(), /orrery$/);
  assert.equal(await page.locator('#gallery [aria-selected="true"]').getAttribute("data-name"), "paper");
  assert.match(await page.locator("#hud-fps").textContent(), /^\d+\.\d$/);
  for (const field of ["render", "encode"])
    assert.match(await page.locator(`#hud-${field}`).textContent(), / ms$/);
  assert.match(await page.locator("#hud-rays").textContent(), /\d/);
});

page_test("what moves in a scene plays on, and stands still with the picture", "scene=orrery&speed=1&samples=1", async (page) => {
  await eventually("the motion's time in the link", async () => Number((await hash_of(page)).t) > 0.3);
  await page.locator("#play").click();
  const still = await rest(page);
  const time = Number((await hash_of(page)).t);
  assert.ok(time > 0.3 && time <= 12, `${time} s`);
  await page.locator("#stage").focus();
  await page.keyboard.press("Space");
  await eventually("frames again", async () => (await canvas_digest(page)) !== still);
  await eventually("time goes on", async () => Number((await hash_of(page)).t) > time);
});

test("the page stays under 125 KB", async () => {
  const files = readdirSync(join(kRoot, "web"));
  const sizes = await Promise.all(
    files.map(async (file) => {
      const response = await fetch(daemon.url + file);
      assert.ok(response.ok, file);
      return (await response.arrayBuffer()).byteLength;
    }),
  );
  const total = sizes.reduce((sum, size) => sum + size, 0);
  assert.ok(total < 125 * 1024, `${total} bytes`);
});

test("scripts and style sheets lose their comments and indentation, and nothing else", async () => {
  const lines = (text) => text.split("\n").map((line) => line.trim());
  const is_comment = (line) => /^\/[/*]/.test(line);
  const code = (line) => (is_comment(line) ? "" : line.replace(/\s+\/\/ [^"'`]*$/, ""));
  for (const file of readdirSync(join(kRoot, "web")).filter((name) => /\.(js|css)$/.test(name))) {
    const served = await (await fetch(daemon.url + file)).text();
    const source = lines(readFileSync(join(kRoot, "web", file), "utf8"));
    assert.deepEqual(served.split("\n"), source.map(code), file);
  }
});

test("the policy forbids everything from elsewhere", async () => {
  const response = await fetch(daemon.url);
  assert.match(response.headers.get("content-security-policy") ?? "", /default-src 'self'/);
});

page_test("pause stops the frames and space starts them again", "", async (page) => {
  await page.locator("#play").click();
  const still = await rest(page);
  await page.waitForTimeout(700);
  assert.equal(await canvas_digest(page), still);
  assert.equal((await hash_of(page)).playing, "0");
  await page.locator("#stage").focus();
  await page.keyboard.press("Space");
  await eventually("frames again", async () => (await canvas_digest(page)) !== still);
  assert.equal(await page.locator("#play").getAttribute("aria-label"), "Pause");
});

page_test("a drag turns the view a full turn for the stage's height", "playing=0", async (page) => {
  const before = await rest(page);
  const height = await drag(page, -60, 30);
  const after_drag = await rest(page);
  assert.notEqual(after_drag, before);
  const state = await hash_of(page);
  near(state.az, (60 * 360) / height, 0.2, "azimuth");
  near(state.el, (30 * 360) / height, 0.2, "elevation");
  const box = await page.locator("#stage").boundingBox();
  const width = Number(after_drag.split("x")[0]);
  near(width, box.width, 1, "width of the picture at rest");
});

page_test(
  "while the view moves, pictures are asked for one at a time, and are coarser where they come slowly",
  "playing=0&samples=4",
  async (page) => {
    await rest(page);
    const { width } = await page.locator("#stage").boundingBox();
    // Counts requests inside the page: the driver may report a request before the end of the last one.
    await page.evaluate(() => {
      const real_fetch = window.fetch;
      window.previews = [];
      window.flying = window.most_flying = 0;
      window.fetch = async (...call) => {
        const [path, query] = String(call[0]).split("?");
        if (!path.endsWith("/frame.png")) return real_fetch(...call);
        window.previews.push(Object.fromEntries(new URLSearchParams(query)));
        window.most_flying = Math.max(window.most_flying, (window.flying += 1));
        try {
          await new Promise((resolve) => setTimeout(resolve, 150));
          return await real_fetch(...call);
        } finally {
          window.flying -= 1;
        }
      };
    });
    await page.evaluate(() => {
      const button = document.querySelector('[data-do="right"]');
      for (let n = 0; n < 4; n += 1) button.click(); // all at once, so that the view does not rest in between
    });
    const at_rest = await rest(page);
    const previews = await page.evaluate(() => window.previews);
    assert.ok(previews.length >= 3, `${previews.length} previews`);
    const last = previews.at(-1);
    assert.ok(last.width < previews[0].width && last.width >= width / 4, `${previews[0].width}, then ${last.width}`);
    assert.equal(last.samples, "1");
    assert.equal(await page.evaluate(() => window.most_flying), 1);
    near(at_rest.split("x")[0], width, 1, "width at rest");
    assert.match(await page.locator("#hud-rmse").textContent(), /, 4 samples$/);
  },
);

page_test(
  "where pictures of a moving view are refused, none is asked for before its time",
  "playing=0&samples=4",
  async (page) => {
    await rest(page);
    let asked = 0;
    await page.route("**/frame.png?*", (route) => {
      asked += 1;
      return route.fulfill({ status: 429, headers: { "Retry-After": "60" }, json: { title: "Too many requests" } });
    });
    for (let n = 0; n < 4; n += 1) await page.locator('[data-do="right"]').click();
    await rest(page);
    assert.equal(asked, 1);
  },
  { expected: /status of 429/ },
);

page_test(
  "no new attempt is announced once a picture has failed for good",
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

page_test("a drag interrupts the orbit, which goes on after it", "speed=30", async (page) => {
  const height = await drag(page, 0, 40);
  const state = await eventually("the new elevation", async () => {
    const hash = await hash_of(page);
    return Math.abs(Number(hash.el) - (40 * 360) / height) < 0.06 && hash;
  });
  await eventually("the orbit goes on", async () => {
    const hash = await hash_of(page);
    return hash.el === state.el && Number(hash.az) > Number(state.az) + 5;
  });
});

page_test(
  "the orbit waits for as long as the view is held",
  "",
  async (page) => {
    await page.locator("#play").click();
    await eventually("frames", async () => Number((await hash_of(page)).az) > 0);
    let held = "";
    await drag(page, 50, 0, async () => (held = await rest(page)));
    await eventually("frames after it", async () => (await canvas_digest(page)) !== held);
  },
  { reducedMotion: "reduce" },
);

page_test(
  "wheel, keys and buttons move the view",
  "playing=0",
  async (page) => {
    const { x, y } = await middle(page);
    const state_after = async (action) => {
      await action();
      await rest(page);
      return hash_of(page);
    };
    await rest(page);
    await page.mouse.move(x, y);
    near((await state_after(() => page.mouse.wheel(0, 100))).dist, 1 / 0.95, 0.002, "one notch away");
    near((await state_after(() => page.mouse.wheel(0, -100))).dist, 1, 0.002, "and back");
    await page.locator("#stage").focus();
    near((await state_after(() => page.keyboard.press("ArrowRight"))).az, 22.5, 0.11, "arrow right");
    near((await state_after(() => page.keyboard.press("ArrowUp"))).el, 22.5, 0.11, "arrow up");
    near((await state_after(() => page.keyboard.press("Shift+ArrowDown"))).el, 21.5, 0.11, "a fine step down");
    near((await state_after(() => page.keyboard.press("Shift+ArrowUp"))).el, 22.5, 0.11, "and up");
    const shifted = { modifiers: ["Shift"] };
    near((await state_after(() => page.locator('[data-do="right"]').click(shifted))).az, 23.5, 0.11, "by a button");
    near((await state_after(() => page.locator('[data-do="left"]').click(shifted))).az, 22.5, 0.11, "and back");
    await page.locator("#stage").focus();
    assert.ok((await state_after(() => page.keyboard.press("PageUp"))).dist < 0.9, "PageUp comes closer");
    near((await state_after(() => page.locator('[data-do="left"]').click())).az, 0, 0.11, "button left");
    assert.ok(
      (await state_after(() => page.locator('[data-do="farther"]').click())).dist > 0.95,
      "button zoom out",
    );
    const reset = await state_after(() => page.mouse.dblclick(x, y));
    assert.deepEqual([reset.az, reset.el, reset.dist], ["0", "0", "1"]);
    for (let n = 0; n < 8; n += 1) await page.locator('[data-do="up"]').click();
    await rest(page);
    assert.ok(Number((await hash_of(page)).el) < 90, "the view stops short of the pole");
  },
  { reducedMotion: "reduce" },
);

page_test(
  "two fingers pinch, one finger turns",
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
    near((await hash_of(page)).dist, 0.5, 0.02, "fingers twice as far apart");
    await touch("touchStart", [[x, y]]);
    for (const dx of [10, 20, 40]) await touch("touchMove", [[x - dx, y]]);
    await touch("touchEnd", []);
    await rest(page);
    assert.ok(Number((await hash_of(page)).az) > 10);
  },
  { hasTouch: true, reducedMotion: "reduce" },
);

page_test(
  "a link opens the view it was made of, and back returns to the last scene",
  "scene=paper&az=40&el=10&dist=1.2&speed=45&playing=0&samples=4",
  async (page) => {
    await rest(page);
    const { az, el, dist, speed, samples } = await hash_of(page);
    assert.deepEqual(
      { az, el, dist, speed, samples },
      { az: "40", el: "10", dist: "1.2", speed: "45", samples: "4" },
    );
    assert.equal(await page.locator("#samples").inputValue(), "4");
    const before = await canvas_digest(page);
    const other = page.locator('#gallery button:not([data-name="paper"])').first();
    const name = await other.getAttribute("data-name");
    await other.click();
    await eventually("the other scene", async () => (await canvas_digest(page)) !== before);
    assert.equal((await hash_of(page)).scene, name);
    await page.goBack();
    await eventually("the first view again", async () => (await canvas_digest(page)) === before);
    const back = await hash_of(page);
    assert.deepEqual([back.scene, back.az], ["paper", "40"]);
  },
);

page_test("technique and size can be chosen", "playing=0", async (page) => {
  const before = await rest(page);
  await page.locator("#size").selectOption("1280x720");
  await eventually("the size", async () => (await canvas_digest(page)).startsWith("1280x720 "));
  await page.locator("#size").selectOption("fit");
  await eventually("the first size", async () => (await canvas_digest(page)) === before);
  const answer = page.waitForResponse((response) => response.url().includes("technique=raycast"));
  await page.locator("#technique").selectOption("raycast");
  assert.equal((await answer).status(), 200);
  assert.equal((await hash_of(page)).technique, "raycast");
});

page_test(
  "who asks for less motion gets a still",
  "scene=paper&playing=1&samples=1",
  async (page) => {
    const still = await rest(page);
    await page.waitForTimeout(500);
    assert.equal(await canvas_digest(page), still);
    assert.equal(await page.locator("#play").getAttribute("aria-label"), "Play");
  },
  { reducedMotion: "reduce" },
);

page_test(
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
    page_test(
      `axe finds nothing to fault in ${colorScheme}, ${width} pixels wide`,
      "playing=0",
      async (page) => {
        if (!package_file("axe-core/axe.min.js")) return console.log("axe-core is not installed: not checked");
        const check = async (where) => assert.deepEqual(await axe_violations(page), [], where);
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
        await check("the picture's error");
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

const kWarning = "Nothing is hit; The camera is inside an object";

// Adds a warning to the pictures for whose URL `ask` returns true.
async function warn(page, ask) {
  await page.route(/(frame\.png|orbit)\?/, async (route) => {
    if (!ask(new URL(route.request().url()))) return route.continue();
    const response = await route.fetch();
    return route.fulfill({ response, headers: { ...response.headers(), "orrery-warning": kWarning } });
  });
}

page_test("the warning of a picture stands under the stage, and goes with it", "playing=0", async (page) => {
  await rest(page);
  const line = page.locator("#warning");
  assert.equal(await line.getAttribute("role"), "status");
  assert.equal(await line.textContent(), "");
  const stage = await page.locator("#stage").boundingBox();
  await warn(page, (url) => Number(url.searchParams.get("azimuth")) > 10);
  await page.locator('[data-do="right"]').click();
  await rest(page);
  await eventually("the warning", async () => (await line.textContent()) === `Warning: ${kWarning}`);
  const box = await line.boundingBox();
  assert.ok(box.y >= stage.y + stage.height && box.height > 10, "beneath the stage");
  assert.deepEqual(await page.locator("#stage").boundingBox(), stage, "the stage keeps its size");
  assert.deepEqual(await axe_violations(page), []);
  await page.locator('[data-do="reset"]').click();
  await rest(page);
  assert.equal(await line.textContent(), "");
});

page_test("the warning of an orbit stands under the stage", "playing=0", async (page) => {
  await rest(page);
  await page.route(/orbit\?/, async (route) => {
    const url = new URL(route.request().url());
    url.searchParams.set("frames", "2"); // the response is passed on once it is complete
    const response = await route.fetch({ url: url.href });
    return route.fulfill({ response, headers: { ...response.headers(), "orrery-warning": kWarning } });
  });
  await page.locator("#play").click();
  await eventually("the warning", async () => (await page.locator("#warning").textContent()) === `Warning: ${kWarning}`);
});
