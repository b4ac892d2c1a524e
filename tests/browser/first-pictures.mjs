#!/usr/bin/env node
// Prints a Markdown table of the sample scenes: time from the click to the first image, and frames per second
// of a drag and of an orbit.
// first-pictures.mjs [--size 1440x900] [--slow TIMES] [NAME...]
// --slow: factor by which the browser, but not the service, is slowed down.

import { parseArgs } from "node:util";
import { eventually, openPage, skipWithoutBrowser, startBrowser, startDaemon } from "./support.mjs";
import { dragFor, logStage, pick, sceneNames, slowDown } from "./stage-log.mjs";

const DRAG_MS = 2000;
const ORBIT_MS = 3000;

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { size: { type: "string", default: "1440x900" }, slow: { type: "string", default: "1" } },
});
const [width, height] = values.size.split("x").map(Number);

const row = (cells) => console.log(`| ${cells.join(" | ")} |`);
const rate = (drawn) => (drawn.length < 2 ? 0 : ((drawn.length - 1) * 1000) / (drawn.at(-1)[0] - drawn[0][0]));
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const motion = (drawn) => [rate(drawn).toFixed(1), drawn.length ? median(drawn.map(([, pixels]) => pixels)) : "–"];

async function measure(page, name) {
  const stage = await page.locator("#stage").evaluate((each) => each.clientWidth);
  const start = await pick(page, name);
  const since = (entry) => (entry ? String(Math.round(entry.at - start)) : "–");
  await eventually("an image", () => page.evaluate(() => window.stageLog.some(({ width: pixels }) => pixels > 0)));
  const log = await page.evaluate(() => window.stageLog);
  const first = log.find(({ width: pixels }) => pixels > 0);
  const thumbnail = log.find((entry) => entry.thumbnail === `${name}.webp`);
  await page.waitForTimeout(1500); // the orbit settles on its size
  await page.evaluate(() => void (window.pictures = []));
  await page.waitForTimeout(ORBIT_MS);
  const orbit = motion(await page.evaluate(() => window.pictures));
  await dragFor(page, 500);
  const drag = motion(await dragFor(page, DRAG_MS));
  await page.waitForTimeout(300);
  row([name, since(thumbnail), since(first), `${first.width} of ${stage}`, ...drag, ...orbit]);
}

skipWithoutBrowser();
const daemon = await startDaemon();
const browser = await startBrowser();
try {
  const { page } = await openPage(browser, `${daemon.url}#scene=paper`, {
    viewport: { width, height },
    before: logStage,
  });
  if (Number(values.slow) > 1) await slowDown(page, Number(values.slow));
  row(["scene", "thumbnail, ms", "first image, ms", "its width, pixels", "drag, fps", "width", "orbit, fps", "width"]);
  row(["---", "--:", "--:", "--:", "--:", "--:", "--:", "--:"]);
  for (const name of positionals.length ? positionals : await sceneNames(page)) await measure(page, name);
} finally {
  await browser.close();
  await daemon.stop();
}
