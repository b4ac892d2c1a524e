// Observable state: named values, and listeners that are called when the values change.

export class Store {
  #values;
  #subscriptions = []; // {names, listener}
  #changed = new Set(); // names of the values that changed since the last notification
  #isNotifying = false;

  // `values` names every value of the store.
  constructor(values) {
    this.#values = Object.freeze({ ...values });
  }

  // Returns all values as an immutable snapshot.
  get() {
    return this.#values;
  }

  // Replaces the named values. Calls each listener of a changed value once. A listener may call set().
  set(values) {
    const unknown = Object.keys(values).find((name) => !Object.hasOwn(this.#values, name));
    if (unknown) throw new Error(`The store has no value "${unknown}"`);
    const changed = Object.keys(values).filter((name) => !Object.is(values[name], this.#values[name]));
    for (const name of changed) this.#changed.add(name);
    this.#values = Object.freeze({ ...this.#values, ...values });
    if (!this.#isNotifying) this.#notify();
  }

  // Calls `listener(values)` now and after each change of one of the named values.
  subscribe(names, listener) {
    this.#subscriptions.push({ names, listener });
    listener(this.#values);
  }

  #notify() {
    this.#isNotifying = true;
    try {
      while (this.#changed.size > 0) {
        const changed = this.#changed;
        this.#changed = new Set();
        for (const { names, listener } of this.#subscriptions)
          if (names.some((name) => changed.has(name))) listener(this.#values);
      }
    } finally {
      this.#isNotifying = false;
    }
  }
}
