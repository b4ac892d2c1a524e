#!/usr/bin/env node
// Tests the store of the page's state.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./web-modules.mjs";

const { Store } = await load("store.js");

// Subscribes to `names` and returns the list of values that the listener receives.
function record(store, ...names) {
  const calls = [];
  store.subscribe(names, (values) => calls.push(values));
  return calls;
}

test("calls a listener at once and after each change of its values", () => {
  const store = new Store({ speed: 20, playing: true, samples: 0 });
  const calls = record(store, "speed", "playing");
  store.set({ speed: 30, playing: false });
  store.set({ samples: 4 });
  store.set({ speed: 30 });
  assert.deepEqual(calls, [
    { speed: 20, playing: true, samples: 0 },
    { speed: 30, playing: false, samples: 0 },
  ]);
  assert.equal(store.get().samples, 4);
});

test("calls every listener with the newest values if a listener sets other values", () => {
  const store = new Store({ scene: "a", title: "", count: 0 });
  store.subscribe(["scene"], ({ scene, count }) => store.set({ title: `Scene ${scene}`, count: count + 1 }));
  const titles = record(store, "title").map(({ title }) => title);
  const scenes = record(store, "scene");
  store.set({ scene: "b" });
  assert.deepEqual(titles, ["Scene a"]);
  assert.deepEqual(
    scenes.map(({ scene, title }) => [scene, title]),
    [
      ["a", "Scene a"],
      ["b", "Scene b"],
    ],
  );
});

test("keeps a snapshot unchanged", () => {
  const store = new Store({ speed: 20 });
  const before = store.get();
  store.set({ speed: 30 });
  assert.equal(before.speed, 20);
  assert.throws(() => (before.speed = 40), TypeError);
});

test("rejects an unknown name", () => {
  const store = new Store({ speed: 20 });
  assert.throws(() => store.set({ sped: 30 }), /no value "sped"/);
  assert.equal(store.get().speed, 20);
});

test("keeps notifying listeners after a listener has thrown", () => {
  const store = new Store({ speed: 20 });
  store.subscribe(["speed"], ({ speed }) => {
    if (speed === 30) throw new Error("listener");
  });
  const calls = record(store, "speed");
  assert.throws(() => store.set({ speed: 30 }), /listener/);
  store.set({ speed: 40 });
  assert.equal(calls.at(-1).speed, 40);
});
