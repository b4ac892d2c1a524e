#!/usr/bin/env node
// Page modules for charts and error bounds that need no browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { near } from "./support.mjs";
import { load } from "./web_modules.mjs";

const { bound_words, budget_words, fields_of, parameters_of } = await load("bound.js");
const { at_view, duration, line_of, options_of, plan_of, stop_at, stops_of } = await load("front.js");
const { format_hash, kDefaults, parse_hash } = await load("state.js");
const { prediction_words } = await load("predicted.js");
const { rounded_up } = await load("progress.js");
const { chart_body, frame_url, job_body } = await load("urls.js");

const point = (cpu_ms, rmse, more = {}) => ({
  cpu_ms,
  rmse,
  technique: "whitted",
  max_depth: 5,
  samples: 16,
  precision: "float",
  interval: { rmse: { low: 0.9 * rmse, high: 1.1 * rmse }, cpu_ms: { low: cpu_ms, high: cpu_ms } },
  full_size: { seconds: cpu_ms / 100, low: null, high: null },
  plan: "max_depth=5&samples=16",
  ...more,
});

test("stops are what costs more and is nearer, by the logarithm of the cost", () => {
  const points = [point(100, 0.01), point(1, 0.5), point(10, 0.1), point(12, 0.11)];
  const stops = stops_of({ front: [1, 2, 3, 0], points, noise_floor: 0.001 });
  assert.deepEqual(
    stops.map((stop) => points.indexOf(stop.point)),
    [1, 2, 0],
    "the third costs more than the second and is farther off",
  );
  for (const [at, place] of [0, 0.5, 1].entries()) near(stops[at].place, place, 1e-9, "its place");
  assert.deepEqual([0, 0.2, 0.3, 0.74, 0.76, 1].map((place) => stop_at(stops, place)), [0, 0, 1, 1, 2, 2]);
  assert.equal(stops_of({ front: [0], points, noise_floor: 0 }).at(0).place, 0);
  assert.equal(stops_of({ front: [1, 2, 0], points, noise_floor: 0.2 }).length, 2, "nobody knows which is nearer below the floor");
});

test("a line says what a point costs and how far it may be off", () => {
  assert.equal(line_of(point(80, 0.0036)), "0.8 s, error ≤ 0.004 (95 %), whitted, depth 5, 16 samples, float");
  const lonely = point(0.5, 0.0036, { interval: null, samples: 1 });
  assert.equal(line_of(lonely), "5 ms, error about 0.0036 (one round), whitted, depth 5, 1 sample, float");
  assert.deepEqual([0.0123, 0.42, 12.34, 240].map(duration), ["12 ms", "0.42 s", "12 s", "4 min"]);
});

test("a link keeps a plan without its view and size", () => {
  const plan = plan_of(point(1, 1, { plan: "azimuth=30&width=320&height=240&technique=path&precision=float&seed=2" }));
  assert.equal(plan, "technique=path&precision=float&seed=2&samples=16");
  const restored = parse_hash(format_hash({ ...kDefaults, plan, seconds: 2, error: 0.005 }));
  assert.equal(restored.plan, plan);
  assert.deepEqual([restored.seconds, restored.error], [2, 0.005]);
  assert.deepEqual(options_of(plan), { technique: "path", samples: 16, more: "precision=float&seed=2" });
  for (const wrong of ["plan=x", "plan=a%3D<b>", `plan=a%3D${"b".repeat(500)}`]) assert.equal(parse_hash(`#${wrong}`).plan, "");
  assert.equal(parse_hash("#seconds=9999").seconds, 60);
});

