// Pictures that lie over the stage for a while, such as a chart's: fetched once, each fades into the next.

import { get_frame } from "./api.js";
import { decode } from "./view.js";

export class Overlay {
  #box;
  #canvases; // two: the one that is seen, and the one before
  #pictures = new Map(); // address -> promise of a bitmap
  #wanted = "";
  #ahead = []; // addresses that were fetched ahead last

  // `box` holds two <canvas>.
  constructor(box) {
    this.#box = box;
    this.#canvases = [...box.querySelectorAll("canvas")];
  }

  get shown() {
    return !this.#box.hidden;
  }

  // Fetches what is not here yet, one after the other, so that it is there when it is wanted; others are dropped.
  // Stops in silence at what fails: who shows it hears why.
  async prefetch(addresses, signal) {
    this.#ahead = addresses;
    this.#drop();
    try {
      for (const address of addresses) {
        if (signal.aborted) return;
        await this.#picture(address);
      }
    } catch {
      // As above.
    }
  }

  // Resolves once it is seen, or something else is wanted. Throws ApiError where it is still wanted.
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
    next.getBoundingClientRect(); // so that it begins unseen
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

  // What was fetched is of no use any more.
  clear() {
    this.#ahead = [];
    this.hide();
  }

  // Bitmaps of a whole screen are large: only those are kept that are likely to be seen soon.
  #drop() {
    for (const [address, picture] of this.#pictures) {
      if (address === this.#wanted || this.#ahead.includes(address)) continue;
      this.#pictures.delete(address);
      picture.then((bitmap) => bitmap.close(), () => {});
    }
  }

  #picture(address) {
    const known = this.#pictures.get(address);
    if (known) return known;
    const fetched = get_frame(address).then(({ png }) => decode(png));
    this.#pictures.set(address, fetched);
    fetched.catch(() => this.#pictures.delete(address));
    return fetched;
  }
}
