#!/usr/bin/env node
// Tests files that the user drops on the page or chooses by the button.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { axeViolations, canvasDigest, dropFiles, eventually, hashOf, pageTests, rest, startBoth } from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);
const folder = mkdtempSync(join(tmpdir(), "orrery-"));
after(() => rmSync(folder, { recursive: true }));

const REST = "scene=paper&playing=0";

// Writes a file of the user and returns its path.
function fileOf(name, content) {
  const path = join(folder, name);
  mkdirSync(join(path, ".."), { recursive: true });
  writeFileSync(path, content);
  return path;
}

const CORNERS = [
  [0, 0, 0],
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const FACES = [
  [0, 2, 1],
  [0, 1, 3],
  [1, 2, 3],
  [0, 3, 2],
];

function tetrahedronObj(head = "") {
  const lines = [
    ...CORNERS.map((at) => `v ${at.join(" ")}`),
    ...FACES.map((at) => `f ${at.map((i) => i + 1).join(" ")}`),
  ];
  return `${head}${lines.join("\n")}\n`;
}

// Returns {json, bin} of a glTF file with the tetrahedron in an external buffer.
function tetrahedronGltf(uri) {
  const bin = Buffer.concat([
    Buffer.from(Float32Array.from(CORNERS.flat()).buffer),
    Buffer.from(Uint32Array.from(FACES.flat()).buffer),
  ]);
  const json = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    buffers: [{ byteLength: bin.length, ...(uri && { uri }) }],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 48 },
      { buffer: 0, byteOffset: 48, byteLength: 48 },
    ],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: "VEC3", min: [0, 0, 0], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5125, count: 12, type: "SCALAR" },
    ],
  };
  return { json, bin };
}

function tetrahedronGlb(extra = {}) {
  const { json, bin } = tetrahedronGltf();
  const text = JSON.stringify({ ...json, ...extra });
  const padded = Buffer.from(text.padEnd(Math.ceil(text.length / 4) * 4));
  const chunk = (type, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length);
    head.write(type, 4, "latin1");
    return Buffer.concat([head, bytes]);
  };
  const chunks = Buffer.concat([chunk("JSON", padded), chunk("BIN\0", bin)]);
  const head = Buffer.from("glTF\x02\0\0\0\0\0\0\0", "latin1");
  head.writeUInt32LE(12 + chunks.length, 8);
  return Buffer.concat([head, chunks]);
}

const card = (page) => page.locator("#file-card");
const title = (page, name) => page.waitForFunction((text) => document.title.startsWith(text), name);
const sceneOf = async (page) => JSON.parse(await page.locator("#text").inputValue());

pageTest("a dropped model is shown turning, under its name, and Back returns", REST, async (page) => {
  const before = await rest(page);
  const zone = page.locator("#drop-zone");
  assert.equal(await zone.isVisible(), false);
  await dropFiles(page, [fileOf("Tetra.glb", tetrahedronGlb())], () => zone.waitFor({ state: "visible" }));
  await title(page, "Tetra.glb");
  assert.equal(await zone.isVisible(), false);
  await page.locator('#stage[data-shows="stream"]').waitFor();
  await eventually("a turn", async () => Number((await hashOf(page)).az) > 0);
  assert.equal(await page.locator("#upload").isVisible(), false);
  assert.equal(await card(page).isVisible(), false);
  const { objects } = await sceneOf(page);
  assert.equal(objects[0].type, "mesh");
  await page.goBack();
  await title(page, "Mirror floor");
  assert.equal(await rest(page), before);
});

pageTest("a link to the model has its name in this tab", REST, async (page) => {
  await rest(page);
  await dropFiles(page, [fileOf("Tetra.glb", tetrahedronGlb())]);
  await title(page, "Tetra.glb");
  await page.reload();
  await title(page, "Tetra.glb");
});

