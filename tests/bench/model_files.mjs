// Writes one generated mesh as OBJ, binary PLY, binary STL and GLB files.

import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { FOLDER } from "./subjects.mjs";

export const FORMATS = ["obj", "ply", "stl", "glb"];

// Returns a closed wavy torus of about `triangles` triangles: {positions, indices}, three numbers each.
function wavyTorus(triangles) {
  const side = Math.round(Math.sqrt(triangles / 2));
  const positions = new Float32Array(3 * side * side),
    indices = new Uint32Array(6 * side * side);
  for (let i = 0; i < side; ++i)
    for (let j = 0; j < side; ++j) {
      const u = (2 * Math.PI * i) / side,
        v = (2 * Math.PI * j) / side;
      const tube = 0.4 * (1 + 0.1 * Math.sin(9 * u) * Math.cos(5 * v) + 0.02 * Math.sin(61 * u + 40 * v));
      const ring = 1 + tube * Math.cos(v);
      positions.set([ring * Math.cos(u), tube * Math.sin(v), -ring * Math.sin(u)], 3 * (i * side + j));
      const a = i * side + j,
        b = ((i + 1) % side) * side + j,
        c = i * side + ((j + 1) % side),
        d = ((i + 1) % side) * side + ((j + 1) % side);
      indices.set([a, b, d, a, d, c], 6 * (i * side + j));
    }
  return { positions, indices };
}

function objOf({ positions, indices }) {
  const lines = [];
  for (let i = 0; i < positions.length; i += 3)
    lines.push(`v ${[0, 1, 2].map((k) => positions[i + k].toFixed(6)).join(" ")}`);
  for (let i = 0; i < indices.length; i += 3) lines.push(`f ${[0, 1, 2].map((k) => indices[i + k] + 1).join(" ")}`);
  return `${lines.join("\n")}\n`;
}

function plyOf({ positions, indices }) {
  const head =
    "ply\nformat binary_little_endian 1.0\n" +
    `element vertex ${positions.length / 3}\nproperty float x\nproperty float y\nproperty float z\n` +
    `element face ${indices.length / 3}\nproperty list uchar int vertex_indices\nend_header\n`;
  const faces = Buffer.allocUnsafe((13 * indices.length) / 3);
  for (let i = 0, at = 0; i < indices.length; i += 3) {
    at = faces.writeUInt8(3, at);
    for (let k = 0; k < 3; ++k) at = faces.writeUInt32LE(indices[i + k], at);
  }
  return Buffer.concat([Buffer.from(head), Buffer.from(positions.buffer), faces]);
}

function stlOf({ positions, indices }) {
  const bytes = Buffer.alloc(84 + (50 * indices.length) / 3);
  bytes.writeUInt32LE(indices.length / 3, 80);
  for (let i = 0, at = 84; i < indices.length; i += 3, at += 50)
    for (let k = 0; k < 3; ++k)
      for (let x = 0; x < 3; ++x) bytes.writeFloatLE(positions[3 * indices[i + k] + x], at + 12 + 12 * k + 4 * x);
  return bytes;
}

function glbOf({ positions, indices }) {
  const least = [0, 1, 2].map((k) => positions.reduce((m, x, i) => (i % 3 === k ? Math.min(m, x) : m), Infinity));
  const most = [0, 1, 2].map((k) => positions.reduce((m, x, i) => (i % 3 === k ? Math.max(m, x) : m), -Infinity));
  const count = positions.length / 3;
  const document = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count, type: "VEC3", min: least, max: most },
      { bufferView: 1, componentType: 5125, count: indices.length, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteLength: positions.byteLength },
      { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength },
    ],
    buffers: [{ byteLength: positions.byteLength + indices.byteLength }],
  };
  const text = Buffer.from(JSON.stringify(document));
  const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
  const binary = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]);
  const chunk = (type, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.write(type, 4, "latin1");
    return Buffer.concat([head, bytes]);
  };
  const body = Buffer.concat([chunk("JSON", json), chunk("BIN\0", binary)]);
  const head = Buffer.alloc(12);
  head.write("glTF", 0, "latin1");
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([head, body]);
}

const WRITERS = { obj: objOf, ply: plyOf, stl: stlOf, glb: glbOf };

// Returns the path of a file with a mesh of about `triangles` triangles. Writes the file unless it exists.
export function modelFile(format, triangles) {
  const path = `${FOLDER}/torus-${triangles}.${format}`;
  if (!existsSync(path)) {
    mkdirSync(FOLDER, { recursive: true });
    writeFileSync(path, WRITERS[format](wavyTorus(triangles)));
  }
  return path;
}
