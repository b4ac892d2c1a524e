// Shared parts of the browser tests and screenshot.mjs: daemon, browser and page helpers.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

export const ROOT = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
export const SKIPPED = 77;
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
const START_TIMEOUT_MS = 600_000;
const require = createRequire(import.meta.url);

// Returns the path of a package's file in node_modules or NODE_PATH, or null if the package is not installed.
export function packageFile(name) {
  try {
    return require.resolve(name);
  } catch {
    return null;
  }
}

// Exits with status SKIPPED if the browser or its driver is missing.
export function skipWithoutBrowser() {
  for (const [what, present] of [
    [CHROMIUM, existsSync(CHROMIUM)],
    ["playwright-core", packageFile("playwright-core")],
  ]) {
    if (present) continue;
    console.log(`skipped: ${what} is not installed`);
    process.exit(SKIPPED);
  }
}

// Starts `orrery serve` on `port`, where 0 means any free port. Resolves to {url, stop()}.
export async function startDaemon(port = 0) {
  const program = process.env.TEST_ORRERY ?? join(ROOT, "build/orrery");
  const child = spawn(program, ["serve", "--port", String(port), "--health-port", "0"], {
    stdio: ["ignore", "pipe", "pipe"],
  });
  const gone = new Promise((resolve) => child.once("close", resolve));
  let output = "";
  const url = await new Promise((resolve, reject) => {
    const timer = setTimeout(
      () => reject(new Error(`${program} did not print its URL within ${START_TIMEOUT_MS} ms; output: ${output}`)),
      START_TIMEOUT_MS,
    );
    const fail = (why) => {
      clearTimeout(timer);
      reject(new Error(`${program} ${why}; output: ${output}`));
    };
    const read = (chunk) => {
      output += chunk;
      const match = /listens on (http:\/\/\S+)/.exec(output);
      if (!match) return;
      clearTimeout(timer);
      resolve(match[1]);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.once("error", (error) => fail(error.message));
    child.once("close", (code) => fail(`exited with status ${code}`));
  }).catch((error) => {
    child.kill("SIGKILL");
    throw error;
  });
  const stop = async () => {
    child.kill("SIGTERM");
    const timer = setTimeout(() => child.kill("SIGKILL"), 5000);
    await gone;
    clearTimeout(timer);
  };
  return { url: url.replace(/\/?$/, "/"), stop };
}

// Starts a Chromium with an empty profile.
export function startBrowser() {
  return require("playwright-core").chromium.launch({
    executablePath: CHROMIUM,
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
}

// Opens a page and records its faults: console errors, uncaught exceptions and requests to other origins. The
// selector `ready` is visible once the page is open. `before(page)` runs before the page is opened. Returns
// {page, faults, close()}.
export async function openPage(browser, url, { ready = "#canvas", before = () => {}, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  context.setDefaultTimeout(600_000); // long enough for a busy machine, so that only hangs fail
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("request", (request) => {
    const { origin, protocol } = new URL(request.url());
    if (protocol !== "blob:" && origin !== new URL(url).origin) faults.push(`request to ${request.url()}`);
  });
  const close = async () => {
    await page.unrouteAll({ behavior: "ignoreErrors" });
    await context.close();
  };
  await before(page);
  await page.goto(url);
  await page.locator(ready).waitFor({ state: "visible" });
  return { page, faults, close };
}

// Returns size and digest of the image on the canvas.
export function canvasDigest(page) {
  return page.evaluate(async () => {
    const canvas = document.getElementById("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", data));
    return `${canvas.width}x${canvas.height} ${[...digest.slice(0, 8)].join(".")}`;
  });
}

// Returns the page's state from its URL hash: {scene, az, el, dist, ...} as strings.
export async function hashOf(page) {
  return Object.fromEntries(new URLSearchParams(await page.evaluate(() => location.hash.slice(1))));
}

// Waits until `probe()` returns a truthy value, and returns it. Throws after `timeoutMs`.
export async function eventually(what, probe, timeoutMs = 600_000) {
  for (const start = Date.now(); Date.now() - start < timeoutMs;) {
    const result = await probe();
    if (result) return result;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`timeout after ${timeoutMs} ms while waiting for ${what}`);
}

// Waits until the view rests and its finest image is drawn. Returns the digest of the image.
export async function rest(page) {
  await page.locator('#stage[data-shows="still"]:not([data-fading])').waitFor();
  return canvasDigest(page);
}

// Starts a daemon and a browser for a test file, and stops them after its tests. `after` is the function of
// node:test.
export async function startBoth(after) {
  skipWithoutBrowser();
  const daemon = await startDaemon();
  const browser = await startBrowser();
  after(async () => {
    await browser.close();
    await daemon.stop();
  });
  return { daemon, browser };
}

// Returns a function that declares a test. The test opens the page with `hash` and runs `body(page,
// context)`. It fails on faults that do not match `expected`. For speed, still images have one sample unless
// the hash sets a number.
export function pageTests(browser, daemon) {
  return (name, hash, body, { expected = /^$/, ...options } = {}) =>
    test(name, async () => {
      const view = /playing=0(?!.*samples)/.test(hash) ? `${hash}&samples=1` : hash;
      const { page, faults, close } = await openPage(browser, `${daemon.url}#${view}`, options);
      try {
        await body(page, page.context());
        assert.deepEqual(
          faults.filter((fault) => !expected.test(fault)),
          [],
        );
      } finally {
        await close();
      }
    });
}

// Returns the violations that axe-core finds, as texts. Returns [] if axe-core is not installed.
export async function axeViolations(page) {
  const axe = packageFile("axe-core/axe.min.js");
  if (!axe) return [];
  await page.evaluate(readFileSync(axe, "utf8"));
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  return violations.map(({ id, nodes }) => `${id} at ${nodes.map(({ target }) => target)}`);
}

// Makes refinement streams hang after the pass with `samples` samples. window.signals contains their abort
// signals.
export async function holdRefinement(page, samples) {
  await page.evaluate((last) => {
    const realFetch = window.fetch;
    window.signals = [];
    window.fetch = async (path, options) => {
      if (!String(path).includes("/refinement?")) return realFetch(path, options);
      window.signals.push(options.signal);
      const response = await realFetch(path, options);
      const bytes = new Uint8Array(await response.arrayBuffer());
      let at = 0;
      for (let seen = 0; seen < last;) {
        const length = new DataView(bytes.buffer).getUint32(at);
        const header = JSON.parse(new TextDecoder().decode(bytes.subarray(at + 4, at + 4 + length)));
        at += 4 + length + header.bytes;
        seen = header.samples;
      }
      const body = new ReadableStream({ start: (stream) => stream.enqueue(bytes.subarray(0, at)) });
      return new Response(body, { headers: response.headers });
    };
  }, samples);
}

// Makes charts render a few small images. Appends the request bodies to `seen`.
export async function quickCharts(page, seen = []) {
  await page.route("**/charts", (route) => {
    const body = route.request().postDataJSON();
    seen.push(structuredClone(body));
    return route.continue({ postData: JSON.stringify({ ...body, chart: { samples: 16, rounds: 2, width: 40 } }) });
  });
  return seen;
}

// Makes a chart. Resolves to the slider, which is at its last stop.
export async function charted(page) {
  await quickCharts(page);
  await rest(page);
  await page.locator("#make-chart").click();
  const slider = page.getByRole("slider", { name: "Settings from fast to accurate" });
  await slider.waitFor({ state: "visible" });
  await page.locator("#overlay").waitFor({ state: "visible" });
  return slider;
}

// Returns the middle of the stage and its height.
export async function middle(page) {
  const box = await page.locator("#stage").boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2, height: box.height };
}

// Drags by (dx, dy) pixels and calls `held()` before the release. Returns the stage's height.
export async function drag(page, dx, dy, held = () => {}, button = "left") {
  const { x, y, height } = await middle(page);
  await page.mouse.move(x, y);
  await page.mouse.down({ button });
  await page.mouse.move(x + dx / 2, y + dy / 2, { steps: 3 });
  await page.mouse.move(x + dx, y + dy, { steps: 3 });
  await held();
  await page.mouse.up({ button });
  return height;
}

// Drags the files at `paths` over the stage, calls `over()` and drops them.
export async function dropFiles(page, paths, over = () => {}) {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  const dispatch = (type) => session.send("Input.dispatchDragEvent", { type, x: 200, y: 300, data });
  await dispatch("dragEnter");
  await dispatch("dragOver");
  await over();
  await dispatch("drop");
}

export const near = (actual, expected, tolerance, what) =>
  assert.ok(Math.abs(Number(actual) - expected) <= tolerance, `${what}: ${actual} is not near ${expected}`);