pageTest("the orbit of a long model stays within the image", `${REST}&size=fit`, async (page) => {
  await rest(page);
  const long = tetrahedronObj().replace("v 1 0 0", "v 8 0 0");
  await dropFiles(page, [fileOf("long.obj", long)]);
  await title(page, "long.obj");
  const { camera } = await sceneOf(page);
  const id = (await hashOf(page)).scene;
  const box = await page.locator("#stage").boundingBox();
  const size = [Math.round(box.width / 4), Math.round(box.height / 4)];
  assert.equal(camera.type, "perspective");
  for (const azimuth of [0, 45, 90, 135, 180, 225, 270, 315]) {
    const query = `azimuth=${azimuth}&width=${size[0]}&height=${size[1]}&samples=1&technique=raycast`;
    const edges = await page.evaluate(async (url) => {
      const bitmap = await createImageBitmap(await (await fetch(url)).blob());
      const { width, height } = bitmap;
      const context = new OffscreenCanvas(width, height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      const { data } = context.getImageData(0, 0, width, height);
      const at = (x, y) => data.slice(4 * (y * width + x), 4 * (y * width + x) + 3).join();
      const colours = new Set();
      for (let x = 0; x < width; x += 1) colours.add(at(x, 0)).add(at(x, height - 1));
      for (let y = 0; y < height; y += 1) colours.add(at(0, y)).add(at(width - 1, y));
      return colours.size;
    }, `v1/scenes/${id}/frame.png?${query}`);
    assert.equal(edges, 1, `the edge shows only the background at ${azimuth} degrees`);
  }
});

pageTest("the button opens a file by the keyboard, and notes appear in plain words", REST, async (page) => {
  await rest(page);
  const animated = { animations: [{}], extensionsUsed: ["KHR_none"] };
  const button = page.getByRole("button", { name: "Open a model" });
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), button.press("Enter")]);
  await chooser.setFiles(fileOf("moving.glb", tetrahedronGlb(animated)));
  await title(page, "moving.glb");
  await card(page).waitFor();
  assert.match(await card(page).textContent(), /Notes on moving\.glb.*The model is at rest, without its animation\./);
  assert.deepEqual(await axeViolations(page), []);
  await page.locator("#gallery button").nth(1).click();
  await card(page).waitFor({ state: "hidden" });
});

