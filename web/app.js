// Entry point of the page. The store contains the state, the player chooses the picture, views show the
// state, and the address bar writes the state to the URL.

import { attachAccuracy } from "./accuracy.js";
import { AddressBar } from "./address-bar.js";
import { getJson, postScene } from "./api.js";
import { wakeAll, withRetries } from "./backoff.js";
import { OrbitCamera } from "./camera.js";
import { attachControls, step, ZOOM_STEP } from "./controls.js";
import { Editor } from "./editor.js";
import { attachFiles } from "./files.js";
import { Gallery } from "./gallery.js";
import { attachHint } from "./hint.js";
import { attachHistory } from "./history.js";
import { Hud } from "./hud.js";
import { DEFAULT_VIEW, parseHash } from "./link.js";
import { attachMessages } from "./messages.js";
import { Options } from "./options.js";
import { movingPictures, pictureAtRest, pictureFor, pictureToChart } from "./picture-request.js";
import { Player } from "./player.js";
import { rejectedSettings } from "./refusal.js";
import { SceneOpener } from "./scene-opener.js";
import { SceneLibrary, thumbnailOf } from "./scenes.js";
import { attachCurl, attachDownload } from "./share.js";
import { Store } from "./store.js";
import { attachTabs } from "./tabs.js";
import { attachToolbar } from "./toolbar.js";
import { frameUrl } from "./urls.js";
import { View } from "./view.js";

const $ = (id) => document.getElementById(id);
const stage = $("stage");
const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

const store = new Store({
  ...parseHash(location.hash).settings,
  catalog: null, // sample scenes and techniques of the service, null until loaded
  limits: { side: 4096, pixels: 2 ** 24, samples: 4096, frames: 3600, fileBytes: 2 ** 26 },
  scene: null, // scene on the stage, null while a scene is being opened
  // Kind of picture on the stage: "preview", "stream", "refining" or "still"; "" while a picture is pending.
  shows: "",
  figures: null, // figures of the picture on the stage, {kind, ...}
  warning: "",
  failure: null, // {error, actions}
  retry: null, // {title, seconds} while the page waits to repeat a request
  progress: null, // progress of the current render, see progress.js
  panning: false, // plain drags, arrow keys and arrow buttons pan
});
const library = new SceneLibrary();
const camera = new OrbitCamera();
const view = new View(stage, $("canvas"));
const address = new AddressBar(store, camera);

// Returns the state that a picture request needs: the store's values, with `changes`, and the stage's size.
const page = (changes) => ({ ...store.get(), box: view.box, ...changes });

const fail = (error, actions = []) => store.set({ retry: null, failure: { error, actions } });
const showRetry = ({ title }, seconds) => store.set({ retry: { title, seconds } });
const announce = (text) => ($("announcement").textContent = text);

// ---- pictures -----------------------------------------------------------------------------------------

const player = new Player(camera, view, {
  movingPictures: (purpose, at) => (store.get().scene ? movingPictures(page(), purpose, at) : []),
  pictureAtRest: (at) => {
    const { scene, samples, plan } = store.get();
    return scene && { picture: pictureAtRest(page(), at), isRequested: samples > 0 || plan !== "" };
  },
  repost: async () => {
    await opener.repost();
    player.refresh();
  },
  drawn: (kind, figures) => {
    const warning = figures.warning ?? store.get().warning;
    const shows = kind === "still" ? "refining" : kind;
    store.set({ shows, figures: { kind, ...figures }, warning, retry: null, failure: null });
    if (kind === "stream") address.saveSoon();
  },
  retrying: showRetry,
  failed: showRenderError,
  progress: (progress) => store.set({ progress }),
  stopped: () => store.set({ shows: "" }),
  settled: () => address.save(),
  finished: () => store.set({ shows: "still" }),
});

const accuracy = attachAccuracy(store, {
  picture: () => store.get().scene && pictureToChart(page(), camera.view),
  withBudget: (budget) => pictureAtRest(page({ plan: "", ...budget }), camera.view),
  // The error map accepts no budget. Uses the plan that the service has chosen for the budget, if known, else
  // drops the budget.
  shownAddress: () => store.get().scene && frameUrl({ ...player.picture, seconds: 0, error: 0 }),
  pause: () => store.get().playing && setPlaying(false),
  set: change,
  announce,
});

