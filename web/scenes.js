// Scenes known to the page: samples by name, pasted scenes by id. The service may evict a scene. The page
// posts an evicted scene again if the page has its text.

import { getJson, getText, postScene } from "./api.js";
import { floorHeight } from "./floor.js";
import { recall, remember } from "./storage.js";

const STORAGE_KEY = "orrery.scenes";
const MAX_STORED_LENGTH = 500_000; // characters; session storage is small
const MAX_STORED_SCENES = 8;
const UNTITLED = "Untitled scene";

export function titleOf(sample) {
  if (sample.title && sample.title !== sample.name) return sample.title;
  return sample.name.charAt(0).toUpperCase() + sample.name.slice(1);
}

// Returns the URL of a sample's thumbnail.
export const thumbnailOf = ({ name }) => `scenes/thumbnails/${name}.webp`;

// Library of scenes {ref, id, title, text, width, height, camera}, with {motion} if anything moves. `ref` is
// the name in links.
export class SceneLibrary {
  samples = []; // {name, title, description, href}
  #texts = new Map(); // name or id -> JSON text
  #titles = new Map(); // id -> title that the page has given to the scene
  #ids = new Map(); // id -> name of the sample

  constructor() {
    for (const [id, text, title] of storedTexts()) {
      this.#texts.set(id, text);
      if (title) this.#titles.set(id, title);
    }
  }

  sample(ref) {
    return this.samples.find((sample) => sample.name === ref);
  }

  // Opens the scene `ref`. Throws ApiError, with status 404 if neither the page nor the service knows the id.
  async open(ref) {
    const sample = this.sample(ref);
    const text = this.#texts.get(ref) ?? (sample ? await getText(sample.href) : undefined);
    if (text === undefined) return this.#fetch(ref);
    if (!sample) return this.post(text, this.#titles.get(ref));
    const info = await postScene(text);
    this.#texts.set(ref, text);
    this.#ids.set(info.id, ref);
    return { ...info, ref, title: titleOf(sample), text };
  }

  // Posts a scene text from the user. `title` replaces the scene's own. Throws ApiError with the places of the
  // errors in the text.
  async post(text, title = "") {
    const info = await postScene(text);
    const name = this.#ids.get(info.id);
    if (name) return { ...info, ref: name, title: titleOf(this.sample(name)), text };
    this.#keep(info.id, text, title);
    return { ...info, ref: info.id, title: title || info.title || UNTITLED, text };
  }

  async #fetch(id) {
    const text = pretty(await getJson(`v1/scenes/${id}`));
    const info = await postScene(text);
    return { ...info, ref: id, title: info.title || UNTITLED, text };
  }

  #keep(id, text, title) {
    this.#texts.set(id, text);
    if (title) this.#titles.set(id, title);
    if (text.length > MAX_STORED_LENGTH) return;
    const stored = storedTexts().filter(([known]) => known !== id);
    stored.push([id, text, title]);
    remember(STORAGE_KEY, stored.slice(-MAX_STORED_SCENES));
  }
}

// Returns {samples, floor} from a scene's text: its sample count and the height of its floor.
export function factsOf({ text, camera }) {
  try {
    const scene = JSON.parse(text);
    return { samples: scene.render?.samples ?? 1, floor: floorHeight(scene, camera) };
  } catch {
    return { samples: 0, floor: -Infinity }; // the service accepts more than JSON.parse, such as a byte order mark
  }
}

const storedTexts = () => recall(STORAGE_KEY) ?? [];

// Returns indented JSON with lists of numbers on one line.
export function pretty(value) {
  const list = /\[\s+((?:-?[\d.]+(?:e[+-]?\d+)?,?\s+)+)\]/gi;
  return JSON.stringify(value, null, 2).replace(list, (_, numbers) => `[${numbers.trim().replace(/\s+/g, " ")}]`);
}
