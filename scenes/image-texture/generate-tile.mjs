#!/usr/bin/env node
// Writes tile.png to its own folder: a glazed tile of 64 x 64 texels, 8-bit sRGB, with a letter-like mark that
// shows its orientation.

import { writeFileSync } from "node:fs";
import { crc32, deflateSync } from "node:zlib";

const kSide = 64;

function color(x, y) {
  const u = (x + 0.5) / kSide - 0.5,
    v = 0.5 - (y + 0.5) / kSide;
  if (Math.max(Math.abs(u), Math.abs(v)) > 0.46) return [196, 190, 178]; // joint
  const radius = Math.hypot(u, v),
    petals = 0.25 + 0.1 * Math.cos(6 * Math.atan2(v, u));
  if (radius < 0.06) return [236, 196, 64];
  if (radius < petals) return [28, 70, 150];
  if (u > 0.22 && v > 0.22 && u + v < 0.72) return [190, 60, 40]; // upper right corner
  return [236, 232, 222];
}

function chunk(name, data) {
  const body = Buffer.concat([Buffer.from(name, "latin1"), data]);
  const ends = Buffer.alloc(8);
  ends.writeUInt32BE(data.length, 0);
  ends.writeUInt32BE(crc32(body), 4);
  return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
}

const rows = [];
for (let y = 0; y < kSide; ++y) {
  rows.push(0); // no filter
  for (let x = 0; x < kSide; ++x) rows.push(...color(x, y));
}
const header = Buffer.alloc(13);
header.writeUInt32BE(kSide, 0);
header.writeUInt32BE(kSide, 4);
header.set([8, 2, 0, 0, 0], 8); // 8 bits, red green blue
const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
const file = Buffer.concat([
  signature,
  chunk("IHDR", header),
  chunk("IDAT", deflateSync(Buffer.from(rows), { level: 9 })),
  chunk("IEND", Buffer.alloc(0)),
]);
writeFileSync(new URL("tile.png", import.meta.url), file);
