// Converts scenes of spheres and planes to POV-Ray's language. tests/povray converts all kinds of scenes.

const vector = (v) => `<${v.join(", ")}>`;
const plus = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const scaled = (v, s) => v.map((x) => x * s);
const unit = (v) => scaled(v, 1 / Math.sqrt(dot(v, v)));
const cross = ([ax, ay, az], [bx, by, bz]) => [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];

// Throws Error on unknown members, because a benchmark must not compare different scenes.
function only(object, kinds) {
  const known = kinds[object.type] ?? [];
  const unknown = Object.keys(object).filter((key) => key !== "type" && !known.includes(key));
  if (unknown.length > 0) throw new Error(`cannot convert ${object.type}.${unknown[0]} to POV-Ray`);
  return object;
}

function cameraOf(camera, aspect) {
  const known = { perspective: ["eye", "look_at", "up", "fov_degrees"] };
  const { eye, look_at: lookAt, up, fov_degrees: fovDegrees } = only(camera, known);
  const forward = unit(plus(lookAt, eye, -1));
  const right = unit(cross(forward, up));
  const height = 2 * Math.tan((fovDegrees * Math.PI) / 360);
  return `camera { perspective location ${vector(eye)} direction ${vector(forward)}
  up ${vector(scaled(cross(right, forward), height))} right ${vector(scaled(right, height * aspect))} }\n`;
}

function textureOf(material) {
  const { type, n, k, kd } = only(material, { reflective: ["n", "k"], rough: ["kd"] });
  if (type === "rough") return `texture { pigment { rgb ${vector(kd)} } finish { ambient 1 diffuse 1 } }`;
  const f0 = n.map((x, i) => ((x - 1) ** 2 + k[i] ** 2) / ((x + 1) ** 2 + k[i] ** 2));
  const reflection = `reflection { rgb ${vector(f0)}, rgb 1 falloff 5 }`; // Schlick's approximation
  return `texture { pigment { rgb 0 } finish { ambient 0 diffuse 0 ${reflection} } }`;
}

function lightOf(light) {
  const { position, intensity } = only(light, { point: ["position", "intensity"] });
  return `light_source { ${vector(position)} rgb ${vector(intensity)} }\n`;
}

function objectOf(object) {
  const { type, center, radius, point, normal, material } = only(object, {
    sphere: ["center", "radius", "material"],
    plane: ["point", "normal", "material"],
  });
  if (type === "sphere") return `sphere { ${vector(center)}, ${radius} texture { Texture_${material} } }\n`;
  return `plane { ${vector(unit(normal))}, ${dot(unit(normal), point)} texture { Texture_${material} } }\n`;
}

export function povrayScene(scene, aspect, depth) {
  const { camera, materials, lights, objects, ambient, background } = scene;
  const texture = ([name, material]) => `#declare Texture_${name} = ${textureOf(material)}\n`;
  const parts = [Object.entries(materials).map(texture), lights.map(lightOf), objects.map(objectOf)];
  return `#version 3.7;
global_settings {
  assumed_gamma 1 adc_bailout 0 max_trace_level ${depth + 1} ambient_light rgb ${vector(ambient)}
}
background { rgb ${vector(background)} }
${cameraOf(camera, aspect)}${parts.flat().join("")}`;
}
