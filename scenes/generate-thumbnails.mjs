#!/usr/bin/env node
// Renders the thumbnails of the page's gallery, scenes/thumbnails/NAME.webp:
//   node scenes/generate-thumbnails.mjs [NAME...]     default: all scenes without a thumbnail
// Requires build/orrery and, to write WebP, Chromium with playwright-core.

import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { ROOT, skipWithoutBrowser, startBrowser } from "../tests/browser/support.mjs";
import { load } from "../tests/browser/web-modules.mjs";

const kBox = { width: 384, height: 288 }; // four times the gallery's size in each direction
const kSamples = 256;
const kQuality = 0.8; // WebP quality from 0 to 1

skipWithoutBrowser();
const { pictureSize } = await load("size.js");
const thumbnail = (name) => join(ROOT, `scenes/thumbnails/${name}.webp`);
const all = readdirSync(join(ROOT, "scenes"))
  .filter((file) => file.endsWith(".json"))
  .map((file) => file.slice(0, -5));
const names = process.argv.length > 2 ? process.argv.slice(2) : all.filter((name) => !existsSync(thumbnail(name)));
const folder = mkdtempSync(join(tmpdir(), "thumbnails-"));
const browser = await startBrowser();
try {
  const page = await browser.newPage();
  for (const name of names) {
    const file = join(ROOT, `scenes/${name}.json`);
    const { image, camera } = JSON.parse(readFileSync(file, "utf8"));
    const scene = { width: image?.width ?? 800, height: image?.height ?? 600, camera };
    const limits = { side: 4096, pixels: 2 ** 24 };
    const { width, height, fov } = pictureSize({ mode: "fit", box: kBox, pixelRatio: 1, scene, limits });
    const picture = join(folder, "picture.png");
    const size = ["--width", width, "--height", height, "--samples", kSamples, ...(fov ? ["--fov", fov] : [])];
    execFileSync(join(ROOT, "build/orrery"), ["render", file, ...size.map(String), "-o", picture], {
      cwd: ROOT,
      stdio: "ignore",
    });
    const webp = await page.evaluate(webp_of, [readFileSync(picture).toString("base64"), kQuality]);
    writeFileSync(thumbnail(name), Buffer.from(webp, "base64"));
    console.log(`${thumbnail(name)}: ${Math.round((webp.length * 3) / 4)} bytes`);
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}

// Converts a PNG to WebP, both in base64. Runs in the browser.
async function webp_of([png, quality]) {
  const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  canvas.getContext("2d").drawImage(bitmap, 0, 0);
  const blob = await canvas.convertToBlob({ type: "image/webp", quality });
  return btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer())));
}
