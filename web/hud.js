// Figures under the picture, updated at most four times a second to stay readable.

import { element } from "./problem.js";
import { rounded } from "./progress.js";

// [label, description]
const kFields = {
  fps: ["fps", "Frames shown in a second"],
  render: ["render", "Time to trace the rays of the last picture"],
  encode: ["encode", "Time to write it as PNG"],
  rays: ["rays/s", "Rays traced in a second"],
  size: ["size", "Pixels of the last picture"],
  skipped: ["skipped", "Frames that came too late to be shown"],
  rmse: ["error", "Root mean square error of a pixel, in linear radiance, as its samples show"],
};
const kRefreshMs = 250;
const kWindowMs = 1500; // window of the frame rate

const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

function milliseconds(value) {
  if (!Number.isFinite(value)) return "–";
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)} ms`;
}

export class Hud {
  #fields = {}; // elements by name
  #times = []; // draw times of the last frames
  #last_write = 0;
  #timer = 0;
  #figures = null;

  // Fills `list`, a <dl>.
  constructor(list) {
    for (const [name, [label, title]] of Object.entries(kFields)) {
      const field = (this.#fields[name] = element("dd", "–"));
      field.id = `hud-${name}`;
      const pair = element("div");
      pair.title = title;
      pair.append(element("dt", label), field);
      list.append(pair);
    }
  }

  // Shows the figures of a frame. `kind` is "stream", "preview" or "still". Absent figures keep their last
  // value.
  show(kind, figures) {
    const now = performance.now();
    this.#times = kind === "still" ? [] : [...this.#times.filter((time) => now - time < kWindowMs), now];
    const told = kind === "still" ? {} : { rmse: undefined };
    this.#figures = { ...this.#figures, skipped: kind === "stream" ? undefined : 0, ...told, ...figures };
    clearTimeout(this.#timer);
    const wait = kind === "still" ? 0 : kRefreshMs - (now - this.#last_write);
    if (wait <= 0) this.#write();
    else this.#timer = setTimeout(() => this.#write(), wait);
  }

  // Clears the figures before another scene is shown.
  clear() {
    clearTimeout(this.#timer);
    this.#times = [];
    this.#figures = null;
    for (const field of Object.values(this.#fields)) field.textContent = "–";
  }

  // Clears the frame rate while no frames arrive.
  pause() {
    if (this.#figures) this.show("still", {});
  }

  #write() {
    this.#last_write = performance.now();
    const { render_ms, encode_ms, rays, width, height, draft, skipped, rmse, samples } = this.#figures;
    const first = this.#times[0];
    const rate = ((this.#times.length - 1) * 1000) / (this.#times.at(-1) - first);
    const texts = {
      fps: Number.isFinite(rate) ? rate.toFixed(1) : "–",
      render: milliseconds(render_ms),
      encode: milliseconds(encode_ms),
      rays: rays > 0 && render_ms > 0 ? short.format((rays * 1000) / render_ms) : "–",
      size: `${width} × ${height}${draft ? ", draft" : ""}`,
      skipped: String(skipped ?? 0),
      rmse: rmse > 0 ? `${rounded(rmse)}, ${samples} samples` : "–",
    };
    for (const [name, text] of Object.entries(texts)) this.#fields[name].textContent = text;
  }
}
