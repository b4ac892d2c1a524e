// Scene editor: edits and applies the text, lists errors and jumps to them. Posts the text CHECK_MS after the
// last edit to check it. The service later evicts unused scenes.

import { Gutter } from "./gutter.js";
import { locate, offsetOf, placeOf } from "./pointer.js";
import { hideProblem, placesOf, showProblem } from "./problem.js";

const LETTER_WIDTH = 0.61; // letter width in em of monospaced fonts
const CHECK_MS = 500; // delay of the check after the last edit

export class Editor {
  #parts;
  #text;
  #gutter;
  #loaded = ""; // text that was last loaded or applied
  #draft = ""; // unapplied text that was replaced when another scene was loaded
  #timer = 0;
  #attempt = 0; // counts edits, loads and attempts, to drop late responses
  #shownError = ""; // content of the error card

  // `parts`: {text, card, note, lines, apply, restore}. `onApply` and `onCheck` take the text and return a
  // promise. The card shows the error of a rejected promise.
  constructor(parts, onApply, onCheck) {
    this.#parts = parts;
    this.#text = parts.text;
    this.#gutter = new Gutter(parts.lines, parts.text);
    const apply = async () => {
      parts.apply.disabled = true;
      try {
        await this.#run(onApply, true);
      } finally {
        parts.apply.disabled = false;
      }
    };
    parts.apply.addEventListener("click", apply);
    this.#text.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      apply();
    });
    this.#text.addEventListener("input", () => {
      this.#onEdit();
      this.#timer = setTimeout(() => this.#run(onCheck, false), CHECK_MS);
    });
    parts.restore.addEventListener("click", () => {
      const { value } = this.#text;
      this.#text.value = this.#draft;
      this.#draft = value === this.#loaded ? "" : value;
      this.#onEdit();
      this.#run(onCheck, false);
      this.#text.focus();
    });
  }

  load(text) {
    const edited = this.#text.value !== this.#loaded;
    if (edited && this.#text.value !== text) this.#draft = this.#text.value;
    if (this.#text.value !== text) {
      this.#text.value = text;
      this.#text.scrollTop = 0;
    }
    this.#loaded = text;
    this.#onEdit();
    this.#showError(null);
  }

  #onEdit() {
    clearTimeout(this.#timer);
    this.#attempt += 1;
    this.#parts.note.textContent = this.#text.value === this.#loaded ? "" : "Not applied yet";
    this.#parts.restore.hidden = this.#draft === "";
    this.#gutter.update();
  }

  // Runs `action` on the text and shows its error, or clears the card. Ignores retryable errors unless
  // `reportsAll`.
  async #run(action, reportsAll) {
    clearTimeout(this.#timer);
    const attempt = ++this.#attempt;
    let problem = null;
    try {
      await action(this.#text.value);
    } catch (error) {
      problem = error;
    }
    if (attempt === this.#attempt && (reportsAll || !problem?.retryable)) this.#showError(problem);
  }

  #showError(error) {
    const places = error ? placesOf(error) : [];
    const text = this.#text.value;
    const faults = places.map((place) => [placeOf(text, this.#range(place)[0]).line, place.detail ?? error.detail]);
    this.#gutter.update(new Map(faults.reverse()));
    this.#text.setAttribute("aria-invalid", String(error !== null));
    const { card } = this.#parts;
    const shown = error ? JSON.stringify([error.title, error.detail, places]) : "";
    if (shown === this.#shownError && !card.hidden) return;
    this.#shownError = shown;
    if (error) showProblem(card, error, (place) => this.#goTo(place));
    else hideProblem(card);
  }

  #range(place) {
    const text = this.#text.value;
    if (place.line) {
      const at = offsetOf(text, place.line, place.column);
      return [at, Math.min(at + 1, text.length)];
    }
    // The message for an unknown key quotes the key.
    const key = /key "((?:[^"\\]|\\.)*)"/.exec(place.detail ?? "")?.[1] ?? null;
    return locate(text, place.pointer, key);
  }

  #goTo(place) {
    const range = this.#range(place);
    this.#text.focus();
    this.#text.setSelectionRange(...range);
    this.#scrollTo(...range);
  }

  // Scrolls to a selection, which setSelectionRange() does not do.
  #scrollTo(start, end) {
    const { line, column } = placeOf(this.#text.value, start);
    const { fontSize, lineHeight } = getComputedStyle(this.#text);
    const right = LETTER_WIDTH * Number.parseFloat(fontSize) * (column + end - start + 3);
    this.#text.scrollTop = Math.max(0, (line - 4) * Number.parseFloat(lineHeight));
    this.#text.scrollLeft = Math.max(0, right - this.#text.clientWidth);
  }
}
