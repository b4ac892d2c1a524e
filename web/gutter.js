// Line numbers next to a textarea that does not wrap lines. Lines with errors are marked. Only visible rows
// are in the document.

import { element } from "./problem.js";

export class Gutter {
  #box;
  #text;
  #count = 0; // lines
  #faults = new Map(); // line -> error message

  constructor(box, text) {
    this.#box = box;
    this.#text = text;
    text.addEventListener("scroll", () => this.#draw());
    new ResizeObserver(() => this.#draw()).observe(text);
  }

  // Redraws the line numbers after the text or its diagnostics have changed. `faults`: line -> error message.
  update(faults = this.#faults) {
    this.#faults = faults;
    this.#count = this.#text.value.split("\n").length;
    this.#draw();
  }

  #draw() {
    const { scrollTop, clientHeight } = this.#text;
    const style = getComputedStyle(this.#text);
    const [height, padding] = [style.lineHeight, style.paddingTop].map(Number.parseFloat);
    const first = Math.max(0, Math.floor((scrollTop - padding) / height));
    const rows = [];
    for (let row = first; row < this.#count && row * height < scrollTop + clientHeight; row += 1) {
      rows.push(this.#row(row + 1));
    }
    this.#box.style.paddingTop = `${Math.max(0, padding - scrollTop)}px`;
    if (rows.length > 0) rows[0].style.marginTop = `${Math.min(0, first * height + padding - scrollTop)}px`;
    this.#box.replaceChildren(...rows);
  }

  #row(line) {
    const fault = this.#faults.get(line);
    const row = element("span", line, fault ? "wrong" : "");
    if (!fault) row.ariaHidden = "true";
    else Object.assign(row, { role: "img", title: fault, ariaLabel: `Line ${line}: ${fault}` });
    return row;
  }
}
