// Compares the schema file with the loader: both must accept the same scenes. Inputs are the corpus, the
// sample scenes, and up to 1,500 small mutations of some of them. The loader is `orrery check --json
// FILE...`.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { strict as assert } from "node:assert";

const orrery = process.env.TEST_ORRERY;
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
// strict: a schema keyword that is unknown to ajv or cannot apply is an error.
const accepts = new Ajv({ strict: true, strictTypes: false, allErrors: false }).compile(schema);
const names_in = (folder) =>
  readdirSync(folder)
    .filter((name) => name.endsWith(".json"))
    .sort();

// Returns the problems that the loader finds, by file, without warnings. Files without problems are absent.
function check(files) {
  const { status, stdout, stderr } = spawnSync(orrery, ["check", "--json", ...files], {
    encoding: "utf8",
    maxBuffer: 2 ** 26,
  });
  const found = new Map();
  for (const problem of JSON.parse(stdout)) {
    if (problem.severity === "warning") continue;
    if (!found.has(problem.file)) found.set(problem.file, []);
    found.get(problem.file).push(problem);
  }
  assert.equal(status, found.size === 0 ? 0 : 2, stderr);
  return found;
}

let failures = 0;
function expect(condition, message) {
  if (condition) return;
  failures += 1;
  console.log(`FAILED: ${message}`);
}

// ---- corpus
const good = [`${here}/good`, "scenes"].flatMap((folder) => names_in(folder).map((name) => join(folder, name)));
const refused = check(good);
for (const file of good) {
  const accepted = accepts(JSON.parse(readFileSync(file, "utf8")));
  expect(accepted, `${file}: the schema says ${JSON.stringify(accepts.errors?.[0])}`);
  expect(!refused.has(file), `${file}: the loader says ${JSON.stringify(refused.get(file))}`);
}

const expectations = JSON.parse(readFileSync(`${here}/expectations.json`, "utf8"));
const bad = names_in(`${here}/bad`).map((name) => `${here}/bad/${name}`);
assert.ok(bad.length >= 40 && bad.length === Object.keys(expectations).length);
const problems = check(bad);
for (const file of bad) {
  const { pointer, by } = expectations[basename(file, ".json")];
  const first = problems.get(file)?.[0];
  expect(first?.pointer === pointer, `${file}: expected ${pointer}, the loader says ${JSON.stringify(first)}`);
  if (by === "json") continue; // not JSON, or an error that JSON.parse removes, such as a duplicate key
  const accepted = accepts(JSON.parse(readFileSync(file, "utf8")));
  expect(accepted === (by === "meaning"), `${file}: the schema ${accepted ? "accepts" : "rejects"} it`);
}

// ---- mutations: one random change each, without changes that only the loader can reject
let state = 20240229; // xorshift32, so that failures are reproducible
function random(count) {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return (state >>> 0) % count;
}
const pick = (list) => list[random(list.length)];

// Yields every place in the document as [holder, key, value, path].
function* places(value, path = []) {
  if (value === null || typeof value !== "object") return;
  for (const key of Array.isArray(value) ? value.keys() : Object.keys(value)) {
    yield [value, key, value[key], [...path, key]];
    yield* places(value[key], [...path, key]);
  }
}

// Returns the new value of a place, or undefined to remove it.
function mutated(value) {
  const others = [null, true, "text", 0.5, -1, 1e13, 5000000, [], {}, [0, 0, 0], [1], { type: "sphere" }];
  if (typeof value === "number") return pick([...others, value + 0.25, value * 2, -value, [value]]);
  if (typeof value === "boolean") return pick([...others, !value, String(value), undefined]);
  if (Array.isArray(value)) return pick([...others, [...value, 1], value.slice(1), { ...value }, undefined]);
  if (value && typeof value === "object")
    return pick([...others, undefined, { ...value, extra: 1 }, { ...value, type: "box" }, [value]]);
  return pick([...others, value + "x", value.toUpperCase(), undefined]);
}

// Keys with constraints that only the loader checks, such as numbers that must be consistent.
const fit_one_another = [
  ...["eye", "look_at", "up", "min", "max", "vertices", "base", "top", "positions", "indices", "normals"],
  ...["attenuation", "inner_degrees", "outer_degrees"],
  ...["points", "weights", "knots_u", "knots_v", "degree_u", "degree_v", "major_radius", "minor_radius"],
];
const is_of_wrong_form = (change) => change === null || typeof change === "string" || typeof change === "boolean";
function about_meaning(path, change) {
  if (path.at(-1) === "material") return typeof change === "string";
  const none_left = change === undefined || (Array.isArray(change) && change.length === 0);
  if (path[0] === "objects" && path.length <= 2 && none_left) return true; // instances would suffice
  if (path[0] === "materials" && path.length <= 2 && (path.length === 1 || change === undefined)) return true;
  return fit_one_another.some((key) => path.includes(key)) && !is_of_wrong_form(change);
}

const folder = mkdtempSync(join(tmpdir(), "orrery-schema-"));
const sources = [
  ...["shapes-every-form", "lights-every-key", "render-largest", "rough-every-key", "refractive-every-key"].map(
    (name) => `${here}/good/${name}.json`,
  ),
  ...["paper", "light-spot", "camera-orthographic"].map((name) => `scenes/${name}.json`),
];
const mutants = new Map(); // file -> { what, by_schema }
for (let round = 0; round < 1500; ++round) {
  const source = sources[round % sources.length];
  const scene = JSON.parse(readFileSync(source, "utf8"));
  const [holder, key, value, path] = pick([...places(scene)]);
  const change = mutated(value);
  if (about_meaning(path, change)) continue;
  if (change !== undefined) holder[key] = change;
  else if (Array.isArray(holder)) holder.splice(key, 1);
  else delete holder[key];
  const file = join(folder, `${round}.json`);
  writeFileSync(file, JSON.stringify(scene));
  const what = `${source} with /${path.join("/")} = ${JSON.stringify(change)}`;
  mutants.set(file, { what, by_schema: accepts(scene) });
}
const counts = { accepted: 0, refused: 0 };
const found = check([...mutants.keys()]);
for (const [file, { what, by_schema }] of mutants) {
  const by_loader = JSON.stringify(found.get(file)?.[0]);
  const verdict = by_schema ? "accepts" : "rejects";
  expect(by_schema === !by_loader, `${what}: the schema ${verdict} it, the loader says ${by_loader}`);
  counts[by_schema ? "accepted" : "refused"] += 1;
}
rmSync(folder, { recursive: true });
console.log(`mutations: ${counts.accepted} accepted, ${counts.refused} rejected by both`);
expect(counts.accepted > 50 && counts.refused > 500, "expected over 50 accepted and 500 rejected mutations");
process.exit(failures === 0 ? 0 : 1);
