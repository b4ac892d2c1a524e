// Writes settings and view to the URL hash, so that a link shows the same picture.

import { formatHash } from "./link.js";

const SAVE_MS = 1000; // update interval; browsers throttle more frequent updates

export class AddressBar {
  #store;
  #camera;
  #timer = 0;

  constructor(store, camera) {
    this.#store = store;
    this.#camera = camera;
  }

  // Updates the URL hash, unless a scene is still being opened.
  save() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    if (this.#store.get().scene) history.replaceState(null, "", this.#hash());
  }

  saveSoon() {
    this.#timer ||= setTimeout(() => this.save(), SAVE_MS);
  }

  // Adds a history entry with `view`, by default the camera's view.
  push(view) {
    history.pushState(null, "", this.#hash(view));
  }

  #hash(view = this.#camera.view) {
    return formatHash(this.#store.get(), view);
  }
}
