// A button, and a key of the page, that hold something as long as they are pressed.

export class Hold {
  #button;
  #held;
  #on;

  // `key`: lower case; it works wherever nobody writes. `on(held)` hears both.
  constructor(button, key, on) {
    this.#button = button;
    this.#on = on;
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      this.#set(true);
    });
    for (const event of ["pointerup", "pointercancel", "lostpointercapture", "blur"])
      button.addEventListener(event, () => this.#set(false));
    // Without a pointer, as from a screen reader, it stays held until the next click.
    button.addEventListener("click", ({ detail }) => detail === 0 && this.#set(!this.#held));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    const is_ours = ({ key: pressed, target }) =>
      target === button ? [" ", "Enter", key].includes(pressed.toLowerCase()) : pressed.toLowerCase() === key;
    document.addEventListener("keydown", (event) => {
      if (!is_ours(event) || writes(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      if (!event.repeat) this.#set(true);
    });
    document.addEventListener("keyup", (event) => {
      if (!is_ours(event)) return;
      // Else some browsers click the button now.
      event.preventDefault();
      this.#set(false);
    });
    addEventListener("blur", () => this.#set(false));
  }

  #set(held) {
    if (held === Boolean(this.#held)) return;
    this.#held = held;
    this.#button.setAttribute("aria-pressed", String(held));
    this.#on(held);
  }
}

// The list box goes to first letters, and a dialog lies over everything.
const writes = (target) =>
  target.closest("textarea, select, input:not([type=range]), [role=listbox]") || document.querySelector("dialog[open]");
