// Small glTF models with one feature each, written for tests.

import { deflateSync, crc32 } from "node:zlib";

const bytesOf = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);

// Returns a PNG file of RGBA texels, given as rows of [r, g, b, a].
export function png(rows) {
  const raw = Buffer.concat(rows.map((row) => Buffer.from([0, ...row.flat()])));
  const chunk = (type, content) => {
    const body = Buffer.concat([Buffer.from(type, "latin1"), content]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(content.length, 0);
    ends.writeUInt32BE(crc(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(rows[0].length, 0);
  header.writeUInt32BE(rows.length, 4);
  header.set([8, 6], 8);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([
    signature,
    chunk("IHDR", header),
    chunk("IDAT", deflateSync(raw)),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

function crc(bytes) {
  if (crc32) return crc32(bytes);
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let k = 0; k < 8; ++k) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

// Document with a buffer that grows.
class Writer {
  constructor() {
    this.json = {
      asset: { version: "2.0" },
      scene: 0,
      scenes: [{ nodes: [0] }],
      nodes: [{ mesh: 0 }],
      accessors: [],
      bufferViews: [],
    };
    this.parts = [];
    this.length = 0;
  }
  view(bytes, target) {
    const byteOffset = this.length;
    const padded = Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4)]);
    this.parts.push(padded);
    this.length += padded.length;
    const view = { buffer: 0, byteOffset, byteLength: bytes.length };
    if (target) view.target = target;
    return this.json.bufferViews.push(view) - 1;
  }
  accessor(array, type, componentType, { target = 34962, ...more } = {}) {
    const components = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 }[type];
    const accessor = {
      bufferView: this.view(bytesOf(array), target),
      componentType,
      count: array.length / components,
      type,
      ...more,
    };
    return this.json.accessors.push(accessor) - 1;
  }
  positions(list) {
    const columns = [0, 1, 2].map((k) => list.filter((_, i) => i % 3 === k));
    return this.accessor(new Float32Array(list), "VEC3", 5126, {
      min: columns.map((c) => Math.fround(Math.min(...c))),
      max: columns.map((c) => Math.fround(Math.max(...c))),
    });
  }
  // Returns the document with its buffer as a data: URI.
  gltf() {
    const binary = Buffer.concat(this.parts);
    const uri = `data:application/octet-stream;base64,${binary.toString("base64")}`;
    return { ...this.json, buffers: [{ byteLength: binary.length, uri }] };
  }
  glb() {
    const binary = Buffer.concat(this.parts);
    const json = Buffer.from(JSON.stringify({ ...this.json, buffers: [{ byteLength: binary.length }] }));
    const text = Buffer.concat([json, Buffer.alloc((4 - (json.length % 4)) % 4, 0x20)]);
    const head = Buffer.alloc(20);
    head.write("glTF", 0);
    [2, 28 + text.length + binary.length, text.length].forEach((n, k) => head.writeUInt32LE(n, 4 + 4 * k));
    head.write("JSON", 16);
    const middle = Buffer.alloc(8);
    middle.writeUInt32LE(binary.length, 0);
    middle.write("BIN\0", 4, "latin1");
    return Buffer.concat([head, text, middle, binary]);
  }
}

// Returns a writer with a square of side 2 in the plane z = 0 that faces +z, with normals, both sets of texture
// coordinates, colours, an image of 2 x 2 texels, and one material.
export function square(material = {}) {
  const w = new Writer();
  const position = w.positions([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]);
  const normal = w.accessor(new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]), "VEC3", 5126);
  const uv = w.accessor(new Float32Array([0, 1, 1, 1, 1, 0, 0, 0]), "VEC2", 5126);
  const uv2 = w.accessor(new Float32Array([0, 2, 2, 2, 2, 0, 0, 0]), "VEC2", 5126);
  const color = w.accessor(
    new Uint8Array([255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255]),
    "VEC4",
    5121,
    { normalized: true },
  );
  const indices = w.accessor(new Uint16Array([0, 1, 2, 0, 2, 3]), "SCALAR", 5123, { target: 34963 });
  const image = w.view(
    png([
      [
        [255, 0, 0, 255],
        [0, 255, 0, 128],
      ],
      [
        [0, 0, 255, 64],
        [255, 255, 255, 0],
      ],
    ]),
  );
  const attributes = { POSITION: position, NORMAL: normal, TEXCOORD_0: uv, TEXCOORD_1: uv2, COLOR_0: color };
  Object.assign(w.json, {
    images: [{ bufferView: image, mimeType: "image/png" }],
    samplers: [{ wrapS: 33071, wrapT: 33648 }],
    textures: [{ source: 0 }, { source: 0, sampler: 0 }],
    materials: [{ name: "m", ...material }],
    meshes: [{ primitives: [{ attributes, indices, material: 0 }] }],
  });
  return w;
}

const texture = (index = 0, more = {}) => ({ index, ...more });
const pbr = (more) => ({ pbrMetallicRoughness: more });
const extension = (name, value, more = {}) => ({
  material: { ...more, extensions: { [name]: value } },
  used: [name],
});

// Features by name: a material, extensions in use, or a change of the document.
export const kFeatures = {
  plain: {},
  "base color": { material: pbr({ baseColorFactor: [1, 0.5, 0.25, 1] }) },
  metal: { material: pbr({ metallicFactor: 1, roughnessFactor: 0.2 }) },
  "base color texture": { material: pbr({ baseColorTexture: texture() }) },
  sampler: { material: pbr({ baseColorTexture: texture(1) }) },
  "second coordinates": { material: pbr({ baseColorTexture: texture(0, { texCoord: 1 }) }) },
  "metallic roughness texture": { material: pbr({ metallicRoughnessTexture: texture() }) },
  "normal texture": { material: { normalTexture: texture(0, { scale: 0.5 }) } },
  "occlusion texture": { material: { occlusionTexture: texture(0, { strength: 0.5 }) } },
  emission: { material: { emissiveFactor: [1, 0.5, 0] } },
  "emission texture": { material: { emissiveFactor: [1, 1, 1], emissiveTexture: texture() } },
  mask: { material: { alphaMode: "MASK", alphaCutoff: 0.4, ...pbr({ baseColorTexture: texture() }) } },
  blend: { material: { alphaMode: "BLEND", ...pbr({ baseColorFactor: [1, 1, 1, 0.5] }) } },
  "double sided": { material: { doubleSided: true } },
  transform: {
    material: pbr({
      baseColorTexture: texture(0, {
        extensions: { KHR_texture_transform: { offset: [0.1, 0.2], rotation: 0.5, scale: [2, 3] } },
      }),
    }),
    used: ["KHR_texture_transform"],
  },
  unlit: extension("KHR_materials_unlit", {}, pbr({ baseColorTexture: texture() })),
  "emissive strength": extension(
    "KHR_materials_emissive_strength",
    { emissiveStrength: 3 },
    { emissiveFactor: [1, 1, 1] },
  ),
  ior: extension("KHR_materials_ior", { ior: 1.8 }),
  specular: extension("KHR_materials_specular", { specularFactor: 0.5, specularColorFactor: [1, 0.5, 0.5] }),
  transmission: extension("KHR_materials_transmission", { transmissionFactor: 1 }),
  volume: {
    material: {
      extensions: {
        KHR_materials_transmission: { transmissionFactor: 1 },
        KHR_materials_volume: { thicknessFactor: 1, attenuationDistance: 2, attenuationColor: [1, 0.5, 0.5] },
      },
    },
    used: ["KHR_materials_transmission", "KHR_materials_volume"],
  },
  clearcoat: extension("KHR_materials_clearcoat", { clearcoatFactor: 1 }),
  sheen: extension("KHR_materials_sheen", { sheenColorFactor: [1, 1, 1] }),
  "clearcoat textures": extension("KHR_materials_clearcoat", {
    clearcoatFactor: 0.5,
    clearcoatRoughnessFactor: 0.2,
    clearcoatTexture: texture(),
    clearcoatRoughnessTexture: texture(),
  }),
  "sheen texture": extension("KHR_materials_sheen", {
    sheenColorFactor: [1, 0.5, 0.2],
    sheenColorTexture: texture(),
    sheenRoughnessFactor: 0.4,
  }),
  "specular textures": extension("KHR_materials_specular", {
    specularFactor: 0.5,
    specularTexture: texture(),
    specularColorTexture: texture(),
  }),
  lights: {
    change: (g) => {
      g.extensions = {
        KHR_lights_punctual: {
          lights: [
            { type: "directional", intensity: 3 },
            { type: "point", color: [1, 0.5, 0], intensity: 10 },
            { type: "spot", intensity: 10, spot: { innerConeAngle: 0.1, outerConeAngle: 0.3 } },
          ],
        },
      };
      [0, 1, 2].forEach((light) =>
        g.nodes.push({ translation: [0, 0, 2], extensions: { KHR_lights_punctual: { light } } }),
      );
      g.scenes[0].nodes = [0, 1, 2, 3];
    },
    used: ["KHR_lights_punctual"],
  },
  cameras: {
    change: (g) => {
      g.cameras = [
        { name: "near", type: "perspective", perspective: { yfov: 0.7, znear: 0.1 } },
        { name: "flat", type: "orthographic", orthographic: { xmag: 2, ymag: 1.5, znear: 0, zfar: 9 } },
      ];
      g.nodes.push({ camera: 0, translation: [0, 0, 4] }, { camera: 1, translation: [0, 0, 4] });
      g.scenes[0].nodes = [0, 1, 2];
    },
  },
  variants: {
    change: (g) => {
      g.extensions = { KHR_materials_variants: { variants: [{ name: "red" }] } };
      g.materials.push({ name: "red", ...pbr({ baseColorFactor: [1, 0, 0, 1] }) });
      g.meshes[0].primitives[0].extensions = {
        KHR_materials_variants: { mappings: [{ material: 1, variants: [0] }] },
      };
    },
    used: ["KHR_materials_variants"],
  },
  "mirrored node": { change: (g) => (g.nodes[0].scale = [-1, 1, 1]) },
  "nested nodes": {
    change: (g) => {
      g.nodes = [
        { children: [1], translation: [1, 0, 0] },
        { mesh: 0, rotation: [0, 0, 0.7071068, 0.7071068] },
      ];
    },
  },
  "shared mesh": {
    change: (g) => {
      g.nodes = [{ mesh: 0 }, { mesh: 0, translation: [3, 0, 0] }];
      g.scenes[0].nodes = [0, 1];
    },
  },
  "no normals": { change: (g) => delete g.meshes[0].primitives[0].attributes.NORMAL },
  "no coordinates": {
    material: {},
    change: (g) => ["TEXCOORD_0", "TEXCOORD_1"].forEach((k) => delete g.meshes[0].primitives[0].attributes[k]),
  },
  "two parts": {
    change: (g) => {
      g.materials.push(pbr({ baseColorFactor: [1, 0, 0, 1] }));
      const { POSITION } = g.meshes[0].primitives[0].attributes;
      g.meshes[0].primitives.push({
        attributes: { POSITION },
        indices: g.meshes[0].primitives[0].indices,
        material: 1,
      });
    },
  },
  "no material": { change: (g) => delete g.meshes[0].primitives[0].material },
  "no scene": { change: (g) => delete g.scene },
};

// Returns the document of a feature, and its GLB bytes.
export function model(feature) {
  const { material, used, change } = kFeatures[feature];
  const writer = square(material);
  if (used) writer.json.extensionsUsed = used;
  change?.(writer.json);
  return { json: writer.gltf(), glb: writer.glb() };
}
