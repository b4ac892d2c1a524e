// Tables and charts of all structures on different kinds of scenes, and of bvh on growing numbers of
// triangles.

import { spawnSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { chart } from "./chart.mjs";
import { writeBall, writeSubjects } from "./subjects.mjs";

const PROGRAM = "build/structures";
const SIZES = [1e3, 1e4, 1e5, 1e6, 1e7]; // triangles

function measure(scene, rounds, rays, names = []) {
  const done = spawnSync(PROGRAM, [scene, String(rounds), rays, ...names], {
    encoding: "utf8",
    stdio: ["ignore", "pipe", process.stderr.isTTY ? "inherit" : "ignore"],
  });
  if (done.status !== 0) throw new Error(`${PROGRAM} ${scene} exited with status ${done.status}`);
  return JSON.parse(done.stdout);
}

function save(folder, name, svg) {
  mkdirSync(folder, { recursive: true });
  writeFileSync(`${folder}/${name}`, svg);
  console.log(`chart: ${folder}/${name}`);
}

const cells = (values, widths) =>
  values.map((v, i) => (i === 0 ? v.padEnd(widths[i]) : v.padStart(widths[i]))).join("");
const fixed = (value) => (value >= 100 ? value.toFixed(0) : value.toPrecision(3));

const COLUMNS = [
  "structure",
  "build",
  "ray",
  "counted",
  "visits",
  "boxes",
  "primitives",
  "bytes",
  "depth",
  "references",
];
const WIDTHS = [17, 9, 9, 9, 10, 10, 12, 10, 7, 12];

function printScene(name, result) {
  const usual = result.structures.find((s) => s.name === "bvh");
  const cheapest = Math.min(...result.structures.map((s) => s.counted_cost));
  console.log(`\n${name}: ${result.primitives} primitives, ${result.precision}; auto selects ${result.auto}`);
  console.log(cells(COLUMNS, WIDTHS));
  for (const s of result.structures) {
    const row = [
      s.name,
      fixed(s.build_s / usual.build_s),
      fixed(s.ray_s / usual.ray_s),
      fixed(s.counted_cost / cheapest),
      fixed(s.visits),
      fixed(s.boxes),
      fixed(s.primitives),
      fixed(s.bytes / result.primitives),
      String(s.depth),
      fixed(s.references / result.primitives),
    ];
    console.log(cells(row, WIDTHS));
  }
  const chosen = result.structures.find((s) => s.name === result.auto);
  console.log(`counted cost of auto: ${(chosen.counted_cost / cheapest).toFixed(2)} times the minimum`);
}

function scenePanel(name, result, names) {
  const usual = result.structures.find((s) => s.name === "bvh");
  const series = names.map((structure) => {
    const s = result.structures.find((one) => one.name === structure);
    if (!s) return { name: structure, points: [] };
    const x = Math.max(s.build_s / usual.build_s, 1e-3),
      y = s.ray_s / usual.ray_s;
    return { name: structure, points: [{ x, y, label: structure, ring: structure === result.auto }] };
  });
  return { title: name, x: "build time", y: "ray cost", series };
}

const STRUCTURES = {
  name: "structures",
  what: "all structures on different kinds of scenes: build time and ray cost relative to bvh, and counts per ray",
  run({ pairs, charts }) {
    const results = writeSubjects().map(([name, scene]) => {
      const result = measure(scene, pairs, "picture");
      printScene(name, result);
      return [name, result];
    });
    console.log(
      "\nbuild and ray: CPU time relative to bvh, medians of interleaved rounds on one thread; counted: cost from",
    );
    console.log(
      "counts, relative to the minimum; visits, boxes, primitives: per ray; bytes and references: per primitive",
    );
    const names = [...new Set(results.flatMap(([, result]) => result.structures.map((s) => s.name)))];
    const panels = results.map(([name, result]) => scenePanel(name, result, names));
    const title = "Structures: ray cost and build time";
    const note = "CPU time relative to bvh (1, 1), one thread; ringed: selected by auto";
    save(charts, "structures.svg", chart({ title, note, panels, columns: 4, names }));
  },
};

const GROWTH = {
  name: "growth",
  what: "cost of a random ray with 1e3 to 1e7 triangles",
  run({ pairs, charts }) {
    const widths = [12, 10, 12, 10, 14, 10];
    const head = ["triangles", "visits", "primitives", "ray", "build/tri.", "bytes"];
    console.log("\n" + cells(head, widths));
    const rows = SIZES.map((triangles) => {
      const result = measure(writeBall(triangles), pairs, "random", ["bvh"]);
      return { triangles: result.primitives, ...result.structures[0] };
    });
    const build = (row) => row.build_s / row.triangles;
    for (const row of rows)
      console.log(
        cells(
          [
            String(row.triangles),
            fixed(row.visits),
            fixed(row.primitives),
            fixed(row.ray_s / rows[0].ray_s),
            fixed(build(row) / build(rows[0])),
            fixed(row.bytes / row.triangles),
          ],
          widths,
        ),
      );
    console.log("visits and primitives: per ray; ray, and build per triangle: CPU time relative to the first row");
    const series = (key) => [{ name: key, line: true, points: rows.map((row) => ({ x: row.triangles, y: row[key] })) }];
    const panels = [
      { title: "node visits per ray", key: "visits" },
      { title: "primitive tests per ray", key: "primitives" },
      { title: "CPU time per ray", key: "relative" },
    ].map(({ title, key }) => ({
      title,
      x: "triangles",
      y: key === "relative" ? "relative to 1e3 triangles" : "per ray",
      yAxis: "linear",
      series:
        key === "relative"
          ? [{ name: key, line: true, points: rows.map((row) => ({ x: row.triangles, y: row.ray_s / rows[0].ray_s })) }]
          : series(key),
    }));
    const title = "Growth: a straight line is logarithmic";
    const note = "bvh, closest hits of random rays through a bumpy ball, one thread";
    save(charts, "growth.svg", chart({ title, note, panels, columns: 3, names: [] }));
  },
};

// Reports without a comparison: {name, what, run({pairs, charts})}.
export const REPORTS = [STRUCTURES, GROWTH].map((report) => ({ ...report, needs: [PROGRAM] }));
