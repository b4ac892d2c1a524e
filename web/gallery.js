// The sample scenes, a list box: one stop of the tab key, in which arrows, Home, End and first letters move. A thumbnail
// is asked for once its row is in sight, one at a time, so that thumbnails never
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

// Where `key` leads in a list box from the option `at`; null where it leads nowhere.
export function next_option(key, at, titles) {
  const last = titles.length - 1;
  const moves = {
    ArrowDown: Math.min(last, at + 1),
    ArrowRight: Math.min(last, at + 1),
    ArrowUp: Math.max(0, at - 1),
    ArrowLeft: Math.max(0, at - 1),
    Home: 0,
    End: last,
  };
  if (key in moves) return moves[key];
  if (!/^\S$/u.test(key)) return null;
  const starts = (index) => titles[index].toLowerCase().startsWith(key.toLowerCase());
  const order = titles.map((_, step) => (at + 1 + step) % titles.length);
  return order.find(starts) ?? null;
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
    root.addEventListener("keydown", (event) => this.#move(event));
    root.replaceChildren(...Object.keys(kHeadings).flatMap((kind) => this.#group(kind)));
    for (const box of root.querySelectorAll(".thumbnail")) watcher.observe(box);
  }

  // Selects the scene that `ref` names, if it is a sample.
  mark(ref) {
    const options = this.#options();
    for (const option of options) option.setAttribute("aria-selected", String(option.dataset.name === ref));
    this.#set_stop(options.find((option) => option.dataset.name === ref) ?? options[0]);
  }

  focus() {
    this.#options().find((option) => option.tabIndex === 0)?.focus();
  }

  #options() {
    return [...this.#root.querySelectorAll('[role="option"]')];
  }

  // The tab key stops at `chosen` alone.
  #set_stop(chosen) {
    for (const option of this.#options()) option.tabIndex = option === chosen ? 0 : -1;
  }

  #move(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const options = this.#options();
    const at = options.indexOf(document.activeElement);
    const titles = options.map((option) => option.querySelector("strong").textContent);
    const next = next_option(event.key, at, titles);
    if (next === null) return;
    event.preventDefault();
    this.#set_stop(options[next]);
    options[next].focus();
  }

  #group(kind) {
    const members = this.#library.samples.filter((sample) => kind_of(sample) === kind);
    if (members.length === 0) return [];
    members.sort((a, b) => (b.name === kFirst) - (a.name === kFirst));
    const list = element("ul");
    list.role = "group";
    list.ariaLabel = kHeadings[kind] || "Scenes";
    const heading = element("li", kHeadings[kind], "heading");
    heading.ariaHidden = "true"; // the group's name says it
    list.append(...(kHeadings[kind] ? [heading] : []), ...members.map((sample) => this.#row(sample)));
    return [list];
  }

  #row(sample) {
    const thumbnail = element("span", "", "thumbnail");
    const text = element("span", "", "words");
    text.append(element("strong", title_of(sample)), element("span", sample.description));
    const button = element("button");
    button.role = "option";
    button.dataset.name = thumbnail.dataset.name = sample.name;
    button.append(thumbnail, text);
    button.addEventListener("click", () => this.#on_pick(sample.name));
    const row = element("li");
    row.role = "none";
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
