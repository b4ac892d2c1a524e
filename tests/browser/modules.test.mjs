#!/usr/bin/env node
// Tests page modules that need no browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { near } from "./support.mjs";
import { load } from "./web-modules.mjs";

const { withRetries, wakeAll } = await load("backoff.js");
const { OrbitCamera, elevationOf } = await load("camera.js");
const { floorHeight } = await load("floor.js");
const { locate, offsetOf, placeOf } = await load("pointer.js");
const { pretty } = await load("scenes.js");
const { progressText } = await load("progress.js");
const { pictureSize, within } = await load("size.js");
const { formatHash, parseHash } = await load("link.js");
const { FrameParser, readFrames } = await load("stream.js");
const { curlCommand, frameUrl, jobBody } = await load("urls.js");

function frameBytes(header, png) {
  const text = new TextEncoder().encode(JSON.stringify({ ...header, bytes: png.length }));
  const bytes = new Uint8Array(4 + text.length + png.length);
  new DataView(bytes.buffer).setUint32(0, text.length);
  bytes.set(text, 4);
  bytes.set(png, 4 + text.length);
  return bytes;
}

test("FrameParser returns whole frames for every division into chunks", () => {
  const first = frameBytes({ frame: 0 }, Uint8Array.of(1, 2, 3));
  const second = frameBytes({ frame: 1 }, Uint8Array.of(4, 5, 6, 7));
  const all = Uint8Array.of(...first, ...second);
  for (let piece = 1; piece <= all.length; piece += 1) {
    const parser = new FrameParser();
    const frames = [];
    for (let at = 0; at < all.length; at += piece) frames.push(...parser.push(all.slice(at, at + piece)));
    assert.deepEqual(
      frames.map(({ header }) => header.frame),
      [0, 1],
      `pieces of ${piece}`,
    );
    assert.deepEqual([...frames[0].png, ...frames[1].png], [1, 2, 3, 4, 5, 6, 7], `pieces of ${piece}`);
    assert.equal(parser.insideFrame, false);
  }
});

test("FrameParser rejects malformed bytes", () => {
  assert.throws(() => new FrameParser().push(Uint8Array.of(255, 255, 255, 255, 0)), /not a frame/);
  assert.throws(() => new FrameParser().push(Uint8Array.of(0, 0, 0, 2, 123, 125)), /not a frame/);
});

test("a stream truncated inside a frame is a retryable error", async () => {
  const bytes = frameBytes({ frame: 0 }, Uint8Array.of(1, 2, 3));
  const body = new Blob([bytes, bytes.slice(0, -1)]).stream();
  const seen = [];
  await assert.rejects(
    async () => {
      for await (const frame of readFrames(body)) seen.push(frame);
    },
    (error) => error.retryable,
  );
  assert.equal(seen.length, 1);
});

const PIXELS = 600; // image height in these tests, in pixels

// Lets `camera` glide at `rate` frames per second and calls `each()` after each step. Returns the number of
// frames until the camera stops. Fails after ten seconds.
function glide(camera, rate = 60, each = () => {}) {
  for (let frames = 1; frames <= 10 * rate; frames += 1) {
    if (!camera.step(1 / rate, PIXELS)) return frames;
    each();
  }
  return assert.fail("glide takes more than ten seconds");
}

test("the camera glides to its goal and stops", () => {
  const camera = new OrbitCamera();
  camera.rotate(90, 0);
  assert.equal(camera.step(1 / 60, PIXELS), true);
  const pixel = (2 / PIXELS) * (180 / Math.PI); // turn that moves the edge of the image by a pixel
  near(camera.view.azimuth, 4.5 + pixel, 1e-9, "1/20 of the distance, plus a pixel");
  camera.rotate(0, 30);
  camera.dolly(0.5);
  glide(camera);
  assert.deepEqual(camera.view, { azimuth: 90, elevation: 30, distance: 0.5, pan: [0, 0, 0], time: 0 });
});

