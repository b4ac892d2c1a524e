#!/usr/bin/env node
// Renders glTF models with `orrery view` and with three.js in Chromium, with the same camera and the same lights, and
// arranges both images side by side. three.js casts no shadows and traces no light between surfaces.
//
//   npm install --no-save three
//   node tests/meshes/three_compare.mjs SHEET.jpg MODEL...     prints the RMS difference of the codes, divided by 255

import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, resolve } from "node:path";

import { chromium } from "playwright-core";

import { compareSideBySide, kSide } from "./side_by_side.mjs";

const kTypes = { ".js": "text/javascript", ".glb": "model/gltf-binary", ".gltf": "model/gltf+json" };

const kPage = `<!doctype html><canvas id="canvas"></canvas>
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "addons/": "/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "addons/loaders/GLTFLoader.js";
const canvas = document.getElementById("canvas");
window.show = async (url, { camera: from, lights: [key], environment }) => {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(${kSide}, ${kSide});
  const scene = new THREE.Scene(), radiance = environment.radiance[0];
  scene.background = new THREE.Color().setRGB(radiance, radiance, radiance);
  const sky = new THREE.DataTexture(new Float32Array(64 * 32 * 4).fill(radiance), 64, 32, THREE.RGBAFormat, THREE.FloatType);
  sky.mapping = THREE.EquirectangularReflectionMapping;
  sky.needsUpdate = true;
  scene.environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(sky).texture;
  // A white surface that faces a light of pi lux has radiance 1.
  const light = new THREE.DirectionalLight(0xffffff, Math.PI * key.intensity[0]);
  light.position.set(...key.direction_to_light);
  scene.add(light, (await new GLTFLoader().loadAsync(url)).scene);
  const camera = new THREE.PerspectiveCamera(from.fov_degrees, 1);
  camera.position.set(...from.eye);
  camera.up.set(...from.up);
  camera.lookAt(...from.look_at);
  const distance = camera.position.distanceTo(new THREE.Vector3(...from.look_at));
  Object.assign(camera, { near: distance / 1000, far: distance * 100 }).updateProjectionMatrix();
  renderer.render(scene, camera);
  return canvas.toDataURL("image/png");
};
window.ready = true;
</script>`;

const [sheet, ...models] = process.argv.slice(2);
if (models.length === 0) {
  console.error("usage: node tests/meshes/three_compare.mjs SHEET.jpg MODEL...");
  process.exit(2);
}
const roots = { "/three/": resolve("node_modules/three"), "/model/": "/" };
const server = createServer((request, response) => {
  const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
  const root = Object.keys(roots).find((prefix) => path.startsWith(prefix));
  try {
    const content = root ? readFileSync(join(roots[root], path.slice(root.length))) : kPage;
    response.writeHead(200, {
      "content-type": root ? (kTypes[extname(path)] ?? "application/octet-stream") : "text/html",
    });
    response.end(content);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  await compareSideBySide(sheet, models, async (model, scene, file) => {
    const page = await browser.newPage();
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.waitForFunction(() => globalThis.ready);
    const data = await page.evaluate(([url, from]) => globalThis.show(url, from), [`/model${model}`, scene]);
    writeFileSync(file, Buffer.from(data.split(",")[1], "base64"));
    await page.close();
  });
} finally {
  await browser.close();
  server.close();
}
