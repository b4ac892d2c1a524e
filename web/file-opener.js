// Opens files from the user: uploads a model and shows it, or shows a scene. Several files become one ZIP
// archive.

import { ApiError, getJson, isAbort } from "./api.js";
import { filesOf } from "./file-list.js";
import { element, hideProblem, showProblem } from "./problem.js";
import { pretty } from "./scenes.js";
import { upload } from "./upload.js";
import { zipOf } from "./zip.js";

const LONGER_SIDE = 512; // pixels of the picture that the service renders for the upload
const MODELS = ["gltf", "glb", "obj", "ply", "stl", "3mf", "zip"]; // extensions, the preferred one first
const $ = (id) => document.getElementById(id);
const megabytes = (bytes) => `${Number((bytes / 1e6).toPrecision(2))} MB`;
// Completes the text of an error or note. Errors of a whole file have no subject.
const sentence = (text) =>
  text.startsWith("must ") ? `The file ${text}.` : `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
const extensionOf = ({ path }) => path.slice(path.lastIndexOf(".") + 1).toLowerCase();

// Returns {main, isScene} of files from the user. `main` is the file that names the others.
export function chosenOf(files) {
  const depth = ({ path }) => path.split("/").length;
  const models = files.filter((file) => MODELS.includes(extensionOf(file)));
  const rank = (file) => 100 * MODELS.indexOf(extensionOf(file)) + depth(file);
  models.sort((a, b) => rank(a) - rank(b));
  const scene = models.length === 0 && files.find((file) => extensionOf(file) === "json");
  return { main: scene || models[0] || files[0], isScene: Boolean(scene) };
}

// Query of POST v1/view: frames the model for a whole turn on a stage of this aspect ratio. Renders one sample.
function viewQuery(aspect) {
  const pixels = (part) => Math.max(1, Math.round(LONGER_SIDE * Math.min(1, part)));
  return new URLSearchParams({
    width: pixels(aspect),
    height: pixels(1 / aspect),
    samples: 1,
    fit: "turn",
    pose_time: "all",
  });
}

export class FileOpener {
  #store;
  #on;
  #abort = new AbortController(); // cancels the current upload
  #card = $("file-card");

  // `on` as in attachFiles().
  constructor(store, on) {
    this.#store = store;
    this.#on = on;
    $("cancel-upload").addEventListener("click", () => this.#reset());
    store.subscribe(["ref"], () => this.#reset()); // another scene has been chosen
  }

  // Opens File and FileSystemEntry objects. Cancels the current upload.
  async open(entries) {
    const signal = this.#reset();
    let name = entries[0].name;
    try {
      const files = await filesOf(entries);
      signal.throwIfAborted();
      const { main, isScene } = chosenOf(files);
      name = main.file.name;
      if (isScene) await this.#on.show(await main.file.text());
      else await this.#openModel(name, files, signal);
    } catch (error) {
      if (!signal.aborted && !isAbort(error)) this.#fail(name, error, entries);
    }
  }

  async #openModel(name, files, signal) {
    this.#requireSize(files);
    this.#showProgress(name, 0);
    const blob = files.length === 1 ? files[0].file : await zipOf(files);
    signal.throwIfAborted();
    const path = `v1/view?${viewQuery(this.#on.aspect())}`;
    const response = await upload(path, blob, signal, (part) => this.#showProgress(name, part));
    const scene = await getJson(`v1/scenes/${response.headers.get("Orrery-Scene-Id")}`, { signal });
    if (!(await this.#on.show(pretty(scene), name))) return;
    this.#on.play();
    this.#reset();
    const notes = response.headers.get("Orrery-Model-Notes");
    if (notes) this.#showNotes(name, notes.split("; "));
  }

  #requireSize(files) {
    const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
    const limit = this.#store.get().limits.fileBytes;
    if (bytes === 0) throw new ApiError({ title: "Empty", detail: "The file is empty." });
    if (bytes <= limit) return;
    const detail = `${files.length > 1 ? "The files have" : "The file has"} ${megabytes(bytes)}. `;
    throw new ApiError({ title: "Too large", detail: `${detail}This service accepts at most ${megabytes(limit)}.` });
  }

  // Cancels the upload and hides the messages. Returns the signal of the next upload.
  #reset() {
    this.#abort.abort();
    this.#abort = new AbortController();
    $("upload").hidden = true;
    hideProblem(this.#card);
    return this.#abort.signal;
  }

  #showProgress(name, part) {
    const text = `${part < 1 ? "Uploading" : "Reading"} ${name}`;
    if ($("upload-text").textContent !== text) $("upload-text").textContent = text; // announced once
    if (part < 1) $("upload-progress").value = part;
    else $("upload-progress").removeAttribute("value");
    $("upload").hidden = false;
  }

  #fail(name, error, entries) {
    this.#reset();
    const { errors = [], line, column, requestId } = error;
    const isOfWhole = errors.every(({ pointer }) => !pointer);
    const detail = isOfWhole ? errors.map((each) => sentence(each.detail)).join(" ") : "";
    const shown = { title: `Cannot open ${name}`, detail: detail || error.detail || error.message, requestId };
    if (!isOfWhole) Object.assign(shown, { errors });
    if (line) Object.assign(shown, { line, column });
    this.#card.classList.remove("notes");
    showProblem(this.#card, shown, undefined, error.retryable ? [["Try again", () => this.open(entries)]] : []);
  }

  #showNotes(name, notes) {
    showProblem(this.#card, { title: `Notes on ${name}` });
    this.#card.classList.add("notes");
    const list = element("ul");
    list.append(...notes.map((note) => element("li", sentence(note))));
    this.#card.append(list);
  }
}
