#!/usr/bin/env node
// Counts hard-to-read sentences in comments and documents, per folder. The counts of a folder must not exceed
// its limits in tests/lint/prose.json. --update lowers the allowed counts, --list [FOLDER] prints the
// sentences, and --self-test checks the rules with small texts.

import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { selfTest } from "./self-test.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const limitsFile = join(root, "tests/lint/prose.json");
const folders = [".", "core", "server", "web", "tests", "docs", "script", "docker", "scenes"];
const skippedFolders = /(?:^|\/)(?:build[^/]*|node_modules|\.git|\.cache)(?:\/|$)/;

// Pattern at the start of a comment line, or null for a document.
const commentMarks = new Map([
  ...[".cpp", ".h", ".js", ".mjs", ".css", ".cl"].map((extension) => [extension, /^\s*(?:\/\/+|\/\*+|\*+\/?) ?/]),
  ...[".sh", ".py", ".cmake", ".txt", ".yml", ""].map((extension) => [extension, /^\s*# ?/]),
  [".md", null],
]);
const trailingMarks = { slashes: /\s\/\/ (.*)$/, hash: /\s# (.*)$/ };

// Patterns that leveldb, pbrt, nori, mitsuba and Boost.Beast have in at most 0.4 % of their sentences.
const rules = {
  start: /^(?:What|Whatever|Who|Whoever|Whose|Whom|Of|Where|Beside|Likewise)\b/i,
  word: /\b(?:tells?|told|telling|foretells?|foretold|beside|anew|likewise|at hand|so (?:many|few)|who (?:waits?|asks?|has|had|have|leaves?|left|comes?|came|gives?|takes?|wants?|reads?|sends?)|what (?:is|has|had|was|are|waits?|moves?|shines?|comes?|came|goes|lies|stands)|holds? \w+ against|held against|none:)\b/i,
};

const withoutCode = (text) => text.replace(/`[^`]*`/g, "`code`").replace(/"(?:[^"\\]|\\.)*"/g, '"text"');

// Returns the sentences of a paragraph as {line, text}; `parts` is a list of {line, text}.
function sentencesOf(parts) {
  const sentences = [];
  let line = 0;
  let open = "";
  const close = () => {
    const text = open.trim();
    if (/[A-Za-z]{2}/.test(text)) sentences.push({ line, text });
    open = "";
  };
  for (const part of parts) {
    for (const piece of part.text.split(/(?<=[.!?]["')]?)\s+(?=["'(`*]*[A-Z])/)) {
      if (open === "") line = part.line;
      else if (piece !== part.text && !part.text.startsWith(piece)) [close(), (line = part.line)];
      open += ` ${piece}`;
    }
    if (/[.!?]["')]?$/.test(part.text)) close();
  }
  close();
  return sentences;
}

// Returns the paragraphs of comments, each a list of {line, text}.
function commentParagraphs(path, text) {
  const extension = extname(path);
  const mark = commentMarks.get(extension);
  const trailing = mark.source.includes("#") ? trailingMarks.hash : trailingMarks.slashes;
  const paragraphs = [[]];
  text.split("\n").forEach((full, index) => {
    const line = index + 1;
    const last = paragraphs.at(-1);
    const whole = mark.test(full) && !full.startsWith("#!");
    const rest = whole ? null : trailing.exec(full.replace(/"(?:[^"\\]|\\.)*"/g, '""'));
    if (rest) paragraphs.push([{ line, text: rest[1] }]);
    else if (!whole || full.replace(mark, "").trim() === "") paragraphs.push([]);
    else
      last.push({
        line,
        text: full
          .replace(mark, "")
          .replace(/\*\/\s*$/, "")
          .trim(),
      });
  });
  return paragraphs;
}

