// Scenes the page knows: the service's samples by name, pasted ones by id. The service may forget a scene; as long
// as its text is here it is posted again.

import { get_json, get_text, post_scene } from "./api.js";
import { floor_height } from "./floor.js";
import { recall, remember } from "./storage.js";

const kStorageKey = "orrery.scenes";
const kLongestKept = 500_000; // characters; session storage is small
const kMostKept = 8;
const kUntitled = "Your scene";

export function title_of(sample) {
  if (sample.title && sample.title !== sample.name) return sample.title;
  return sample.name.charAt(0).toUpperCase() + sample.name.slice(1);
}

// Address of its picture in the gallery.
export const thumbnail_of = ({ name }) => `scenes/thumbnails/${name}.webp`;

// A scene is {ref, id, title, text, width, height, camera} and, if something moves in it, {motion}; `ref` is what
// a link calls it.
export class SceneLibrary {
  samples = []; // {name, title, description, href}
  #texts = new Map(); // name or id -> JSON text
  #ids = new Map(); // id -> name of the sample

  constructor() {
    for (const [id, text] of kept_texts()) this.#texts.set(id, text);
  }

  sample(ref) {
    return this.samples.find((sample) => sample.name === ref);
  }

  // The scene that `ref` names. Throws ApiError: 404 for an id that neither side knows any more.
  async open(ref) {
    const sample = this.sample(ref);
    const text = this.#texts.get(ref) ?? (sample ? await get_text(sample.href) : undefined);
    if (text === undefined) return this.#fetch(ref);
    if (!sample) return this.post(text);
    const info = await post_scene(text);
    this.#texts.set(ref, text);
    this.#ids.set(info.id, ref);
    return { ...info, ref, title: title_of(sample), text };
  }

  // Posts a text of the user's own. Throws ApiError with the places that are wrong in it.
  async post(text) {
    const info = await post_scene(text);
    const name = this.#ids.get(info.id);
    if (name) return { ...info, ref: name, title: title_of(this.sample(name)), text };
    this.#keep(info.id, text);
    return { ...info, ref: info.id, title: info.title || kUntitled, text };
  }

  async #fetch(id) {
    const text = pretty(await get_json(`v1/scenes/${id}`));
    const info = await post_scene(text);
    return { ...info, ref: id, title: info.title || kUntitled, text };
  }

  #keep(id, text) {
    this.#texts.set(id, text);
    if (text.length > kLongestKept) return;
    const kept = kept_texts().filter(([known]) => known !== id);
    kept.push([id, text]);
    remember(kStorageKey, kept.slice(-kMostKept));
  }
}

// What the page reads in a scene's text itself: {samples, floor}, the samples that it asks for and its floor's height.
export function facts_of({ text, camera }) {
  try {
    const scene = JSON.parse(text);
    return { samples: scene.render?.samples ?? 1, floor: floor_height(scene, camera) };
  } catch {
    return { samples: 0, floor: -Infinity }; // the service may read what JSON.parse does not, such as a byte order mark
  }
}

const kept_texts = () => recall(kStorageKey) ?? [];

// Indented JSON with lists of numbers on one line.
export function pretty(value) {
  const list = /\[\s+((?:-?[\d.]+(?:e[+-]?\d+)?,?\s+)+)\]/gi;
  return JSON.stringify(value, null, 2).replace(
    list,
    (_, numbers) => `[${numbers.trim().replace(/\s+/g, " ")}]`,
  );
}
