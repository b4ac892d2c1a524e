// Lists of files that the user has chosen or dropped.

import { ApiError } from "./api.js";

const MAX_FILES = 1000;

// Resolves to [{path, file}] of File and FileSystemEntry objects, with the files in folders and below them.
// Leaves out hidden files. Throws ApiError if there is no file, or more than MAX_FILES.
export async function filesOf(entries) {
  const files = [];
  for (const entry of entries) await add(files, entry);
  if (files.length === 0) throw new ApiError({ title: "No file", detail: "There is no file in the folder." });
  return files;
}

async function add(files, entry) {
  if (entry.name.startsWith(".") || entry.name === "__MACOSX") return;
  if (entry.isDirectory) {
    const reader = entry.createReader();
    for (let some = await readSome(reader); some.length > 0; some = await readSome(reader))
      for (const each of some) await add(files, each);
    return;
  }
  if (files.length === MAX_FILES) {
    throw new ApiError({ title: "Too many files", detail: `The folder has more than ${MAX_FILES} files.` });
  }
  const file = entry.isFile ? await new Promise((resolve, reject) => entry.file(resolve, reject)) : entry;
  files.push({ path: (entry.fullPath ?? entry.name).replace(/^\//, ""), file });
}

// A reader returns its entries in batches, the last of which is empty.
const readSome = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
