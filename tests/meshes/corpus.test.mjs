#!/usr/bin/env node
// Reads the OBJ, PLY, STL, 3MF and glTF files of Debian's assimp-testmodels, which were not made for this project, and
// compares bounds and triangles with assimp (assimp-utils). For glTF files it computes them itself, because
// `assimp info` combines nested transforms in the wrong order and counts shared meshes once. A file must be read,
// or rejected for the cause that is listed here. Exits with 77 if the packages are not installed.
//
//   node tests/meshes/corpus.test.mjs [--list]     --list: prints one line per file

import { spawnSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { basename, dirname, join, relative } from "node:path";

const kFolder = "/usr/share/assimp/models";
const kProgram = process.env.TEST_ORRERY ?? "build/orrery";

// Files that are rejected, by the end of their path, and a part of the error.
const kNoSurface = "mesh must have at least 1 triangle";
const kOldGltf = "/asset/version: must be";
const kRejected = new Map([
  // Invalid files.
  ["number_formats.obj", "v must be a finite number"],
  ["malformed.obj", "v of a corner must be from 1 to 8"],
  ["malformed2.obj", "face must have at least 3 corners"],
  ["empty.obj", "must be an OBJ, PLY, STL"],
  ["empty.ply", "must be an OBJ, PLY, STL"],
  ["pond.0.ply", 'element "vertex" must have 70051 entries'],
  ["BoxWithInfinites.glb", "coordinates must be at most"],
  ["AllIndicesOutOfRange.gltf", "indices must be integers"],
  ["IndexOutOfRange.gltf", "indices must be integers"],
  ["MissingBin/BoxTextured.gltf", "/buffers/0/uri: cannot read"],
  ["RecursiveNodes.gltf", "nodes must form a tree"],
  ["sceneWrongType.gltf", "/scene: must be an integer"],
  ["badArray.gltf", "/meshes/0/primitives: must be an array"],
  ["badExtension.gltf", "KHR_texture_transform: must be an object"],
  ["badNumber.gltf", '/materials/0/normalTexture: missing key "index"'],
  ["badObject.gltf", "/materials/0/pbrMetallicRoughness: must be an object"],
  ["badUint.gltf", "/materials/0/pbrMetallicRoughness/baseColorTexture/index: must be an integer"],
  ["IncorrectVertexArrays/Cube.gltf", "a multiple of 3 in mode 4 (got 35)"],
  // Files without surfaces.
  ...["00", "01", "02", "03", "07", "08", "09", "10"].map((mode) => [
    `Mesh_PrimitiveMode_${mode}.gltf`,
    "primitives of points or lines are not rendered",
  ]),
  ["point_cloud.obj", kNoSurface],
  ["testline.obj", kNoSurface],
  ["testpoints.obj", kNoSurface],
  ["points.ply", kNoSurface],
  ["issue623.ply", "must be an integer"],
  ["NoScene.gltf", 'missing key "nodes"'],
  ["SceneWithoutNodes.gltf", 'missing key "nodes"'],
  // Not supported.
  ["BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", "KHR_technique_webgl"],
  ["glTF/BoxTextured-glTF-Binary/BoxTextured.glb", "must be GLB version 2"],
]);

// Compressed files, by the end of their path, with an uncompressed file of the same model. Quantization moves bounds
// by up to 2^-12 of the size. Encoders remove triangles without area.
const kUncompressed = new Map([["draco/2CylinderEngine.gltf", "2CylinderEngine-glTF-Binary/2CylinderEngine.glb"]]);

const kFormats = /\.(obj|ply|stl|3mf|gltf|glb)$/i;

function* filesBelow(folder) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) yield* filesBelow(path);
    else if (kFormats.test(entry.name)) yield path;
  }
}

function run(program, args) {
  const { status, stdout, stderr, error } = spawnSync(program, args, { encoding: "utf8", timeout: 60_000 });
  return { status, stdout, stderr: error ? String(error) : stderr };
}

