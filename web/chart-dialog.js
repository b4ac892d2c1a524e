// Dialog with the drawing of a chart. Points that are slider stops are buttons for pointer and keyboard.

export class ChartDialog {
  #dialog;
  #box;
  #choose;

  // Calls `choose(index)` with the index of the picked point.
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

  // Shows `drawing`, an SVG from the service. `points`: {index, line} of the selectable points, in order of
  // cost.
  show(drawing, points) {
    const svg = new DOMParser().parseFromString(drawing, "image/svg+xml").documentElement;
    svg.setAttribute("role", "group");
    const title = svg.querySelector(":scope > title");
    svg.ariaLabel = title?.textContent ?? "Speed and accuracy";
    title?.remove(); // the browser would show it instead of the points' titles
    this.#box.replaceChildren(document.importNode(svg, true));
    for (const { index, line } of points) {
      const mark = this.#mark(index);
      mark.setAttribute("role", "button");
      mark.setAttribute("tabindex", "0");
      mark.setAttribute("aria-label", line);
      mark.parentNode.append(mark); // draws it above the others, and sorts the tab order by cost
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
