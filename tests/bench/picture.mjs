// Reads linear images from OpenEXR files and compares them.

import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

const MAGIC = 20000630,
  VERSION = 2,
  LONG_NAMES = 0x400,
  FLOAT = 2;
const LINES_OF = { 0: 1, 2: 1, 3: 16 }; // scan lines per block, by compression: none, ZIPS, ZIP

// Returns the attributes of the header by name, as the bytes of their values, and the offset of the header's
// end.
function readHeader(file) {
  const attributes = {};
  let at = 8;
  const word = () => {
    const end = file.indexOf(0, at);
    const found = file.toString("latin1", at, end);
    at = end + 1;
    return found;
  };
  for (let name = word(); name; name = word()) {
    word(); // the type, which the name implies
    const size = file.readInt32LE(at);
    attributes[name] = file.subarray(at + 4, at + 4 + size);
    at += 4 + size;
  }
  return { attributes, end: at };
}

// Returns the names of the channels in the order of the file. Throws Error unless all are 32-bit floats.
function channelsOf(list) {
  const names = [];
  for (let at = 0; list[at] !== 0;) {
    const end = list.indexOf(0, at);
    names.push(list.toString("latin1", at, end));
    if (list.readInt32LE(end + 1) !== FLOAT) throw new Error("channels must be 32-bit floats");
    at = end + 17;
  }
  return names;
}

// Inflates a ZIP or ZIPS block and undoes its predictor: even bytes come before odd bytes, and each byte is
// the difference from the previous byte.
function unpack(packed) {
  const bytes = inflateSync(packed),
    half = (bytes.length + 1) >> 1,
    unpacked = Buffer.alloc(bytes.length);
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1] - 128;
  for (let i = 0; i < bytes.length; ++i) unpacked[i] = bytes[(i >> 1) + (i & 1 ? half : 0)];
  return unpacked;
}

// Returns {width, height, values}: R, G and B of each pixel, row by row from the top. Throws Error unless the
// file is a single-part scan line image of floats, uncompressed or compressed by ZIP or ZIPS.
export function readExr(path) {
  const file = readFileSync(path);
  const isPlain = file.readInt32LE(0) === MAGIC && (file.readInt32LE(4) & ~LONG_NAMES) === VERSION;
  if (!isPlain) throw new Error(`${path}: must be a single-part OpenEXR image in scan lines`);
  const { attributes, end } = readHeader(file);
  const [left, top, right, bottom] = [0, 4, 8, 12].map((at) => attributes.dataWindow.readInt32LE(at));
  const width = right - left + 1,
    height = bottom - top + 1;
  const channels = channelsOf(attributes.channels),
    lines = LINES_OF[attributes.compression[0]];
  if (!lines) throw new Error(`${path}: compression must be none, ZIPS or ZIP`);
  const places = channels.map((name) => "RGB".indexOf(name)); // -1 for a channel that is not read
  const values = new Float32Array(3 * width * height),
    lineBytes = 4 * width * channels.length;
  for (let block = 0; block * lines < height; ++block) {
    const at = Number(file.readBigUInt64LE(end + 8 * block)),
      size = file.readInt32LE(at + 4);
    const first = file.readInt32LE(at) - top,
      count = Math.min(lines, height - first);
    const stored = file.subarray(at + 8, at + 8 + size);
    const bytes = size < count * lineBytes ? unpack(stored) : stored;
    for (let i = 0; i < count * channels.length; ++i) {
      const row = first + Math.floor(i / channels.length),
        place = places[i % channels.length];
      if (place < 0) continue;
      for (let x = 0; x < width; ++x) values[3 * (row * width + x) + place] = bytes.readFloatLE(4 * (i * width + x));
    }
  }
  return { width, height, values };
}

// Returns the image of the means over blocks of side x side pixels. REQUIRES: width and height are multiples
// of side.
export function blockMeans({ width, height, values }, side) {
  if (side === 1) return { width, height, values };
  const across = width / side,
    means = new Float64Array((3 * across * height) / side);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      for (let c = 0; c < 3; ++c)
        means[3 * (Math.floor(y / side) * across + Math.floor(x / side)) + c] +=
          values[3 * (y * width + x) + c] / side ** 2;
  return { width: across, height: height / side, values: means };
}

// Returns the mean of (a - b) (c - d) over pixels and channels. REQUIRES: all images have the same size.
export function meanProduct(a, b, c, d) {
  let sum = 0;
  for (let i = 0; i < a.values.length; ++i) sum += (a.values[i] - b.values[i]) * (c.values[i] - d.values[i]);
  return sum / a.values.length;
}

// Returns the mean of (a - b) (c - d) and its standard error, estimated from the variation between pixels.
// The channels of a pixel are averaged.
export function productStatistics(a, b, c, d) {
  const pixels = a.values.length / 3;
  let sum = 0,
    squares = 0;
  for (let i = 0; i < pixels; ++i) {
    let product = 0;
    for (let j = 3 * i; j < 3 * i + 3; ++j) product += ((a.values[j] - b.values[j]) * (c.values[j] - d.values[j])) / 3;
    sum += product;
    squares += product ** 2;
  }
  const mean = sum / pixels;
  return { mean, error: Math.sqrt((squares / pixels - mean ** 2) / pixels) };
}

// Returns the means of R, G and B over the picture.
export function channelMeans({ values }) {
  const sums = [0, 0, 0];
  values.forEach((value, i) => (sums[i % 3] += value));
  return sums.map((sum) => (3 * sum) / values.length);
}

export function meanPicture(pictures) {
  const { width, height } = pictures[0],
    values = new Float64Array(3 * width * height);
  for (const picture of pictures) picture.values.forEach((value, i) => (values[i] += value / pictures.length));
  return { width, height, values };
}
