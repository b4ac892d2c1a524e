// The canvas: draws pictures and knows the box it fills.

import { ApiError } from "./api.js";

export class View {
  #canvas;
  #stage;
  #context;

  constructor(stage, canvas) {
    this.#stage = stage;
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d", { alpha: false });
  }

  // Room for the picture, in CSS pixels.
  get box() {
    return { width: Math.max(1, this.#stage.clientWidth), height: Math.max(1, this.#stage.clientHeight) };
  }

  // `fills`: the picture has the box's proportions; the odd half pixel of rounding is cut, not framed.
  draw(bitmap, fills) {
    const canvas = this.#canvas;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    this.#context.drawImage(bitmap, 0, 0);
    bitmap.close();
    canvas.classList.toggle("fills", fills);
    canvas.hidden = false;
  }

  clear() {
    this.#canvas.hidden = true;
  }

  on_resize(action) {
    new ResizeObserver(action).observe(this.#stage);
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
