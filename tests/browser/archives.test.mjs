#!/usr/bin/env node
// Tests the archives of several files that the page sends, without a browser.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { load } from "./web-modules.mjs";

const { chosenOf } = await load("file-opener.js");
const { crc32, zipOf } = await load("zip.js");
const { filesOf } = await load("file-list.js");
const folder = mkdtempSync(join(tmpdir(), "orrery-"));
after(() => rmSync(folder, { recursive: true }));

const bytesOf = (text) => new TextEncoder().encode(text);

test("crc32() has the check value of ISO 3309", () => {
  assert.equal(crc32(bytesOf("123456789")), 0xcbf43926);
  assert.equal(crc32(bytesOf("")), 0);
});

test("another program reads the archive", async (context) => {
  const files = { "a/b ä.txt": "hello", empty: "", "c.bin": "\0\xff".repeat(50_000) };
  const archive = await zipOf(Object.entries(files).map(([path, text]) => ({ path, file: new Blob([text]) })));
  const path = join(folder, "a.zip");
  writeFileSync(path, Buffer.from(await archive.arrayBuffer()));
  const program = `
import json, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
print(json.dumps({name: archive.read(name).decode() for name in archive.namelist()}))`;
  const { error, stdout, stderr } = spawnSync("python3", ["-c", program, path], { encoding: "utf8" });
  if (error) return context.skip("python3 is not installed");
  assert.equal(stderr, "");
  assert.deepEqual(JSON.parse(stdout), files);
});

test("chosenOf() prefers glTF, then fewer folders, and a scene only without models", () => {
  const main = (...paths) => {
    const { main: chosen, isScene } = chosenOf(paths.map((path) => ({ path })));
    return `${chosen.path}${isScene ? " as a scene" : ""}`;
  };
  assert.equal(main("wood.png", "chair.obj", "chair.mtl"), "chair.obj");
  assert.equal(main("a.obj", "x/y/b.GLTF"), "x/y/b.GLTF");
  assert.equal(main("x/a.stl", "b.stl"), "b.stl");
  assert.equal(main("scene.json"), "scene.json as a scene");
  assert.equal(main("package.json", "chair.glb"), "chair.glb");
  assert.equal(main("letter.doc"), "letter.doc");
});

// Returns a folder whose reader gives at most two entries at a time.
const directory = (name, entries) => ({
  name,
  isDirectory: true,
  createReader: () => ({ readEntries: (resolve) => resolve(entries.splice(0, 2)) }),
});
const entry = (fullPath) => ({
  name: fullPath.split("/").at(-1),
  isFile: true,
  fullPath,
  file: (resolve) => resolve(fullPath),
});

test("filesOf() lists the files of folders, without hidden ones", async () => {
  const inner = directory("new", ["/chairs/new/a", "/chairs/new/b", "/chairs/new/c", "/chairs/new/.d"].map(entry));
  const hidden = directory("__MACOSX", [entry("/chairs/__MACOSX/a")]);
  const files = await filesOf([directory("chairs", [inner, hidden, entry("/chairs/e")]), { name: "f" }]);
  const paths = files.map(({ path }) => path);
  assert.deepEqual(paths, ["chairs/new/a", "chairs/new/b", "chairs/new/c", "chairs/e", "f"]);
  await assert.rejects(filesOf([directory("empty", [])]), /No file/);
  const many = directory(
    "many",
    Array.from({ length: 1001 }, (_, at) => entry(`/many/${at}`)),
  );
  await assert.rejects(filesOf([many]), /Too many files/);
});
