#!/usr/bin/env node
// Takes a screenshot of the page: screenshot.mjs OUT.png [--width 1280] [--height 800] [--scale 1] [--dark]
//   [--hash "scene=paper&playing=0"] [--tab json] [--full] [--wait MS] [--url http://host:port/]
// Without --url, starts $TEST_ORRERY, by default build/orrery.

import { parseArgs } from "node:util";
import { skipWithoutBrowser, startBrowser, startDaemon } from "./support.mjs";

const text = (value) => ({ type: "string", default: value });
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    width: text("1280"),
    height: text("800"),
    scale: text("1"),
    hash: text("playing=0"),
    tab: text("scenes"),
    wait: text("1500"),
    url: text(""),
    dark: { type: "boolean" },
    full: { type: "boolean" },
  },
});
if (positionals.length !== 1) {
  console.error(
    "usage: screenshot.mjs OUT.png [--width N] [--height N] [--scale N] [--dark] [--hash TEXT] " +
      "[--tab scenes|json] [--full] [--wait MS] [--url URL]",
  );
  process.exit(2);
}

skipWithoutBrowser();
const daemon = values.url ? null : await startDaemon();
const browser = await startBrowser();
const context = await browser.newContext({
  viewport: { width: Number(values.width), height: Number(values.height) },
  deviceScaleFactor: Number(values.scale),
  colorScheme: values.dark ? "dark" : "light",
});
try {
  const page = await context.newPage();
  await page.goto(`${daemon?.url ?? values.url}#${values.hash}`);
  await page.locator("#canvas").waitFor({ state: "visible" });
  await page.locator(`#tab-${values.tab}`).click();
  await page.evaluate(() => scrollTo({ top: 0, behavior: "instant" }));
  await page.waitForTimeout(Number(values.wait));
  await page.screenshot({ path: positionals[0], fullPage: values.full ?? false });
} finally {
  await browser.close();
  await daemon?.stop();
}
