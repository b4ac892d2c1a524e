// Page wiring: the URL hash is the state, the player shows it, the controls change it.

import { attach_accuracy } from "./accuracy.js";
import { get_json, post_scene } from "./api.js";
import { moving_pictures, picture_at_rest, picture_for, picture_to_chart } from "./asked.js";
import { persist, wake_all } from "./backoff.js";
import { OrbitCamera } from "./camera.js";
import { attach_controls, kZoomStep, step } from "./controls.js";
import { Editor } from "./editor.js";
import { Gallery } from "./gallery.js";
import { attach_hint } from "./hint.js";
import { Hud } from "./hud.js";
import { Options } from "./options.js";
import { Player } from "./player.js";
import { hide_problem, show_problem } from "./problem.js";
import { show_progress } from "./progress.js";
import { refused_of } from "./refusal.js";
import { facts_of, SceneLibrary, thumbnail_of } from "./scenes.js";
import { attach_curl, attach_download } from "./share.js";
import { format_hash, kDefaults, parse_hash, view_of } from "./state.js";
import { attach_tabs } from "./tabs.js";
import { frame_url } from "./urls.js";
import { View } from "./view.js";

const kSaveMs = 1000; // interval of hash updates; browsers throttle shorter ones

const $ = (id) => document.getElementById(id);
const still_please = matchMedia("(prefers-reduced-motion: reduce)");

const state = parse_hash(location.hash);
const library = new SceneLibrary();
const camera = new OrbitCamera();
const stage = $("stage");
const view = new View(stage, $("canvas"), $("poster"));
const hud = new Hud($("hud"));
const limits = { side: 4096, pixels: 2 ** 24, samples: 4096, frames: 3600 };
let scene = null; // scene on the stage, or null while one is being opened
let gallery = null;
let options = null;
let opening = 0; // scene change counter, to drop late responses
let save_timer = 0;
let pans = false;
const page = () => ({ state, scene, view, limits });

const player = new Player(camera, view, {
  moving: (purpose, at) => (scene ? moving_pictures(page(), purpose, at) : []),
  at_rest: (at) => scene && { picture: picture_at_rest(page(), at), asked: state.samples > 0 || state.plan !== "" },
  missing: () => post_again(),
  stats: (kind, figures) => {
    hud.show(kind, figures);
    show_warning(figures.warning);
    // A still of a held orbit is rendered without a budget.
    if (kind === "still" && figures.bound && !state.playing) accuracy.tell(figures, state);
    stage.dataset.shows = kind === "still" ? "refining" : kind;
    $("notice").hidden = true;
    hide_fail();
    if (kind === "stream") save_soon();
  },
  waiting: show_waiting,
  problem: fail_to_render,
  progress: (figures) => show_progress($("busy"), $("progress"), figures),
  stale: () => {
    delete stage.dataset.shows;
    accuracy.stale();
  },
  settled: () => save_now(),
  rested: () => {
    stage.dataset.shows = "still";
    refresh_download();
    if (!state.playing) accuracy.rest();
  },
});

const accuracy = attach_accuracy({
  picture: () => scene && picture_to_chart(page(), camera.view),
  within: (budget) => picture_at_rest({ ...page(), state: { ...state, plan: "", ...budget } }, camera.view),
  // The error view needs a resolved budget; falls back to the picture without a budget.
  seen: () => scene && frame_url({ ...player.picture, seconds: 0, error: 0 }),
  pause: () => state.playing && set_playing(false),
  set: (settings) => change(settings),
});

const editor = new Editor(
  {
    text: $("text"),
    card: $("text-problem"),
    note: $("text-note"),
    lines: $("lines"),
    apply: $("apply"),
    restore: $("restore"),
  },
  async (text) => {
    const turn = opening;
    const posted = await library.post(text);
    if (turn !== opening) return; // another scene was opened meanwhile
    save_now();
    show_scene(posted, kDefaults);
    history.pushState(null, "", current_hash());
    show_stage();
  },
  post_scene,
);

function current_picture() {
  if (!scene) return null;
  return { picture: player.picture, name: library.sample(scene.ref)?.name ?? "scene" };
}