function currentPicture() {
  const { scene } = store.get();
  return scene && { picture: player.picture, name: library.sample(scene.ref)?.name ?? "scene" };
}

// Reports `error`. If the service rejected settings of the link, every offered action resets these settings.
function showRenderError(error) {
  const rejected = rejectedSettings(error, store.get());
  if (!rejected) return fail(error);
  const reset = () => {
    store.set({ ...rejected.settings, failure: null });
    address.save();
  };
  fail(error, [[rejected.label, reset], ...otherScenes.map(([label, act]) => [label, () => (reset(), act())])]);
}

// ---- scenes -------------------------------------------------------------------------------------------

const opener = new SceneOpener(store, library, camera, {
  opening: ({ ref }) => {
    const sample = library.sample(ref);
    view.announce(sample ? thumbnailOf(sample) : "");
  },
  opened: () => address.save(),
  retrying: showRetry,
  failed: (error) => {
    view.announce("");
    fail(error.status === 404 ? unknownScene(error) : error, otherScenes);
  },
});

// Actions offered when a scene cannot be shown, each [label, function].
const otherScenes = [
  ["Choose a sample scene", () => (selectTab("tab-scenes"), gallery.focus())],
  ["Paste a scene", () => (selectTab("tab-json"), $("text").focus())],
];

function unknownScene({ requestId }) {
  const { ref } = store.get();
  const name = ref.length > 40 ? `${ref.slice(0, 12)}…` : ref;
  const detail = "The service does not have this scene. It keeps posted scenes only for a limited time.";
  return { title: `Unknown scene “${name}”`, detail, requestId };
}

function pickSample(name) {
  address.save();
  store.set({ ref: name });
  address.push(DEFAULT_VIEW);
  opener.open(DEFAULT_VIEW);
  showStage();
}

// Posts a scene text and shows the scene. Resolves to false if another scene was opened meanwhile. Throws
// ApiError.
async function applyText(text, title) {
  const posted = await opener.post(text, title);
  if (!posted) return false;
  address.save();
  opener.show(posted, DEFAULT_VIEW);
  address.push();
  showStage();
  return true;
}

// Scrolls the stage into view, because a narrow page may have scrolled it away.
function showStage() {
  stage.scrollIntoView({ block: "nearest" });
}

// ---- settings -----------------------------------------------------------------------------------------

// Applies settings that the user has chosen.
function change(settings) {
  if (!store.get().scene) return store.set(settings);
  address.save();
  store.set({ ...settings, failure: null });
  address.push();
}

function setPlaying(playing) {
  store.set({ playing });
  address.save();
}

// Applies the hash after the user has navigated in the history or edited the URL.
function loadHash() {
  const { settings, view: linked } = parseHash(location.hash);
  const { catalog, scene, playing } = store.get();
  if (reducedMotion.matches && !playing) settings.playing = false;
  if (!catalog) return store.set(settings); // start() opens the scene
  if (settings.ref !== scene?.ref) {
    store.set({ ...settings, scene: null });
    return opener.open(linked);
  }
  camera.jump(linked);
  player.invalidate();
  store.set(settings);
  accuracy.hideOverlay();
  player.refresh();
}

// ---- camera moves -------------------------------------------------------------------------------------

const moves = {
  rotate: (azimuth, elevation) => (camera.rotate(azimuth, elevation), moved()),
  dolly,
  pan,
  isPanning: () => store.get().panning,
  reset: () => (camera.reset(), moved()),
  togglePlay: () => setPlaying(!store.get().playing),
  hold: (held) => player.hold(held),
};

function moved() {
  $("hint").hidden = true;
  accuracy.hideOverlay();
  player.input();
}

function dolly(factor) {
  const applied = camera.dolly(factor);
  moved();
  return applied;
}

