// Temporary pictures over the stage, such as the pictures of a chart. A picture fades in over the previous
// picture.

import { getFrame } from "./api.js";
import { decode } from "./view.js";

export class Overlay {
  #box;
  #canvases; // the visible canvas, then the previous one
  #pictures = new Map(); // URL -> promise of a bitmap
  #wanted = "";
  #ahead = []; // URLs of the last prefetch

  // `box` contains two <canvas> elements.
  constructor(box) {
    this.#box = box;
    this.#canvases = [...box.querySelectorAll("canvas")];
  }

  get shown() {
    return !this.#box.hidden;
  }

  // Fetches the pictures at `addresses` one after another, unless they are cached. Drops all other pictures
  // but the wanted one. Stops silently at the first failure.
  async prefetch(addresses, signal) {
    this.#ahead = addresses;
    this.#drop();
    try {
      for (const address of addresses) {
        if (signal.aborted) return;
        await this.#picture(address);
      }
    } catch {
      // show() reports the failure.
    }
  }

  // Resolves once the picture is visible or another picture is wanted. Throws ApiError if the picture is
  // still wanted and cannot be fetched.
  async show(address) {
    this.#wanted = address;
    const bitmap = await this.#picture(address).catch((error) => {
      if (this.#wanted === address) throw error;
    });
    if (this.#wanted !== address) return;
    const [seen, next] = this.#canvases;
    Object.assign(next, { width: bitmap.width, height: bitmap.height });
    next.getContext("2d").drawImage(bitmap, 0, 0);
    next.className = "";
    next.getBoundingClientRect(); // starts the fade at opacity 0
    next.className = "seen";
    seen.className = "under";
    this.#canvases.reverse();
    this.#box.dataset.shows = address;
    this.#box.hidden = false;
  }

  hide() {
    this.#wanted = "";
    this.#box.hidden = true;
    for (const canvas of this.#canvases) canvas.className = "";
    this.#drop();
  }

  // Hides the overlay and drops the prefetched pictures.
  clear() {
    this.#ahead = [];
    this.hide();
  }

  // Drops all bitmaps except for the wanted and the prefetched ones. Full-screen bitmaps are large.
  #drop() {
    for (const [address, picture] of this.#pictures) {
      if (address === this.#wanted || this.#ahead.includes(address)) continue;
      this.#pictures.delete(address);
      picture.then(
        (bitmap) => bitmap.close(),
        () => {},
      );
    }
  }

  #picture(address) {
    const known = this.#pictures.get(address);
    if (known) return known;
    const fetched = getFrame(address).then(({ png }) => decode(png));
    this.#pictures.set(address, fetched);
    fetched.catch(() => this.#pictures.delete(address));
    return fetched;
  }
}
