#!/usr/bin/env node
// Limits the length of functions and forbids some names and calls. Without arguments it checks this
// repository. With --self-test it checks small texts that each break a rule.

import { readdirSync, readFileSync } from "node:fs";
import { dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { selfTest } from "./self-test.mjs";

const kRoot = join(dirname(fileURLToPath(import.meta.url)), "../..");
const kFolders = ["core", "server", "tests", "web", "script"];
const kCode = new Set([".cpp", ".h", ".js", ".mjs"]);
const kMaxLines = 60;

// Project-specific names for which the field has standard terms.
const kPrivateNames =
  /\b(?:Trip|Meetings?|Crowd|Walkers|Rungs?|Sightings?|Thinned|Asker|Rider|Crew|Means|looseness|worsening)\b/;
// [rule, forbidden pattern, files that the rule applies to]
const kPatterns = [
  ["name", kPrivateNames, /\.(?:cpp|h)$/],
  ["stop", /\bstd::function<bool\(\)>/, /^(?:core|server)\//], // use std::stop_token
  // Wait for a condition instead.
  ["polling", /\bsleep_(?:for|until)\b|\busleep\b|\.wait_for\([^,()]*, *[^,]*\);/, /^(?:core|server)\//],
];

const withoutComments = (line) => line.replace(/"(?:[^"\\]|\\.)*"/g, '""').replace(/\/\/.*/, "");
// A line that opens the body of a function, a lambda or a branch. Formatters guarantee that the body ends
// with a brace that is indented no deeper.
const indentation = (line) => line.search(/\S|$/);
const kRow = /^\s*[{"]/; // row of a table in a function: data, not code
const opensBody = (line) => /\)[^;{}]*\{$|=> \{$/.test(line) && !/^\s*(?:namespace|class|struct|enum)\b/.test(line);

// Returns the problems as {line, rule, text}.
function judge(path, text) {
  const problems = [];
  const lines = text.split("\n");
  lines.forEach((full, index) => {
    const line = withoutComments(full).trimEnd();
    for (const [rule, pattern, where] of kPatterns) {
      const match = where.test(path) && line.match(pattern);
      if (match) problems.push({ line: index + 1, rule, text: `"${match[0]}"` });
    }
    if (!opensBody(line)) return;
    const end = lines.findIndex(
      (other, at) => at > index && /^\s*\}/.test(other) && indentation(other) <= indentation(line),
    );
    const length = lines.slice(index, end + 1).filter((other) => !kRow.test(other)).length;
    if (length > kMaxLines)
      problems.push({ line: index + 1, rule: "length", text: `function has ${length} lines (limit ${kMaxLines})` });
  });
  return problems;
}

function judgeRepository() {
  let count = 0;
  const files = kFolders.flatMap((folder) =>
    readdirSync(join(kRoot, folder), { recursive: true }).map((name) => `${folder}/${name}`),
  );
  for (const path of files.filter((name) => kCode.has(extname(name)))) {
    for (const { line, rule, text } of judge(path, readFileSync(join(kRoot, path), "utf8"))) {
      console.error(`${path}:${line}: ${rule}: ${text}`);
      ++count;
    }
  }
  console.log(`${count} problems`);
  return count;
}

const body = (lines) => `void f() {\n${"  g();\n".repeat(lines - 2)}}\n`;
const kSelfTests = [
  ["", "core/a.cpp", body(60)],
  ["length", "core/a.cpp", body(61)],
  ["", "core/a.cpp", `void f() {\n  return {\n${"      {1, 2},\n".repeat(60)}  };\n}\n`],
  ["", "core/a.cpp", `A::A(int b)\n    : b_(b) {\n  g();\n}\n${"int x;\n".repeat(99)}}\n`],
  ["length", "web/a.js", `const f = () => {\n${"  g();\n".repeat(60)}};\n`],
  ["", "core/a.cpp", `namespace a {\n${"int x;\n".repeat(99)}}\n`],
  ["name", "core/a.h", "struct Trip {};\n"],
  ["", "core/a.h", '// A Trip.\nconst char* a = "Trip";\n'],
  ["stop", "core/a.h", "void f(const std::function<bool()>& stop);\n"],
  ["", "tests/a.cpp", "std::function<bool()> ask;\n"],
  ["polling", "server/a.cpp", "std::this_thread::sleep_for(kWhile);\n"],
  ["polling", "server/a.cpp", "changed_.wait_for(lock, kAsk);\n"],
  ["", "server/a.cpp", "changed_.wait_for(lock, kLimit, [&] { return done_; });\n"],
];

const judgeSelf = () =>
  selfTest(
    kSelfTests,
    (path, text) => judge(path, text).map(({ rule }) => rule),
    (path, text) => `${path}: ${text.slice(0, 60)}`,
  );

process.exitCode = (process.argv.includes("--self-test") ? judgeSelf() : judgeRepository()) ? 1 : 0;
