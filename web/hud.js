// The figures under the picture. Written at most four times a second: faster cannot be read.

const kRefreshMs = 250;
const kWindowMs = 1500; // frames per second are counted over this long

function short(value) {
  const steps = [
    [1e9, " G"],
    [1e6, " M"],
    [1e3, " k"],
  ];
  const [unit, name] = steps.find(([least]) => value >= least) ?? [1, ""];
  return `${(value / unit).toPrecision(3).replace(/e.*/, "")}${name}`;
}

function milliseconds(value) {
  if (!Number.isFinite(value)) return "–";
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)} ms`;
}

export class Hud {
  #fields;
  #times = []; // when the last frames were drawn
  #last_write = 0;
  #timer = 0;
  #figures = null;

  // `fields`: elements by name: fps, render, encode, rays, size, skipped.
  constructor(fields) {
    this.#fields = fields;
  }

  // `kind` is "stream", "preview" or "still"; figures that are absent keep their last value.
  show(kind, figures) {
    const now = performance.now();
    this.#times = kind === "still" ? [] : [...this.#times.filter((time) => now - time < kWindowMs), now];
    this.#figures = { ...this.#figures, skipped: kind === "stream" ? undefined : 0, ...figures };
    clearTimeout(this.#timer);
    const wait = kind === "still" ? 0 : kRefreshMs - (now - this.#last_write);
    if (wait <= 0) this.#write();
    else this.#timer = setTimeout(() => this.#write(), wait);
  }

  // No frames come at present.
  pause() {
    if (this.#figures) this.show("still", {});
  }

  #write() {
    this.#last_write = performance.now();
    const { render_ms, encode_ms, rays, width, height, draft, skipped } = this.#figures;
    const first = this.#times[0];
    const rate = ((this.#times.length - 1) * 1000) / (this.#times.at(-1) - first);
    const texts = {
      fps: Number.isFinite(rate) ? rate.toFixed(1) : "–",
      render: milliseconds(render_ms),
      encode: milliseconds(encode_ms),
      rays: rays > 0 && render_ms > 0 ? short((rays * 1000) / render_ms) : "–",
      size: `${width} × ${height}${draft ? ", draft" : ""}`,
      skipped: String(skipped ?? 0),
    };
    for (const [name, text] of Object.entries(texts)) {
      if (this.#fields[name].textContent !== text) this.#fields[name].textContent = text;
    }
  }
}
