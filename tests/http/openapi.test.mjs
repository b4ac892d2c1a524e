// Checks every exchange of the http tests against the service's OpenAPI description. The status, the media
// type, the body and the headers of responses must match. Accepted request bodies must be valid, and every
// operation must have been requested.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const recorded = process.env.TEST_EXCHANGES;
let Ajv;
try {
  Ajv = require("ajv/dist/2020.js").default;
} catch {
  console.log("skipped: ajv is not installed");
  process.exit(77);
}
if (!recorded || !existsSync(recorded)) {
  console.log("skipped: no exchanges of the http tests found");
  process.exit(77);
}

const kHome = "http://orrery/openapi.json";
const exchanges = readFileSync(recorded, "utf8")
  .trim()
  .split("\n")
  .map((line) => JSON.parse(line));
const described = exchanges.find(
  ({ method, path, status }) => method === "GET" && path === "/openapi.json" && status === 200,
);
if (!described) {
  console.log("not ok: no test requests /openapi.json");
  process.exit(1);
}
const description = JSON.parse(described.body);
const ajv = new Ajv({ strict: false, allErrors: false, validateFormats: false });
const scene_schema = JSON.parse(readFileSync("scenes/schema/scene.json", "utf8"));
ajv.addSchema({ ...scene_schema, $id: "http://orrery/schemas/scene.json" });
ajv.addSchema(description, kHome);

const escaped = (part) => part.replaceAll("~", "~0").replaceAll("/", "~1");
const pointer_to = (...parts) => parts.map((part) => `/${escaped(part)}`).join("");
// Returns the object at a pointer, or the component that it refers to, with the pointer to it.
function resolve(pointer) {
  const at = pointer
    .split("/")
    .slice(1)
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
  const value = at.reduce((object, part) => object?.[part], description);
  return value?.$ref ? resolve(value.$ref.slice(1)) : { value, pointer };
}

const validators = new Map();
function problem_of(pointer, text) {
  if (!validators.has(pointer)) validators.set(pointer, ajv.compile({ $ref: `${kHome}#${encodeURI(pointer)}` }));
  const validate = validators.get(pointer);
  let value;
  try {
    value = JSON.parse(text);
  } catch (error) {
    return error.message;
  }
  return validate(value) ? null : ajv.errorsText(validate.errors);
}

const patterns = Object.keys(description.paths).map((path) => ({
  path,
  pattern: new RegExp(`^${path.replaceAll(".", "\\.").replaceAll(/\{\w+\}/g, "[^/]+")}$`),
}));
const asked = new Set();

function check_body(response, exchange) {
  const type = (exchange.headers["Content-Type"] ?? "").split(";")[0];
  const types = Object.keys(response.value.content ?? {});
  if (exchange.method === "HEAD") return null;
  if (types.length === 0) return type ? `must have no body (got ${type})` : null;
  if (!types.includes(type)) return `body must have type ${types} (got ${type || "none"})`;
  const schema = `${response.pointer}${pointer_to("content", type, "schema")}`;
  return response.value.content[type].schema ? problem_of(schema, exchange.body) : null;
}

function check_request(operation, exchange) {
  const content = operation.value.requestBody?.content ?? {};
  if (exchange.status >= 300 || !content["application/json"] || !exchange.request) return null;
  const schema = pointer_to("requestBody", "content", "application/json", "schema");
  const problem = problem_of(`${operation.pointer}${schema}`, exchange.request);
  return problem && `must reject the request body: ${problem}`;
}

const is_optional = (header) => resolve(header).value.required === false;

function check(exchange) {
  const place = patterns.find(({ pattern }) => pattern.test(exchange.path.split("?")[0]))?.path;
  if (!place) return exchange.path.startsWith("/v1/") && exchange.status < 400 ? "path is not described" : null;
  const method = exchange.method === "HEAD" ? "get" : exchange.method.toLowerCase();
  const operation = resolve(pointer_to("paths", place, method));
  if (!operation.value) return [204, 404, 405].includes(exchange.status) ? null : "method is not described";
  asked.add(`${method} ${place}`);
  const exact = resolve(`${operation.pointer}${pointer_to("responses", String(exchange.status))}`);
  const response =
    exact.value || exchange.status < 400 ? exact : resolve(`${operation.pointer}${pointer_to("responses", "default")}`);
  if (!response.value) return "status is not described";
  const missing = Object.keys(response.value.headers ?? {}).filter(
    (name) => !(name in exchange.headers) && !is_optional(`${response.pointer}${pointer_to("headers", name)}`),
  );
  if (missing.length > 0) return `missing header ${missing}`;
  return check_body(response, exchange) ?? check_request(operation, exchange);
}

let wrong = 0;
for (const exchange of exchanges) {
  const problem = check(exchange);
  if (!problem) continue;
  if (++wrong <= 20) console.log(`not ok: ${exchange.method} ${exchange.path} ${exchange.status}: ${problem}`);
}
for (const [path, item] of Object.entries(description.paths))
  for (const method of Object.keys(item).filter((key) => ["get", "post", "put", "delete"].includes(key)))
    if (!asked.has(`${method} ${path}`) && ++wrong) console.log(`not ok: ${method} ${path} was never requested`);
console.log(`${exchanges.length} exchanges, ${wrong} differ from the description`);
process.exit(wrong === 0 ? 0 : 1);
