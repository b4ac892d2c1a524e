// Stages in front of a structure, compared with the structure alone.

import { mkdirSync, writeFileSync } from "node:fs";
import { kFolder, random_numbers, scene_of, write_ball, write_subjects } from "./subjects.mjs";
import { start_two_sided } from "./two_sided.mjs";

const kProgram = "build/stages";

// Writes a scene in which a few large balls shade a meadow of small ones from 16 lamps, the best case of
// prediction.
function write_shade() {
  mkdirSync(kFolder, { recursive: true });
  const random = random_numbers(7),
    at = () => 8 * random() - 4;
  const ball = (center, radius) => ({ type: "sphere", center, radius, material: "chalk" });
  const meadow = Array.from({ length: 8000 }, () => ball([at(), 0.1 * random(), at()], 0.02 + 0.04 * random()));
  const clouds = Array.from({ length: 6 }, () => ball([0.7 * at(), 2.5 + random(), 0.7 * at()], 0.9));
  const scene = scene_of("A meadow in the shade", [...meadow, ...clouds], [0, 6, 9]);
  scene.lights = Array.from({ length: 16 }, () => ({
    type: "point",
    position: [0.2 * at(), 9, 0.2 * at()],
    intensity: [0.06, 0.06, 0.06],
    attenuation: [1, 0, 0],
  }));
  const path = `${kFolder}/shade.json`;
  writeFileSync(path, JSON.stringify(scene));
  return path;
}

let subjects = null;
function path_of(subject) {
  if (subject === "shade") return write_shade();
  if (subject === "million") return write_ball(1_000_000);
  subjects ??= new Map(write_subjects());
  return subjects.get(subject);
}

const percent = (part, whole) => `${((100 * part) / whole).toFixed(1)} %`;

function remark_of({ rays, ray_s, occluded, proposals, proofs, build_ms }, stage) {
  const alone = `${rays} rays, ${(1e9 * ray_s).toFixed(0)} ns each in the structure alone`;
  if (stage !== "predict") return alone;
  return (
    `${alone}, ${percent(occluded, rays)} occluded, of these ${percent(proofs, occluded)} proved by ` +
    `${(proposals / rays).toFixed(2)} proposals a ray, ${build_ms.toFixed(0)} ms of training`
  );
}

// `asked`: arguments of the program, such as structure, stage and predictor.
function comparison(name, what, subject, asked) {
  return {
    name,
    what,
    cost: "CPU s of one thread",
    reach: null,
    aim: null,
    needs: [kProgram],
    start: async () => {
      const { facts, ...sides } = await start_two_sided(kProgram, [path_of(subject), ...asked]);
      return { ...sides, remark: remark_of(facts, asked[1]) };
    },
  };
}

const kUsual = "bvh";
const kPredictors = [
  ["none", "nobody: what chance alone does"],
  ["last", "the last occluder of the batch"],
  ["random", "any primitive"],
  ["network", "a network trained on some tiles"],
];

function predictions(short, scene, subject, structure = kUsual) {
  const where = structure === kUsual ? short : `${short}-${structure}`;
  const rows = kPredictors.map(([predictor, words]) =>
    comparison(
      `prediction-${where}-${predictor}`,
      `shadow rays among ${scene}, predicted by ${words}, against ${structure} alone`,
      subject,
      [structure, "predict", predictor],
    ),
  );
  const nearest = comparison(
    `prediction-${where}-nearest`,
    `camera rays among ${scene} that bring their nearest hit for nothing, against ${structure} alone: the most ` +
      "that predicting it could save",
    subject,
    [structure, "known", "nearest"],
  );
  return [...rows, nearest];
}

const kRays = [
  ["coherent", "camera", "camera rays"],
  ["bounced", "bounced", "rays in any direction off what a tile shows"],
  ["incoherent", "scattered", "rays in any direction off what the picture shows, shuffled"],
];

function reorderings(short, scene, subject) {
  return kRays.map(([name, kind, words]) =>
    comparison(`reordering-${short}-${name}`, `${words}, among ${scene}, sorted, against as they come`, subject, [
      kUsual,
      "reorder",
      kind,
    ]),
  );
}

export const kStages = [
  ...predictions("many", "8,000 balls that shade each other", "cloud"),
  ...predictions("few", "6 large balls over 8,000 small ones", "shade"),
  ...predictions("few", "6 large balls over 8,000 small ones", "shade", "octree"),
  ...predictions("mesh", "70,000 triangles", "bumpy"),
  ...reorderings("balls", "8,000 balls", "cloud"),
  ...reorderings("mesh", "70,000 triangles", "bumpy"),
  ...reorderings("million", "a million triangles", "million"),
];
