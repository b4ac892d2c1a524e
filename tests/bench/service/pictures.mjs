// Small image files that are expensive to decode. `number` makes each file different, so that the service
// cannot reuse a stored asset.

import { createHash } from "node:crypto";
import { deflateSync } from "node:zlib";

const SIDE = [16384, 2048];

const u16 = (value) => [value >> 8, value & 255];
function u32(value) {
  const bytes = Buffer.alloc(4);
  bytes.writeUInt32BE(value);
  return bytes;
}

const segment = (marker, bytes) => Buffer.from([0xff, marker, ...u16(bytes.length + 2), ...bytes]);

// Returns the bytes of a progressive scan in which all `blocks` are empty: end-of-band runs of up to 32,767
// blocks each.
function endOfBandRuns(blocks) {
  let bits = "";
  let left = blocks;
  for (; left >= 32767; left -= 32767) bits += "0" + "1".repeat(14);
  if (left >= 16384) bits += "0" + (left - 16384).toString(2).padStart(14, "0");
  else bits += "10".repeat(left);
  bits = bits.padEnd(8 * Math.ceil(bits.length / 8), "1");
  const bytes = [];
  for (let i = 0; i < bits.length; i += 8) {
    bytes.push(parseInt(bits.slice(i, i + 8), 2));
    if (bytes.at(-1) === 255) bytes.push(0);
  }
  return bytes;
}

// Returns a progressive JPEG with 33 million pixels and 4 components in about 360 bytes, for which libjpeg
// allocates 268 MB of coefficients. `rounds`: number of scans per component. Decoding time is proportional to
// this number.
export function tinyJpeg(number, rounds = 1) {
  const [width, height] = SIDE;
  const components = [1, 2, 3, 4];
  const blocks = (width / 8) * (height / 8);
  const codes = endOfBandRuns(blocks);
  const scan = (id) => [segment(0xda, [1, id, 0, 1, 63, 0]), Buffer.from(codes)];
  return Buffer.concat([
    Buffer.from([0xff, 0xd8]),
    segment(0xfe, Buffer.from(`number ${number}`)),
    segment(0xdb, [0, ...Array(64).fill(1)]),
    segment(0xc2, [8, ...u16(height), ...u16(width), 4, ...components.flatMap((id) => [id, 0x11, 0])]),
    segment(0xc4, [0x10, 1, 1, ...Array(14).fill(0), 0xe0, 0x00]),
    ...Array.from({ length: rounds }, () => components.flatMap(scan)).flat(),
    Buffer.from([0xff, 0xd9]),
  ]);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 && 0xedb88320);
  }
  return ~crc >>> 0;
}

const chunk = (type, bytes) => {
  const named = Buffer.concat([Buffer.from(type), bytes]);
  return Buffer.concat([u32(bytes.length), named, u32(crc32(named))]);
};

// Returns a PNG of 8x8 pixels with `count` compressed texts of 7.9 MB each.
export function textPng(number, count = 5) {
  const text = deflateSync(`${String(number).padStart(8, "0")}${"a".repeat(7_900_000)}`);
  const texts = Array.from({ length: count }, (_, i) => chunk("zTXt", Buffer.concat([Buffer.from(`k${i}\0\0`), text])));
  return Buffer.concat([
    Buffer.from("\x89PNG\r\n\x1a\n", "latin1"),
    chunk("IHDR", Buffer.from([...u32(8), ...u32(8), 8, 0, 0, 0, 0])),
    ...texts,
    chunk("IDAT", deflateSync(Buffer.alloc(72))),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

// Returns an OpenEXR header with `count` additional attributes, without pixels.
export function manyAttributesExr(number, count = 2500) {
  const attribute = (name, type, bytes) => {
    const size = Buffer.alloc(4);
    size.writeInt32LE(bytes.length);
    return Buffer.concat([Buffer.from(`${name}\0${type}\0`), size, Buffer.from(bytes)]);
  };
  const box = [0, 0, 0, 0, 0, 0, 0, 0, 15, 0, 0, 0, 15, 0, 0, 0];
  const one = [0, 0, 0x80, 0x3f];
  return Buffer.concat([
    Buffer.from([0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]),
    attribute("channels", "chlist", [0x52, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0]),
    attribute("compression", "compression", [0]),
    attribute("dataWindow", "box2i", box),
    attribute("displayWindow", "box2i", box),
    attribute("lineOrder", "lineOrder", [0]),
    attribute("pixelAspectRatio", "float", one),
    attribute("screenWindowCenter", "v2f", [...Array(8).fill(0)]),
    attribute("screenWindowWidth", "float", one),
    ...Array.from({ length: count }, (_, i) => attribute(`a${number}.${i}`, "int", [0, 0, 0, 0])),
    Buffer.from([0]),
  ]);
}

export const assetPath = (bytes) => `/v1/assets/${createHash("sha256").update(bytes).digest("hex")}`;
export const putAsset = (bytes) => ({ method: "PUT", path: assetPath(bytes), body: bytes });
