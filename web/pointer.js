// Resolves JSON Pointers (RFC 6901) in a JSON text, which may be malformed after the value. Not recursive, so
// the nesting depth is unlimited.

const SPACE = /[\s,:]*/y;
const PLAIN_TOKEN = /[^\s,:{}[\]"]*/y;
const STRING_TOKEN = /"(?:[^"\\]|\\.)*"?/sy;

function matchEnd(pattern, text, at) {
  pattern.lastIndex = at;
  pattern.exec(text);
  return Math.max(at, pattern.lastIndex);
}

const skipSpace = (text, at) => matchEnd(SPACE, text, at);

// Returns the end of the value that starts at `at`.
function valueEnd(text, at) {
  let depth = 0;
  while (at < text.length) {
    const first = text[at];
    if (first === '"') at = matchEnd(STRING_TOKEN, text, at);
    else if (first === "{" || first === "[") ((depth += 1), (at += 1));
    else if (first === "}" || first === "]") ((depth -= 1), (at += 1));
    else at = Math.max(at + 1, matchEnd(PLAIN_TOKEN, text, at));
    if (depth <= 0) return at;
    at = skipSpace(text, at);
  }
  return text.length;
}

function unquoted(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text.replace(/^"|"$/g, "");
  }
}

// Returns the member `name` of the object or list at `at` as {key: [start, end] or null, value: start}, or
// null.
function findChild(text, at, name) {
  const isList = text[at] === "[";
  if (!isList && text[at] !== "{") return null;
  let place = skipSpace(text, at + 1);
  for (let index = 0; place < text.length && text[place] !== "}" && text[place] !== "]"; index += 1) {
    let key = null;
    if (!isList) {
      key = [place, valueEnd(text, place)];
      place = skipSpace(text, key[1]);
    }
    if ((isList ? String(index) : unquoted(text.slice(...key))) === name) return { key, value: place };
    place = skipSpace(text, valueEnd(text, place));
  }
  return null;
}

// Returns [start, end] in `text` of the value at `pointer`. For a missing member, returns the opening bracket
// of its nearest existing ancestor. With `key`, returns the place of that key in the value, if it is present.
export function locate(text, pointer, key = null) {
  const names = pointer
    .split("/")
    .slice(1)
    .map((name) => name.replaceAll("~1", "/").replaceAll("~0", "~"));
  let at = skipSpace(text, 0);
  for (const name of names) {
    const child = findChild(text, at, name);
    if (!child) return [at, Math.min(at + 1, text.length)];
    at = child.value;
  }
  const child = key === null ? null : findChild(text, at, key);
  if (child?.key) return child.key;
  const opens = text[at] === "{" || text[at] === "[";
  return [at, opens ? at + 1 : valueEnd(text, at)];
}

// Returns the offset of a line and column, both counted from 1.
export function offsetOf(text, line, column) {
  const lines = text.split("\n").slice(0, line);
  const last = lines.pop();
  return [...lines, ""].join("\n").length + Math.min(Math.max(0, column - 1), last.length);
}

// Returns {line, column} of an offset.
export function placeOf(text, offset) {
  const lines = text.slice(0, offset).split("\n");
  return { line: lines.length, column: lines.at(-1).length + 1 };
}