// Pans by pixels on the stage. Points at the target's distance stay under the pointer.
function pan(right, up) {
  if (!store.get().scene) return;
  const { width, height, fov } = pictureFor(page(), "still", camera.view);
  const shownHeight = Math.min(view.box.height, (view.box.width * height) / width);
  camera.pan(right / shownHeight, up / shownHeight, fov);
  moved();
}

const by = (x, y) => (event) => step(stage, moves, x, y, { pans: moves.isPanning(), fine: event.shiftKey });
const actions = {
  left: by(-1, 0),
  right: by(1, 0),
  up: by(0, 1),
  down: by(0, -1),
  pan: () => store.set({ panning: !moves.isPanning() }),
  closer: () => moves.dolly(ZOOM_STEP),
  farther: () => moves.dolly(1 / ZOOM_STEP),
  reset: () => moves.reset(),
  play: () => moves.togglePlay(),
  retry: () => (wakeAll(), player.retryNow()),
};

// ---- views --------------------------------------------------------------------------------------------

new Hud($("hud"), store);
attachMessages(store);
attachToolbar(store, actions, (speed) => {
  store.set({ speed });
  player.refreshSoon();
  address.saveSoon();
});
new Options({ technique: $("technique"), samples: $("samples"), size: $("size") }, store, (key, value) =>
  change({ ...(key !== "size" && { plan: "" }), [key]: value }),
);
const gallery = new Gallery($("gallery"), store, pickSample);
const selectTab = attachTabs($("tabs"));
const editor = new Editor(
  {
    text: $("text"),
    card: $("text-problem"),
    note: $("text-note"),
    lines: $("lines"),
    apply: $("apply"),
    restore: $("restore"),
  },
  applyText,
  postScene,
);
attachFiles(store, {
  aspect: () => view.box.width / view.box.height,
  show: applyText,
  play: () => !reducedMotion.matches && setPlaying(true),
});
attachControls(stage, moves);
attachHistory($("show-history"), $("history"), store, currentPicture);
attachHint($("hint"));
attachCurl($("curl"), currentPicture, announce);
const refreshDownload = attachDownload($("download"), currentPicture, fail);

store.subscribe(["ref"], ({ ref }) => (stage.dataset.scene = ref));
store.subscribe(["shows"], ({ shows }) => {
  if (shows) stage.dataset.shows = shows;
  else delete stage.dataset.shows;
});
store.subscribe(["scene"], ({ scene }) => {
  document.title = scene ? `${scene.title} · orrery` : "orrery";
  stage.setAttribute("aria-label", scene ? `${scene.title}, 3D view` : "3D view");
  if (scene) editor.load(scene.text);
});
store.subscribe(["scene", "shows"], refreshDownload);

store.subscribe(["playing"], ({ playing }) => (player.playing = playing));
store.subscribe(["speed"], ({ speed }) => (player.speed = speed));
store.subscribe(["limits"], ({ limits }) => (player.streamFrames = limits.frames));
store.subscribe(["technique", "samples", "size", "plan", "seconds", "error"], () => player.refresh());
store.subscribe(["scene"], () => {
  player.invalidate();
  player.refresh();
});

new ResizeObserver(() => player.refreshSoon()).observe(stage);
addEventListener("hashchange", loadHash);
reducedMotion.addEventListener("change", () => (camera.damped = !reducedMotion.matches));

// ---- start --------------------------------------------------------------------------------------------

async function loadCatalog() {
  const [catalog, published] = await Promise.all([getJson("v1/catalog"), getJson("v1/limits")]);
  const { image_side: side, image_pixels: pixels, samples, orbit_frames: frames, asset_bytes: fileBytes } = published;
  return { catalog, limits: { side, pixels, samples, frames, fileBytes } };
}

async function start() {
  camera.damped = !reducedMotion.matches;
  if (reducedMotion.matches) store.set({ playing: false });
  const { catalog, limits } = await withRetries(loadCatalog, showRetry);
  library.samples = catalog.samples ?? [];
  store.set({ catalog, limits });
  const { ref } = store.get();
  if (!location.hash && !library.sample(ref)) store.set({ ref: library.samples[0]?.name ?? ref });
  await opener.open(parseHash(location.hash).view);
}

start().catch(fail);
