// Scenes known to the page: samples by name, pasted scenes by id. The service may evict a scene. The page
// posts it again if it has the text.

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

// Returns the address of a sample's thumbnail.
export const thumbnail_of = ({ name }) => `scenes/thumbnails/${name}.webp`;

// Library of scenes {ref, id, title, text, width, height, camera}, with {motion} if anything moves. `ref` is
// the name in links.
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

  // Opens the scene `ref`. Throws ApiError, with status 404 if neither page nor service has the id.
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

  // Posts a text of the user. Throws ApiError with the places of its errors.
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

// Returns {samples, floor} from a scene's text: its sample count and the height of its floor.
export function facts_of({ text, camera }) {
  try {
    const scene = JSON.parse(text);
    return { samples: scene.render?.samples ?? 1, floor: floor_height(scene, camera) };
  } catch {
    return { samples: 0, floor: -Infinity }; // the service accepts more than JSON.parse, such as a byte order mark
  }
}

const kept_texts = () => recall(kStorageKey) ?? [];

// Returns indented JSON with lists of numbers on one line.
export function pretty(value) {
  const list = /\[\s+((?:-?[\d.]+(?:e[+-]?\d+)?,?\s+)+)\]/gi;
  return JSON.stringify(value, null, 2).replace(
    list,
    (_, numbers) => `[${numbers.trim().replace(/\s+/g, " ")}]`,
  );
}
