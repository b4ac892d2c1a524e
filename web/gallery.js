// The list of sample scenes. A thumbnail is asked for once its row is in sight, one at a time, so that
// thumbnails never crowd out the picture.

import { picture_size } from "./size.js";
import { frame_url } from "./urls.js";

const kThumbnail = { width: 96, height: 72 };  // CSS pixels, as in style.css

export class Gallery {
  #list;
  #library;
  #on_pick;
  #limits;
  #queue = Promise.resolve();

  constructor(list, library, limits, on_pick) {
    this.#list = list;
    this.#library = library;
    this.#limits = limits;
    this.#on_pick = on_pick;
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries.filter((each) => each.isIntersecting)) {
        watcher.unobserve(entry.target);
        this.#queue = this.#queue.then(() => this.#load_thumbnail(entry.target)).catch(() => {});
      }
    });
    list.replaceChildren(...library.samples.map((sample) => this.#row(sample)));
    for (const image of list.querySelectorAll("img")) watcher.observe(image);
  }

  mark(ref) {
    for (const button of this.#list.querySelectorAll("button")) {
      if (button.dataset.name === ref) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    }
  }

  #row(sample) {
    const image = document.createElement("img");
    Object.assign(image, { alt: "", ...kThumbnail });
    image.dataset.name = sample.name;
    const title = document.createElement("strong");
    title.textContent = sample.title || sample.name;
    const description = document.createElement("span");
    description.textContent = sample.description ?? "";
    const text = document.createElement("span");
    text.className = "words";
    text.append(title, description);
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.name = sample.name;
    button.append(image, text);
    button.addEventListener("click", () => this.#on_pick(sample.name));
    const row = document.createElement("li");
    row.append(button);
    return row;
  }

  async #load_thumbnail(image) {
    const scene = await this.#library.open(image.dataset.name);
    const size = picture_size({
      mode: "fit", purpose: "still", box: kThumbnail, pixel_ratio: 2, scene, limits: this.#limits,
    });
    image.src = frame_url({ id: scene.id, azimuth: 0, elevation: 0, distance: 1, ...size, samples: 1 });
    await image.decode();
  }
}
