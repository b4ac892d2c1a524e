#!/usr/bin/env node
// Tests speed and accuracy in the page: chart, slider, plans in links, budgets and unknown errors.

import assert from "node:assert/strict";
import { after } from "node:test";
import {
  axeViolations,
  canvasDigest,
  charted,
  eventually,
  hashOf,
  pageTests,
  quickCharts,
  rest,
  startBoth,
} from "./support.mjs";

const { daemon, browser } = await startBoth(after);
const pageTest = pageTests(browser, daemon);

const still = { reducedMotion: "reduce" };
const text = (page, id) => page.locator(`#${id}`).textContent();
const shown = (page) => page.locator("#overlay").getAttribute("data-shows");
const query = (address) => new URLSearchParams(address.split("?")[1]);

// Moves the slider to its first stop. Resolves to the URL of the stop's image once it is shown.
async function firstStop(page, slider) {
  const last = await shown(page);
  await slider.press("Home");
  return eventually("the first image", async () => ((await shown(page)) !== last ? shown(page) : null));
}

const lineShape = /^[\d.]+ (ms|s), error ≤ [\d.e-]+ \(95 % confidence\), \w+, depth \d+, \d+ samples?, (float|double)$/;

pageTest(
  "the chart button makes a chart and reports its progress",
  "playing=0",
  async (page) => {
    const seen = await quickCharts(page);
    await rest(page);
    const make = page.getByRole("button", { name: "Make speed and accuracy chart" });
    assert.equal(await page.locator("#stop").isVisible(), false);
    assert.equal(await page.locator("#reference").isVisible(), false);
    const progress = await page.evaluateHandle(() => {
      const texts = new Set();
      const part = document.getElementById("chart-part");
      new MutationObserver(() => texts.add(part.textContent)).observe(part, { childList: true });
      return { list: () => [...texts], texts };
    });
    const before = await page.locator("#stage").boundingBox();
    await make.click();
    await page.locator("#stop").waitFor({ state: "visible" });
    assert.deepEqual(await page.locator("#stage").boundingBox(), before, "the stage does not move");
    assert.equal(await make.isVisible(), false);
    const texts = await progress.evaluate(({ texts: all }) => [...all]);
    assert.ok(
      texts.some((each) => /\d+ %/.test(each)),
      texts.join("\n"),
    );
    const [{ image, chart }] = seen;
    const canvas = await page.locator("#canvas").evaluate(({ width, height }) => ({ width, height }));
    assert.deepEqual(image, canvas, "times are predicted for the size of the stage");
    assert.ok(chart.width < image.width);
    assert.deepEqual(await axeViolations(page), []);
  },
  still,
);

pageTest(
  "without a chart, the page predicts the outcome of each budget",
  "scene=cornell-box&playing=0&samples=2",
  async (page) => {
    const requested = [];
    page.on("request", (request) => /explain/.test(request.url()) && requested.push(query(request.url())));
    const line =
      /^Prediction: 2 s gives error ≤ 0\.\d+ in display values · 2 % error (takes [\d.]+ (ms|s|min)|is out of reach \(error ≤ 0\.\d+ in display values\)) · 0\.5 % error /;
    const predicted = () => eventually("the prediction", async () => line.exec(await text(page, "stop-line"))?.input);
    await predicted();
    assert.deepEqual(await axeViolations(page), []);
    requested.length = 0;
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("the offer to render this view", async () =>
      /The chart renders this view with different settings/.test(await text(page, "stop-line")),
    );
    await predicted();
    assert.deepEqual(
      requested.map((each) => each.get("seconds") ?? each.get("error")),
      ["2", "0.02", "0.005"],
    );
    assert.deepEqual([...new Set(requested.map((each) => each.get("samples")))], ["2"], "the chosen number of samples");
    await page.locator("#technique").selectOption("raycast");
    await eventually("a prediction for other options", async () => requested.at(-1).get("technique") === "raycast");
    await page.goBack();
    await eventually("the first prediction again", async () => requested.at(-1).get("technique") !== "raycast");
    await predicted();
    const before = requested.length;
    await page.getByRole("button", { name: "2 s" }).click();
    await eventually("the budget", async () => /^Limit /.test(await text(page, "budget-status")));
    await predicted();
    assert.equal(requested.length, before, "cached results are not requested again");
  },
  still,
);

