// The chart's drawing in a dialog. The points that are stops of the slider are buttons, for pointer and keyboard.

export class ChartDialog {
  #dialog;
  #box;
  #choose;

  // `choose(index)` hears which of the chart's points was picked.
  constructor(dialog, opener, choose) {
    this.#dialog = dialog;
    this.#box = dialog.querySelector(".drawing");
    this.#choose = choose;
    opener.addEventListener("click", () => dialog.showModal());
    this.#box.addEventListener("click", (event) => this.#pick(event.target));
    this.#box.addEventListener("keydown", (event) => {
      if (![" ", "Enter"].includes(event.key)) return;
      event.preventDefault();
      this.#pick(event.target);
    });
  }

  // `drawing`: SVG of the service; `points`: {index, line} of those that can be picked, by cost.
  show(drawing, points) {
    const svg = new DOMParser().parseFromString(drawing, "image/svg+xml").documentElement;
    svg.setAttribute("role", "group");
    const title = svg.querySelector(":scope > title");
    svg.ariaLabel = title?.textContent ?? "Speed against accuracy";
    title?.remove(); // else it would cover those of the points
    this.#box.replaceChildren(document.importNode(svg, true));
    for (const { index, line } of points) {
      const mark = this.#mark(index);
      mark.setAttribute("role", "button");
      mark.setAttribute("tabindex", "0");
      mark.setAttribute("aria-label", line);
      mark.parentNode.append(mark); // over the others, and in the order of cost for the keyboard
    }
  }

  #mark(index) {
    return this.#box.querySelector(`#point-${index}`);
  }

  #pick(target) {
    const mark = target.closest("[role=button]");
    if (!mark) return;
    this.#dialog.close();
    this.#choose(Number(mark.id.replace("point-", "")));
  }
}
