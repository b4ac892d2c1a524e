#!/usr/bin/env node
// Responses of the service as the page parses them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./web_modules.mjs";

const { get_json, server_timing } = await load("api.js");

test("an answer that breaks off is a failure worth a new attempt", async (context) => {
  const body = new ReadableStream({ start: (stream) => stream.error(new TypeError("network error")) });
  context.mock.method(globalThis, "fetch", async () => new Response(body));
  await assert.rejects(get_json("v1/limits"), ({ status, retryable }) => status === 0 && retryable);
});

test("Server-Timing is read by name", () => {
  assert.deepEqual(server_timing('load;dur=0.1, render;desc="x";dur=12.5, cached'), {
    load: 0.1,
    render: 12.5,
  });
  assert.deepEqual(server_timing(null), {});
});
