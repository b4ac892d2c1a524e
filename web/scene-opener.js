// Opens scenes in the page. Opening another scene discards a scene that is still loading.

import { withRetries } from "./backoff.js";
import { factsOf } from "./scenes.js";

export class SceneOpener {
  #store;
  #library;
  #camera;
  #on;
  #turn = 0; // counts opened scenes, to drop late responses

  // `on` has opening(values of the store), opened(), retrying(error, seconds) and failed(error).
  constructor(store, library, camera, on) {
    this.#store = store;
    this.#library = library;
    this.#camera = camera;
    this.#on = on;
  }

  // Opens the scene that the store names, at `view`. Retries until the service responds.
  async open(view) {
    const turn = ++this.#turn;
    const isCurrent = () => turn === this.#turn;
    this.#store.set({ scene: null, figures: null, failure: null, warning: "" });
    this.#on.opening(this.#store.get());
    const { ref } = this.#store.get();
    try {
      const opened = await withRetries(() => this.#library.open(ref), this.#on.retrying, isCurrent);
      if (!isCurrent()) return;
      this.show(opened, view);
      this.#on.opened();
    } catch (error) {
      if (isCurrent()) this.#on.failed(error);
    }
  }

  // Posts a scene text from the user, see SceneLibrary.post(). Resolves to the scene, or to null if another
  // scene was opened meanwhile. Throws ApiError.
  async post(text, title) {
    const turn = this.#turn;
    const posted = await this.#library.post(text, title);
    return turn === this.#turn ? posted : null;
  }

  // Shows a scene of the library at `view`.
  show(opened, view) {
    this.#turn += 1;
    const scene = { ...opened, ...factsOf(opened) };
    this.#camera.useSceneCamera(scene.camera, scene.floor);
    this.#camera.jump(view);
    this.#store.set({ ref: scene.ref, scene, failure: null });
  }

  // Posts the scene again after the service has evicted it.
  async repost() {
    const { scene } = this.#store.get();
    const posted = await this.post(scene.text, scene.title);
    if (posted && posted.id !== scene.id) this.#store.set({ scene: { ...scene, id: posted.id } });
  }
}
