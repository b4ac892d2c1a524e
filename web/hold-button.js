// Button and keyboard key that are active while pressed.

export class HoldButton {
  #button;
  #held;
  #on;

  // `key`: value of KeyboardEvent.key in lower case. Ignored in form fields and while a dialog is open. Calls
  // `on(held)` on press and release.
  constructor(button, key, on) {
    this.#button = button;
    this.#on = on;
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      this.#set(true);
    });
    for (const event of ["pointerup", "pointercancel", "lostpointercapture", "blur"])
      button.addEventListener(event, () => this.#set(false));
    // A click without a pointer, such as from a screen reader, toggles the state.
    button.addEventListener("click", ({ detail }) => detail === 0 && this.#set(!this.#held));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    const isHandled = ({ key: pressed, target }) =>
      target === button ? [" ", "Enter", key].includes(pressed.toLowerCase()) : pressed.toLowerCase() === key;
    document.addEventListener("keydown", (event) => {
      if (!isHandled(event) || writes(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      if (!event.repeat) this.#set(true);
    });
    document.addEventListener("keyup", (event) => {
      if (!isHandled(event)) return;
      // Otherwise some browsers click the button when the key is released.
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

// Returns whether `target` uses letter keys itself (text fields, list box) or a dialog is open.
const writes = (target) =>
  target.closest("textarea, select, input:not([type=range]), [role=listbox]") || document.querySelector("dialog[open]");