pageTest(
  "a file that is no model shows the error of the service and keeps the scene",
  "scene=paper",
  async (page) => {
    await page.locator('#stage[data-shows="stream"]').waitFor();
    await dropFiles(page, [fileOf("letter.doc", "Dear Sir or Madam")]);
    await card(page).waitFor();
    const text = await card(page).textContent();
    assert.match(text, /^Cannot open letter\.docThe file must be an OBJ, PLY, STL .* \(got 17 bytes/);
    assert.match(text, /Request ID \S{4,}$/);
    const { az } = await hashOf(page);
    await eventually("a frame", async () => (await hashOf(page)).az !== az);
    assert.equal(await card(page).isVisible(), true, "the next frame keeps the error");
    assert.equal((await hashOf(page)).scene, "paper");
    await card(page).getByRole("button", { name: "Dismiss" }).click();
    await dropFiles(page, [fileOf("empty.glb", "")]);
    await card(page).getByText("The file is empty").waitFor();
  },
  { expected: /status of 422/ },
);

pageTest("a file that is too large is not sent", REST, async (page) => {
  await rest(page);
  await page.route(/v1\/view/, () => assert.fail("sent"));
  await dropFiles(page, [fileOf("large.stl", Buffer.alloc(2 ** 26 + 1))]);
  await card(page).waitFor();
  assert.match(await card(page).textContent(), /The file has 67 MB\. This service accepts at most 67 MB/);
});

pageTest(
  "without permission, the page shows why",
  REST,
  async (page) => {
    await rest(page);
    const problem = { title: "Forbidden", detail: "token has no scope write" };
    await page.route(/v1\/view/, (route) => route.fulfill({ status: 403, json: problem }));
    await dropFiles(page, [fileOf("Tetra.glb", tetrahedronGlb())]);
    await card(page).getByText("token has no scope write").waitFor();
  },
  { expected: /status of 403/ },
);

pageTest(
  "an upload can be cancelled or tried again",
  REST,
  async (page) => {
    const before = await rest(page);
    await page.route(/v1\/view/, () => {}, { times: 1 }); // no response
    const paths = [fileOf("Tetra.glb", tetrahedronGlb())];
    await dropFiles(page, paths);
    await page.locator("#upload").waitFor();
    assert.match(await page.locator("#upload-text").textContent(), /(Uploading|Reading) Tetra\.glb/);
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.locator("#upload").waitFor({ state: "hidden" });
    assert.equal(await canvasDigest(page), before);
    assert.equal(await card(page).isVisible(), false);
    await page.route(/v1\/view/, (route) => route.abort(), { times: 1 });
    await dropFiles(page, paths);
    await card(page).getByRole("button", { name: "Try again" }).click();
    await title(page, "Tetra.glb");
  },
  { expected: /net::ERR_/ },
);

pageTest(
  "a dropped scene is shown, and a broken one shows the places of its errors",
  REST,
  async (page) => {
    await rest(page);
    const scene = await sceneOf(page);
    const radius = (value) => JSON.stringify({ ...scene, objects: [{ ...scene.objects[0], radius: value }] });
    await dropFiles(page, [fileOf("wrong.json", radius(-77))]);
    await card(page).waitFor();
    assert.match(await card(page).textContent(), /Cannot open wrong\.json.*\/objects\/0\/radius/);
    await dropFiles(page, [fileOf("right.json", radius(0.25))]);
    await eventually("the scene", async () => (await sceneOf(page)).objects[0].radius === 0.25);
    assert.equal(await card(page).isVisible(), false);
    assert.equal((await hashOf(page)).playing, "0");
  },
  { expected: /status of 4/ },
);

pageTest("an OBJ file and its materials are opened together", REST, async (page) => {
  await rest(page);
  const head = ["mtllib Paint.mtl", "usemtl red", ""].join("\n");
  const model = fileOf("pair/tetra.obj", tetrahedronObj(head));
  const material = fileOf("pair/Paint.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
  await dropFiles(page, [material, model]);
  await title(page, "tetra.obj");
  await page.locator('#stage[data-shows="stream"]').waitFor();
  const { asset } = (await sceneOf(page)).objects[0];
  const sent = await (await fetch(`${daemon.url}v1/assets/${asset}`)).text();
  assert.ok(sent.startsWith("PK\x03\x04") && sent.includes("newmtl red"));
});

pageTest("a dropped folder is opened with the files below it", REST, async (page) => {
  await rest(page);
  const { json, bin } = tetrahedronGltf("data/corners%20ä.bin");
  fileOf("Chair/chair.gltf", JSON.stringify(json));
  fileOf("Chair/data/corners ä.bin", bin);
  fileOf("Chair/.cache.obj", "not a model");
  await dropFiles(page, [join(folder, "Chair")]);
  await title(page, "chair.gltf");
  assert.equal((await sceneOf(page)).objects[0].type, "mesh");
});

pageTest("the button opens several files", REST, async (page) => {
  await rest(page);
  const { json, bin } = tetrahedronGltf("corners.bin");
  const model = fileOf("several/chair.gltf", JSON.stringify(json));
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator("#open-files").click()]);
  await chooser.setFiles([model, fileOf("several/corners.bin", bin)]);
  await title(page, "chair.gltf");
});

pageTest(
  "a model whose files are missing, and several models, show the reason",
  REST,
  async (page) => {
    await rest(page);
    const { json } = tetrahedronGltf("corners.bin");
    await dropFiles(page, [fileOf("alone/chair.gltf", JSON.stringify(json))]);
    await card(page).getByText("corners.bin").waitFor();
    await dropFiles(
      page,
      ["a.obj", "b.obj"].map((name) => fileOf(`two/${name}`, tetrahedronObj())),
    );
    await card(page).getByText('Archive must contain one model (got 2: "a.obj", "b.obj").').waitFor();
  },
  { expected: /status of 422/ },
);
