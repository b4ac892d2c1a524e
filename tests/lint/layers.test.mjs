#!/usr/bin/env node
// Checks the source tree: allowed includes, complete registries and file length. Without arguments it checks
// this repository. With --self-test it checks small trees that each break one rule.

import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { drawRooms, kLayers } from "./rooms.mjs";
import { selfTest } from "./self-test.mjs";

const kComponents = kLayers.find((rooms) => rooms.includes("core/shapes"));
const kRegisteredRooms = [
  ...kComponents.filter((room) => room !== "core/occlusion"),
  "core/techniques",
  "core/stability",
];
const kGenerated = ["core/base/version.h"]; // in the build folder
const kMaxLines = 500;
const kTextFolders = [
  ".ci",
  "cmake",
  "core",
  "docker",
  "docs",
  "packaging",
  "scenes",
  "script",
  "server",
  "tests",
  "web",
];
const kCounted = new Set([".cpp", ".h", ".js", ".mjs", ".css", ".html", ".sh", ".cmake"]);
const kText = new Set([...kCounted, ".in", ".md", ".json", ".yaml", ".yml", ".txt", ".svg", ".pov", ".service", ""]);
const kUnread = new Set(["package-lock.json", "LICENSE", ".git"]); // .git is a file in a worktree
const kLibraries = [
  { name: "nlohmann", header: /^nlohmann\//, rooms: /^(core\/params|core\/meshes|server)\// },
  { name: "meshoptimizer", header: /^meshoptimizer\.h$/, rooms: /^(core\/meshes|tests)\// },
  { name: "draco", header: /^draco\//, rooms: /^(core\/meshes\/decoder|tests)\// },
  { name: "httplib", header: /^httplib\.h$/, rooms: /^(server\/http|tests)\// },
  { name: "libpng", header: /^png\.h$/, rooms: /^core\/image\/encode\// },
  { name: "turbojpeg", header: /^(turbojpeg|jpeglib)\.h$/, rooms: /^core\/image\/encode\// },
  { name: "pugixml", header: /^pugixml\.hpp$/, rooms: /^core\/meshes\// },
  { name: "libzip", header: /^zip\.h$/, rooms: /^core\/meshes\// },
  { name: "OpenImageIO", header: /^OpenImageIO\//, rooms: /^core\/image\/decode\/decoder\// },
  { name: "libwebp", header: /^webp\//, rooms: /^(core\/image\/decode\/decoder|tests)\// },
  { name: "OpenEXR", header: /^(OpenEXR\/|Imath\/|Imf|Imath|openexr)/, rooms: /^core\/image\/encode\// },
];
// Folders that exist on one machine only. After a word or a dot, the match would be part of a relative path.
const kMachinePath = /(?<![\w.)}\]-])(?:\/(?:work|home|root|Users|mnt)\/|[A-Z]:\\\\?Users)/;

const roomOf = (path) => path.split("/").slice(0, -1).slice(0, 2).join("/");
const floorOf = (path) => kLayers.findIndex((rooms) => rooms.includes(roomOf(path)));
const isCode = (path) => /^(core|server)\/.*\.(cpp|h)$/.test(path);

function listFiles(root) {
  const files = [];
  const walk = (folder) => {
    for (const entry of readdirSync(join(root, folder), { withFileTypes: true })) {
      const path = folder ? `${folder}/${entry.name}` : entry.name;
      if (entry.isFile()) files.push(path);
      else if (entry.isDirectory() && (folder || kTextFolders.includes(path))) walk(path);
    }
  };
  walk("");
  return files.filter((path) => kText.has(extname(path)) && !kUnread.has(path)).sort();
}

function includesOf(lines) {
  const found = [];
  lines.forEach((line, index) => {
    const match = line.match(/^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)/);
    if (match) found.push({ line: index + 1, target: match[1] ?? match[2], quoted: match[1] !== undefined });
  });
  return found;
}

// Returns the problems of the tree at `root`, as {path, line, rule, text}.
function judge(root) {
  const problems = [];
  const complain = (rule, path, line, text) => problems.push({ rule, path, line, text });
  const files = listFiles(root);
  const contents = new Map(files.map((path) => [path, readFileSync(join(root, path), "utf8")]));
  const includes = new Map();
  for (const path of files.filter(isCode)) includes.set(path, includesOf(contents.get(path).split("\n")));

  judgeText(contents, complain);
  judgeIncludes(includes, files, complain);
  judgeLibraries(includes, complain);
  judgeCycles(includes, complain);
  judgeRegistries(contents, complain);
  return problems;
}

function judgeText(contents, complain) {
  for (const [path, text] of contents) {
    const lines = text.split("\n");
    if (lines.at(-1) === "") lines.pop();
    const script = text.startsWith("#!") || basename(path) === "CMakeLists.txt";
    if ((script || kCounted.has(extname(path))) && lines.length > kMaxLines) {
      complain("length", path, kMaxLines + 1, `file has ${lines.length} lines (limit ${kMaxLines})`);
    }
    lines.forEach((line, index) => {
      const match = line.match(kMachinePath);
      if (match) complain("machine", path, index + 1, `"${match[0]}" exists on one machine only`);
    });
  }
}

function judgeIncludes(includes, files, complain) {
  for (const [path, list] of includes) {
    const floor = floorOf(path);
    if (floor < 0) complain("room", path, 1, `${roomOf(path)} is not in the list of layers`);
    if (/^server\//.test(roomOf(path)) && !files.includes(`${roomOf(path)}/README.md`)) {
      complain("readme", path, 1, `${roomOf(path)} needs a README.md: what it owns, its threads, its includes`);
    }
    for (const { line, target, quoted } of list) {
      if (!quoted) continue;
      if (!includes.has(target) && !kGenerated.includes(target)) {
        complain("root", path, line, `"${target}" must be a file in core/ or server/, relative to the repository root`);
      } else if (floorOf(target) > floor) {
        complain("floor", path, line, `"${target}" is in a higher layer`);
      } else if (floorOf(target) === floor && roomOf(target) !== roomOf(path)) {
        complain("neighbour", path, line, `"${target}" is in another folder of the same layer`);
      }
    }
  }
}

function judgeLibraries(includes, complain) {
  for (const [path, list] of includes) {
    for (const { line, target } of list) {
      for (const { name, header, rooms } of kLibraries) {
        if (header.test(target) && !rooms.test(path)) {
          complain("library", path, line, `${name} must not be included here (only in ${rooms.source})`);
        }
      }
    }
  }
}

function judgeCycles(includes, complain) {
  const done = new Set();
  const visit = (path, trail) => {
    if (trail.includes(path)) {
      complain("cycle", path, 1, [...trail.slice(trail.indexOf(path)), path].join(" -> "));
    } else if (!done.has(path)) {
      for (const { target, quoted } of includes.get(path) ?? []) if (quoted) visit(target, [...trail, path]);
      done.add(path);
    }
  };
  for (const path of includes.keys()) visit(path, []);
}

// A type in core/shapes/sphere.cpp defines sphere_type() (or _channel(), _row()). It is listed if
// registry.cpp names sphere, make_sphere or sphere_<word>. Any other .cpp file must have a header of the same
// name, because several types share its code.
function judgeRegistries(contents, complain) {
  for (const path of contents.keys()) {
    if (!path.endsWith(".cpp") || !kRegisteredRooms.includes(dirname(path))) continue;
    const name = basename(path, ".cpp");
    const system = new RegExp(`\\b${name}_(?:type|channel|row)\\(\\)`).test(contents.get(path));
    if (name === "registry" || (!system && contents.has(`${dirname(path)}/${name}.h`))) continue;
    const registry = contents.get(`${dirname(path)}/registry.cpp`) ?? "";
    const code = registry.replace(/\/\/.*|\/\*[^]*?\*\/|^\s*#.*/gm, "");
    if (!new RegExp(`\\b(?:make_)?${name}(?:_[a-z]+)?\\b`).test(code)) {
      complain("registry", path, 1, `must be listed in ${dirname(path)}/registry.cpp`);
    }
  }
}

// ---- self-test ----

const machineFolder = ["", "work", "checkout"].join("/");
const innerFolder = ["..", "work", "checkout"].join("/"); // not an absolute path
const kGoodTree = {
  "core/base/a.h": "#pragma once\n#include <string>\n",
  "core/params/params.cpp": '#include <nlohmann/json.hpp>\n#include "core/base/a.h"\n',
  "core/image/encode/png.cpp": "#include <png.h>\n#include <turbojpeg.h>\n#include <OpenEXR/ImfRgbaFile.h>\n",
  "core/meshes/gltf.cpp": "#include <nlohmann/json.hpp>\n",
  "core/model/shape.h": '#include "core/base/a.h"\n#include "core/base/version.h"\n',
  "core/shapes/sphere.cpp": `#include "core/model/shape.h"\n// see ${innerFolder}, docs/home/x\n`,
  "core/shapes/shared.h": "#pragma once\n",
  "core/shapes/shared.cpp": '#include "core/shapes/shared.h"\n',
  "core/shapes/registry.cpp": "ShapeType sphere_type();  // one line each\n",
  "server/http/README.md": "# HTTP\n",
  "server/http/http.cpp": '#include "core/model/shape.h"\n',
  "web/app.js": "// one\n".repeat(kMaxLines),
};
const kBadTrees = [
  ["floor", { "core/model/bad.h": '#include "server/http/x.h"\n', "server/http/x.h": "" }],
  [
    "floor",
    { "server/http/bad.h": '#include "server/app/app.h"\n', "server/app/app.h": "", "server/app/README.md": "" },
  ],
  ["floor", { "core/base/bad.h": '#include "core/model/shape.h"\n' }],
  [
    "neighbour",
    { "server/http/bad.h": '#include "server/cache/c.h"\n', "server/cache/c.h": "", "server/cache/README.md": "" },
  ],
  ["readme", { "server/jobs/job.h": "" }],
  ["neighbour", { "core/math/bad.h": '#include "core/base/a.h"\n' }],
  ["neighbour", { "core/shapes/bad.h": '#include "core/lights/light.h"\n', "core/lights/light.h": "" }],
  ["cycle", { "core/base/p.h": '#include "core/base/q.h"\n', "core/base/q.h": '#include "core/base/p.h"\n' }],
  ["registry", { "core/shapes/box.cpp": "int box;\n" }],
  ["registry", { "core/shapes/box.cpp": "ShapeType box_type() {}\n", "core/shapes/box.h": "#pragma once\n" }],
  ["registry", { "core/shapes/cone.cpp": "", "core/shapes/registry.cpp": "sphere_type(); // cone_type();\n" }],
  ["registry", { "core/shapes/box.cpp": "", "core/shapes/registry.cpp": "sphere_type(); boxes_type();\n" }],
  ["registry", { "core/lights/point.cpp": "int point;\n" }],
  ["length", { "web/long.js": "// line\n".repeat(kMaxLines + 1) }],
  ["length", { "script/long": `#!/bin/sh\n${"true\n".repeat(kMaxLines)}` }],
  ["library", { "core/model/json.cpp": "#include <nlohmann/json.hpp>\n" }],
  ["library", { "server/http/picture.cpp": "#include <png.h>\n" }],
  ["library", { "core/render/picture.cpp": "#include <turbojpeg.h>\n" }],
  ["library", { "core/load/picture.cpp": "#include <OpenEXR/ImfRgbaFile.h>\n" }],
  ["library", { "server/routes/client.cpp": "#include <httplib.h>\n", "server/routes/README.md": "" }],
  ["machine", { "script/run": `cd ${machineFolder}\n` }],
  ["machine", { "README.md": `It lies in "${machineFolder}".\n` }],
  ["root", { "core/model/near.cpp": '#include "shape.h"\n' }],
  ["room", { "core/attic/old.cpp": "int old;\n" }],
];

function judgeTree(tree) {
  const root = mkdtempSync(join(tmpdir(), "layers-"));
  try {
    for (const [path, text] of Object.entries(tree)) {
      mkdirSync(join(root, dirname(path)), { recursive: true });
      writeFileSync(join(root, path), text);
    }
    return judge(root).map(({ rule }) => rule);
  } finally {
    rmSync(root, { recursive: true });
  }
}

const judgeSelf = () =>
  selfTest(
    [["", {}], ...kBadTrees],
    (changes) => [...new Set(judgeTree({ ...kGoodTree, ...changes }))],
    (changes) => Object.keys(changes),
  );

function judgeRepository() {
  const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
  const problems = judge(root);
  const drawing = "docs/pictures/rooms.svg";
  if (readFileSync(join(root, drawing), "utf8") !== drawRooms())
    problems.push({ path: drawing, line: 1, rule: "drawing", text: "run node tests/lint/rooms.mjs > " + drawing });
  for (const { path, line, rule, text } of problems) console.error(`${path}:${line}: ${rule}: ${text}`);
  console.log(`${problems.length} problems`);
  return problems.length;
}

process.exitCode = (process.argv.includes("--self-test") ? judgeSelf() : judgeRepository()) ? 1 : 0;
