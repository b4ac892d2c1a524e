// The stage: draws pictures on its canvas and knows its size. A scene that has none yet is announced by its thumbnail.

import { ApiError } from "./api.js";

const kFadeMs = 180;

export class View {
  #canvas;
  #stage;
  #poster;
  #context;
  #newest = null; // the bitmap drawn last, or being faded in

  // `poster`: the <img> of thumbnails.
  constructor(stage, canvas, poster) {
    this.#stage = stage;
    this.#poster = poster;
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d", { alpha: false });
  }

  // Room for the picture, in CSS pixels.
  get box() {
    return { width: Math.max(1, this.#stage.clientWidth), height: Math.max(1, this.#stage.clientHeight) };
  }

  // `fills`: the picture has the box's proportions; the odd half pixel of rounding is cut, not framed.
  // `fades`: it takes over little by little from what is shown. Closes the bitmap.
  draw(bitmap, fills, fades = false) {
    const canvas = this.#canvas;
    const { width, height } = bitmap;
    if (canvas.hidden) fades = false;
    if (canvas.width !== width || canvas.height !== height) {
      const before = canvas.cloneNode();
      before.getContext("2d").drawImage(canvas, 0, 0);
      canvas.width = width;
      canvas.height = height;
      if (fades) this.#context.drawImage(before, 0, 0, width, height);
    }
    canvas.classList.toggle("fills", fills);
    canvas.hidden = false;
    this.#poster.hidden = true;
    this.#newest = bitmap;
    this.#blend(bitmap, 0, performance.now(), fades ? kFadeMs : 0);
  }

  // Shows nothing but the `thumbnail` at this address, "" for none, until a picture is drawn.
  announce(thumbnail) {
    this.#canvas.hidden = true;
    this.#newest = null;
    this.#poster.hidden = !thumbnail;
    if (thumbnail) this.#poster.src = thumbnail;
  }

  // `shown`: the bitmap's part in what the canvas shows; the rest is what was there before.
  #blend(bitmap, shown, start, duration) {
    if (this.#newest !== bitmap) return bitmap.close();
    const part = duration > 0 ? Math.min(1, Math.max(shown, (performance.now() - start) / duration)) : 1;
    this.#context.globalAlpha = part < 1 ? (part - shown) / (1 - shown) : 1;
    this.#context.drawImage(bitmap, 0, 0);
    this.#context.globalAlpha = 1;
    this.#stage.toggleAttribute("data-fading", part < 1);
    if (part === 1) bitmap.close();
    else requestAnimationFrame(() => this.#blend(bitmap, part, start, duration));
  }
}

// Throws ApiError for bytes that are no picture.
export async function decode(png) {
  const blob = png instanceof Blob ? png : new Blob([png], { type: "image/png" });
  try {
    return await createImageBitmap(blob);
  } catch {
    const detail = "The browser could not decode it.";
    throw new ApiError({ status: 200, title: "This picture cannot be shown", detail });
  }
}
