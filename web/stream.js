// Reads application/x-orrery-frames: [4 bytes, big-endian: length of the header][header, JSON][PNG],
// repeated. The header's `bytes` is the length of the PNG.

import { toApiError, connectionError } from "./api.js";

export const FRAME_TYPE = "application/x-orrery-frames";
const MAX_HEADER_BYTES = 64 * 1024;
const MAX_PICTURE_BYTES = 256 * 1024 * 1024;

function check(sound) {
  if (!sound) throw new Error("The stream contains data that is not a frame");
}

// Incremental parser that returns complete frames.
export class FrameParser {
  #chunks = []; // unparsed bytes, in order
  #size = 0; // total length of #chunks
  #header = null; // header of the frame whose PNG is incomplete
  #headerLength = -1;

  // Returns the frames {header, png} that `chunk` completes. Throws Error if the bytes are malformed.
  push(chunk) {
    this.#chunks.push(chunk);
    this.#size += chunk.length;
    const frames = [];
    for (let frame = this.#next(); frame; frame = this.#next()) frames.push(frame);
    return frames;
  }

  get insideFrame() {
    return this.#size > 0 || this.#header !== null || this.#headerLength >= 0;
  }

  #next() {
    if (this.#headerLength < 0) {
      const bytes = this.#take(4);
      if (!bytes) return null;
      this.#headerLength = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0);
      check(this.#headerLength <= MAX_HEADER_BYTES);
    }
    if (!this.#header) {
      const bytes = this.#take(this.#headerLength);
      if (!bytes) return null;
      this.#header = JSON.parse(new TextDecoder().decode(bytes));
      const length = this.#header.bytes;
      check(Number.isInteger(length) && length >= 0 && length <= MAX_PICTURE_BYTES);
    }
    const png = this.#take(this.#header.bytes);
    if (!png) return null;
    const frame = { header: this.#header, png };
    this.#header = null;
    this.#headerLength = -1;
    return frame;
  }

  // Returns the next `count` bytes as one array, or null if fewer have arrived. Copies only across chunks.
  #take(count) {
    if (this.#size < count) return null;
    this.#size -= count;
    if (count === 0) return new Uint8Array(0);
    if (this.#chunks[0].length >= count) return this.#takeFromFirst(count);
    const bytes = new Uint8Array(count);
    for (let filled = 0; filled < count;) {
      const part = this.#takeFromFirst(Math.min(this.#chunks[0].length, count - filled));
      bytes.set(part, filled);
      filled += part.length;
    }
    return bytes;
  }

  #takeFromFirst(count) {
    const first = this.#chunks[0];
    if (first.length === count) return this.#chunks.shift();
    this.#chunks[0] = first.subarray(count);
    return first.subarray(0, count);
  }
}

// Returns the header's figures under the names that the page uses.
export const figuresOf = ({ render_ms: renderMs, encode_ms: encodeMs, azimuth_degrees: azimuth, ...figures }) => ({
  ...figures,
  renderMs,
  encodeMs,
  azimuth,
});

// Yields the frames of a response body as they arrive. Throws ApiError if the body is truncated, Error if it
// is malformed.
export async function* readFrames(body) {
  const parser = new FrameParser();
  for await (const chunk of chunks(body)) yield* parser.push(chunk);
  if (parser.insideFrame) throw connectionError("The stream ended inside a frame.");
}

// Yields the chunks of a response body as they arrive.
export async function* chunks(body) {
  const reader = body.getReader();
  try {
    for (;;) {
      const { done, value } = await read(reader);
      if (done) return;
      yield value;
    }
  } finally {
    reader.cancel().catch(() => {}); // rejects if the connection is already closed
  }
}

async function read(reader) {
  try {
    return await reader.read();
  } catch (error) {
    throw toApiError(error);
  }
}
