#!/usr/bin/env node
// Tests page modules for charts and error bounds that need no browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { near } from "./support.mjs";
import { load } from "./web-modules.mjs";

const { boundText, budgetText, fieldsOf, parametersOf } = await load("bound.js");
const { atView, duration, lineOf, optionsOf, planOf, stopAt, stopsOf } = await load("pareto-front.js");
const { DEFAULT_VIEW, DEFAULTS, formatHash, parseHash } = await load("link.js");
const { predictionText } = await load("budget-prediction.js");
const { roundedUp } = await load("progress.js");
const { chartBody, frameUrl, jobBody } = await load("urls.js");

const point = (cpuMs, rmse, more = {}) => ({
  cpu_ms: cpuMs,
  rmse,
  technique: "whitted",
  max_depth: 5,
  samples: 16,
  precision: "float",
  interval: { rmse: { low: 0.9 * rmse, high: 1.1 * rmse }, cpu_ms: { low: cpuMs, high: cpuMs } },
  full_size: { seconds: cpuMs / 100, low: null, high: null },
  plan: "max_depth=5&samples=16",
  ...more,
});

test("slider stops are Pareto optimal and spaced by the logarithm of their cost", () => {
  const points = [point(100, 0.01), point(1, 0.5), point(10, 0.1), point(12, 0.11)];
  const stops = stopsOf({ front: [1, 2, 3, 0], points, noise_floor: 0.001 });
  assert.deepEqual(
    stops.map((stop) => points.indexOf(stop.point)),
    [1, 2, 0],
    "the point at 12 ms costs more than the point at 10 ms and has a larger error",
  );
  for (const [at, place] of [0, 0.5, 1].entries()) near(stops[at].place, place, 1e-9, "place of the stop");
  assert.deepEqual(
    [0, 0.2, 0.3, 0.74, 0.76, 1].map((place) => stopAt(stops, place)),
    [0, 0, 1, 1, 2, 2],
  );
  assert.equal(stopsOf({ front: [0], points, noise_floor: 0 }).at(0).place, 0);
  assert.equal(
    stopsOf({ front: [1, 2, 0], points, noise_floor: 0.2 }).length,
    2,
    "errors below the noise floor cannot be compared",
  );
});

test("lineOf() describes the time, error and settings of a point", () => {
  assert.equal(
    lineOf(point(80, 0.0036)),
    "0.8 s, error ≤ 0.004 (95 % confidence), whitted, depth 5, 16 samples, float",
  );
  const lonely = point(0.5, 0.0036, { interval: null, samples: 1 });
  assert.equal(lineOf(lonely), "5 ms, error about 0.0036 (one round), whitted, depth 5, 1 sample, float");
  assert.deepEqual([0.0123, 0.42, 12.34, 240].map(duration), ["12 ms", "0.42 s", "12 s", "4 min"]);
});

test("a plan in a link contains neither view nor size, and malformed plans are ignored", () => {
  const plan = planOf(
    point(1, 1, { plan: "azimuth_degrees=30&fov=50&width=320&height=240&technique=path&precision=float&seed=2" }),
  );
  assert.equal(plan, "technique=path&precision=float&seed=2&samples=16");
  const { settings: restored } = parseHash(formatHash({ ...DEFAULTS, plan, seconds: 2, error: 0.005 }, DEFAULT_VIEW));
  assert.equal(restored.plan, plan);
  assert.deepEqual([restored.seconds, restored.error], [2, 0.005]);
  assert.deepEqual(optionsOf(plan), { technique: "path", samples: 16, more: "precision=float&seed=2" });
  for (const wrong of ["plan=x", "plan=a%3D<b>", `plan=a%3D${"b".repeat(500)}`])
    assert.equal(parseHash(`#${wrong}`).settings.plan, "");
  assert.equal(parseHash("#seconds=9999").settings.seconds, 60);
});

