// Scene editor: edits and applies the text, lists errors and jumps to them. Typing posts the text to check
// it: the service evicts unused scenes.

import { Gutter } from "./gutter.js";
import { locate, offset_of, place_of } from "./pointer.js";
import { hide_problem, places_of, show_problem } from "./problem.js";

const kLetterWidth = 0.61; // letter width in em of monospaced fonts
const kCheckMs = 500; // delay after the last key

export class Editor {
  #parts;
  #text;
  #gutter;
  #loaded = ""; // text as last loaded or applied
  #draft = ""; // unapplied edit that another scene has replaced
  #timer = 0;
  #turn = 0; // counts edits, loads and attempts, to drop late responses
  #told = ""; // content of the card

  // `parts`: {text, card, note, lines, apply, restore}. `on_apply` and `on_check` take the text and return a
  // promise. The card shows the errors that they throw.
  constructor(parts, on_apply, on_check) {
    this.#parts = parts;
    this.#text = parts.text;
    this.#gutter = new Gutter(parts.lines, parts.text);
    const apply = async () => {
      parts.apply.disabled = true;
      try {
        await this.#try(on_apply, true);
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
      this.#changed();
      this.#timer = setTimeout(() => this.#try(on_check, false), kCheckMs);
    });
    parts.restore.addEventListener("click", () => {
      const { value } = this.#text;
      this.#text.value = this.#draft;
      this.#draft = value === this.#loaded ? "" : value;
      this.#changed();
      this.#try(on_check, false);
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
    this.#changed();
    this.#tell(null);
  }

  #changed() {
    clearTimeout(this.#timer);
    this.#turn += 1;
    this.#parts.note.textContent = this.#text.value === this.#loaded ? "" : "Edited, not applied yet";
    this.#parts.restore.hidden = this.#draft === "";
    this.#gutter.update();
  }

  // Runs `action` on the text and reports its error. A retryable error is reported only with `tell_all`.
  async #try(action, tell_all) {
    clearTimeout(this.#timer);
    const turn = ++this.#turn;
    let problem = null;
    try {
      await action(this.#text.value);
    } catch (error) {
      problem = error;
    }
    if (turn === this.#turn && (tell_all || !problem?.retryable)) this.#tell(problem);
  }

  #tell(error) {
    const places = error ? places_of(error) : [];
    const text = this.#text.value;
    const faults = places.map((place) => [
      place_of(text, this.#range(place)[0]).line,
      place.detail ?? error.detail,
    ]);
    this.#gutter.update(new Map(faults.reverse()));
    this.#text.setAttribute("aria-invalid", String(error !== null));
    const { card } = this.#parts;
    const told = error ? JSON.stringify([error.title, error.detail, places]) : "";
    if (told === this.#told && !card.hidden) return;
    this.#told = told;
    if (error) show_problem(card, error, (place) => this.#go_to(place));
    else hide_problem(card);
  }

  #range(place) {
    const text = this.#text.value;
    if (place.line) {
      const at = offset_of(text, place.line, place.column);
      return [at, Math.min(at + 1, text.length)];
    }
    // The message for an unknown key quotes the key.
    const key = /key "((?:[^"\\]|\\.)*)"/.exec(place.detail ?? "")?.[1] ?? null;
    return locate(text, place.pointer, key);
  }

  #go_to(place) {
    const range = this.#range(place);
    this.#text.focus();
    this.#text.setSelectionRange(...range);
    this.#scroll_to(...range);
  }

  // Scrolls to a selection, which setSelectionRange() does not do.
  #scroll_to(start, end) {
    const { line, column } = place_of(this.#text.value, start);
    const { fontSize, lineHeight } = getComputedStyle(this.#text);
    const right = kLetterWidth * Number.parseFloat(fontSize) * (column + end - start + 3);
    this.#text.scrollTop = Math.max(0, (line - 4) * Number.parseFloat(lineHeight));
    this.#text.scrollLeft = Math.max(0, right - this.#text.clientWidth);
  }
}
