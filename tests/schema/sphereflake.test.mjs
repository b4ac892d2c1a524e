// Checks that the sample sphereflakes equal the output of their generator. Every sphere except for the first
// must touch its parent, and no spheres may overlap.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";

const generate = (level) =>
  execFileSync(process.execPath, ["scenes/generate-sphereflake.mjs", String(level)], { encoding: "utf8" });

for (const level of [1, 2, 3])
  assert.equal(generate(level), readFileSync(`scenes/sphereflake-${level}.json`, "utf8"), `level ${level}`);

for (const [level, count] of [
  [0, 1],
  [1, 10],
  [2, 91],
  [3, 820],
  [4, 7381],
]) {
  const spheres = JSON.parse(generate(level)).objects.filter((object) => object.type === "sphere");
  assert.equal(spheres.length, count);
  if (level > 3) continue; // the loop below visits every pair
  let touching = 0;
  for (const [i, a] of spheres.entries())
    for (const b of spheres.slice(0, i)) {
      const gap = Math.hypot(...a.center.map((c, axis) => c - b.center[axis])) - a.radius - b.radius;
      assert.ok(gap > -1e-6, `spheres overlap by ${-gap}`);
      if (gap < 1e-6 && a.radius !== b.radius) touching += 1;
    }
  assert.ok(touching >= count - 1, "every sphere but the first touches its parent");
}
