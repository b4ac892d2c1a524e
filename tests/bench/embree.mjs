// Ray and build times compared with Embree's, on typical meshes: table, geometric mean, worst case and chart.

import { mkdirSync, readdirSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { median } from "./measure.mjs";
import { ratio_chart } from "./ratio_chart.mjs";
import { start_two_sided } from "./two_sided.mjs";

const kProgram = "build/bench";
const kSizes = [1_000, 70_000, 1_000_000],
  kUsualSize = 70_000; // triangles of generated subjects
const kKinds = ["primary", "bounce", "bounce-4", "point", "area", "short"],
  kReach = 1,
  kAim = 1.2;
const kMostBuilds = 3; // limit of pairs of builds, which take long
const kWidths = [26, 10, 10, ...kKinds.map(() => 10), 10];

const cells = (values) => values.map((v, i) => (i === 0 ? v.padEnd(kWidths[i]) : v.padStart(kWidths[i]))).join("");
const fixed = (value) => (value === undefined ? "-" : value.toFixed(2));
const geometric_mean = (values) => Math.exp(values.reduce((sum, v) => sum + Math.log(v), 0) / values.length);

// Returns the ratios theirs / ours by kind, medians of interleaved pairs.
async function measure_case({ mesh, triangles, place, mode }, pairs) {
  const sides = await start_two_sided(kProgram, [mesh, String(triangles), place, mode]);
  const ratios = {};
  try {
    // Skips builds in ROBUST mode, in which Embree builds without spatial splits at any quality.
    for (const kind of [...(mode === "robust" ? [] : ["build"]), ...kKinds].filter((one) => sides.facts.kinds[one])) {
      const found = [];
      if (kind !== "build") await Promise.all([await sides.ours(kind), await sides.theirs(kind)]);
      for (let pair = 0; pair < (kind === "build" ? Math.min(pairs, kMostBuilds) : pairs); ++pair) {
        let ours;
        if (pair % 2 === 0) ours = await sides.ours(kind);
        const theirs = await sides.theirs(kind);
        ours ??= await sides.ours(kind);
        found.push(theirs.cost / ours.cost);
      }
      ratios[kind] = median(found);
    }
  } finally {
    await sides.stop();
  }
  return { ratios, facts: sides.facts };
}

function cases_of(meshes, sizes) {
  const made = spawnSync(kProgram, ["list"], { encoding: "utf8" }).stdout.trim().split("\n");
  const files = meshes ? readdirSync(meshes).filter((name) => /\.(obj|ply|stl|glb)$/i.test(name)) : [];
  const subjects = [
    ...made.flatMap((name) => (name === "cornell" ? [0] : sizes).map((triangles) => ({ name, mesh: name, triangles }))),
    ...files.map((file) => ({ name: file.replace(/\.\w+$/, ""), mesh: `${meshes}/${file}`, triangles: 0 })),
  ];
  return ["default", "robust"].flatMap((mode) =>
    subjects
      .filter(({ triangles }) => mode === "default" || triangles === kUsualSize)
      .flatMap((subject) => ["open", "room"].map((place) => ({ ...subject, place, mode }))),
  );
}

const name_of = ({ name, triangles, place, mode }) =>
  [
    name,
    triangles ? (triangles >= 1e6 ? `${triangles / 1e6}m` : `${triangles / 1e3}k`) : "",
    place,
    mode === "robust" ? mode : "",
  ]
    .filter(Boolean)
    .join("-");

function print_summary(what, rows) {
  const all = rows.flatMap(({ name, ratios }) =>
    kKinds.filter((k) => ratios[k]).map((k) => [ratios[k], `${name} ${k}`]),
  );
  if (all.length === 0) return;
  const [least, where] = all.reduce((worst, one) => (one[0] < worst[0] ? one : worst));
  const under = all.filter(([ratio]) => ratio < kReach).length;
  console.log(
    `${what}: geometric mean ${fixed(geometric_mean(all.map(([ratio]) => ratio)))}, worst ${fixed(least)} (${where}), ` +
      `${under} of ${all.length} under ${kReach}`,
  );
}

export const kEmbree = {
  name: "embree",
  what: "rays and builds compared with Embree 3 on seven kinds of meshes, open and in a closed room; one thread",
  needs: [kProgram],
  async run({ pairs, charts, meshes, triangles }) {
    console.log(
      "\ntheirs / ours, CPU time: primary rays against Embree's packets of 16, others against its single rays",
    );
    console.log(cells(["subject", "triangles", "build", ...kKinds, "bytes"]));
    const rows = [];
    for (const one of cases_of(meshes, triangles ? [triangles] : kSizes)) {
      const name = name_of(one);
      try {
        const { ratios, facts } = await measure_case(one, pairs);
        const bytes = [facts.our_bytes, facts.their_bytes].map((b) => (b / facts.triangles).toFixed(0)).join("/");
        rows.push({ name, mode: one.mode, ratios, facts });
        console.log(
          cells([name, String(facts.triangles), fixed(ratios.build), ...kKinds.map((k) => fixed(ratios[k])), bytes]),
        );
      } catch (error) {
        console.log(`${name} failed: ${error.message}`);
        process.exitCode = 1;
      }
    }
    const of_mode = (mode) => rows.filter((row) => row.mode === mode);
    print_summary("against its default mode", of_mode("default"));
    print_summary("against ROBUST, which is watertight too", of_mode("robust"));
    console.log(`reach ${kReach}, aim ${kAim} each; bytes: a triangle, ours/theirs`);
    mkdirSync(charts, { recursive: true });
    writeFileSync(
      `${charts}/embree.svg`,
      ratio_chart("CPU time of Embree 3 relative to orrery, one thread", of_mode("default"), kKinds),
    );
    console.log(`chart: ${charts}/embree.svg`);
    return rows.flatMap(({ name, ratios }) =>
      Object.entries(ratios).map(([kind, ratio]) => ({
        name: `embree-${name}-${kind}`,
        ratio,
        reach: kReach,
        aim: kAim,
      })),
    );
  },
};
