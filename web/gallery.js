// List box of sample scenes: a single tab stop, navigated with arrows, Home, End and first letters.

import { element } from "./problem.js";
import { thumbnailOf, titleOf } from "./scenes.js";

const FIRST = "paper";
const HEADINGS = {
  // by the prefix of the sample's name, in display order
  "": "",
  material: "Materials",
  light: "Lights",
  shape: "Shapes",
  camera: "Cameras",
  technique: "Techniques",
};

function kindOf(sample) {
  const start = sample.name.split("-")[0];
  return start in HEADINGS ? start : "";
}

// Returns the index of the option that `key` moves the focus to from the option `at`. Returns null if the key
// does not move the focus.
export function nextOption(key, at, titles) {
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
  #onPick;

  // Lists the samples of the catalog in `root`. Calls `onPick(name)` when the user picks one.
  constructor(root, store, onPick) {
    this.#root = root;
    this.#onPick = onPick;
    root.addEventListener("keydown", (event) => this.#move(event));
    store.subscribe(["catalog"], ({ catalog }) => {
      const samples = catalog?.samples ?? [];
      root.replaceChildren(...Object.keys(HEADINGS).flatMap((kind) => this.#group(kind, samples)));
    });
    store.subscribe(["catalog", "ref"], ({ ref }) => this.#mark(ref));
  }

  // Selects the scene `ref` if it is a sample.
  #mark(ref) {
    const options = this.#options();
    for (const option of options) option.setAttribute("aria-selected", String(option.dataset.name === ref));
    this.#setStop(options.find((option) => option.dataset.name === ref) ?? options[0]);
  }

  focus() {
    this.#options()
      .find((option) => option.tabIndex === 0)
      ?.focus();
  }

  #options() {
    return [...this.#root.querySelectorAll('[role="option"]')];
  }

  // Makes `chosen` the only tab stop.
  #setStop(chosen) {
    for (const option of this.#options()) option.tabIndex = option === chosen ? 0 : -1;
  }

  #move(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const options = this.#options();
    const at = options.indexOf(document.activeElement);
    const titles = options.map((option) => option.querySelector("strong").textContent);
    const next = nextOption(event.key, at, titles);
    if (next === null) return;
    event.preventDefault();
    this.#setStop(options[next]);
    options[next].focus();
  }

  #group(kind, samples) {
    const members = samples.filter((sample) => kindOf(sample) === kind);
    if (members.length === 0) return [];
    members.sort((a, b) => (b.name === FIRST) - (a.name === FIRST));
    const list = element("ul");
    list.role = "group";
    list.ariaLabel = HEADINGS[kind] || "Scenes";
    const heading = element("li", HEADINGS[kind], "heading");
    heading.ariaHidden = "true"; // the group's label has the same text
    list.append(...(HEADINGS[kind] ? [heading] : []), ...members.map((sample) => this.#row(sample)));
    return [list];
  }

  #row(sample) {
    const thumbnail = element("img", "", "thumbnail");
    thumbnail.alt = "";
    thumbnail.loading = "lazy";
    thumbnail.src = thumbnailOf(sample);
    const text = element("span", "", "words");
    text.append(element("strong", titleOf(sample)), element("span", sample.description));
    const button = element("button");
    button.role = "option";
    button.dataset.name = sample.name;
    button.append(thumbnail, text);
    button.addEventListener("click", () => this.#onPick(sample.name));
    const row = element("li");
    row.role = "none";
    row.append(button);
    return row;
  }
}
