// JSON Pointers (RFC 6901) resolved in a JSON text, which may be broken after the value. Not recursive: no
// nesting is too deep.

const kSpace = /[\s,:]*/y;
const kPlain = /[^\s,:{}[\]"]*/y;
const kString = /"(?:[^"\\]|\\.)*"?/sy;

function match_end(pattern, text, at) {
  pattern.lastIndex = at;
  pattern.exec(text);
  return Math.max(at, pattern.lastIndex);
}

const skip_space = (text, at) => match_end(kSpace, text, at);

// Returns the end of the value that starts at `at`.
function value_end(text, at) {
  let depth = 0;
  while (at < text.length) {
    const first = text[at];
    if (first === '"') at = match_end(kString, text, at);
    else if (first === "{" || first === "[") ((depth += 1), (at += 1));
    else if (first === "}" || first === "]") ((depth -= 1), (at += 1));
    else at = Math.max(at + 1, match_end(kPlain, text, at));
    if (depth <= 0) return at;
    at = skip_space(text, at);
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
function find_child(text, at, name) {
  const is_list = text[at] === "[";
  if (!is_list && text[at] !== "{") return null;
  let place = skip_space(text, at + 1);
  for (let index = 0; place < text.length && text[place] !== "}" && text[place] !== "]"; index += 1) {
    let key = null;
    if (!is_list) {
      key = [place, value_end(text, place)];
      place = skip_space(text, key[1]);
    }
    if ((is_list ? String(index) : unquoted(text.slice(...key))) === name) return { key, value: place };
    place = skip_space(text, value_end(text, place));
  }
  return null;
}

// Returns [start, end] in `text` of the value at `pointer`. For a missing member, returns the opening bracket
// of its nearest ancestor. With `key`, returns the place of that key in the value, if it is present.
export function locate(text, pointer, key = null) {
  const names = pointer
    .split("/")
    .slice(1)
    .map((name) => name.replaceAll("~1", "/").replaceAll("~0", "~"));
  let at = skip_space(text, 0);
  for (const name of names) {
    const child = find_child(text, at, name);
    if (!child) return [at, Math.min(at + 1, text.length)];
    at = child.value;
  }
  const child = key === null ? null : find_child(text, at, key);
  if (child?.key) return child.key;
  const opens = text[at] === "{" || text[at] === "[";
  return [at, opens ? at + 1 : value_end(text, at)];
}

// Returns the offset of a line and column, both counted from 1.
export function offset_of(text, line, column) {
  const lines = text.split("\n").slice(0, line);
  const last = lines.pop();
  return [...lines, ""].join("\n").length + Math.min(Math.max(0, column - 1), last.length);
}

// Returns {line, column} of an offset.
export function place_of(text, offset) {
  const lines = text.slice(0, offset).split("\n");
  return { line: lines.length, column: lines.at(-1).length + 1 };
}
