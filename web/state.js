// Page state in the URL hash: parsing and formatting.

import { kModes, fixed_size } from "./size.js";
import { pan_text, round } from "./urls.js";

export const kDefaults = Object.freeze({
  scene: "paper",
  az: 0,
  el: 0,
  dist: 1,
  pan: [0, 0, 0], // metres
  t: 0, // seconds of the scene's motion
  speed: 20,
  playing: true,
  technique: "",
  samples: 0,
  size: "fit",
  plan: "", // query of frame.png without view and size, from a chart's point
  seconds: 0, // budgets; 0: none
  error: 0,
});
export const kFastest = 120; // degrees per second
const kFarthestPan = 1e12; // metres, limit of the service
const kLongestSeconds = 60;
const kAlways = ["scene", "az", "el", "dist", "speed", "playing"];

// Parses a hash such as "#scene=paper&az=30". Missing and invalid values get their default.
export function parse_hash(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const number = (key, low, high) => {
    const value = Number.parseFloat(query.get(key));
    return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : kDefaults[key];
  };
  const word = (key, pattern) => (pattern.test(query.get(key) ?? "") ? query.get(key) : kDefaults[key]);
  const size = query.get("size") ?? "";
  const pan = (query.get("pan") ?? "").split(",").map(Number.parseFloat);
  return {
    scene: word("scene", /^[\w-]{1,100}$/),
    az: number("az", -1e6, 1e6),
    el: number("el", -180, 180),
    dist: number("dist", 0.001, 1000),
    pan: pan.length === 3 && pan.every((metres) => Math.abs(metres) <= kFarthestPan) ? pan : kDefaults.pan,
    t: number("t", -1e6, 1e6),
    speed: number("speed", 1, kFastest),
    playing: query.has("playing") ? query.get("playing") !== "0" : kDefaults.playing,
    technique: word("technique", /^[\w-]{1,40}$/),
    samples: Math.round(number("samples", 0, 65536)),
    size: kModes.includes(size) || fixed_size(size) ? size : kDefaults.size,
    plan: word("plan", /^(?=.{3,400}$)[\w-]+=[\w.-]+(&[\w-]+=[\w.-]+)*$/),
    seconds: number("seconds", 0, kLongestSeconds),
    error: number("error", 0, 1),
  };
}

export function format_hash(state) {
  const texts = {
    scene: state.scene,
    az: round(state.az, 1),
    el: round(state.el, 1),
    dist: round(state.dist, 3),
    pan: pan_text(state.pan),
    t: round(state.t, 3),
    speed: state.speed,
    playing: state.playing ? 1 : 0,
    technique: state.technique,
    samples: state.samples,
    size: state.size,
    plan: state.plan,
    seconds: state.seconds,
    error: state.error,
  };
  const query = new URLSearchParams();
  for (const [key, value] of Object.entries(texts)) {
    if (value !== "" && (kAlways.includes(key) || value !== kDefaults[key])) query.set(key, value);
  }
  return `#${query}`;
}

// Returns the view of the hash for the camera.
export function view_of({ az, el, dist, pan, t }) {
  return { azimuth: az, elevation: el, distance: dist, pan, time: t };
}
