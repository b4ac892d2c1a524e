#!/usr/bin/env node
// Compares the glTF reader with gltf-validator, the validator of Khronos: models of one feature each, and models with
// one damaged value each. Files without errors must be read, and files with an error rejected, unless they are
// listed here with the reason. Exits with 77 if the package is not installed.
//
//   node tests/meshes/validator.test.mjs [--list]     --list: prints one line per file

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { kFeatures, model, square } from "./gltf_models.mjs";

const kProgram = process.env.TEST_ORRERY ?? "build/orrery";

const validator = await import("gltf-validator").then(
  (module) => module.default,
  () => process.exit(77),
);

const first = (g) => g.meshes[0].primitives[0];
const accessor = (g, name) => g.accessors[first(g).attributes[name]];
const textured = { pbrMetallicRoughness: { baseColorTexture: { index: 0 } } };

// Changes of one value of a valid document, by name.
const kDamage = {
  "asset missing": (g) => delete g.asset,
  "version 1.0": (g) => (g.asset.version = "1.0"),
  "version a number": (g) => (g.asset.version = 2),
  "unknown required extension": (g) => {
    g.extensionsUsed = g.extensionsRequired = ["EXT_unknown_geometry"];
  },
  "scene out of range": (g) => (g.scene = 1),
  "scene negative": (g) => (g.scene = -1),
  "scene a text": (g) => (g.scene = "0"),
  "scene node out of range": (g) => (g.scenes[0].nodes = [7]),
  "node cycle": (g) => (g.nodes[0].children = [0]),
  "node with two parents": (g) => {
    g.nodes = [{ children: [1] }, { mesh: 0 }, { children: [1] }];
    g.scenes[0].nodes = [0, 2];
  },
  "node mesh out of range": (g) => (g.nodes[0].mesh = 3),
  "node matrix of 15 numbers": (g) => (g.nodes[0].matrix = Array(15).fill(1)),
  "node rotation of 3 numbers": (g) => (g.nodes[0].rotation = [0, 0, 1]),
  "node scale a text": (g) => (g.nodes[0].scale = ["1", "1", "1"]),
  "node matrix and scale": (g) =>
    Object.assign(g.nodes[0], { matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], scale: [2, 2, 2] }),
  "primitives missing": (g) => delete g.meshes[0].primitives,
  "primitives empty": (g) => (g.meshes[0].primitives = []),
  "mode 7": (g) => (first(g).mode = 7),
  "mode negative": (g) => (first(g).mode = -1),
  "attributes missing": (g) => delete first(g).attributes,
  "position out of range": (g) => (first(g).attributes.POSITION = 40),
  "position of two components": (g) => (first(g).attributes.POSITION = first(g).attributes.TEXCOORD_0),
  "position of bytes": (g) => (accessor(g, "POSITION").componentType = 5121),
  "normal of other count": (g) => (accessor(g, "NORMAL").count = 3),
  "coordinates of other count": (g) => (accessor(g, "TEXCOORD_0").count = 2),
  "colour of other count": (g) => (accessor(g, "COLOR_0").count = 1),
  "indices out of range": (g) => (first(g).indices = 40),
  "indices of floats": (g) => (g.accessors[first(g).indices].componentType = 5126),
  "indices of 4 entries": (g) => (g.accessors[first(g).indices].count = 4),
  "index beyond vertices": (g) => (accessor(g, "POSITION").count = accessor(g, "NORMAL").count = 2),
  "material out of range": (g) => (first(g).material = 4),
  "material negative": (g) => (first(g).material = -1),
  "accessor count 0": (g) => (accessor(g, "POSITION").count = 0),
  "accessor count a fraction": (g) => (accessor(g, "POSITION").count = 3.5),
  "accessor count missing": (g) => delete accessor(g, "POSITION").count,
  "accessor type unknown": (g) => (accessor(g, "POSITION").type = "VEC9"),
  "accessor component type unknown": (g) => (accessor(g, "POSITION").componentType = 5124),
  "accessor view out of range": (g) => (accessor(g, "POSITION").bufferView = 40),
  "accessor beyond its view": (g) => (accessor(g, "POSITION").byteOffset = 12),
  "accessor huge": (g) => (accessor(g, "POSITION").count = 2 ** 40),
  "sparse of too many": (g) => {
    accessor(g, "POSITION").sparse = {
      count: 9,
      indices: { bufferView: 0, componentType: 5123 },
      values: { bufferView: 0 },
    };
  },
  "view buffer out of range": (g) => (g.bufferViews[0].buffer = 1),
  "view beyond its buffer": (g) => (g.bufferViews[0].byteOffset = 1e6),
  "view length missing": (g) => delete g.bufferViews[0].byteLength,
  "view length 0": (g) => (g.bufferViews[0].byteLength = 0),
  "view stride 1": (g) => (g.bufferViews[0].byteStride = 1),
  "buffer longer than its bytes": (g) => (g.buffers[0].byteLength = 1e6),
  "buffer length missing": (g) => delete g.buffers[0].byteLength,
  "buffer not in base64": (g) => (g.buffers[0].uri = "data:application/octet-stream;base64,%%%"),
  "texture out of range": (g) => (g.materials[0].pbrMetallicRoughness.baseColorTexture.index = 9),
  "texture index missing": (g) => delete g.materials[0].pbrMetallicRoughness.baseColorTexture.index,
  "texture image out of range": (g) => (g.textures[0].source = 9),
  "texture sampler out of range": (g) => (g.textures[0].sampler = 9),
  "sampler wrap unknown": (g) => {
    g.textures[0].sampler = 0;
    g.samplers[0].wrapS = 1;
  },
  "base color of 2": (g) => (g.materials[0].pbrMetallicRoughness.baseColorFactor = [2, 1, 1, 1]),
  "base color of 2 numbers": (g) => (g.materials[0].pbrMetallicRoughness.baseColorFactor = [1, 1]),
  "roughness of -1": (g) => (g.materials[0].pbrMetallicRoughness.roughnessFactor = -1),
  "metalness a text": (g) => (g.materials[0].pbrMetallicRoughness.metallicFactor = "1"),
  "emission of -1": (g) => (g.materials[0].emissiveFactor = [-1, 0, 0]),
  "alpha mode unknown": (g) => (g.materials[0].alphaMode = "GLASS"),
  "alpha cutoff negative": (g) => Object.assign(g.materials[0], { alphaMode: "MASK", alphaCutoff: -1 }),
  "materials an object": (g) => (g.materials = {}),
  "images an object": (g) => (g.images = {}),
  "meshes missing": (g) => delete g.meshes,
  "accessors missing": (g) => delete g.accessors,
  "document an array": () => [],
};

