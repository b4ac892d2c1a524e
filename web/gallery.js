// The sample scenes, those that show one shape, light or the like under a heading of their own. A thumbnail
// is asked for once its row is in sight, one at a time, so that thumbnails never crowd out the picture.

import { title_of } from "./scenes.js";
import { picture_size } from "./size.js";
import { frame_url } from "./urls.js";

const kThumbnail = { width: 96, height: 72 }; // CSS pixels, as in style.css
const kFirst = "paper";
const kHeadings = {
  // by what a sample's name starts with, in the order shown
  "": "",
  material: "Materials",
  light: "Lights",
  shape: "Shapes",
  camera: "Cameras",
  technique: "Techniques",
};

function kind_of(sample) {
  const start = sample.name.split("-")[0];
  return start in kHeadings ? start : "";
}

export class Gallery {
  #root;
  #library;
  #on_pick;
  #limits;
  #queue = Promise.resolve();

  constructor(root, library, limits, on_pick) {
    this.#root = root;
    this.#library = library;
    this.#limits = limits;
    this.#on_pick = on_pick;
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries.filter((each) => each.isIntersecting)) {
        watcher.unobserve(entry.target);
        this.#queue = this.#queue.then(() => this.#load_thumbnail(entry.target)).catch(() => {});
      }
    });
    root.replaceChildren(...Object.keys(kHeadings).flatMap((kind) => this.#group(kind)));
    for (const box of root.querySelectorAll(".thumbnail")) watcher.observe(box);
  }

  mark(ref) {
    for (const button of this.#root.querySelectorAll("button")) {
      if (button.dataset.name === ref) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
  }

  #group(kind) {
    const members = this.#library.samples.filter((sample) => kind_of(sample) === kind);
    if (members.length === 0) return [];
    members.sort((a, b) => (b.name === kFirst) - (a.name === kFirst));
    const list = document.createElement("ul");
    list.append(...members.map((sample) => this.#row(sample)));
    if (!kHeadings[kind]) return [list];
    const heading = document.createElement("h2");
    heading.textContent = kHeadings[kind];
    return [heading, list];
  }

  #row(sample) {
    const thumbnail = document.createElement("span");
    thumbnail.className = "thumbnail";
    thumbnail.dataset.name = sample.name;
    const title = document.createElement("strong");
    title.textContent = title_of(sample);
    const description = document.createElement("span");
    description.textContent = sample.description ?? "";
    const text = document.createElement("span");
    text.className = "words";
    text.append(title, description);
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.name = sample.name;
    button.append(thumbnail, text);
    button.addEventListener("click", () => this.#on_pick(sample.name));
    const row = document.createElement("li");
    row.append(button);
    return row;
  }

  async #load_thumbnail(box) {
    const scene = await this.#library.open(box.dataset.name);
    const size = picture_size({
      mode: "fit",
      purpose: "still",
      box: kThumbnail,
      pixel_ratio: 2,
      scene,
      limits: this.#limits,
    });
    const image = new Image(kThumbnail.width, kThumbnail.height);
    image.alt = "";
    image.src = frame_url({ id: scene.id, azimuth: 0, elevation: 0, distance: 1, ...size, samples: 1 });
    await image.decode();
    box.append(image);
  }
}