pageTest(
  "a rejected prediction is requested again for the next image",
  "playing=0",
  async (page) => {
    const refused = [];
    await page.route("**/explain?**", (route) => {
      refused.push(query(route.request().url()).get("technique"));
      return route.fulfill({ status: 429, json: { title: "Too many requests" } });
    });
    await page.locator("#technique").selectOption("raycast");
    await eventually("the rejection", async () => refused.includes("raycast"));
    await rest(page);
    assert.match(await text(page, "stop-line"), /The chart renders this view with different settings/);
    assert.equal(refused.filter((technique) => technique === "raycast").length, 1);
    await page.unroute("**/explain?**");
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("the prediction", async () => /^Prediction: /.test(await text(page, "stop-line")));
  },
  { ...still, expected: /status of 429/ },
);

pageTest(
  "arrow keys move the slider between its stops, and the page describes each stop",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const valueText = () => slider.getAttribute("aria-valuetext");
    const lines = [];
    await slider.press("Home");
    for (let last = ""; last !== (await valueText()); await slider.press("ArrowRight")) {
      last = await valueText();
      assert.match(last, lineShape);
      assert.equal(await text(page, "stop-line"), last);
      assert.match(await text(page, "stop-note"), /^Bound without a reference image: error (unknown because of \w+|≤)/);
      lines.push(last);
    }
    assert.ok(lines.length >= 3, lines.join("\n"));
    const errors = lines.map((each) => Number(/≤ ([\d.e-]+)/.exec(each)[1]));
    assert.ok(errors[0] > 2 * errors.at(-1), errors.join());
    const pictures = new Set();
    for (const [key, line] of [
      ["Home", lines[0]],
      ["End", lines.at(-1)],
      ["ArrowLeft", lines.at(-2)],
      ["ArrowDown", lines.at(-3)],
    ]) {
      await slider.press(key);
      assert.equal(await valueText(), line, key);
      const samples = /(\d+) sample/.exec(line)[1];
      await eventually(`the image of ${line}`, async () => {
        const requested = query(await shown(page)).get("samples");
        return samples === (requested ?? "1");
      });
      pictures.add(await shown(page));
    }
    assert.equal(pictures.size, new Set([lines[0], lines.at(-1), lines.at(-2), lines.at(-3)]).size);
    assert.deepEqual(await axeViolations(page), []);
  },
  still,
);

pageTest(
  "the slider's thumb snaps to a stop when the pointer is released",
  "playing=0&az=30",
  async (page) => {
    const slider = await charted(page);
    const box = await slider.boundingBox();
    const y = box.y + box.height / 2;
    await page.mouse.move(box.x + box.width - 9, y);
    await page.mouse.down();
    await page.mouse.move(box.x + 4, y, { steps: 5 });
    await page.mouse.up();
    assert.equal(await slider.inputValue(), "0");
    assert.match(await text(page, "stop-line"), /raycast|1 sample|depth 1/);
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await rest(page);
    await slider.press("End");
    await eventually("another view", async () => /for another view/.test(await text(page, "stop-note")));
    await page.locator("#overlay").waitFor({ state: "visible" });
    assert.notEqual(query(await shown(page)).get("distance"), null, "the image shows the current view");
  },
  still,
);

pageTest(
  "a tap moves the slider",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const before = await text(page, "stop-line");
    await slider.scrollIntoViewIfNeeded();
    const box = await slider.boundingBox();
    await page.touchscreen.tap(box.x + 6, box.y + box.height / 2);
    await eventually("the first stop", async () => (await slider.inputValue()) === "0");
    assert.notEqual(await text(page, "stop-line"), before);
    const outside = await page.evaluate(() =>
      [...document.querySelectorAll("#tradeoff :is(button, input, span)")]
        .filter((each) => each.checkVisibility() && each.getBoundingClientRect().right > innerWidth)
        .map(({ id }) => id),
    );
    assert.deepEqual(outside, []);
    assert.deepEqual(await axeViolations(page), []);
  },
  { ...still, viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true },
);

