#!/usr/bin/env node
// Tests frame rate and quality of the images that the page requests.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./web-modules.mjs";

const { Cost } = await load("cost.js");
const { Pace } = await load("pace.js");
const { passes, qualityLevels, samplesAtRest } = await load("quality.js");
const { Refiner } = await load("refine.js");

// Simulates an orbit of `seconds`. A frame takes `frameMs(level, now)` milliseconds. `costs` are the relative
// costs of the levels. Returns the pace and the `starts` of the streams, each [time, level, fps].
function paced(frameMs, costs, seconds, speed = 20) {
  const pace = new Pace();
  const starts = [[0, pace.level, pace.fps]];
  for (let now = 0; now < 1000 * seconds;) {
    const ms = frameMs(pace.level, now);
    now += Math.max(1000 / pace.fps, ms);
    if (!pace.note(now, ms, speed, costs)) continue;
    starts.push([Math.round(now), pace.level, pace.fps]);
    pace.restart();
  }
  return { pace, starts };
}

test("an orbit drops to the finest smooth level at its first slow frame", () => {
  const ms = [400, 100, 30, 8];
  const { pace, starts } = paced((at) => ms[at], ms, 20);
  assert.deepEqual(starts, [
    [0, 0, 30],
    [400, 2, 30],
  ]);
  assert.equal(pace.level, 2);
});

test("an orbit drops further if a level is slower than predicted", () => {
  const ms = [400, 300, 200, 8];
  const { starts } = paced((at) => ms[at], [16, 4, 1, 1 / 4], 20);
  assert.deepEqual(starts.slice(0, 3), [
    [0, 0, 30],
    [400, 2, 30],
    [600, 3, 30],
  ]);
});

test("an orbit that starts coarse reaches the finest smooth level", () => {
  const pace = new Pace();
  pace.play({ id: "ab", width: 8, height: 6, fills: true, technique: "", samples: 1 }, 3);
  for (let now = 0; pace.level === 3 && now < 10_000; now += 34) pace.note(now, 3, 20, [64, 16, 4, 1]);
  assert.equal(pace.level, 1);
});

test("an orbit retries a level that was too slow after 5 s, not before", () => {
  const { starts } = paced((level) => [90, 12][level], [5, 1], 12);
  const times = starts.filter(([, level]) => level === 0).map(([now]) => now);
  assert.ok(times.length >= 2);
  times.slice(1).forEach((now, at) => assert.ok(now - times[at] >= 5000, times.join()));
});

test("an orbit recovers the finest level after a slow moment", () => {
  const { pace, starts } = paced((level, now) => (now < 500 ? 100 : 8) / 4 ** level, [1, 1 / 4], 20);
  assert.equal(pace.level, 0);
  assert.equal(starts.length, 3);
});

test("an orbit at the coarsest level keeps its speed with fewer frames", () => {
  const { level, fps } = paced(() => 125, [1], 20).pace;
  assert.deepEqual({ level, fps }, { level: 0, fps: 8 });
});

test("an orbit never steps by more than 10 degrees, and fast frames keep its rate and level", () => {
  assert.equal(paced(() => 5000, [1], 60).pace.fps, 2);
  assert.deepEqual(paced(() => 5, [4, 1], 20).starts, [[0, 0, 30]]);
});

test("an orbit raises its frame rate when frames get faster", () => {
  assert.equal(paced((level, now) => (now < 5000 ? 125 : 4), [1], 20).pace.fps, 30);
});

test("a new window size keeps the level of an orbit", () => {
  const chosen = { id: "ab", width: 800, height: 600, fills: true, technique: "", samples: 1 };
  const levelAfter = (change) => {
    const pace = new Pace();
    pace.play(chosen);
    pace.note(0, 400, 20, [4, 1]);
    assert.equal(pace.level, 1);
    pace.play({ ...chosen, ...change });
    return pace.level;
  };
  assert.equal(levelAfter({ width: 1000, height: 500 }), 1);
  assert.equal(levelAfter({ id: "cd" }), 0);
  assert.equal(levelAfter({ technique: "raycast" }), 0);
  assert.equal(levelAfter({ samples: 4 }), 0);
  assert.equal(levelAfter({ fills: false }), 0);
});

test("quality levels reduce samples first, then size, and keep the user's choices", () => {
  const own = qualityLevels({ samples: 0, size: "fit", own: 4 });
  assert.deepEqual(own.slice(0, 4), [
    { part: 1, samples: 4 },
    { part: 1, samples: 2 },
    { part: 1, samples: 1 },
    { part: 0.84, samples: 1 },
  ]);
  assert.deepEqual(own.at(-1), { part: 0.25, samples: 1 });
  assert.deepEqual(qualityLevels({ samples: 16, size: "scene" }), [{ part: 1, samples: 16 }]);
  assert.deepEqual(
    qualityLevels({ samples: 16, size: "half" }).at(-1),
    { part: 0.5, samples: 16 },
    "half of the stage",
  );
  assert.deepEqual(qualityLevels({ samples: 0, size: "1280x720", own: 2 }), [
    { part: 1, samples: 2 },
    { part: 1, samples: 1 },
  ]);
});

test("render times are estimated from the last image of the scene", () => {
  const cost = new Cost();
  const picture = { id: "ab", technique: "", width: 100, height: 100, samples: 1 };
  const pictures = [4, 2, 1].map((samples) => ({ ...picture, samples }));
  assert.equal(cost.firstWithin(pictures, 1e9), 2, "without an estimate");
  cost.note(picture, 50);
  assert.deepEqual(
    [300, 150, 60, 10].map((ms) => cost.firstWithin(pictures, ms)),
    [0, 1, 2, 2],
  );
  assert.equal(cost.knows({ ...picture, technique: "raycast" }), false);
  assert.equal(cost.expectedMs({ ...picture, width: 200 }), 100);
});

test("the still image has the chosen samples, else the larger of 64 and the scene's samples", () => {
  assert.equal(samplesAtRest(0, 1, 4096), 64);
  assert.equal(samplesAtRest(0, 256, 4096), 256);
  assert.equal(samplesAtRest(0, 1, 32), 32);
  assert.equal(samplesAtRest(16, 64, 4096), 16);
});

test("each refinement pass has half the samples of the next pass", () => {
  assert.deepEqual(passes(64), [1, 2, 4, 8, 16, 32, 64]);
  assert.deepEqual(passes(100), [1, 3, 6, 12, 25, 50, 100]);
  assert.deepEqual(passes(1), [1]);
});

test("refinement ends with the finest image within the time limit unless samples were chosen", () => {
  const cost = new Cost();
  const refiner = new Refiner(cost);
  const picture = { id: "ab", technique: "", width: 10, height: 10, samples: 64 };
  const last = (isRequested = false) => refiner.last(picture, isRequested).samples;
  assert.equal(last(), 64, "without an estimate");
  cost.note({ ...picture, samples: 1 }, 400);
  assert.equal(last(), 32);
  assert.equal(last(true), 64);
  cost.note({ ...picture, samples: 1 }, 60_000);
  assert.equal(last(), 1);
});