test("a glide moves at least a pixel per frame until it ends", () => {
  const moves = {
    turn: (camera) => camera.rotate(36, 0), // a drag over a tenth of the height
    lift: (camera) => camera.rotate(0, 36),
    zoom: (camera) => camera.dolly(0.7),
    pan: (camera) => camera.pan(0.3, 0),
  };
  for (const [name, move] of Object.entries(moves)) {
    const camera = new OrbitCamera();
    move(camera);
    const height = 2 * 4 * Math.tan(Math.PI / 8); // metres shown at the target, 4 m away
    const seen = ({ azimuth, elevation, distance, pan }) => [
      (azimuth * Math.PI) / 360,
      (elevation * Math.PI) / 360,
      Math.log(distance) / 2,
      pan[0] / height,
    ];
    let before = seen(camera.view);
    const frames = glide(camera, 60, () => {
      const now = seen(camera.view);
      const pixels = PIXELS * Math.max(...now.map((value, at) => Math.abs(value - before[at])));
      assert.ok(pixels >= 1, `${name}: ${pixels} pixels`);
      before = now;
    });
    const last = PIXELS * Math.max(...seen(camera.goal).map((value, at) => Math.abs(value - before[at])));
    assert.ok(last <= 1.1, `${name}: jumps by ${last} pixels at its end`);
    assert.ok(frames <= 50, `${name}: ${frames} frames`);
  }
});

test("a glide takes the same time at any frame rate", () => {
  const seconds = [60, 144].map((rate) => {
    const camera = new OrbitCamera();
    camera.rotate(36, 0);
    return glide(camera, rate) / rate;
  });
  near(seconds[1], seconds[0], 0.05, "seconds");
});

test("the view stays above the floor", () => {
  const scene = { camera: { eye: [0, 2, 4], look_at: [0, 1, 0] }, floor: 0 };
  const eyeHeight = ({ elevation, distance, pan }) => {
    const own = elevationOf(scene.camera);
    return 1 + pan[1] + distance * Math.hypot(4, 1) * Math.sin(((own + elevation) * Math.PI) / 180);
  };
  const moves = {
    sinks: (camera) => camera.rotate(0, -100),
    "zooms out when low": (camera) => (camera.rotate(0, -100), camera.dolly(20)),
    "moves down": (camera) => (camera.rotate(0, -100), camera.pan(0, -0.2)),
    "opens by a link": (camera) => camera.jump({ azimuth: 0, elevation: -80, distance: 3 }),
  };
  for (const [name, move] of Object.entries(moves)) {
    const camera = new OrbitCamera();
    camera.useSceneCamera(scene.camera, scene.floor);
    move(camera);
    near(eyeHeight(camera.goal), 0.01 * Math.hypot(4, 1), 1e-9, name);
    camera.reset();
    assert.equal(camera.goal.elevation, 0);
    camera.useSceneCamera(scene.camera);
    move(camera);
    assert.ok(eyeHeight(camera.goal) < -1, `${name} without a floor`);
  }
});

test("the floor is an opaque plane perpendicular to up, below the eye of the scene", () => {
  const camera = { eye: [0, 2, 4], look_at: [0, 0, 0], up: [0, 2, 0] };
  const floor = (plane, materials = { stone: { type: "rough" } }) =>
    floorHeight(
      { materials, objects: [{ type: "plane", point: [5, -1, 0], normal: [0, -3, 0], material: "stone", ...plane }] },
      camera,
    );
  assert.equal(floor({}), -1);
  assert.equal(floor({ point: [0, 3, 0] }), -Infinity, "a ceiling");
  assert.equal(floor({ normal: [0, 1, 0.1] }), -Infinity, "a slope");
  assert.equal(floor({ type: "disk" }), -Infinity);
  assert.equal(floor({}, { stone: { type: "refractive" } }), -Infinity, "a surface of water");
  assert.equal(floorHeight({}, camera), -Infinity);
});

