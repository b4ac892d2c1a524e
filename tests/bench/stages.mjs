// Compares a structure behind a stage with the structure alone.

import { mkdirSync, writeFileSync } from "node:fs";
import { FOLDER, randomNumbers, sceneOf, writeBall, writeSubjects } from "./subjects.mjs";
import { startTwoSided } from "./two_sided.mjs";

const PROGRAM = "build/stages";

// Writes a scene in which a few large balls occlude 16 lamps for a meadow of small balls, the best case for
// prediction.
function writeShade() {
  mkdirSync(FOLDER, { recursive: true });
  const random = randomNumbers(7),
    at = () => 8 * random() - 4;
  const ball = (center, radius) => ({ type: "sphere", center, radius, material: "chalk" });
  const meadow = Array.from({ length: 8000 }, () => ball([at(), 0.1 * random(), at()], 0.02 + 0.04 * random()));
  const clouds = Array.from({ length: 6 }, () => ball([0.7 * at(), 2.5 + random(), 0.7 * at()], 0.9));
  const scene = sceneOf("A meadow in the shade", [...meadow, ...clouds], [0, 6, 9]);
  scene.lights = Array.from({ length: 16 }, () => ({
    type: "point",
    position: [0.2 * at(), 9, 0.2 * at()],
    intensity: [0.06, 0.06, 0.06],
    attenuation: [1, 0, 0],
  }));
  const path = `${FOLDER}/shade.json`;
  writeFileSync(path, JSON.stringify(scene));
  return path;
}

let subjects = null;
function pathOf(subject) {
  if (subject === "shade") return writeShade();
  if (subject === "million") return writeBall(1_000_000);
  subjects ??= new Map(writeSubjects());
  return subjects.get(subject);
}

const percent = (part, whole) => `${((100 * part) / whole).toFixed(1)} %`;

function remarkOf({ rays, ray_s: rayS, occluded, proposals, proofs, build_ms: buildMs }, stage) {
  const alone = `${rays} rays, ${(1e9 * rayS).toFixed(0)} ns each in the structure alone`;
  if (stage !== "predict") return alone;
  return (
    `${alone}, ${percent(occluded, rays)} occluded, of which ${percent(proofs, occluded)} proved by ` +
    `${(proposals / rays).toFixed(2)} proposals a ray, ${buildMs.toFixed(0)} ms of training`
  );
}

// `asked` contains the arguments of the program: structure, stage and predictor.
function comparison(name, what, subject, asked) {
  return {
    name,
    what,
    cost: "CPU s of one thread",
    reach: null,
    aim: null,
    needs: [PROGRAM],
    start: async () => {
      const { facts, ...sides } = await startTwoSided(PROGRAM, [pathOf(subject), ...asked]);
      return { ...sides, remark: remarkOf(facts, asked[1]) };
    },
  };
}

const USUAL = "bvh";
const PREDICTORS = [
  ["none", "no predictor (noise of the measurement)"],
  ["last", "the last occluder of the batch"],
  ["random", "random primitives"],
  ["network", "a network trained on some tiles"],
];

function predictions(short, scene, subject, structure = USUAL) {
  const where = structure === USUAL ? short : `${short}-${structure}`;
  const rows = PREDICTORS.map(([predictor, words]) =>
    comparison(
      `prediction-${where}-${predictor}`,
      `shadow rays among ${scene}, predicted by ${words}, compared with ${structure} alone`,
      subject,
      [structure, "predict", predictor],
    ),
  );
  const nearest = comparison(
    `prediction-${where}-nearest`,
    `camera rays among ${scene} with known nearest hits, compared with ${structure} alone: upper bound of the ` +
      "savings by prediction of hits",
    subject,
    [structure, "known", "nearest"],
  );
  return [...rows, nearest];
}

const RAYS = [
  ["coherent", "camera", "camera rays"],
  ["bounced", "bounced", "random rays from the visible points of a tile"],
  ["incoherent", "scattered", "random rays from all visible points, shuffled"],
];

function reorderings(short, scene, subject) {
  return RAYS.map(([name, kind, words]) =>
    comparison(
      `reordering-${short}-${name}`,
      `${words}, among ${scene}, sorted, compared with the original order`,
      subject,
      [USUAL, "reorder", kind],
    ),
  );
}

export const STAGES = [
  ...predictions("many", "8,000 balls that shade each other", "cloud"),
  ...predictions("few", "6 large balls over 8,000 small ones", "shade"),
  ...predictions("few", "6 large balls over 8,000 small ones", "shade", "octree"),
  ...predictions("mesh", "70,000 triangles", "bumpy"),
  ...reorderings("balls", "8,000 balls", "cloud"),
  ...reorderings("mesh", "70,000 triangles", "bumpy"),
  ...reorderings("million", "a million triangles", "million"),
];
