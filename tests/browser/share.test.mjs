#!/usr/bin/env node
// Sharing: the download and the copied command yield the picture on the canvas.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after } from "node:test";
import { eventually, hold_refinement, page_tests, rest, start_both } from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

async function download(page) {
  const [file] = await Promise.all([page.waitForEvent("download"), page.locator("#download").click()]);
  return { bytes: readFileSync(await file.path()), name: file.suggestedFilename() };
}

async function copied_url(page) {
  await page.locator("#curl").click();
  await page.getByText("Copied").waitFor();
  const command = await page.evaluate(() => navigator.clipboard.readText());
  const [, url] = /^curl -fo \S+\.png '([^']+)'$/.exec(command) ?? assert.fail(command);
  return url;
}

// Returns whether the canvas shows the pixels of a PNG.
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

const samples_of = (url) => new URL(url).searchParams.get("samples");
const link_of = (page) =>
  page.locator("#download").evaluate((link) => {
    link.dispatchEvent(new Event("focus"));
    return link.href;
  });

const clipboard = { permissions: ["clipboard-read", "clipboard-write"] };

for (const [what, view, name, options] of [
  ["at the scene's own settings", "scene=paper&az=30", "paper-30-0.png", {}],
  [
    "with every setting changed",
    "scene=orrery&az=20&el=5&dist=1.2&pan=0.1,0,0.2&t=1.5&size=half&technique=raycast",
    "orrery-20-5.png",
    { viewport: { width: 500, height: 900 } },
  ],
]) {
  page_test(
    `the refined picture is downloaded and copied, ${what}`,
    `${view}&playing=0&samples=0`,
    async (page) => {
      await rest(page);
      const file = await download(page);
      assert.equal(file.name, name);
      assert.ok(await shows(page, file.bytes), "the pixels of the canvas");
      const url = await copied_url(page);
      assert.ok(url.startsWith(daemon.url));
      assert.equal(samples_of(url), "64");
      const response = await fetch(url);
      assert.equal(response.headers.get("content-type"), "image/png");
      assert.ok(file.bytes.equals(Buffer.from(await response.arrayBuffer())), "the same bytes by the command");
    },
    { ...clipboard, ...options },
  );
}

page_test("what is shown is downloaded while finer pictures are on their way", "playing=0&samples=1", async (page) => {
  await rest(page);
  await hold_refinement(page, 4);
  await page.locator("#samples").selectOption("64");
  await eventually("4 samples", async () => samples_of(await link_of(page)) === "4");
  const { bytes } = await download(page);
  assert.ok(await eventually("its pixels, once it has faded in", () => shows(page, bytes)));
});

page_test("of a view that moves the picture is downloaded that it will rest with", "samples=16&speed=1", async (page) => {
  await page.locator('#stage[data-shows="stream"]').waitFor();
  assert.equal(samples_of(await link_of(page)), "16");
  const ahead = await page.evaluate(() => {
    document.querySelector('[data-do="up"]').click();
    const link = document.getElementById("download");
    link.dispatchEvent(new Event("focus"));
    return new URL(link.href).searchParams.get("elevation");
  });
  assert.equal(ahead, "22.5");
});

page_test("where nothing is shown there is nothing to download", "playing=0&samples=1", async (page) => {
  await rest(page);
  await page.route(/v1\/scenes$/, () => {}); // never responds
  await page.locator('#gallery button[data-name="glass"]').click();
  assert.equal(await link_of(page), "");
});
