import { start_two_sided } from "./two_sided.mjs";

const kProgram = "build/bench";
const kBunny = 70_000, kMillion = 1_000_000; // triangles; the first as many as the Stanford bunny has

// A process that holds the mesh and both structures; each line asks it for one run.
async function start(kind, triangles, mode) {
  const { facts, ...sides } = await start_two_sided(kProgram, [kind, String(triangles), mode]);
  const per_triangle = (bytes) => (bytes / facts.triangles).toFixed(0);
  return {
    ...sides,
    remark:
      `${facts.triangles} triangles` +
      (kind === "build" ? "" : `, ${facts.rays} rays`) +
      `, bytes a triangle: ours ${per_triangle(facts.our_bytes)}, theirs ${per_triangle(facts.their_bytes)}`,
  };
}

function comparison(kind, what, reach, aim, { mode = "default", triangles = kBunny } = {}) {
  const size = triangles === kMillion ? "-1m" : "";
  return {
    name: `embree-${mode === "robust" ? "robust-" : ""}${kind}${size}`,
    what,
    cost: "CPU s of one thread",
    reach,
    aim,
    needs: [kProgram],
    start: () => start(kind, triangles, mode),
  };
}

const kKinds = [
  ["primary", "coherent camera rays, ours watertight, against Embree's packets of 16", 0.8, 1],
  ["bounce", "cosine-weighted rays off the surface, ours watertight, against Embree's single rays", 0.9, 1.1],
  ["anyhit", "the same rays, occlusion within half a radius, against Embree's single rays", 0.9, 1.1],
  ["build", "building the hierarchy, against Embree's high quality", 1, 2],
];
const kRobust = " in its ROBUST mode, which is watertight too";

export const kEmbree = [
  ...kKinds.map((kind) => comparison(...kind)),
  ...kKinds.map((kind) => comparison(...kind, { triangles: kMillion })),
  ...[kBunny, kMillion].flatMap((triangles) =>
    kKinds.slice(0, 3).map(([kind, what, ...aims]) =>
      comparison(kind, what + kRobust, ...aims, { mode: "robust", triangles }),
    ),
  ),
];