pageTest(
  "key R and its button show the reference image while held",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const first = await firstStop(page, slider);
    const isReference = async () => query(await shown(page)).get("samples") === "64";
    await page.keyboard.down("r");
    await eventually("the reference", isReference);
    assert.equal(query(await shown(page)).get("precision"), "double");
    await page.keyboard.up("r");
    await eventually("the image of the point again", async () => (await shown(page)) === first);
    const box = await page.locator("#reference").boundingBox();
    await page.mouse.move(box.x + 5, box.y + 5);
    await page.mouse.down();
    await eventually("the reference", isReference);
    assert.equal(await page.locator("#reference").getAttribute("aria-pressed"), "true");
    await page.mouse.up();
    await eventually("the image of the point again", async () => (await shown(page)) === first);
  },
  still,
);

pageTest(
  "key E shows the error map of the same plan, or reports why there is none",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const point = await firstStop(page, slider);
    await page.route("**/*view=bound*", (route) =>
      route.fulfill({ status: 422, json: { title: "No such view", detail: "This service draws no bounds." } }),
    );
    const requested = page.waitForRequest(/view=bound/);
    await page.keyboard.down("e");
    assert.ok((await requested).url().endsWith(`${point}&view=bound`), (await requested).url());
    await eventually("the reason", async () => /No such view.*draws no bounds/.test(await text(page, "stop-note")));
    await page.keyboard.up("e");
    assert.equal(await shown(page), point);
    await page.unroute("**/*view=bound*");
    await page.route("**/*view=bound*", (route) => route.fulfill({ status: 303, headers: { Location: point } }));
    await page.keyboard.down("e");
    await eventually("the bound", async () => (await shown(page))?.endsWith("view=bound"));
    assert.ok(await page.locator("#scale").isVisible(), "the colour scale is visible");
    await page.keyboard.up("e");
    await eventually("the image of the point again", async () => (await shown(page)) === point);
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await rest(page);
    const seen = await page.locator("#download").getAttribute("href");
    const other = page.waitForRequest(/view=bound/);
    await page.locator("#bound").evaluate((button) => button.click());
    assert.ok((await other).url().endsWith(`${seen}&view=bound`), "error map of the shown image");
    assert.equal(await page.locator("#bound").getAttribute("aria-pressed"), "true", "pressed without a pointer");
    await page.locator("#bound").evaluate((button) => button.click());
    assert.equal(await page.locator("#bound").getAttribute("aria-pressed"), "false");
  },
  { ...still, expected: /status of 422/ },
);

pageTest(
  "the link keeps a used plan and reproduces its image",
  "playing=0&az=30",
  async (page, context) => {
    const slider = await charted(page);
    await slider.press("Home");
    await slider.press("ArrowRight");
    const line = await text(page, "stop-line");
    await page.getByRole("button", { name: "Use these settings" }).click();
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await eventually("the image of the plan", async () => /^Settings: /.test(await text(page, "budget-status")));
    const digest = await rest(page);
    const { plan } = await hashOf(page);
    const wanted = new URLSearchParams(plan);
    assert.equal(wanted.get("samples"), /(\d+) sample/.exec(line)[1]);
    assert.equal(wanted.get("width"), null);
    assert.match(await text(page, "budget-status"), /error (unknown because of|≤)/);
    const link = await page.evaluate(() => location.href);
    const other = await context.newPage();
    await other.goto(link);
    await eventually("the status of the plan", async () => /^Settings: /.test(await text(other, "budget-status")));
    assert.equal(await rest(other), digest);
    assert.deepEqual(await axeViolations(other), []);
    await other.getByRole("button", { name: "Reset to automatic" }).click();
    await eventually("no plan", async () => (await hashOf(other)).plan === undefined);
    await eventually("another image", async () => (await rest(other)) !== digest);
    assert.equal(await text(other, "budget-status"), "");
  },
  still,
);