// Opens the scene in `state`, retrying until the service responds.
async function open_scene(at) {
  const turn = ++opening;
  const wanted = () => turn === opening;
  scene = null;
  accuracy.show();
  player.invalidate();
  announce();
  try {
    const opened = await persist(() => library.open(state.scene), show_waiting, wanted);
    if (!wanted()) return;
    show_scene(opened, at);
    save_now();
  } catch (error) {
    if (!wanted()) return;
    show_nothing();
    fail(error.status === 404 ? unknown_scene(error) : error, others);
  }
}

// Clears stage, figures and messages, and shows the thumbnail of the scene being opened.
function announce() {
  const sample = library.sample(state.scene);
  view.announce(sample ? thumbnail_of(sample) : "");
  stage.dataset.scene = state.scene;
  hud.clear();
  hide_fail();
  show_warning("");
}

function show_nothing() {
  view.announce("");
  document.title = "orrery";
  stage.setAttribute("aria-label", "Orbit view");
}

function unknown_scene({ request_id }) {
  const name = state.scene.length > 40 ? `${state.scene.slice(0, 12)}…` : state.scene;
  const detail = "The service never had it, or has forgotten it: it keeps posted scenes for a time only.";
  return { title: `There is no scene “${name}”`, detail, request_id };
}

function show_scene(opened, at) {
  opening += 1;
  scene = { ...opened, ...facts_of(opened) };
  state.scene = stage.dataset.scene = opened.ref;
  camera.use_scene_camera(opened.camera, scene.floor);
  camera.jump(view_of(at));
  hide_fail();
  editor.load(opened.text);
  gallery?.mark(opened.ref);
  options?.show(state, opened);
  document.title = `${opened.title} · orrery`;
  stage.setAttribute("aria-label", `${opened.title}, orbit view`);
  accuracy.show();
  accuracy.leave();
  refresh_download();
  player.invalidate();
  player.refresh();
}

async function post_again() {
  const turn = opening;
  const { id } = await library.post(scene.text);
  if (turn !== opening) return;
  scene = { ...scene, id };
  player.refresh();
}

function pick_sample(name) {
  save_now();
  state.scene = name;
  history.pushState(null, "", format_hash({ ...state, az: 0, el: 0, dist: 1, pan: kDefaults.pan, t: 0 }));
  gallery.mark(name);
  open_scene(kDefaults);
  show_stage();
}

// Scrolls the stage into view: a narrow page may have scrolled it away.
function show_stage() {
  stage.scrollIntoView({ block: "nearest" });
}

function current_hash() {
  const { azimuth, elevation, distance, pan, time } = camera.view;
  return format_hash({ ...state, az: azimuth, el: elevation, dist: distance, pan, t: time });
}

function save_now() {
  clearTimeout(save_timer);
  save_timer = 0;
  if (scene) history.replaceState(null, "", current_hash());
}

function save_soon() {
  save_timer ||= setTimeout(save_now, kSaveMs);
}

// Applies the hash after the user went back, forward, or edited the address.
function load_hash() {
  const next = parse_hash(location.hash);
  const same_scene = scene && next.scene === scene.ref;
  Object.assign(state, next, { playing: next.playing && (!still_please.matches || state.playing) });
  show_settings();
  if (!same_scene) return open_scene(state);
  camera.jump(view_of(state));
  accuracy.leave();
  accuracy.show();
  player.invalidate();
  player.playing = state.playing;
}

