#!/usr/bin/env node
// Prints a Markdown table of the sample scenes: time from the click to the first picture, and frames per
// second of a drag and of an orbit.
// first_pictures.mjs [--size 1440x900] [--slow TIMES] [NAME...]
// --slow: factor by which the browser's processor is slowed down, not the service's.

import { parseArgs } from "node:util";
import { eventually, open_page, skip_without_browser, start_browser, start_daemon } from "./support.mjs";
import { drag_for, log_stage, pick, scene_names, slow_down } from "./stage_log.mjs";

const kDrag_ms = 2000;
const kOrbit_ms = 3000;

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
  await eventually("a picture", () => page.evaluate(() => window.stage_log.some(({ width: pixels }) => pixels > 0)));
  const log = await page.evaluate(() => window.stage_log);
  const first = log.find(({ width: pixels }) => pixels > 0);
  const thumbnail = log.find((entry) => entry.thumbnail === `${name}.webp`);
  await page.waitForTimeout(1500); // the orbit settles on its size
  await page.evaluate(() => void (window.pictures = []));
  await page.waitForTimeout(kOrbit_ms);
  const orbit = motion(await page.evaluate(() => window.pictures));
  await drag_for(page, 500);
  const drag = motion(await drag_for(page, kDrag_ms));
  await page.waitForTimeout(300);
  row([name, since(thumbnail), since(first), `${first.width} of ${stage}`, ...drag, ...orbit]);
}

skip_without_browser();
const daemon = await start_daemon();
const browser = await start_browser();
try {
  const { page } = await open_page(browser, `${daemon.url}#scene=paper`, { viewport: { width, height }, before: log_stage });
  if (Number(values.slow) > 1) await slow_down(page, Number(values.slow));
  row(["scene", "thumbnail, ms", "first picture, ms", "its width, pixels", "drag, fps", "width", "orbit, fps", "width"]);
  row(["---", "--:", "--:", "--:", "--:", "--:", "--:", "--:"]);
  for (const name of positionals.length ? positionals : await scene_names(page)) await measure(page, name);
} finally {
  await browser.close();
  await daemon.stop();
}
