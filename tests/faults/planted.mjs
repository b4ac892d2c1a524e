// What a file holds while a fault of faults.mjs is in it.

import {existsSync, readFileSync} from "node:fs";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

export const kRoot = resolve(dirname(fileURLToPath(import.meta.url)), "../..");

// {original, text}: the file at `root` without and with the fault; {problem} if the fault has no one place.
export function planted({file, from, to}, root = kRoot) {
  const path = join(root, file);
  if (!existsSync(path)) return {problem: `${file} is missing`};
  const original = readFileSync(path, "utf8");
  const count = original.split(from).length - 1;
  if (count !== 1) return {problem: `its place stands ${count} times in ${file}, not once`};
  const text = original.replace(from, () => to);
  return text === original ? {problem: `it changes nothing in ${file}`} : {original, text};
}
