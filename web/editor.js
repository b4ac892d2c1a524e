// The scene as text: edit, apply, and jump to what the service found wrong.

import { locate, offset_of } from "./pointer.js";
import { hide_problem, show_problem } from "./problem.js";

export class Editor {
  #text;
  #card;
  #note;
  #restore;
  #loaded = ""; // the text as it was loaded or applied last
  #draft = ""; // an edit that loading another scene has replaced

  // `parts`: {text, card, note, apply, restore}. `on_apply` takes the text and returns a promise; what it
  // throws is shown in the card.
  constructor(parts, on_apply) {
    this.#text = parts.text;
    this.#card = parts.card;
    this.#note = parts.note;
    this.#restore = parts.restore;
    const apply = async () => {
      parts.apply.disabled = true;
      try {
        await on_apply(this.#text.value);
        hide_problem(this.#card);
      } catch (error) {
        show_problem(this.#card, error, (place) => this.#go_to(place));
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
    this.#text.addEventListener("input", () => this.#show_note());
    this.#restore.addEventListener("click", () => {
      this.#text.value = this.#draft;
      this.#draft = "";
      this.#show_note();
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
    hide_problem(this.#card);
    this.#show_note();
  }

  #show_note() {
    this.#note.textContent = this.#text.value === this.#loaded ? "" : "Edited, not applied yet";
    this.#restore.hidden = this.#draft === "";
  }

  #go_to(place) {
    const text = this.#text.value;
    let range;
    if (place.line) {
      const at = offset_of(text, place.line, place.column);
      range = [at, Math.min(at + 1, text.length)];
    } else {
      // A sentence about an unknown key names it in quotes.
      const key = /key "((?:[^"\\]|\\.)*)"/.exec(place.detail ?? "")?.[1] ?? null;
      range = locate(text, place.pointer, key);
    }
    this.#text.focus();
    this.#text.setSelectionRange(...range);
    this.#scroll_to(...range);
  }

  // Selecting alone does not bring the place into view.
  #scroll_to(start, end) {
    const lines = this.#text.value.slice(0, start).split("\n");
    const style = getComputedStyle(this.#text);
    const brush = document.createElement("canvas").getContext("2d");
    brush.font = `${style.fontSize} ${style.fontFamily}`;
    const right = brush.measureText("0").width * (lines.at(-1).length + end - start + 4);
    this.#text.scrollTop = Math.max(0, (lines.length - 4) * Number.parseFloat(style.lineHeight));
    this.#text.scrollLeft = Math.max(0, right - this.#text.clientWidth);
  }
}
