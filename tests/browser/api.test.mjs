#!/usr/bin/env node
// Tests how the page parses responses of the service.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./web-modules.mjs";

const { getJson, serverTiming } = await load("api.js");

test("a truncated response is a retryable error", async (context) => {
  const body = new ReadableStream({ start: (stream) => stream.error(new TypeError("network error")) });
  context.mock.method(globalThis, "fetch", async () => new Response(body));
  await assert.rejects(getJson("v1/limits"), ({ status, retryable }) => status === 0 && retryable);
});

test("Server-Timing is parsed by name", () => {
  assert.deepEqual(serverTiming('load;dur=0.1, render;desc="x";dur=12.5, cached'), {
    load: 0.1,
    render: 12.5,
  });
  assert.deepEqual(serverTiming(null), {});
});
