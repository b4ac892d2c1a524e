#!/usr/bin/env node
// Tests that the download and the copied command produce the image on the canvas.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after } from "node:test";
import { eventually, holdRefinement, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

async function download(page) {
  const [file] = await Promise.all([page.waitForEvent("download"), page.locator("#download").click()]);
  return { bytes: readFileSync(await file.path()), name: file.suggestedFilename() };
}

async function copiedUrl(page) {
  await page.locator("#curl").click();
  await page.locator("#curl", { hasText: "Copied" }).waitFor();
  const command = await page.evaluate(() => navigator.clipboard.readText());
  const [, url] = /^curl -fo \S+\.png '([^']+)'$/.exec(command) ?? assert.fail(command);
  return url;
}

// Resolves to whether the canvas shows the pixels of a PNG.
const shows = (page, png) =>
  page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = document.getElementById("canvas");
    const other = new OffscreenCanvas(bitmap.width, bitmap.height);
    other.getContext("2d").drawImage(bitmap, 0, 0);
    const pixels = (any) => any.getContext("2d").getImageData(0, 0, any.width, any.height).data;
    const [a, b] = [pixels(canvas), pixels(other)];
    return canvas.width === other.width && a.length === b.length && a.every((value, at) => value === b[at]);
  }, png.toString("base64"));

const samplesOf = (url) => new URL(url).searchParams.get("samples");
const linkOf = (page) =>
  page.locator("#download").evaluate((link) => {
    link.dispatchEvent(new Event("focus"));
    return link.href;
  });

const clipboard = { permissions: ["clipboard-read", "clipboard-write"] };

for (const [what, view, name, options] of [
  ["with the settings of the scene", "scene=paper&az=30", "paper-30-0.png", {}],
  [
    "with every setting changed",
    "scene=orrery&az=20&el=5&dist=1.2&pan=0.1,0,0.2&t=1.5&size=half&technique=raycast",
    "orrery-20-5.png",
    { viewport: { width: 500, height: 900 } },
  ],
]) {
  pageTest(
    `download and curl command produce the refined image, ${what}`,
    `${view}&playing=0&samples=0`,
    async (page) => {
      await rest(page);
      const file = await download(page);
      assert.equal(file.name, name);
      assert.ok(await shows(page, file.bytes), "the download has the pixels of the canvas");
      const url = await copiedUrl(page);
      assert.ok(url.startsWith(daemon.url));
      assert.equal(samplesOf(url), "64");
      const response = await fetch(url);
      assert.equal(response.headers.get("content-type"), "image/png");
      assert.ok(file.bytes.equals(Buffer.from(await response.arrayBuffer())), "the command returns the same bytes");
    },
    { ...clipboard, ...options },
  );
}

pageTest("during refinement, the download is the image on the stage", "playing=0&samples=1", async (page) => {
  await rest(page);
  await holdRefinement(page, 4);
  await page.locator("#samples").selectOption("64");
  await eventually("4 samples", async () => samplesOf(await linkOf(page)) === "4");
  const { bytes } = await download(page);
  assert.ok(await eventually("the pixels of the image after the fade", () => shows(page, bytes)));
});

pageTest("during a move, the download is the still image at its end", "samples=16&speed=1", async (page) => {
  await page.locator('#stage[data-shows="stream"]').waitFor();
  assert.equal(samplesOf(await linkOf(page)), "16");
  const ahead = await page.evaluate(() => {
    document.querySelector('[data-do="up"]').click();
    const link = document.getElementById("download");
    link.dispatchEvent(new Event("focus"));
    return new URL(link.href).searchParams.get("elevation");
  });
  assert.equal(ahead, "22.5");
});

pageTest("an empty stage has no download", "playing=0&samples=1", async (page) => {
  await rest(page);
  await page.route(/v1\/scenes$/, () => {}); // never responds
  await page.locator('#gallery button[data-name="glass"]').click();
  assert.equal(await linkOf(page), "");
});
