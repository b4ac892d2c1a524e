// Compares ray and build times on typical meshes with Embree. Prints a table, geometric means and worst
// cases, and draws a chart.

import { mkdirSync, readdirSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { median } from "./measure.mjs";
import { ratioChart } from "./ratio_chart.mjs";
import { startTwoSided } from "./two_sided.mjs";

const PROGRAM = "build/bench";
const SIZES = [1_000, 70_000, 1_000_000],
  USUAL_SIZE = 70_000; // triangles of generated subjects
const KINDS = ["primary", "bounce", "bounce-4", "point", "area", "short"],
  REACH = 1,
  AIM = 1.2;
const MOST_BUILDS = 3; // maximum number of pairs of builds, which take long
const WIDTHS = [26, 10, 10, ...KINDS.map(() => 10), 10];

const cells = (values) => values.map((v, i) => (i === 0 ? v.padEnd(WIDTHS[i]) : v.padStart(WIDTHS[i]))).join("");
const fixed = (value) => (value === undefined ? "-" : value.toFixed(2));
const geometricMean = (values) => Math.exp(values.reduce((sum, v) => sum + Math.log(v), 0) / values.length);

// Returns the ratio theirs / ours of each kind, the median of interleaved pairs.
async function measureCase({ mesh, triangles, place, mode }, pairs) {
  const sides = await startTwoSided(PROGRAM, [mesh, String(triangles), place, mode]);
  const ratios = {};
  try {
    // Skips builds in ROBUST mode, because Embree then builds without spatial splits at any quality.
    for (const kind of [...(mode === "robust" ? [] : ["build"]), ...KINDS].filter((one) => sides.facts.kinds[one])) {
      const found = [];
      if (kind !== "build") await Promise.all([await sides.ours(kind), await sides.theirs(kind)]);
      for (let pair = 0; pair < (kind === "build" ? Math.min(pairs, MOST_BUILDS) : pairs); ++pair) {
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

function casesOf(meshes, sizes) {
  const made = spawnSync(PROGRAM, ["list"], { encoding: "utf8" }).stdout.trim().split("\n");
  const files = meshes ? readdirSync(meshes).filter((name) => /\.(obj|ply|stl|glb)$/i.test(name)) : [];
  const subjects = [
    ...made.flatMap((name) => (name === "cornell" ? [0] : sizes).map((triangles) => ({ name, mesh: name, triangles }))),
    ...files.map((file) => ({ name: file.replace(/\.\w+$/, ""), mesh: `${meshes}/${file}`, triangles: 0 })),
  ];
  return ["default", "robust"].flatMap((mode) =>
    subjects
      .filter(({ triangles }) => mode === "default" || triangles === USUAL_SIZE)
      .flatMap((subject) => ["open", "room"].map((place) => ({ ...subject, place, mode }))),
  );
}

const nameOf = ({ name, triangles, place, mode }) =>
  [
    name,
    triangles ? (triangles >= 1e6 ? `${triangles / 1e6}m` : `${triangles / 1e3}k`) : "",
    place,
    mode === "robust" ? mode : "",
  ]
    .filter(Boolean)
    .join("-");

function printSummary(what, rows) {
  const all = rows.flatMap(({ name, ratios }) =>
    KINDS.filter((k) => ratios[k]).map((k) => [ratios[k], `${name} ${k}`]),
  );
  if (all.length === 0) return;
  const [least, where] = all.reduce((worst, one) => (one[0] < worst[0] ? one : worst));
  const under = all.filter(([ratio]) => ratio < REACH).length;
  console.log(
    `${what}: geometric mean ${fixed(geometricMean(all.map(([ratio]) => ratio)))}, worst ${fixed(least)} (${where}), ` +
      `${under} of ${all.length} below ${REACH}`,
  );
}

export const EMBREE = {
  name: "embree",
  what: "rays and builds compared with Embree 3 on seven kinds of meshes, open and in a closed room; one thread",
  needs: [PROGRAM],
  async run({ pairs, charts, meshes, triangles }) {
    console.log(
      "\nCPU time, theirs / ours: primary rays compared with Embree's packets of 16, other rays with its single rays",
    );
    console.log(cells(["subject", "triangles", "build", ...KINDS, "bytes"]));
    const rows = [];
    for (const one of casesOf(meshes, triangles ? [triangles] : SIZES)) {
      const name = nameOf(one);
      try {
        const { ratios, facts } = await measureCase(one, pairs);
        const bytes = [facts.our_bytes, facts.their_bytes].map((b) => (b / facts.triangles).toFixed(0)).join("/");
        rows.push({ name, mode: one.mode, ratios, facts });
        console.log(
          cells([name, String(facts.triangles), fixed(ratios.build), ...KINDS.map((k) => fixed(ratios[k])), bytes]),
        );
      } catch (error) {
        console.log(`${name} failed: ${error.message}`);
        process.exitCode = 1;
      }
    }
    const ofMode = (mode) => rows.filter((row) => row.mode === mode);
    printSummary("compared with Embree's default mode", ofMode("default"));
    printSummary("compared with Embree's watertight mode ROBUST", ofMode("robust"));
    console.log(`required ratio ${REACH}, desired ${AIM}; bytes per triangle, ours/theirs`);
    mkdirSync(charts, { recursive: true });
    writeFileSync(
      `${charts}/embree.svg`,
      ratioChart("CPU time of Embree 3 relative to orrery, one thread", ofMode("default"), KINDS),
    );
    console.log(`chart: ${charts}/embree.svg`);
    return rows.flatMap(({ name, ratios }) =>
      Object.entries(ratios).map(([kind, ratio]) => ({
        name: `embree-${name}-${kind}`,
        ratio,
        reach: REACH,
        aim: AIM,
      })),
    );
  },
};
