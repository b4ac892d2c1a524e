// Selects under the picture: technique, samples, size.

import { fixed_size, kModes, within } from "./size.js";

const kSamples = [1, 4, 16, 64];

// Fills `select` with `options`, each [value, label, title]. Adds `value` if it is missing: a link may ask
// for it.
function fill(select, options, value) {
  const is_chosen = ([key]) => String(key) === String(value);
  const all = options.some(is_chosen) ? options : [...options, [value, value]];
  select.replaceChildren(
    ...all.map(([key, label, title = ""]) =>
      Object.assign(new Option(label, key, false, is_chosen([key])), { title }),
    ),
  );
}

const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);

export class Options {
  #selects;
  #catalog;
  #limits;

  // `selects`: {technique, samples, size}. `on_change` gets the key and the new value.
  constructor(selects, catalog, limits, on_change) {
    this.#selects = selects;
    this.#catalog = catalog;
    this.#limits = limits;
    for (const [key, select] of Object.entries(selects)) {
      select.addEventListener("change", () =>
        on_change(key, key === "samples" ? Number(select.value) : select.value),
      );
    }
  }

  // Lists the choices for `scene` (null: none yet) and selects those of `state`.
  show(state, scene) {
    const { technique, samples, size } = this.#selects;
    const { techniques = [] } = this.#catalog;
    const names = techniques.map(({ type, summary }) => [type, sentence(type), summary]);
    fill(technique, [["", "Scene’s own"], ...names], state.technique);
    const counts = kSamples.filter((count) => count <= this.#limits.samples);
    fill(samples, [[0, "Automatic"], ...counts.map((count) => [count, count])], state.samples);
    const sizes = kModes.filter((mode) => this.#fits(fixed_size(mode)));
    fill(size, sizes.map((mode) => [mode, size_label(mode, scene)]), state.size);
  }

  #fits(fixed) {
    const { side, pixels } = this.#limits;
    return !fixed || within(fixed, side, pixels).width === fixed.width;
  }
}

function size_label(mode, scene) {
  if (mode === "fit") return "Fit the window";
  if (mode === "half") return "Half the window";
  if (mode === "scene") return scene ? `Scene’s own, ${scene.width} × ${scene.height}` : "Scene’s own";
  return mode.replace("x", " × ");
}