function causeOf(path) {
  for (const [end, cause] of kRejected) if (path.endsWith(`/${end}`)) return cause;
  if (path.includes("/glTF/")) return kOldGltf;
  return null;
}

// Returns what assimp reports about a file, or null if it cannot read it.
function assimpOf(path) {
  const { status, stdout } = run("assimp", ["info", path]);
  const numbers = (label) =>
    stdout
      .match(new RegExp(`${label}\\s+\\(([^)]*)\\)`))?.[1]
      .split(" ")
      .map(Number);
  const faces = stdout.match(/Faces:\s+(\d+)/)?.[1];
  const onlyTriangles = /Primitive Types:\s+triangles\s*$/m.test(stdout);
  const min = numbers("Minimum point"),
    max = numbers("Maximum point");
  return status === 0 && min && max ? { min, max, triangles: onlyTriangles ? Number(faces) : null } : null;
}

function readGltf(path) {
  const bytes = readFileSync(path);
  if (bytes.toString("latin1", 0, 4) !== "glTF") return { gltf: JSON.parse(bytes), binary: null };
  const length = bytes.readUInt32LE(12);
  return { gltf: JSON.parse(bytes.subarray(20, 20 + length)), binary: bytes.subarray(28 + length) };
}

function bufferOf(path, buffer, binary) {
  if (!buffer.uri) return binary;
  if (buffer.uri.startsWith("data:")) return Buffer.from(buffer.uri.split(",")[1], "base64");
  return readFileSync(join(dirname(path), decodeURIComponent(buffer.uri)));
}

// Returns the product of two matrices of 16 numbers in column order.
function product(a, b) {
  return Array.from({ length: 16 }, (_, i) =>
    [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i % 4)] * b[4 * Math.floor(i / 4) + k], 0),
  );
}

function matrixOf({ matrix, translation: t = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale = [1, 1, 1] }) {
  if (matrix) return matrix;
  const axes = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
  ];
  return [...axes.flatMap((axis, k) => [...axis.map((value) => value * scale[k]), 0]), ...t, 1];
}

const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

// Returns the components of element i of an accessor.
function readElement({ gltf, buffers }, index, i, components) {
  const { bufferView, byteOffset = 0, componentType, normalized } = gltf.accessors[index],
    view = gltf.bufferViews[bufferView];
  const [bytes, read, most] = {
    5121: [1, "readUInt8", 255],
    5123: [2, "readUInt16LE", 65535],
    5125: [4, "readUInt32LE", 2 ** 32 - 1],
    5126: [4, "readFloatLE", 1],
  }[componentType];
  const first = (view.byteOffset ?? 0) + byteOffset + i * (view.byteStride ?? bytes * components);
  return Array.from(
    { length: components },
    (_, k) => buffers[view.buffer][read](first + k * bytes) / (normalized ? most : 1),
  );
}

// Returns the matrix of a vertex: that of its node, or the weighted sum of those of its joints.
function vertexMatrix(file, attributes, i, matrix, joints) {
  if (!joints) return matrix;
  const numbers = readElement(file, attributes.JOINTS_0, i, 4),
    weights = readElement(file, attributes.WEIGHTS_0, i, 4);
  return kIdentity.map((_, k) => weights.reduce((sum, weight, n) => sum + weight * joints[numbers[n]][k], 0));
}

// Returns the matrices of all nodes of the default scene.
function placeNodes(gltf) {
  const matrices = [];
  const place = (index, parent) => {
    matrices[index] = product(parent, matrixOf(gltf.nodes[index]));
    for (const child of gltf.nodes[index].children ?? []) place(child, matrices[index]);
  };
  for (const root of gltf.scenes[gltf.scene ?? 0].nodes) place(root, kIdentity);
  return matrices;
}