pageTest(
  "the stops of the chart are buttons in its drawing",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    await page.locator("#show-chart").click();
    const dialog = page.getByRole("dialog", { name: "Speed and accuracy chart" });
    const marks = dialog.locator(".drawing [role=button]");
    const lines = await marks.evaluateAll((all) => all.map((each) => each.getAttribute("aria-label")));
    for (const line of lines) assert.match(line, lineShape);
    assert.deepEqual(await axeViolations(page), []);
    await marks.first().focus();
    await page.keyboard.press("Enter");
    await dialog.waitFor({ state: "hidden" });
    assert.equal(await text(page, "stop-line"), lines[0]);
    assert.equal(await slider.getAttribute("aria-valuetext"), lines[0]);
    await page.locator("#show-chart").click();
    await marks.last().click();
    assert.equal(await text(page, "stop-line"), lines.at(-1));
  },
  still,
);

pageTest(
  "the page reports why a budget was missed, and the download link reproduces the image",
  "scene=paper&playing=0",
  async (page) => {
    await page.route("**/frame.png?*error=*", async (route) => {
      const response = await route.fetch();
      const headers = {
        ...response.headers(),
        "orrery-budget": 'met=?0;error=0.005;error-met=?0;reason="8 bits can prove no less"',
        "orrery-error-bound":
          'rms=unknown;kind=unknown;max=unknown;because="caustics";known=0.0031;known-kind=estimated',
      };
      return route.fulfill({ response, headers });
    });
    await rest(page);
    await page.getByRole("button", { name: "0.5 % error" }).click();
    await eventually("the budget", async () =>
      /^Limit missed: 8 bits can prove no less/.test(await text(page, "budget-status")),
    );
    assert.match(
      await text(page, "budget-status"),
      /error unknown because of caustics; other errors ≤ 0\.0031 \(95 % confidence\)$/,
    );
    assert.equal(await page.locator("#budget-status.missed").count(), 1);
    const rgb = await page.locator("#budget-status").evaluate((each) => getComputedStyle(each).color);
    assert.equal(rgb, "rgb(138, 82, 0)", "amber");
    assert.equal((await hashOf(page)).error, "0.005");
    assert.deepEqual(await axeViolations(page), []);
    await page.locator("#download").hover();
    const link = await page.locator("#download").getAttribute("href");
    assert.equal(query(link).get("error"), null, "link to the resulting plan");
    await page.getByRole("button", { name: "0.5 % error" }).click();
    await eventually("no budget", async () => (await text(page, "budget-status")) === "");
    assert.equal((await hashOf(page)).error, undefined);
  },
  still,
);

pageTest(
  "the link keeps a time budget, and the page reports its outcome",
  "playing=0&seconds=0.3",
  async (page) => {
    await eventually("the budget", async () => /^Limit (met|missed): /.test(await text(page, "budget-status")));
    assert.match(await text(page, "budget-status"), /error (unknown because of|≤)/);
    await rest(page);
    assert.ok((await canvasDigest(page)).length > 0);
    const status = await text(page, "budget-status");
    await page.evaluate(() => dispatchEvent(new Event("online")));
    await rest(page);
    assert.equal(await text(page, "budget-status"), status, "status of the same image");
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("no status for another view", async () => (await text(page, "budget-status")) === "");
    await eventually("the status of the new view", async () => (await text(page, "budget-status")) !== "");
    await page.getByRole("button", { name: "2 s" }).click();
    await eventually("another budget", async () => (await hashOf(page)).seconds === "2");
    assert.equal(await page.getByRole("button", { name: "2 s" }).getAttribute("aria-pressed"), "true");
  },
  still,
);

pageTest(
  "a failed chart reports the reason, and a cancelled chart can be made again",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.route("**/charts", (route) =>
      route.fulfill({ status: 429, json: { title: "Too many jobs", detail: "2 jobs are under way." } }),
    );
    const make = page.locator("#make-chart");
    await make.click();
    await eventually("the reason", async () =>
      /The chart failed: Too many jobs\. 2 jobs/.test(await text(page, "stop-note")),
    );
    await page.unroute("**/charts");
    await page.route("**/v1/jobs/*/events", () => {}); // never responds
    await make.click();
    await page.getByRole("button", { name: "Cancel chart" }).click();
    await page.getByRole("button", { name: "Make speed and accuracy chart" }).waitFor();
  },
  { ...still, expected: /status of 429/ },
);