// Returns the paragraphs, list items, table cells and headings of a Markdown document.
function documentParagraphs(text) {
  const paragraphs = [[]];
  let inCode = false;
  text.split("\n").forEach((full, index) => {
    const line = index + 1;
    if (/^\s*```/.test(full)) inCode = !inCode;
    if (inCode || /^\s*(?:```|<|\|[-: |]*$|$)/.test(full)) return paragraphs.push([]);
    if (/^\s*\|/.test(full))
      return full.split(/(?<!\\)\|/).forEach((cell) => paragraphs.push([{ line, text: cell.trim() }]));
    if (/^\s*(?:[-*+]|\d+\.|#+) /.test(full)) paragraphs.push([]);
    return paragraphs.at(-1).push({ line, text: full.replace(/^\s*(?:[-*+]|\d+\.|#+|>) +/, "").trim() });
  });
  return paragraphs;
}

// Returns {sentences, problems}, where a problem is {line, rule, text}.
function judge(path, text) {
  const isDocument = commentMarks.get(extname(path)) === null;
  const paragraphs = isDocument ? documentParagraphs(text) : commentParagraphs(path, text);
  const sentences = paragraphs.flatMap(sentencesOf);
  const problems = sentences.flatMap(({ line, text: sentence }) =>
    Object.entries(rules)
      .filter(([, pattern]) => pattern.test(withoutCode(sentence).replace(/^[*"'(]+/, "")))
      .map(([rule]) => ({ line, rule, text: sentence })),
  );
  return { sentences: sentences.length, problems };
}

function filesOf(folder) {
  const recursive = folder !== ".";
  return readdirSync(join(root, folder), { recursive, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name).slice(root.length + 1))
    .filter((path) => !skippedFolders.test(path) && commentMarks.has(extname(path)))
    .sort();
}

// Returns the folder that a file is counted in, such as core/render, server or docs.
const roomOf = (path) => {
  const parts = dirname(path).split("/");
  return parts.slice(0, ["core", "server", "tests"].includes(parts[0]) ? 2 : 1).join("/");
};

function judgeRepository() {
  const rooms = new Map();
  for (const path of folders.flatMap(filesOf)) {
    const { sentences, problems } = judge(path, readFileSync(join(root, path), "utf8"));
    const room = rooms.get(roomOf(path)) ?? { sentences: 0, start: 0, word: 0, problems: [] };
    room.sentences += sentences;
    for (const problem of problems) {
      ++room[problem.rule];
      room.problems.push({ path, ...problem });
    }
    rooms.set(roomOf(path), room);
  }
  return new Map([...rooms].sort());
}

const percent = (count, all) => `${((100 * count) / Math.max(1, all)).toFixed(1)} %`;

function printTable(rooms) {
  const all = { sentences: 0, start: 0, word: 0 };
  console.log("folder                sentences  bad start  house word");
  const row = (name, { sentences, start, word }) =>
    console.log(
      `${name.padEnd(22)}${String(sentences).padStart(9)}` +
        `${`${start} (${percent(start, sentences)})`.padStart(13)}${`${word} (${percent(word, sentences)})`.padStart(14)}`,
    );
  for (const [name, room] of rooms) {
    for (const key of Object.keys(all)) all[key] += room[key];
    row(name, room);
  }
  row("all", all);
}

function checkRepository() {
  const limits = JSON.parse(readFileSync(limitsFile, "utf8"));
  const rooms = judgeRepository();
  let failures = 0;
  for (const [name, { start, word, problems }] of rooms) {
    const limit = limits[name] ?? { start: 0, word: 0 };
    for (const [rule, count] of Object.entries({ start, word })) {
      if (count <= limit[rule]) continue;
      ++failures;
      console.error(`${name}: ${count} sentences break the rule "${rule}" (limit ${limit[rule]}):`);
      for (const { path, line, text } of problems.filter((problem) => problem.rule === rule))
        console.error(`  ${path}:${line}: ${text.slice(0, 120)}`);
    }
  }
  printTable(rooms);
  return failures;
}

// Writes the current counts, or the previous limits where those are lower.
function updateLimits() {
  let before = {};
  try {
    before = JSON.parse(readFileSync(limitsFile, "utf8"));
  } catch {
    // Without a limits file, the counts become the limits.
  }
  const limits = {};
  for (const [name, { start, word }] of judgeRepository()) {
    const former = before[name] ?? (Object.keys(before).length ? { start: 0, word: 0 } : { start, word });
    const lowered = { start: Math.min(start, former.start), word: Math.min(word, former.word) };
    if (lowered.start || lowered.word) limits[name] = lowered;
  }
  writeFileSync(limitsFile, `${JSON.stringify(limits, null, 2)}\n`);
  return 0;
}

function listProblems(folder = "") {
  for (const { problems } of judgeRepository().values())
    for (const { path, line, rule, text } of problems)
      if (path.startsWith(folder)) console.log(`${path}:${line}: ${rule}: ${text.slice(0, 160)}`);
  return 0;
}

const selfTests = [
  ["", "a.h", "// Returns nullopt if the ray misses.\n"],
  ["start,word", "a.h", "// What waits.\n"],
  ["start", "a.h", "int a;  // of each ray\n"],
  ["", "a.h", "// The number\n// of rays.\n"],
  ["start", "a.h", "// The number. Of rays.\n"],
  ["word", "a.h", "// The log tells why.\n"],
  ["", "a.h", '// The message "who has it" is quoted.\n'],
  ["", "a.h", 'const char* a = "What";\n'],
  ["start,word", "a.md", "# Who waits\n"],
  ["", "a.md", "```\nWhat\n```\n"],
  ["word", "a.md", "| a | so many rays |\n"],
  ["start", "a.sh", "# Of each.\n"],
];

const judgeSelf = () =>
  selfTest(
    selfTests,
    (path, text) => judge(path, text).problems.map(({ rule }) => rule),
    (path, text) => `${path}: ${text}`,
  );

const [mode, argument] = process.argv.slice(2);
const modes = {
  "--update": updateLimits,
  "--list": () => listProblems(argument),
  "--self-test": judgeSelf,
};
process.exitCode = (modes[mode] ?? checkRepository)() ? 1 : 0;