// Returns the bounds and the number of triangles of the default scene.
function gltfOf(path) {
  const { gltf, binary } = readGltf(path);
  const buffers = gltf.buffers.map((buffer) => bufferOf(path, buffer, binary));
  const found = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity], triangles: 0 };
  const file = { gltf, buffers };
  const add = ({ attributes, indices, mode = 4 }, matrix, joints) => {
    if (mode < 4) return;
    const accessor = gltf.accessors[attributes.POSITION];
    const count = indices === undefined ? accessor.count : gltf.accessors[indices].count;
    found.triangles += mode === 4 ? count / 3 : count - 2;
    if (accessor.bufferView === undefined) return; // compressed
    for (let i = 0; i < accessor.count; ++i) {
      const at = readElement(file, attributes.POSITION, i, 3),
        m = vertexMatrix(file, attributes, i, matrix, joints);
      for (let k = 0; k < 3; ++k) {
        const value = m[k] * at[0] + m[4 + k] * at[1] + m[8 + k] * at[2] + m[12 + k];
        found.min[k] = Math.min(found.min[k], value);
        found.max[k] = Math.max(found.max[k], value);
      }
    }
  };
  placeNodes(gltf).forEach((matrix, index, matrices) => {
    const { mesh, skin } = gltf.nodes[index];
    if (mesh === undefined) return;
    const { joints, inverseBindMatrices } = gltf.skins?.[skin] ?? {};
    const ofJoints = joints?.map((joint, i) => product(matrices[joint], readElement(file, inverseBindMatrices, i, 16)));
    for (const part of gltf.meshes[mesh].primitives) add(part, matrix, ofJoints);
  });
  return found;
}

// Returns the bounds of the uncompressed file, and the number of triangles of the compressed one.
function compressedOf(path) {
  for (const [end, other] of kUncompressed)
    if (path.endsWith(end))
      return { ...gltfOf(path.replace(end, other)), triangles: gltfOf(path).triangles, quantum: 2 ** -12 };
  return null;
}

// Returns differences between our report and the other. assimp prints six decimals, and quaternions are rounded.
function differences(ours, theirs) {
  const found = [];
  const size = Math.max(1, ...ours.max.map(Math.abs), ...ours.min.map(Math.abs));
  for (const key of ["min", "max"])
    for (let k = 0; k < 3; ++k)
      if (Math.abs(ours[key][k] - theirs[key][k]) > (theirs.quantum ?? 1e-5) * size)
        found.push(`${key} is ${ours[key]}, must be ${theirs[key]}`);
  if (theirs.triangles !== null && theirs.triangles !== ours.triangles)
    found.push(`${ours.triangles} triangles, must be ${theirs.triangles}`);
  return [...new Set(found)];
}

function check(path) {
  const result = run(kProgram, ["inspect", path, "--json"]);
  const cause = causeOf(path);
  if (result.status === 2 && cause && result.stderr.includes(cause)) return { kind: "rejected", text: cause };
  if (result.status !== 0 || cause)
    return { kind: "problem", text: `status ${result.status}: ${result.stderr.trim() || "accepted"}` };
  const ours = JSON.parse(result.stdout),
    theirs = compressedOf(path) ?? (/\.gl(tf|b)$/.test(path) ? gltfOf(path) : assimpOf(path));
  if (!theirs) return { kind: "read", text: "assimp does not read it" };
  const different = differences(ours, theirs);
  return different.length > 0 ? { kind: "problem", text: different.join("; ") } : { kind: "compared", text: "" };
}

if (!existsSync(kFolder) || run("assimp", ["version"]).status !== 0) {
  console.log("assimp-testmodels and assimp-utils are not installed");
  process.exit(77);
}
const counts = { compared: 0, read: 0, rejected: 0, problem: 0 };
for (const path of [...filesBelow(kFolder)].sort()) {
  const { kind, text } = check(path);
  ++counts[kind];
  if (kind === "problem" || process.argv.includes("--list"))
    console.log(`${kind.padEnd(9)} ${relative(kFolder, path)}${text ? `: ${text.replace(path, basename(path))}` : ""}`);
}
console.log(
  `${counts.compared} files have the expected bounds and triangles, ${counts.read} are read by us only, ` +
    `${counts.rejected} are rejected for the expected cause, ${counts.problem} differ`,
);
process.exit(counts.problem > 0 || counts.compared < 50 ? 1 : 0);