test("URLs and job bodies contain the options and budgets of the plan", () => {
  const picture = { id: "s", azimuth: 1, elevation: 2, distance: 1, pan: [0, 0, 0], width: 8, height: 6, samples: 16 };
  const planned = { ...picture, technique: "path", more: "precision=float&max_depth=3" };
  assert.match(frameUrl(planned), /technique=path&samples=16&precision=float&max_depth=3$/);
  assert.match(frameUrl({ ...picture, samples: 0, error: 0.005 }), /height=6&error=0\.005$/);
  assert.deepEqual(jobBody(planned).render, {
    samples: 16,
    technique: "path",
    time: undefined,
    precision: "float",
    max_depth: 3,
  });
  const { chart, render } = JSON.parse(JSON.stringify(chartBody(planned, { samples: 4 })));
  assert.deepEqual([chart, render], [{ samples: 4 }, { technique: "path" }]);
  const elsewhere = atView(
    "/v1/scenes/s/frame.png?azimuth_degrees=5&max_depth=3&width=320",
    new URLSearchParams("azimuth=9&width=8&time=1"),
  );
  assert.equal(elsewhere, "/v1/scenes/s/frame.png?max_depth=3&width=320&time=1&azimuth=9");
});

test("boundText() describes the error bound of an image", () => {
  const header =
    'rms=unknown;kind=unknown;max=unknown;because="precision, caustics";known=0.0031;known-kind=estimated;known-max=unknown';
  assert.equal(
    boundText(parametersOf(header)),
    "error unknown because of precision, caustics; other errors ≤ 0.0031 (95 % confidence)",
  );
  assert.equal(boundText(parametersOf("rms=0.0044;kind=proved;max=1")), "error ≤ 0.0044 (proved)");
  assert.equal(
    boundText(parametersOf("rms=0.0044;kind=proved;space=display")),
    "error ≤ 0.0044 (proved) in display values",
  );
  assert.match(boundText(parametersOf(null)), /unknown/);
  const unknown = { kind: "unknown", rms: null, max: null };
  const json = { total: unknown, known: unknown, space: "linear", terms: [{ subject: "samples", bound: unknown }] };
  assert.equal(boundText(fieldsOf(json)), "error unknown because of samples");
});

test("budgetText() reports whether a budget was met and why not", () => {
  const bound = parametersOf("rms=0.0071;kind=estimated");
  const missed = budgetText(parametersOf('met=?0;error=0.005;error-met=?0;reason="8 bits; no more"'), bound);
  assert.deepEqual(missed, {
    missed: true,
    text: "Limit missed: 8 bits; no more; error limit: 0.005; error ≤ 0.0071 (95 % confidence)",
  });
  const met = budgetText(parametersOf("met=?1;seconds=2;seconds-met=?1;used=1.834"), bound);
  assert.deepEqual(met, { missed: false, text: "Limit met: 1.9 s of 2 s; error ≤ 0.0071 (95 % confidence)" });
});

test("predictionText() reports the predicted outcome of a budget", () => {
  const forecast = (rms, met, space) => ({
    budget: { used_s: 1.234, error_met: met, seconds_met: met },
    certificate: { total: { kind: rms === null ? "unknown" : "estimated", rms }, space },
  });
  const seconds = { seconds: 2, error: 0 },
    error = { seconds: 0, error: 0.005 };
  assert.equal(predictionText(seconds, forecast(0.0121, true)), "2 s gives error ≤ 0.013");
  assert.equal(predictionText(seconds, forecast(0.0121, true, "display")), "2 s gives error ≤ 0.013 in display values");
  assert.equal(predictionText(seconds, forecast(null, true)), "2 s gives an unknown error");
  assert.equal(predictionText(seconds, forecast(0.01, false)), "2 s is too short (1.2 s)");
  assert.equal(predictionText(error, forecast(0.0049, true)), "0.5 % error takes 1.2 s");
  assert.equal(predictionText(error, forecast(0.00501, false)), "0.5 % error is out of reach (error ≤ 0.0051)");
});

test("roundedUp() never rounds down", () => {
  const rounded = [0, 0.02, 0.0201, 0.0995, 0.996, 1, 1.01, 1e-7].map(roundedUp);
  assert.deepEqual(rounded, ["0", "0.02", "0.021", "0.1", "1", "1", "1.1", "1e-7"]);
});
