// Selects under the picture: technique, samples, size.

import { fixedSize, MODES, within } from "./size.js";

const SAMPLES = [1, 4, 16, 64];

// Fills `select` with `options`, each [value, label, title]. Adds `value` as an option if it is missing,
// because a link may contain any value.
function fill(select, options, value) {
  const isChosen = ([key]) => String(key) === String(value);
  const all = options.some(isChosen) ? options : [...options, [value, value]];
  select.replaceChildren(
    ...all.map(([key, label, title = ""]) => Object.assign(new Option(label, key, false, isChosen([key])), { title })),
  );
}

const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);

export class Options {
  #selects;

  // `selects`: {technique, samples, size}. `onChange` gets the key and the new value.
  constructor(selects, store, onChange) {
    this.#selects = selects;
    for (const [key, select] of Object.entries(selects)) {
      select.addEventListener("change", () => onChange(key, key === "samples" ? Number(select.value) : select.value));
    }
    store.subscribe(["catalog", "limits", "scene", "technique", "samples", "size"], (values) => this.#show(values));
  }

  #show({ catalog, limits, scene, technique, samples, size }) {
    const { techniques = [] } = catalog ?? {};
    const names = techniques.map(({ type, summary }) => [type, sentence(type), summary]);
    fill(this.#selects.technique, [["", "Scene default"], ...names], technique);
    const counts = SAMPLES.filter((count) => count <= limits.samples);
    fill(this.#selects.samples, [[0, "Automatic"], ...counts.map((count) => [count, count])], samples);
    const modes = MODES.filter((mode) => fits(fixedSize(mode), limits));
    fill(
      this.#selects.size,
      modes.map((mode) => [mode, sizeLabel(mode, scene)]),
      size,
    );
  }
}

// Returns whether the limits of the service allow a fixed size. Returns true for null, a size chosen by the
// page.
function fits(size, { side, pixels }) {
  return !size || within(size, side, pixels).width === size.width;
}

function sizeLabel(mode, scene) {
  if (mode === "fit") return "Fit window";
  if (mode === "half") return "Half window";
  if (mode === "scene") return scene ? `Scene default, ${scene.width} × ${scene.height}` : "Scene default";
  return mode.replace("x", " × ");
}
