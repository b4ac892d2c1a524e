// The schema file against the loader: what one accepts, the other accepts. The corpus and the sample scenes go
// through both, then some hundred small mutations of them. The loader is `orrery check FILE` (exit status 0 or not).
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { strict as assert } from "node:assert";

const orrery = process.env.ORRERY_BIN;
const require = createRequire(import.meta.url);
let Ajv;
try {
  Ajv = require("ajv/dist/2020.js").default;
} catch {
  console.log("ajv is not installed");
  process.exit(77);
}

const here = "tests/schema";
const schema = JSON.parse(readFileSync("scenes/schema/scene.json", "utf8"));
// strict: a keyword that ajv does not know or that cannot apply is an error of ours.
const accepts = new Ajv({ strict: true, strictTypes: false, allErrors: false }).compile(schema);
const namesIn = (folder) => readdirSync(folder).filter((name) => name.endsWith(".json")).sort();
const check = (file) => spawnSync(orrery, ["check", file], { encoding: "utf8" });

let failures = 0;
function expect(condition, message) {
  if (condition) return;
  failures += 1;
  console.log(`FAILED: ${message}`);
}

// ---- corpus
for (const folder of [`${here}/good`, "scenes"])
  for (const name of namesIn(folder)) {
    const scene = JSON.parse(readFileSync(join(folder, name), "utf8"));
    expect(accepts(scene), `${folder}/${name}: the schema refuses it: ${JSON.stringify(accepts.errors?.[0])}`);
    const { status, stdout, stderr } = check(join(folder, name));
    expect(status === 0, `${folder}/${name}: the loader refuses it: ${stdout}${stderr}`);
  }

const expectations = JSON.parse(readFileSync(`${here}/expectations.json`, "utf8"));
assert.ok(Object.keys(expectations).length >= 40);
for (const [name, { pointer, by }] of Object.entries(expectations)) {
  const file = `${here}/bad/${name}.json`;
  const { status, stdout, stderr } = check(file);
  expect(status > 0, `${file}: the loader accepts it, or crashed: ${status}`);
  expect((stdout + stderr).includes(pointer), `${file}: the loader does not name ${pointer}: ${stdout}${stderr}`);
  if (by === "json") continue; // no JSON, or JSON with what a parsed value no longer shows
  const accepted = accepts(JSON.parse(readFileSync(file, "utf8")));
  expect(accepted === (by === "meaning"), `${file}: the schema ${accepted ? "accepts" : "refuses"} it`);
}

// ---- mutations: one change of form at a random place, none that only changes the meaning
let state = 20240229; // xorshift32, so that a failure can be repeated
function random(count) {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return (state >>> 0) % count;
}
const pick = (list) => list[random(list.length)];

// Every place in the document: [holder, key, value, path].
function* places(value, path = []) {
  if (value === null || typeof value !== "object") return;
  for (const key of Array.isArray(value) ? value.keys() : Object.keys(value)) {
    yield [value, key, value[key], [...path, key]];
    yield* places(value[key], [...path, key]);
  }
}

// The new value of a place, or undefined to remove it.
function mutated(value) {
  const others = [null, true, "text", 0.5, -1, 1e13, 5000000, [], {}, [0, 0, 0], [1], { type: "sphere" }];
  if (typeof value === "number") return pick([...others, value + 0.25, value * 2, -value, [value]]);
  if (Array.isArray(value)) return pick([...others, [...value, 1], value.slice(1), { ...value }, undefined]);
  if (value && typeof value === "object")
    return pick([...others, undefined, { ...value, extra: 1 }, { ...value, type: "box" }, [value]]);
  return pick([...others, value + "x", value.toUpperCase(), undefined]);
}

// Changes here would touch what only the loader knows: names that must exist, and numbers that must fit one another.
const aboutMeaning = (path, change) =>
  (path.at(-1) === "material" && typeof change === "string") ||
  (path[0] === "materials" && (path.length === 1 || (path.length === 2 && change === undefined))) ||
  ["eye", "look_at", "up", "min", "max", "vertices", "base", "top", "positions", "indices", "normals", "attenuation",
    "inner_degrees", "outer_degrees"].some((key) => path.includes(key)) && !isOfWrongForm(change);
const isOfWrongForm = (change) => change === null || typeof change === "string" || typeof change === "boolean";

const folder = mkdtempSync(join(tmpdir(), "orrery-schema-"));
const sources = [`${here}/good/shapes-every-form.json`, `${here}/good/lights-every-key.json`, `${here}/good/render-largest.json`,
  `${here}/good/rough-every-key.json`, `${here}/good/refractive-every-key.json`, "scenes/paper.json", "scenes/light-spot.json",
  "scenes/camera-orthographic.json"];
const counts = { accepted: 0, refused: 0 };
for (let round = 0; round < 600; ++round) {
  const scene = JSON.parse(readFileSync(sources[round % sources.length], "utf8"));
  const [holder, key, value, path] = pick([...places(scene)]);
  const change = mutated(value);
  if (aboutMeaning(path, change)) continue;
  if (change !== undefined) holder[key] = change;
  else if (Array.isArray(holder)) holder.splice(key, 1);
  else delete holder[key];
  const file = join(folder, "scene.json");
  writeFileSync(file, JSON.stringify(scene));
  const bySchema = accepts(scene);
  const { status, stdout, stderr } = check(file);
  expect(bySchema === (status === 0) && status !== null,
    `/${path.join("/")} = ${JSON.stringify(change)} in ${sources[round % sources.length]}: ` +
      `schema ${bySchema ? "accepts" : "refuses"}, loader says ${status}: ${stdout}${stderr}`);
  counts[bySchema ? "accepted" : "refused"] += 1;
}
rmSync(folder, { recursive: true });
console.log(`mutations: ${counts.accepted} accepted, ${counts.refused} refused by both`);
expect(counts.accepted > 30 && counts.refused > 250, "the mutations are too one-sided to show anything");
process.exit(failures === 0 ? 0 : 1);