test("the camera never looks parallel to up", () => {
  const own = { eye: [0, 3, 3], look_at: [0, 0, 0], up: [0, 2, 0] };
  assert.ok(Math.abs(elevationOf(own) - 45) < 1e-9);
  const camera = new OrbitCamera();
  camera.useSceneCamera(own);
  camera.rotate(0, 1000);
  assert.ok(Math.abs(camera.goal.elevation - 44.9) < 1e-9);
  camera.rotate(0, -1000);
  assert.ok(Math.abs(camera.goal.elevation + 134.9) < 1e-9);
});

test("a pan by a fraction of the image height moves the target by this fraction of the visible height", () => {
  const closeTo = (actual, expected) =>
    actual.forEach((value, axis) => assert.ok(Math.abs(value - expected[axis]) < 1e-12, `${actual} ${expected}`));
  const own = { type: "perspective", eye: [0, 1, 4], look_at: [0, 1, 0], up: [0, 3, 0], fov_degrees: 90 };
  const panned = (view, right, up, fov) => {
    const camera = new OrbitCamera();
    camera.useSceneCamera({ ...own, ...view.camera });
    camera.jump({ azimuth: 0, elevation: 0, distance: 1, ...view });
    camera.pan(right, up, fov);
    return camera.goal.pan;
  };
  closeTo(panned({}, 1, 0.5), [8, 4, 0]); // height 2 * 4 m * tan 45
  closeTo(panned({ distance: 2 }, 0, 1), [0, 16, 0]);
  closeTo(panned({ azimuth: 90 }, 1, 0), [0, 0, -8]); // the eye is at +x, its right is -z
  closeTo(panned({ elevation: 60 }, 0, 1), [0, 4, -4 * Math.sqrt(3)]);
  const lifted = { eye: [0, 5, 4] }; // 45 degrees up, 4 * sqrt(2) m away
  closeTo(panned({ camera: lifted }, 0, 1), [0, 8, -8]);
  closeTo(panned({ camera: lifted, azimuth: 90, elevation: -45 }, 0.5, 0.25), [0, 2 * Math.SQRT2, -4 * Math.SQRT2]);
  closeTo(panned({}, 0, 1, (2 * (Math.atan(0.5) * 180)) / Math.PI), [0, 4, 0]);
  closeTo(panned({ camera: { type: "orthographic", height: 3 }, distance: 2 }, 1, 0), [6, 0, 0]);
});

test("a pan during a glide uses the scale of the goal", () => {
  const camera = new OrbitCamera();
  camera.pan(1, 0);
  const [metres] = camera.goal.pan;
  assert.equal(camera.dolly(0.5), 0.5);
  camera.pan(1, 0);
  assert.equal(camera.goal.pan[0], 1.5 * metres, "scale of the goal, not of the current view");
  assert.equal(camera.dolly(0.01), 0.04, "from 1/2 to 1/50, the minimum");
});

test("the camera glides to a panned view and back on reset", () => {
  const camera = new OrbitCamera();
  camera.pan(1, 0);
  const goal = camera.goal.pan[0];
  assert.equal(camera.step(1 / 60, PIXELS), true);
  near(camera.view.pan[0] / goal, 1 / 20 + 1 / PIXELS, 1e-9, "1/20 of the distance, plus a pixel");
  glide(camera);
  assert.equal(camera.view.pan[0], goal);
  camera.reset();
  assert.equal(camera.step(1 / 60, PIXELS), true);
  glide(camera);
  assert.deepEqual(camera.view.pan, [0, 0, 0]);
});

test("reset turns in the shorter direction", () => {
  const camera = new OrbitCamera();
  camera.jump({ azimuth: 350, elevation: 10, distance: 2 });
  camera.reset();
  camera.step(1 / 60, PIXELS);
  assert.ok(camera.view.azimuth > 350);
});

