// Stage: draws pictures on its canvas, and a thumbnail before the first picture of a scene.

import { ApiError } from "./api.js";
import { element } from "./problem.js";

const FADE_MS = 180;

export class View {
  #canvas;
  #stage;
  #poster;
  #context;
  #newest = null; // bitmap drawn last or fading in

  constructor(stage, canvas) {
    this.#stage = stage;
    this.#poster = Object.assign(element("img"), { id: "poster", alt: "", hidden: true });
    stage.prepend(this.#poster);
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d", { alpha: false });
  }

  // Size of the stage in CSS pixels.
  get box() {
    return { width: Math.max(1, this.#stage.clientWidth), height: Math.max(1, this.#stage.clientHeight) };
  }

  // Draws and closes a bitmap. `fills`: the picture has the stage's aspect ratio, and a half pixel of
  // rounding is cropped. `fades`: the picture fades in.
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
    this.#blend(bitmap, 0, performance.now(), fades ? FADE_MS : 0);
  }

  // Hides the canvas until a picture is drawn. Shows the thumbnail with this URL instead, or nothing for "".
  announce(thumbnail) {
    this.#canvas.hidden = true;
    this.#newest = null;
    this.#poster.hidden = !thumbnail;
    if (thumbnail) this.#poster.src = thumbnail;
  }

  // Fades in the bitmap. `shown`: weight of the bitmap on the canvas, 0 to 1.
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

// Decodes a picture. Throws ApiError if the bytes are malformed.
export async function decode(png) {
  const blob = png instanceof Blob ? png : new Blob([png], { type: "image/png" });
  try {
    return await createImageBitmap(blob);
  } catch {
    const detail = "The browser could not decode it.";
    throw new ApiError({ status: 200, title: "Cannot show the image", detail });
  }
}