function show_settings() {
  player.speed = state.speed;
  $("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
  $("play").classList.toggle("playing", state.playing);
  $("speed").value = state.speed;
  $("speed-text").textContent = `${state.speed}°/s`;
  options?.show(state, scene);
  accuracy.mark(state);
}

function set_playing(playing) {
  state.playing = playing;
  show_settings();
  if (playing) accuracy.leave();
  player.playing = playing;
  save_now();
}

const set_option = (key, value) => change({ ...(key !== "size" && { plan: "" }), [key]: value });

// Applies settings that the user has chosen.
function change(settings) {
  save_now();
  Object.assign(state, settings);
  show_settings();
  if (!scene) return;
  history.pushState(null, "", current_hash());
  hide_fail();
  accuracy.leave();
  accuracy.show();
  player.refresh();
}

const hide_fail = () => hide_problem($("stage-problem"));

function fail(error, actions = []) {
  $("notice").hidden = true;
  show_problem($("stage-problem"), error, undefined, actions);
}

// Actions offered if no scene can be shown, each [label, function].
const others = [
  ["Choose a sample", () => (select_tab("tab-scenes"), gallery?.focus())],
  ["Paste a scene", () => (select_tab("tab-json"), $("text").focus())],
];

// Reports `error`. If the service rejected settings of the link, every offered action resets them.
function fail_to_render(error) {
  const refused = refused_of(error, state);
  if (!refused) return fail(error);
  const drop = () => {
    Object.assign(state, refused.settings);
    show_settings();
  };
  const again = [refused.label, () => (drop(), hide_fail(), save_now(), player.refresh())];
  fail(error, [again, ...others.map(([label, act]) => [label, () => (drop(), act())])]);
}

function show_warning(text) {
  if (text === undefined || $("warning").title === text) return;
  $("warning").title = text;
  $("warning").textContent = text && `Warning: ${text}`;
}

function show_waiting(error, seconds) {
  hud.pause();
  $("notice-text").textContent = `${error.title}. Trying again in ${Math.max(1, Math.round(seconds))} s.`;
  $("notice").hidden = false;
}

function moved() {
  $("hint").hidden = true;
  accuracy.leave();
  player.input();
}

const moves = {
  rotate: (azimuth, elevation) => (camera.rotate(azimuth, elevation), moved()),
  dolly,
  pan,
  panning: () => pans,
  reset: () => (camera.reset(), moved()),
  toggle_play: () => set_playing(!state.playing),
  hold: (held) => player.hold(held),
};

function dolly(factor) {
  const changed = camera.dolly(factor);
  moved();
  return changed;
}

// Pans by pixels on the stage. Points at the target's distance stay under the pointer.
function pan(right, up) {
  if (!scene) return;
  const { width, height, fov } = picture_for(page(), "still", camera.view);
  const shown_height = Math.min(view.box.height, (view.box.width * height) / width);
  camera.pan(right / shown_height, up / shown_height, fov);
  moved();
}

// Makes plain drags, arrow keys and arrow buttons pan (`on`) or rotate.
function set_panning(on) {
  pans = on;
  $("pan").setAttribute("aria-pressed", String(on));
  for (const name of ["left", "right", "up", "down"]) {
    const button = document.querySelector(`[data-do="${name}"]`);
    button.title = `${on ? "Move" : "Turn"} ${name} (arrow key; with shift finely)`;
  }
}

const by = (x, y) => (event) => step(stage, moves, x, y, { pans, fine: event.shiftKey });
const actions = {
  left: by(-1, 0),
  right: by(1, 0),
  up: by(0, 1),
  down: by(0, -1),
  pan: () => set_panning(!pans),
  closer: () => moves.dolly(kZoomStep),
  farther: () => moves.dolly(1 / kZoomStep),
  reset: () => moves.reset(),
  play: () => moves.toggle_play(),
  retry: () => (wake_all(), player.retry_now()),
};

attach_controls(stage, moves);
attach_hint($("hint"));
const select_tab = attach_tabs($("tabs"));
for (const button of document.querySelectorAll("[data-do]")) {
  button.addEventListener("click", actions[button.dataset.do]);
}
$("speed").addEventListener("input", () => {
  state.speed = Number($("speed").value);
  show_settings();
  player.refresh_soon();
  save_soon();
});
new ResizeObserver(() => player.refresh_soon()).observe(stage);
const refresh_download = attach_download($("download"), current_picture, fail);
attach_curl($("curl"), current_picture, $("announcement"));
addEventListener("hashchange", load_hash);
still_please.addEventListener("change", () => (camera.damped = !still_please.matches));

async function load_catalog() {
  const [catalog, published] = await Promise.all([get_json("v1/catalog"), get_json("v1/limits")]);
  const { image_side: side, image_pixels: pixels, samples, orbit_frames: frames } = published;
  Object.assign(limits, { side, pixels, samples, frames });
  return catalog;
}

async function start() {
  camera.damped = !still_please.matches;
  set_panning(false);
  if (still_please.matches) state.playing = false;
  show_settings();
  player.playing = state.playing;
  const catalog = await persist(load_catalog, show_waiting);
  player.stream_frames = limits.frames;
  library.samples = catalog.samples ?? [];
  if (!location.hash && !library.sample(state.scene)) state.scene = library.samples[0]?.name ?? state.scene;
  options = new Options(
    { technique: $("technique"), samples: $("samples"), size: $("size") },
    catalog,
    limits,
    set_option,
  );
  options.show(state, null);
  gallery = new Gallery($("gallery"), library, pick_sample);
  await open_scene(state);
}

start().catch(fail);