test("locate() finds the place of a JSON Pointer", () => {
  const text = '{ "a/b": [1, {"x": "}]\\"", "radius": -2}], "radius": 7, "list": [[], {}, 3] }';
  const at = (pointer, key) => text.slice(...locate(text, pointer, key));
  assert.equal(at("/a~1b/1/radius"), "-2");
  assert.equal(at("/radius"), "7");
  assert.equal(at("/a~1b/0"), "1");
  assert.equal(at("/list/2"), "3");
  assert.equal(at("/a~1b/1", "x"), '"x"');
  assert.deepEqual(locate(text, "/a~1b/1/absent"), locate(text, "/a~1b/1"));
  assert.equal(at(""), "{");
  for (let end = 0; end < text.length; end += 1) locate(text.slice(0, end), "/list/2");
  assert.equal(locate("[".repeat(1e5), "/0/0").length, 2);
});

test("offsetOf() and placeOf() are inverses", () => {
  assert.equal(offsetOf("ab\ncd\n", 2, 2), 4);
  assert.equal(offsetOf("ab\ncd\n", 1, 99), 2);
  assert.equal(offsetOf("ab", 9, 1), 0);
  const text = "\nab\n\ncd";
  for (let at = 0; at <= text.length; at += 1) {
    const { line, column } = placeOf(text, at);
    assert.equal(offsetOf(text, line, column), at);
  }
});

test("a URL hash restores settings and view, and invalid values are clamped or ignored", () => {
  const usual = parseHash("");
  const settings = { ...usual.settings, ref: "mirror", playing: false, technique: "raycast", samples: 16 };
  const view = { azimuth: 12.5, elevation: -3, distance: 0.5, pan: [0.5, -1e-7, 12345], time: 1.25 };
  assert.deepEqual(parseHash(formatHash(settings, view)), { settings, view });
  assert.equal(formatHash(usual.settings, usual.view), "#scene=paper&az=0&el=0&dist=1&speed=20&playing=1");
  const odd = parseHash("#scene=../x&az=abc&speed=1e9&size=9x&samples=-4&el=1e999&pan=1,2,x");
  assert.equal(odd.settings.speed, 120);
  odd.settings.speed = 20;
  assert.deepEqual(odd, usual);
});

test("an image fits its box and the limits of the service", () => {
  const scene = { width: 600, height: 600, camera: { type: "perspective", fov_degrees: 90 } };
  const limits = { side: 4096, pixels: 2 ** 24 };
  const size = (more) =>
    pictureSize({
      mode: "fit",
      purpose: "still",
      box: { width: 800, height: 400 },
      pixelRatio: 2,
      scene,
      limits,
      ...more,
    });
  assert.deepEqual(size(), { width: 1600, height: 800, fov: undefined, fills: true });
  assert.deepEqual(size({ purpose: "preview", part: 0.25 }), {
    width: 400,
    height: 200,
    fov: undefined,
    fills: true,
  });
  const stream = size({ purpose: "stream" });
  assert.ok(stream.width * stream.height <= 1e6 && stream.width > 1400);
  const narrow = size({ box: { width: 400, height: 800 } });
  assert.ok(Math.abs(narrow.fov - (2 * Math.atan(2) * 180) / Math.PI) < 1e-9, "the sides stay in view");
  assert.deepEqual(within({ width: 8192, height: 100 }, 4096, 2 ** 24), { width: 4096, height: 50 });
});

