// Slider stops of a chart: render plans, each more accurate than every cheaper stop.

import { rounded, roundedUp } from "./progress.js";

const EQUAL_RATIO = 0.99; // error ratio above which two points count as equal, as in the service
// Query parameters of the view, with the short names that the page uses.
const VIEW_KEYS = ["azimuth_degrees", "elevation_degrees", "fov_degrees", "distance", "pan", "time"];
const SHORT_VIEW_KEYS = ["azimuth", "elevation", "fov"];

// Returns the stops as {point, place, line}: the chart's point, its position on a logarithmic scale of CPU
// time from 0 (fastest) to 1 (slowest), and its description. Skips a point of the front unless its error is
// at least 1 % smaller than the error of every cheaper stop. An error below the noise floor counts as the
// noise floor.
export function stopsOf({ front, points, noise_floor: noiseFloor }) {
  const stops = [];
  let nearest = Infinity;
  for (const point of front.map((index) => points[index])) {
    const error = Math.max(point.rmse, noiseFloor);
    if (error >= EQUAL_RATIO * nearest) continue;
    nearest = error;
    stops.push({ point, line: lineOf(point) });
  }
  const [low, high] = [stops[0], stops.at(-1)].map(({ point }) => Math.log(point.cpu_ms));
  return stops.map((stop) => ({
    ...stop,
    place: high > low ? (Math.log(stop.point.cpu_ms) - low) / (high - low) : 0,
  }));
}

// Returns the index of the stop nearest to `place`.
export function stopAt(stops, place) {
  const away = stops.map((stop) => Math.abs(stop.place - place));
  return away.indexOf(Math.min(...away));
}

export function duration(seconds) {
  if (seconds < 0.0995) return `${rounded(1000 * seconds)} ms`;
  return seconds < 99.5 ? `${rounded(seconds)} s` : `${Math.round(seconds / 60)} min`;
}

// Returns a text such as "0.8 s, error ≤ 0.004 (95 % confidence), whitted, depth 5, 16 samples, float". The
// time is predicted.
export function lineOf({ full_size: fullSize, interval, rmse, technique, max_depth: depth, samples, precision }) {
  const error = interval
    ? `error ≤ ${roundedUp(interval.rmse.high)} (95 % confidence)`
    : `error about ${rounded(rmse)} (one round)`;
  const count = samples === 1 ? "1 sample" : `${samples} samples`;
  return `${duration(fullSize.seconds)}, ${error}, ${technique}, depth ${depth}, ${count}, ${precision}`;
}

// Returns the plan of a point as a query for links, without view and size.
export function planOf({ plan, samples }) {
  const query = new URLSearchParams(plan);
  for (const key of [...VIEW_KEYS, ...SHORT_VIEW_KEYS, "width", "height"]) query.delete(key);
  query.set("samples", samples); // a plan without samples uses the scene's samples
  return String(query);
}

// Parses the plan of a link into {technique, samples, more}. `more` contains the other options as a query.
export function optionsOf(plan) {
  const query = new URLSearchParams(plan);
  const [technique, samples] = [query.get("technique") ?? "", Number(query.get("samples"))];
  query.delete("technique");
  query.delete("samples");
  return { technique, samples, more: String(query) };
}

// Returns the URL of a picture's error map, its error bound in false colours.
export const boundOf = (address) => `${address}${address.includes("?") ? "&" : "?"}view=bound`;

// Returns the URL of a picture in the view of `query` (URLSearchParams).
export function atView(address, query) {
  const [path, text] = address.split("?");
  const all = new URLSearchParams(text);
  for (const key of [...VIEW_KEYS, ...SHORT_VIEW_KEYS]) {
    all.delete(key);
    if (query.has(key)) all.set(key, query.get(key));
  }
  return `${path}?${all}`;
}
