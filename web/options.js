// The selects under the picture: technique, samples, size.

import { fixed_size, kModes } from "./size.js";

const kSamples = [1, 4, 16, 64];

function fill(select, options, value) {
  select.replaceChildren(
    ...options.map(([key, label, title]) => {
      const option = new Option(label, key, false, String(key) === String(value));
      if (title) option.title = title;
      return option;
    }),
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

  // Lists what may be chosen for `scene` (null: none yet) and marks what `state` says.
  show(state, scene) {
    const { technique, samples, size } = this.#selects;
    const techniques = (this.#catalog.techniques ?? []).map(({ type, summary }) => [
      type,
      sentence(type),
      summary,
    ]);
    fill(technique, [["", "Scene’s own"], ...with_value(techniques, state.technique)], state.technique);
    const counts = kSamples
      .filter((count) => count <= this.#limits.samples)
      .map((count) => [count, String(count)]);
    fill(samples, [[0, "Scene’s own"], ...with_value(counts, state.samples)], state.samples);
    const sizes = kModes.filter((mode) => this.#fits(mode)).map((mode) => [mode, size_label(mode, scene)]);
    fill(size, with_value(sizes, state.size), state.size);
  }

  #fits(mode) {
    const fixed = fixed_size(mode);
    const { side, pixels } = this.#limits;
    return !fixed || (Math.max(fixed.width, fixed.height) <= side && fixed.width * fixed.height <= pixels);
  }
}

// A link may ask for what the list lacks: then it is listed too.
function with_value(options, value) {
  if (!value || options.some(([key]) => String(key) === String(value))) return options;
  return [...options, [value, String(value)]];
}

function size_label(mode, scene) {
  if (mode === "fit") return "Fit the window";
  if (mode === "half") return "Half the window’s";
  if (mode === "scene") return scene ? `Scene’s own, ${scene.width} × ${scene.height}` : "Scene’s own";
  return mode.replace("x", " × ");
}
