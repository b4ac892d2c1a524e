// Applies a fault of faults.mjs to the text of its file.

import { existsSync, readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const kRoot = resolve(dirname(fileURLToPath(import.meta.url)), "../..");

// Returns {original, text}: the file below `root` without and with the fault. Returns {problem} unless `from`
// occurs exactly once.
export function planted({ file, from, to }, root = kRoot) {
  const path = join(root, file);
  if (!existsSync(path)) return { problem: `cannot find ${file}` };
  const original = readFileSync(path, "utf8");
  const count = original.split(from).length - 1;
  if (count !== 1) return { problem: `"from" must occur once in ${file} (got ${count})` };
  const text = original.replace(from, () => to);
  return text === original ? { problem: `"to" must differ from "from" in ${file}` } : { original, text };
}
