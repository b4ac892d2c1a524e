// Dialog that shows the view by every technique, in the order of their publication, and wipes between two.

import { getFrame, isAbort } from "./api.js";
import { element } from "./problem.js";
import { rounded } from "./progress.js";
import { frameUrl } from "./urls.js";

const SIDE = 400; // longest side of a picture, pixels
const SAMPLES = 16; // per pixel
const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

// Returns the catalog's techniques in the order of the history: those on polygons, then those that trace rays.
export function inOrder(techniques) {
  return [...techniques.filter(drawsPolygons), ...techniques.filter((technique) => !drawsPolygons(technique))];
}

const drawsPolygons = ({ missing }) => missing.includes("shadows");

// Returns a sentence on what the technique does not show.
export function sentenceOf({ missing }) {
  if (missing.length === 0) return "Shows all light of the scene, with noise.";
  return `Does not show ${new Intl.ListFormat("en", { type: "disjunction" }).format(missing)}.`;
}

// Returns the RMS difference of two pictures of equal size, {data} of RGBA bytes, in display values from 0 to 1.
export function rmsDifference(a, b) {
  let sum = 0;
  for (let i = 0; i < a.data.length; ++i) if (i % 4 < 3) sum += (a.data[i] - b.data[i]) ** 2;
  return Math.sqrt(sum / (a.data.length * 0.75)) / 255;
}

function canvasOf() {
  const canvas = element("canvas");
  canvas.setAttribute("role", "img");
  canvas.ariaLabel = "Not rendered yet";
  return canvas;
}

function paint(canvas, { pixels, technique }) {
  Object.assign(canvas, { width: pixels.width, height: pixels.height });
  canvas.getContext("2d").putImageData(pixels, 0, 0);
  canvas.ariaLabel = `The scene by ${technique.type}`;
}

async function pixelsOf(png) {
  const bitmap = await createImageBitmap(png);
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d");
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

export class HistoryDialog {
  #dialog;
  #cards;
  #wipe;
  #note;
  #sides; // selects of the left and the right technique
  #work = null; // AbortController of the pictures being made
  #steps = []; // {technique, card, pixels, stats}

  // Fills `dialog`, an empty <dialog>.
  constructor(dialog) {
    this.#dialog = dialog;
    this.#note = element("p", "", "note");
    this.#note.role = "status";
    this.#cards = element("div", "", "cards");
    this.#wipe = this.#makeWipe();
    const close = element("button", "Close", "primary");
    close.addEventListener("click", () => dialog.close());
    dialog.append(element("h2", "History of rendering"), this.#note, this.#wipe, this.#cards, close);
    dialog.addEventListener("close", () => this.#work?.abort());
  }

  // Shows `picture` by all `techniques` of the catalog. Pictures appear as soon as they are rendered.
  async show(picture, techniques) {
    this.#work?.abort();
    const { signal } = (this.#work = new AbortController());
    const scale = Math.min(1, SIDE / Math.max(picture.width, picture.height));
    const size = { width: Math.round(picture.width * scale), height: Math.round(picture.height * scale) };
    this.#steps = inOrder(techniques).map((technique) => ({ technique, card: this.#makeCard(technique) }));
    this.#cards.replaceChildren(...this.#steps.map(({ card }) => card));
    this.#wipe.hidden = true;
    this.#dialog.showModal();
    for (const [place, step] of this.#steps.entries()) {
      this.#note.textContent = `Rendering ${place + 1} of ${this.#steps.length}: ${step.technique.type}`;
      const technique = step.technique.type;
      try {
        await this.#load(step, frameUrl({ ...picture, ...size, technique, samples: SAMPLES }), signal);
      } catch (error) {
        if (isAbort(error)) return;
        step.card.querySelector(".figures").textContent = error.detail || error.message;
      }
    }
    this.#note.textContent = `${SAMPLES} samples per pixel. Differences are from the last picture, in display values.`;
    this.#compare();
  }

  async #load(step, address, signal) {
    const { png, stats } = await getFrame(address, signal);
    step.pixels = await pixelsOf(png);
    signal.throwIfAborted();
    step.stats = stats;
    paint(step.card.querySelector("canvas"), step);
    step.card.querySelector(".figures").textContent = `${Math.round(stats.renderMs)} ms`;
  }

  #makeCard(technique) {
    const card = element("figure");
    const image = canvasOf();
    const caption = element("figcaption");
    caption.append(
      element("b", technique.type),
      ` ${technique.origin}`,
      element("p", "…", "figures"),
      element("p", sentenceOf(technique)),
    );
    card.append(image, caption);
    return card;
  }

  // Fills in the differences from the last picture, and shows the wipe.
  #compare() {
    const made = this.#steps.filter(({ pixels }) => pixels);
    const last = made.at(-1);
    for (const { technique, card, pixels, stats } of made) {
      const off = pixels === last.pixels ? "reference" : `difference ${rounded(rmsDifference(pixels, last.pixels))}`;
      const rays = !drawsPolygons(technique) ? `${short.format(stats.rays)} rays · ` : "";
      card.querySelector(".figures").textContent = `${Math.round(stats.renderMs)} ms · ${rays}${off}`;
    }
    if (made.length < 2) return;
    for (const [side, select] of this.#sides.entries()) {
      select.replaceChildren(...made.map(({ technique }) => new Option(technique.type)));
      select.selectedIndex = side === 0 ? Math.max(0, made.length - 3) : made.length - 1;
    }
    this.#wipe.hidden = false;
    this.#showSides();
  }

  #makeWipe() {
    const wipe = element("div", "", "wipe");
    const pair = element("div", "", "pair");
    const images = [canvasOf(), canvasOf()];
    const slider = element("input");
    Object.assign(slider, { type: "range", min: 0, max: 100, value: 50, ariaLabel: "Boundary of the two pictures" });
    const place = () => pair.style.setProperty("--boundary", `${slider.value}%`);
    slider.addEventListener("input", place);
    place();
    this.#sides = ["Left", "Right"].map((side) => {
      const select = element("select");
      select.ariaLabel = `${side} picture`;
      select.addEventListener("change", () => this.#showSides());
      return select;
    });
    const row = element("div", "", "bar");
    row.append(this.#sides[0], slider, this.#sides[1]);
    pair.append(...images);
    wipe.append(pair, row);
    wipe.hidden = true;
    return wipe;
  }

  #showSides() {
    const images = this.#wipe.querySelectorAll("canvas");
    for (const [side, select] of this.#sides.entries()) {
      const step = this.#steps.find(({ technique }) => technique.type === select.value);
      paint(images[side], step);
    }
  }
}
