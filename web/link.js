// Settings and view of the page in the URL hash: parsing and formatting.

import { MODES, fixedSize } from "./size.js";
import { panText, round } from "./urls.js";

export const DEFAULTS = Object.freeze({
  ref: "paper", // name of a sample, or id of a posted scene
  speed: 20, // degrees per second
  playing: true,
  technique: "",
  samples: 0,
  size: "fit",
  plan: "", // query of frame.png without view and size, taken from a point of a chart
  seconds: 0, // time budget, 0 for no budget
  error: 0, // error budget, 0 for no budget
});
export const DEFAULT_VIEW = Object.freeze({
  azimuth: 0,
  elevation: 0,
  distance: 1,
  pan: Object.freeze([0, 0, 0]), // metres
  time: 0, // seconds of the scene's motion
});
const MAX_SPEED = 120; // degrees per second
const MAX_PAN = 1e12; // metres, limit of the service
const MAX_SECONDS = 60;

// Parses a hash such as "#scene=paper&az=30" into {settings, view}. Missing and malformed values get their
// default. Numbers are clamped to their range, except for `pan`: a number beyond its limit resets it.
export function parseHash(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const number = (key, low, high, fallback) => {
    const value = Number.parseFloat(query.get(key));
    return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : fallback;
  };
  const word = (key, pattern, fallback) => (pattern.test(query.get(key) ?? "") ? query.get(key) : fallback);
  const size = query.get("size") ?? "";
  const pan = (query.get("pan") ?? "").split(",").map(Number.parseFloat);
  return {
    settings: {
      ref: word("scene", /^[\w-]{1,100}$/, DEFAULTS.ref),
      speed: number("speed", 1, MAX_SPEED, DEFAULTS.speed),
      playing: query.has("playing") ? query.get("playing") !== "0" : DEFAULTS.playing,
      technique: word("technique", /^[\w-]{1,40}$/, DEFAULTS.technique),
      samples: Math.round(number("samples", 0, 65536, DEFAULTS.samples)),
      size: MODES.includes(size) || fixedSize(size) ? size : DEFAULTS.size,
      plan: word("plan", /^(?=.{3,400}$)[\w-]+=[\w.-]+(&[\w-]+=[\w.-]+)*$/, DEFAULTS.plan),
      seconds: number("seconds", 0, MAX_SECONDS, DEFAULTS.seconds),
      error: number("error", 0, 1, DEFAULTS.error),
    },
    view: {
      azimuth: number("az", -1e6, 1e6, DEFAULT_VIEW.azimuth),
      elevation: number("el", -180, 180, DEFAULT_VIEW.elevation),
      distance: number("dist", 0.001, 1000, DEFAULT_VIEW.distance),
      pan: pan.length === 3 && pan.every((metres) => Math.abs(metres) <= MAX_PAN) ? pan : DEFAULT_VIEW.pan,
      time: number("t", -1e6, 1e6, DEFAULT_VIEW.time),
    },
  };
}

// Returns the hash. Leaves out settings with their default (except for scene, speed and playing), and a pan
// or time of 0.
export function formatHash(settings, view) {
  const query = new URLSearchParams({
    scene: settings.ref,
    az: round(view.azimuth, 1),
    el: round(view.elevation, 1),
    dist: round(view.distance, 3),
  });
  if (view.pan.some(Boolean)) query.set("pan", panText(view.pan));
  if (round(view.time, 3)) query.set("t", round(view.time, 3));
  query.set("speed", settings.speed);
  query.set("playing", settings.playing ? 1 : 0);
  for (const key of ["technique", "samples", "size", "plan", "seconds", "error"])
    if (settings[key] !== DEFAULTS[key]) query.set(key, settings[key]);
  return `#${query}`;
}
