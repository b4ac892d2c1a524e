// The stops of a chart: ways to make its picture, each nearer to the reference than all that cost less.

import { rounded, rounded_up } from "./progress.js";

const kNearer = 0.99; // a smaller difference of errors is none, as the service has it
// What a link says of the view and of its size is no part of a plan.
const kOfView = ["azimuth", "elevation", "distance", "pan", "fov", "time", "width", "height"];

// {point, place, line} each: the chart's point, where it stands from 0, the fastest, to 1 by the logarithm of its
// cost, and what is said of it. Where rounds cannot tell two points apart, the one that is farther off by its mean
// and costs more is no stop.
export function stops_of({ front, points, noise_floor }) {
  const stops = [];
  let nearest = Infinity;
  for (const point of front.map((index) => points[index])) {
    const error = Math.max(point.rmse, noise_floor);
    if (error >= kNearer * nearest) continue;
    nearest = error;
    stops.push({ point, line: line_of(point) });
  }
  const [low, high] = [stops[0], stops.at(-1)].map(({ point }) => Math.log(point.cpu_ms));
  return stops.map((stop) => ({
    ...stop,
    place: high > low ? (Math.log(stop.point.cpu_ms) - low) / (high - low) : 0,
  }));
}

// The number of the stop that is nearest to a place.
export function stop_at(stops, place) {
  const away = stops.map((stop) => Math.abs(stop.place - place));
  return away.indexOf(Math.min(...away));
}

export function duration(seconds) {
  if (seconds < 0.0995) return `${rounded(1000 * seconds)} ms`;
  return seconds < 99.5 ? `${rounded(seconds)} s` : `${Math.round(seconds / 60)} min`;
}

// "0.8 s, error ≤ 0.004 (95 %), whitted, depth 5, 16 samples, float". The time is predicted.
export function line_of({ full_size, interval, rmse, technique, max_depth, samples, precision }) {
  const error = interval
    ? `error ≤ ${rounded_up(interval.rmse.high)} (95 %)`
    : `error about ${rounded(rmse)} (one round)`;
  const count = samples === 1 ? "1 sample" : `${samples} samples`;
  return `${duration(full_size.seconds)}, ${error}, ${technique}, depth ${max_depth}, ${count}, ${precision}`;
}

// The plan of a point as a link keeps it: what makes its picture, whatever the view and the size.
export function plan_of({ plan, samples }) {
  const query = new URLSearchParams(plan);
  for (const key of kOfView) query.delete(key);
  query.set("samples", samples); // which the plan may leave to the scene
  return String(query);
}

// What a link's plan asks for: {technique, samples, more}, the rest as a query.
export function options_of(plan) {
  const query = new URLSearchParams(plan);
  const [technique, samples] = [query.get("technique") ?? "", Number(query.get("samples"))];
  query.delete("technique");
  query.delete("samples");
  return { technique, samples, more: String(query) };
}

// The bound of a picture in false colours.
export const bound_of = (address) => `${address}${address.includes("?") ? "&" : "?"}view=bound`;

// A picture's address with another view: that of `query`, an address's parameters.
export function at_view(address, query) {
  const [path, text] = address.split("?");
  const all = new URLSearchParams(text);
  for (const key of kOfView.filter((name) => name !== "width" && name !== "height")) {
    all.delete(key);
    if (query.has(key)) all.set(key, query.get(key));
  }
  return `${path}?${all}`;
}
