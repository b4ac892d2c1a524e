#!/usr/bin/env node
// Writes two evening skies to its own folder: sky.hdr with a sun, and dusk.hdr without. Each has 128 x 64
// texels (equirectangular, Radiance HDR, flat RGBE) with a band of cloud and dark ground.

import { writeFileSync } from "node:fs";

const kWidth = 128,
  kHeight = 64;
const kSun = [-0.62, 0.3, -0.72]; // direction: +y is up, -z is the middle of the picture

const mix = (a, b, share) => a.map((value, i) => value + (b[i] - value) * share);
const smooth = (from, to, x) => {
  const t = Math.min(1, Math.max(0, (x - from) / (to - from)));
  return t * t * (3 - 2 * t);
};

function radiance(column, row, sun) {
  const down = ((row + 0.5) / kHeight) * Math.PI,
    turn = ((column + 0.5) / kWidth - 0.5) * 2 * Math.PI;
  const direction = [Math.sin(down) * Math.sin(turn), Math.cos(down), -Math.sin(down) * Math.cos(turn)];
  const [, height] = direction;
  if (height < 0) return mix([0.1, 0.075, 0.06], [0.03, 0.025, 0.025], smooth(0, -0.4, height));
  const length = Math.hypot(...kSun);
  const near = direction.reduce((sum, value, i) => sum + (value * kSun[i]) / length, 0);
  let sky = mix([0.95, 0.52, 0.3], [0.1, 0.16, 0.42], smooth(0, 0.75, height));
  sky = mix(sky, [1.9, 1.05, 0.5], 0.8 * Math.max(0, near) ** 12);
  const cloud =
    smooth(0.55, 0.95, 0.5 + 0.5 * Math.sin(3 * turn + 5 * Math.sin(9 * height) + 1)) *
    smooth(0.16, 0.26, height) *
    smooth(0.5, 0.34, height);
  sky = mix(sky, [1.1, 0.72, 0.62], 0.6 * cloud);
  return sun && near > Math.cos(0.1) ? [150, 104, 56] : sky;
}

// Returns RGBE with a shared exponent: the largest channel has a mantissa of 128..255.
function rgbe(color) {
  const exponent = Math.floor(Math.log2(Math.max(...color))) + 1;
  return [...color.map((value) => Math.min(255, Math.floor(value * 2 ** (8 - exponent)))), exponent + 128];
}

const header = `#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${kHeight} +X ${kWidth}\n`;
for (const [name, sun] of [
  ["sky.hdr", true],
  ["dusk.hdr", false],
]) {
  const texels = [];
  for (let row = 0; row < kHeight; ++row)
    for (let column = 0; column < kWidth; ++column) texels.push(...rgbe(radiance(column, row, sun)));
  writeFileSync(new URL(name, import.meta.url), Buffer.concat([Buffer.from(header), Buffer.from(texels)]));
}
