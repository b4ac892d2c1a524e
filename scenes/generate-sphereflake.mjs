#!/usr/bin/env node
// Writes a sphereflake scene to FILE, or to standard output:  node scenes/generate-sphereflake.mjs LEVEL [FILE]
//
// The "balls" scene of Eric Haines' Standard Procedural Databases (A Proposal for Standard Graphics
// Environments, IEEE Computer Graphics and Applications 7(11), 1987). The first sphere has a radius of 0.5.
// Each sphere carries nine touching ones of a third of its radius, six about its equator and three above,
// down to LEVEL. LEVEL is that collection's size factor: 1 gives 10 spheres, 2 gives 91, 3 gives 820, 4 (its
// usual size) 7,381, 5 gives 66,430. Camera and lights are those of the collection. Here the spheres are of
// gold, and the floor is infinite.
import { writeFileSync } from "node:fs";

const kDigits = 9;
const round = (x) => Number(x.toPrecision(kDigits)) + 0;
const three = (v) => `[${v.map(round).join(", ")}]`;

// Returns unit vectors to the nine children of a sphere whose pole is z: nine of the twelve corners of a
// cuboctahedron.
function child_directions() {
  const ring = (count, azimuth_degrees, z) =>
    Array.from({ length: count }, (_, i) => {
      const azimuth = (azimuth_degrees / 180 + (2 * i) / count) * Math.PI;
      const across = Math.sqrt(1 - z * z);
      return [across * Math.cos(azimuth), across * Math.sin(azimuth), z];
    });
  return [...ring(6, 15, 0), ...ring(3, 45, Math.sqrt(2 / 3))];
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Returns `v` rotated by the shortest rotation from z to the unit vector `pole` (Rodrigues' formula).
function turned(v, pole) {
  if (pole[2] < -0.999999999) return [v[0], -v[1], -v[2]];
  const axis = cross([0, 0, 1], pole); // its length is the sine of the angle
  const once = cross(axis, v);
  const twice = cross(axis, once);
  return v.map((c, i) => c + once[i] + twice[i] / (1 + pole[2]));
}

function* spheres(level, center = [0, 0, 0], radius = 0.5, pole = [0, 0, 1]) {
  yield `{ "type": "sphere", "center": ${three(center)}, "radius": ${round(radius)}, "material": "gold" }`;
  if (level === 0) return;
  const reach = radius + radius / 3;
  for (const direction of child_directions()) {
    const outward = turned(direction, pole);
    const child = center.map((c, i) => c + reach * outward[i]);
    yield* spheres(level - 1, child, radius / 3, outward);
  }
}

function scene(level) {
  const flake = [...spheres(level)];
  const light = (from) => `{ "type": "point", "position": ${three(from)}, "intensity": [0.58, 0.58, 0.58] }`;
  return `{
  "version": 1,
  "title": "Sphereflake ${level}",
  "description": "${flake.length.toLocaleString("en")} gold spheres; each level adds nine smaller spheres to every sphere of the level before.",
  "camera": { "type": "perspective", "eye": [2.1, 1.3, 1.7], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov_degrees": 45 },
  "image": { "width": 512, "height": 512 },
  "ambient": [0.1, 0.1, 0.1],
  "background": [0.62, 0.68, 0.78],
  "materials": {
    "gold": { "type": "reflective", "n": [0.143, 0.375, 1.442], "k": [3.983, 2.386, 1.603] },
    "floor": { "type": "rough", "kd": [0.09, 0.13, 0.22] }
  },
  "lights": [
    ${[
      [4, 3, 2],
      [1, -4, 4],
      [-3, 1, 5],
    ]
      .map(light)
      .join(",\n    ")}
  ],
  "objects": [
    { "type": "plane", "point": [0, 0, -0.5], "normal": [0, 0, 1], "material": "floor" },
    ${flake.join(",\n    ")}
  ],
  "render": { "max_depth": 5 }
}
`;
}

const level = Number(process.argv[2]);
if (!Number.isInteger(level) || level < 0 || level > 6) {
  console.error("usage: generate-sphereflake.mjs LEVEL [FILE]     LEVEL is 0 to 6");
  process.exit(2);
}
if (process.argv[3]) writeFileSync(process.argv[3], scene(level));
else process.stdout.write(scene(level));
