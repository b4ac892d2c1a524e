// Figures under the picture. They change at most four times a second while the view moves, to stay readable.

import { element } from "./problem.js";
import { rounded } from "./progress.js";

// name: [label, tooltip]
const FIELDS = {
  fps: ["fps", "Displayed frames per second"],
  render: ["render", "Render time of the last image"],
  encode: ["encode", "PNG encoding time of the last image"],
  rays: ["rays/s", "Rays traced per second"],
  size: ["size", "Size of the last image in pixels"],
  skipped: ["dropped", "Frames that arrived too late to be shown"],
  rmse: ["error", "Root mean square error per pixel in linear radiance, estimated from the samples"],
};
const REFRESH_MS = 250;
const WINDOW_MS = 1500; // time over which the frame rate is measured

const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

function milliseconds(value) {
  if (!Number.isFinite(value)) return "–";
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)} ms`;
}

export class Hud {
  #fields = {}; // elements by name
  #times = []; // draw times of the last frames
  #lastWrite = 0;
  #timer = 0;
  #figures = null;

  // Fills `list`, a <dl>.
  constructor(list, store) {
    for (const [name, [label, title]] of Object.entries(FIELDS)) {
      const field = (this.#fields[name] = element("dd", "–"));
      field.id = `hud-${name}`;
      const pair = element("div");
      pair.title = title;
      pair.append(element("dt", label), field);
      list.append(pair);
    }
    store.subscribe(["figures"], ({ figures }) => (figures ? this.#show(figures) : this.#clear()));
    store.subscribe(["retry"], ({ retry }) => retry && this.#clearRate());
  }

  // Shows the figures of a picture. `kind` is "stream", "preview" or "still". Absent figures keep their last
  // value, except that "stream" and "preview" clear `rmse`, and "still" and "preview" set `skipped` to 0.
  #show({ kind, ...figures }) {
    const now = performance.now();
    this.#times = kind === "still" ? [] : [...this.#times.filter((time) => now - time < WINDOW_MS), now];
    const unknown = kind === "still" ? {} : { rmse: undefined };
    this.#figures = { ...this.#figures, skipped: kind === "stream" ? undefined : 0, ...unknown, ...figures };
    clearTimeout(this.#timer);
    const wait = kind === "still" ? 0 : REFRESH_MS - (now - this.#lastWrite);
    if (wait <= 0) this.#write();
    else this.#timer = setTimeout(() => this.#write(), wait);
  }

  // Clears the figures before another scene is shown.
  #clear() {
    clearTimeout(this.#timer);
    this.#times = [];
    this.#figures = null;
    for (const field of Object.values(this.#fields)) field.textContent = "–";
  }

  // Clears the frame rate while no frames arrive.
  #clearRate() {
    if (this.#figures) this.#show({ kind: "still" });
  }

  #write() {
    this.#lastWrite = performance.now();
    const { renderMs, encodeMs, rays, width, height, draft, skipped, rmse, samples } = this.#figures;
    const first = this.#times[0];
    const rate = ((this.#times.length - 1) * 1000) / (this.#times.at(-1) - first);
    const texts = {
      fps: Number.isFinite(rate) ? rate.toFixed(1) : "–",
      render: milliseconds(renderMs),
      encode: milliseconds(encodeMs),
      rays: rays > 0 && renderMs > 0 ? short.format((rays * 1000) / renderMs) : "–",
      size: `${width} × ${height}${draft ? ", draft" : ""}`,
      skipped: String(skipped ?? 0),
      rmse: rmse > 0 ? `${rounded(rmse)}, ${samples} samples` : "–",
    };
    for (const [name, text] of Object.entries(texts)) this.#fields[name].textContent = text;
  }
}
