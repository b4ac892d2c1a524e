// The sample scenes. A thumbnail is asked for once its row is in sight, one at a time, so that thumbnails never
// crowd out the picture.

import { get_frame } from "./api.js";
import { element } from "./problem.js";
import { title_of } from "./scenes.js";
import { picture_size } from "./size.js";
import { frame_url } from "./urls.js";
import { decode } from "./view.js";

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
      button.ariaCurrent = button.dataset.name === ref ? "true" : null;
    }
  }

  #group(kind) {
    const members = this.#library.samples.filter((sample) => kind_of(sample) === kind);
    if (members.length === 0) return [];
    members.sort((a, b) => (b.name === kFirst) - (a.name === kFirst));
    const list = element("ul");
    list.append(...members.map((sample) => this.#row(sample)));
    if (!kHeadings[kind]) return [list];
    return [element("h2", kHeadings[kind]), list];
  }

  #row(sample) {
    const thumbnail = element("span", "", "thumbnail");
    const text = element("span", "", "words");
    text.append(element("strong", title_of(sample)), element("span", sample.description));
    const button = element("button");
    button.dataset.name = thumbnail.dataset.name = sample.name;
    button.append(thumbnail, text);
    button.addEventListener("click", () => this.#on_pick(sample.name));
    const row = element("li");
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
    const url = frame_url({ id: scene.id, azimuth: 0, elevation: 0, distance: 1, ...size, samples: 1 });
    const canvas = element("canvas");
    canvas.getContext("bitmaprenderer").transferFromImageBitmap(await decode((await get_frame(url)).png));
    box.append(canvas);
  }
}
