#!/usr/bin/env node
// Prints the times from the drop of a model on the page to its first image and to the third image of its orbit.
// open-times.mjs [--size 1440x900] [--runs N] FILE...

import { resolve } from "node:path";
import { parseArgs } from "node:util";
import { dropFiles, openPage, skipWithoutBrowser, startBrowser, startDaemon } from "./support.mjs";

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { size: { type: "string", default: "1440x900" }, runs: { type: "string", default: "3" } },
});
const [width, height] = values.size.split("x").map(Number);

// Makes window.times the times of the images that are drawn after the drop, once the page has the title of the
// model, in milliseconds.
const logImages = () =>
  addEventListener("drop", () => {
    const start = performance.now();
    const context = document.getElementById("canvas").getContext("2d");
    const draw = context.drawImage.bind(context);
    const before = document.title;
    window.times = [];
    context.drawImage = (...image) => {
      if (document.title !== before) window.times.push(performance.now() - start);
      return draw(...image);
    };
  });

skipWithoutBrowser();
const browser = await startBrowser();
for (const file of positionals) {
  for (let run = 0; run < Number(values.runs); run += 1) {
    const daemon = await startDaemon(); // has no stored scene
    const { page, close } = await openPage(browser, `${daemon.url}#scene=paper`, { viewport: { width, height } });
    await page.waitForTimeout(1000);
    await page.evaluate(logImages);
    await dropFiles(page, [resolve(file)]);
    await page.waitForFunction(() => window.times?.length >= 3);
    const [first, , third] = await page.evaluate(() => window.times);
    console.log(`${file}: first image ${Math.round(first)} ms, turning ${Math.round(third)} ms`);
    await close();
    await daemon.stop();
  }
}
await browser.close();