// Verdicts that differ on purpose, with the reason: files with errors that are read, and files without errors that
// are rejected.
const kRead = new Map([
  ["node matrix and scale", "the matrix is used"],
  ["position of bytes", "integers are read without KHR_mesh_quantization, too"],
]);
const kRejected = new Map([
  ["unknown required extension", "the image would lack what the extension adds"],
  ["indices of 4 entries", "the last triangle is not complete"],
  ["sampler wrap unknown", "the specification does not define the value"],
  ["alpha mode unknown", "the specification does not define the value"],
]);

const folder = mkdtempSync(join(tmpdir(), "orrery-"));
const list = process.argv.includes("--list");
let files = 0,
  problems = 0;

async function check(name, bytes, ending) {
  ++files;
  const path = join(folder, `model${ending}`);
  writeFileSync(path, bytes);
  const report = await validator
    .validateBytes(new Uint8Array(bytes), { externalResourceFunction: () => Promise.reject(new Error("none")) })
    .catch((error) => ({ issues: { numErrors: 1, messages: [{ severity: 0, code: String(error), pointer: "" }] } }));
  const errors = report.issues.messages.filter(({ severity }) => severity === 0);
  const { status, stderr } = spawnSync(kProgram, ["inspect", path], { encoding: "utf8", timeout: 60_000 });
  const isValid = (errors.length === 0 || kRead.has(name)) && !kRejected.has(name);
  const agrees = status === (isValid ? 0 : 2);
  if (!agrees) ++problems;
  if (list || !agrees) {
    const found = errors.map(({ code, pointer }) => `${code} ${pointer}`).join(", ") || "no error";
    console.log(
      `${agrees ? "same" : "problem"}  ${name}${ending}: validator: ${found}; orrery: ${status} ${stderr.trim()}`,
    );
  }
}

try {
  for (const name of Object.keys(kFeatures)) {
    const { glb, json } = model(name);
    await check(name, glb, ".glb");
    await check(name, Buffer.from(JSON.stringify(json)), ".gltf");
  }
  for (const [name, damage] of Object.entries(kDamage)) {
    const json = square(structuredClone(textured)).gltf();
    const changed = damage(json);
    await check(name, Buffer.from(JSON.stringify(Array.isArray(changed) ? changed : json)), ".gltf");
  }
} finally {
  rmSync(folder, { recursive: true, force: true });
}
console.log(
  `${files - problems} of ${files} files have the expected verdict, all but ${kRead.size + kRejected.size} that of gltf-validator`,
);
process.exit(problems > 0 ? 1 : 0);