test("equal views have equal URLs, and commands are quoted for the shell", () => {
  const picture = {
    id: "ab12",
    azimuth: 10.001,
    elevation: -0.0001,
    distance: 1,
    width: 60,
    height: 40,
    samples: 0,
  };
  assert.equal(frameUrl(picture), "v1/scenes/ab12/frame.png?azimuth=10&elevation=0&distance=1&width=60&height=40");
  assert.match(frameUrl({ ...picture, pan: [0, 0, 0] }), /distance=1&width/);
  const panned = new URL(frameUrl({ ...picture, pan: [1.23456789, -2e-7, 0] }), "http://host");
  assert.equal(panned.searchParams.get("pan"), "1.23457,-2e-7,0");
  assert.equal(
    curlCommand(picture, "my scene", "http://host:1/"),
    "curl -fo my-scene-10-0.png 'http://host:1/v1/scenes/ab12/frame.png?azimuth=10&elevation=0&distance=1&width=60&height=40'",
  );
});

test("a job body has the options of the image's URL", () => {
  const view = { id: "ab", azimuth: 10.001, elevation: 0, distance: 2, width: 60, height: 40 };
  assert.deepEqual(JSON.parse(JSON.stringify(jobBody({ ...view, samples: 16 }))), {
    scene_id: "ab",
    camera: { azimuth_degrees: 10, elevation_degrees: 0, distance: 2 },
    image: { width: 60, height: 40 },
    render: { samples: 16 },
  });
  const more = { pan: [1, -2, 1e-7], fov: 50, technique: "raycast", isAnimated: true, time: 1.5 };
  const { camera, render } = jobBody({ ...view, ...more, samples: 4 });
  assert.deepEqual([camera.pan, camera.fov_degrees], [[1, -2, 1e-7], 50]);
  assert.deepEqual(render, { samples: 4, technique: "raycast", time: 1.5 });
});

test("the curl command reads the token from the environment", () => {
  const picture = { id: "ab", azimuth: 0, elevation: 0, distance: 1, width: 6, height: 4 };
  const command = curlCommand(picture, "a", "http://host/", "secret");
  assert.match(command, /^curl -fo a-0-0\.png -H "Authorization: Bearer \$ORRERY_TOKEN" 'http:/);
  assert.ok(!command.includes("secret"));
});

test('progress marks an estimated time with "about"', () => {
  const at = { shown: 16, end: 64 };
  assert.equal(progressText({ ...at, part: 0.439, secondsLeft: 2.1 }), "16 of 64 samples · 43 % · 3 s left");
  assert.equal(progressText({ ...at, part: 0.1 }), "16 of 64 samples · 10 %");
  assert.equal(
    progressText({ ...at, rmse: 0.01234, secondsLeft: 2 }),
    "16 of 64 samples · error 0.012 · about 2 s left",
  );
  assert.equal(progressText({ ...at, secondsLeft: 2.1 }), "16 of 64 samples · about 3 s left");
  assert.equal(progressText({ ...at, secondsLeft: NaN }), "16 of 64 samples");
  assert.equal(progressText({ ...at, secondsLeft: -1 }), "16 of 64 samples", "an estimate that has passed");
  assert.equal(progressText({ ...at, part: 0, secondsLeft: 600 }), "16 of 64 samples · 0 % · 10 min left");
  assert.equal(progressText({}), "");
});

test("withRetries() repeats a task after retryable errors only", async () => {
  const failure = (retryable) => Object.assign(new Error("no"), { retryable, retryAfterSeconds: 60 });
  let attempts = 0;
  const task = async () => {
    attempts += 1;
    if (attempts < 3) throw failure(true);
    return "done";
  };
  assert.equal(await withRetries(task, () => setImmediate(wakeAll)), "done");
  assert.equal(attempts, 3);
  await assert.rejects(
    withRetries(
      async () => {
        throw failure(false);
      },
      () => {},
    ),
    /no/,
  );
});

test("pretty() keeps the value and puts lists of numbers on one line", () => {
  const value = {
    eye: [0, -1.5, 2e-7],
    names: ["a", "b"],
    empty: [],
    deep: [
      [1, 2],
      [3, 4],
    ],
  };
  assert.deepEqual(JSON.parse(pretty(value)), value);
  assert.match(pretty(value), /"eye": \[0, -1\.5, 2e-7\]/);
});
