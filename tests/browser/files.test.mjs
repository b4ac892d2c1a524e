#!/usr/bin/env node
// Tests the files of the page as served by the service.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { get } from "node:http";
import { join } from "node:path";
import { after, test } from "node:test";
import { ROOT, startDaemon } from "./support.mjs";

const daemon = await startDaemon();
after(() => daemon.stop());

const MAX_COMPRESSED_BYTES = 85_000;
const files = readdirSync(join(ROOT, "web"));
const source = (file) => readFileSync(join(ROOT, "web", file));

// Resolves to {headers, bytes} of a response, without decompressing it.
function fetchRaw(path, headers) {
  return new Promise((resolve, reject) => {
    get(daemon.url + path, { headers }, (response) => {
      const chunks = [];
      response.on("data", (chunk) => chunks.push(chunk));
      response.on("end", () => resolve({ headers: response.headers, bytes: Buffer.concat(chunks) }));
      response.on("error", reject);
    }).on("error", reject);
  });
}

// Files that the page loads only when they are used: modules of import() and style sheets of other dialogs.
const onDemand = files.filter((file) => !source("index.html").includes(file) && file !== "index.html");

test("a visitor downloads at most 85 kB of compressed files", async () => {
  let total = 0;
  for (const file of files.filter((name) => !onDemand.includes(name))) {
    const { headers, bytes } = await fetchRaw(file, { "Accept-Encoding": "gzip" });
    total += bytes.length;
    if (source(file).length >= 1024) assert.equal(headers["content-encoding"], "gzip", file);
  }
  console.log(`${files.length - onDemand.length} files, ${total} bytes compressed`);
  assert.ok(total <= MAX_COMPRESSED_BYTES, `${total} bytes`);
});

test("files are served unchanged", async () => {
  for (const file of files) assert.ok((await fetchRaw(file, {})).bytes.equals(source(file)), file);
});

test("the content security policy forbids content of other origins", async () => {
  const { headers } = await fetchRaw("", {});
  assert.match(headers["content-security-policy"] ?? "", /default-src 'self'/);
});

// Returns the modules that `file` imports, directly or through others.
function importsOf(file, found = new Set()) {
  for (const [, name] of source(file)
    .toString()
    .matchAll(/^(?:import|export)\b[^;]*? from "\.\/([^"]+)";/gm)) {
    if (found.has(name)) continue;
    found.add(name);
    importsOf(name, found);
  }
  return found;
}

test("the page preloads exactly the modules that it imports", () => {
  const page = source("index.html").toString();
  const links = [...page.matchAll(/<link rel="modulepreload" href="([^"]+)"/g)].map(([, name]) => name);
  assert.deepEqual(links, [...importsOf("app.js")].sort());
  const modules = files.filter((file) => file.endsWith(".js") && file !== "app.js");
  const later = ["app.js", ...links].flatMap((file) =>
    [
      ...source(file)
        .toString()
        .matchAll(/\bimport\("\.\/([^"]+)"\)/g),
    ].map(([, name]) => name),
  );
  const used = new Set([...links, ...later, ...later.flatMap((file) => [...importsOf(file)])]);
  assert.deepEqual([...used].sort(), modules.sort(), "no module is unused");
});