test("addresses and jobs have the plan's options and budgets", () => {
  const picture = { id: "s", azimuth: 1, elevation: 2, distance: 1, pan: [0, 0, 0], width: 8, height: 6, samples: 16 };
  const planned = { ...picture, technique: "path", more: "precision=float&max_depth=3" };
  assert.match(frame_url(planned), /technique=path&samples=16&precision=float&max_depth=3$/);
  assert.match(frame_url({ ...picture, samples: 0, error: 0.005 }), /height=6&error=0\.005$/);
  assert.deepEqual(job_body(planned).render, { samples: 16, technique: "path", time: undefined, precision: "float", max_depth: 3 });
  const { chart, render } = JSON.parse(JSON.stringify(chart_body(planned, { samples: 4 })));
  assert.deepEqual([chart, render], [{ samples: 4 }, { technique: "path" }]);
  const elsewhere = at_view("/v1/scenes/s/frame.png?azimuth=5&max_depth=3&width=320", new URLSearchParams("azimuth=9&width=8&time=1"));
  assert.equal(elsewhere, "/v1/scenes/s/frame.png?max_depth=3&width=320&azimuth=9&time=1");
});

test("what a picture tells of its error is put into words", () => {
  const header = 'rms=unknown;kind=unknown;max=unknown;because="precision, caustics";known=0.0031;known-kind=estimated;known-max=unknown';
  assert.equal(bound_words(parameters_of(header)), "error unknown, because of precision, caustics; the rest ≤ 0.0031 (95 %, estimated)");
  assert.equal(bound_words(parameters_of("rms=0.0044;kind=proved;max=1")), "error ≤ 0.0044 (proved)");
  assert.equal(bound_words(parameters_of("rms=0.0044;kind=proved;space=display")), "error ≤ 0.0044 (proved), on a display");
  assert.match(bound_words(parameters_of(null)), /unknown/);
  const unknown = { kind: "unknown", rms: null, max: null };
  const json = { total: unknown, known: unknown, space: "linear", terms: [{ subject: "samples", bound: unknown }] };
  assert.equal(bound_words(fields_of(json)), "error unknown, because of samples; nothing of it is known");
});

test("a missed budget says why, and that it was missed", () => {
  const bound = parameters_of("rms=0.0071;kind=estimated");
  const missed = budget_words(parameters_of('met=?0;error=0.005;error-met=?0;reason="8 bits; no more"'), bound);
  assert.deepEqual(missed, {
    missed: true,
    text: "Limit missed: 8 bits; no more; error limit: 0.005; error ≤ 0.0071 (95 %, estimated)",
  });
  const met = budget_words(parameters_of("met=?1;seconds=2;seconds-met=?1;used=1.834"), bound);
  assert.deepEqual(met, { missed: false, text: "Limit kept: 1.9 s of 2 s; error ≤ 0.0071 (95 %, estimated)" });
});

test("a prediction says what a budget gives, and when it is missed", () => {
  const forecast = (rms, met, space) => ({
    budget: { used_s: 1.234, error_met: met, seconds_met: met },
    certificate: { total: { kind: rms === null ? "unknown" : "estimated", rms }, space },
  });
  const seconds = { seconds: 2, error: 0 }, error = { seconds: 0, error: 0.005 };
  assert.equal(prediction_words(seconds, forecast(0.0121, true)), "of 2 s: error ≤ 0.013");
  assert.equal(prediction_words(seconds, forecast(0.0121, true, "display")), "of 2 s: error ≤ 0.013, on a display");
  assert.equal(prediction_words(seconds, forecast(null, true)), "of 2 s: error unknown");
  assert.equal(prediction_words(seconds, forecast(0.01, false)), "of 2 s: missed, takes 1.2 s");
  assert.equal(prediction_words(error, forecast(0.0049, true)), "of 0.5 % error: 1.2 s");
  assert.equal(prediction_words(error, forecast(0.00501, false)), "of 0.5 % error: missed, error ≤ 0.0051");
});

test("what is at most so much is never rounded down", () => {
  const rounded = [0, 0.02, 0.0201, 0.0995, 0.996, 1, 1.01, 1e-7].map(rounded_up);
  assert.deepEqual(rounded, ["0", "0.02", "0.021", "0.1", "1", "1", "1.1", "1e-7"]);
});
