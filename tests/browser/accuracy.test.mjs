#!/usr/bin/env node
// Speed and accuracy in the page: chart, slider, plans in links, budgets and unknown errors.

import assert from "node:assert/strict";
import { after } from "node:test";
import { axe_violations, canvas_digest, charted, eventually, hash_of, page_tests, quick_charts, rest, start_both } from "./support.mjs";

const { daemon, browser } = await start_both(after);
const page_test = page_tests(browser, daemon);

const still = { reducedMotion: "reduce" };
const text = (page, id) => page.locator(`#${id}`).textContent();
const shown = (page) => page.locator("#overlay").getAttribute("data-shows");
const query = (address) => new URLSearchParams(address.split("?")[1]);

// Goes to the first stop. Resolves to the address of its picture once it is shown.
async function first_stop(page, slider) {
  const last = await shown(page);
  await slider.press("Home");
  return eventually("the first picture", async () => ((await shown(page)) !== last ? shown(page) : null));
}

const line_shape = /^[\d.]+ (ms|s), error ≤ [\d.e-]+ \(95 %\), \w+, depth \d+, \d+ samples?, (float|double)$/;

page_test(
  "before there is a chart a button offers one, and says how far it is",
  "playing=0",
  async (page) => {
    const seen = await quick_charts(page);
    await rest(page);
    const make = page.getByRole("button", { name: "Chart speed against accuracy" });
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
    assert.deepEqual(await page.locator("#stage").boundingBox(), before, "nothing moves");
    assert.equal(await make.isVisible(), false);
    const texts = await progress.evaluate(({ texts: all }) => [...all]);
    assert.ok(texts.some((each) => /\d+ %/.test(each)), texts.join("\n"));
    const [{ image, chart }] = seen;
    const canvas = await page.locator("#canvas").evaluate(({ width, height }) => ({ width, height }));
    assert.deepEqual(image, canvas, "times are predicted for what the stage shows");
    assert.ok(chart.width < image.width);
    assert.deepEqual(await axe_violations(page), []);
  },
  still,
);

page_test(
  "before there is a chart it is predicted what the budgets would give, of the picture at rest",
  "scene=cornell-box&playing=0&samples=2",
  async (page) => {
    const asked = [];
    page.on("request", (request) => /explain/.test(request.url()) && asked.push(query(request.url())));
    const line = /^With a limit of 2 s: error ≤ 0\.\d+, on a display · of 2 % error: ([\d.]+ (ms|s|min)|missed, error ≤ 0\.\d+, on a display) · of 0\.5 % error: /;
    const predicted = () => eventually("the prediction", async () => line.exec(await text(page, "stop-line"))?.input);
    await predicted();
    assert.deepEqual(await axe_violations(page), []);
    asked.length = 0;
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("the offer", async () => /The chart renders this view in many ways/.test(await text(page, "stop-line")));
    await predicted();
    assert.deepEqual(asked.map((each) => each.get("seconds") ?? each.get("error")), ["2", "0.02", "0.005"]);
    assert.deepEqual([...new Set(asked.map((each) => each.get("samples")))], ["2"], "what was chosen");
    await page.locator("#technique").selectOption("raycast");
    await eventually("that of other options", async () => asked.at(-1).get("technique") === "raycast");
    await page.goBack();
    await eventually("the first again", async () => asked.at(-1).get("technique") !== "raycast");
    await predicted();
    const before = asked.length;
    await page.getByRole("button", { name: "2 s" }).click();
    await eventually("the budget", async () => /^Limit /.test(await text(page, "told")));
    await predicted();
    assert.equal(asked.length, before, "what is known is not asked again");
  },
  still,
);

page_test(
  "a prediction that is refused leaves the offer, and is asked of the next picture",
  "playing=0",
  async (page) => {
    const refused = [];
    await page.route("**/explain?**", (route) => {
      refused.push(query(route.request().url()).get("technique"));
      return route.fulfill({ status: 429, json: { title: "Too many requests" } });
    });
    await page.locator("#technique").selectOption("raycast");
    await eventually("the refusal", async () => refused.includes("raycast"));
    await rest(page);
    assert.match(await text(page, "stop-line"), /The chart renders this view in many ways/);
    assert.equal(refused.filter((technique) => technique === "raycast").length, 1);
    await page.unroute("**/explain?**");
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("the prediction", async () => /^With a limit of /.test(await text(page, "stop-line")));
  },
  { ...still, expected: /status of 429/ },
);

page_test(
  "the slider goes from stop to stop by keys, and says what each is",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const said = () => slider.getAttribute("aria-valuetext");
    const told = [];
    await slider.press("Home");
    for (let last = ""; last !== (await said()); await slider.press("ArrowRight")) {
      last = await said();
      assert.match(last, line_shape);
      assert.equal(await text(page, "stop-line"), last);
      assert.match(await text(page, "stop-note"), /^The picture alone tells: error (unknown, because of \w+|≤)/);
      told.push(last);
    }
    assert.ok(told.length >= 3, told.join("\n"));
    const errors = told.map((each) => Number(/≤ ([\d.e-]+)/.exec(each)[1]));
    assert.ok(errors[0] > 2 * errors.at(-1), errors.join());
    const pictures = new Set();
    for (const [key, line] of [["Home", told[0]], ["End", told.at(-1)], ["ArrowLeft", told.at(-2)], ["ArrowDown", told.at(-3)]]) {
      await slider.press(key);
      assert.equal(await said(), line, key);
      const samples = /(\d+) sample/.exec(line)[1];
      await eventually(`the picture of ${line}`, async () => {
        const asked = query(await shown(page)).get("samples");
        return samples === (asked ?? "1");
      });
      pictures.add(await shown(page));
    }
    assert.equal(pictures.size, new Set([told[0], told.at(-1), told.at(-2), told.at(-3)]).size);
    assert.deepEqual(await axe_violations(page), []);
  },
  still,
);

page_test(
  "the slider's thumb rests on a stop when a pointer lets it go",
  "playing=0",
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
    await eventually("another view", async () => /another view/.test(await text(page, "stop-note")));
    await page.locator("#overlay").waitFor({ state: "visible" });
    assert.notEqual(query(await shown(page)).get("distance"), null, "the picture is of the view at hand");
  },
  still,
);

page_test(
  "the slider follows a finger",
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
    assert.deepEqual(await axe_violations(page), []);
  },
  { ...still, viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true },
);

page_test(
  "R and its button hold the reference over the stage",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const first = await first_stop(page, slider);
    const is_reference = async () => query(await shown(page)).get("samples") === "64";
    await page.keyboard.down("r");
    await eventually("the reference", is_reference);
    assert.equal(query(await shown(page)).get("precision"), "double");
    await page.keyboard.up("r");
    await eventually("the point again", async () => (await shown(page)) === first);
    const box = await page.locator("#reference").boundingBox();
    await page.mouse.move(box.x + 5, box.y + 5);
    await page.mouse.down();
    await eventually("the reference", is_reference);
    assert.equal(await page.locator("#reference").getAttribute("aria-pressed"), "true");
    await page.mouse.up();
    await eventually("the point again", async () => (await shown(page)) === first);
  },
  still,
);

page_test(
  "E asks for the bound of the same plan, and says in words where there is none",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    const point = await first_stop(page, slider);
    await page.route("**/*view=bound*", (route) =>
      route.fulfill({ status: 422, json: { title: "No such view", detail: "This service draws no bounds." } }),
    );
    const asked = page.waitForRequest(/view=bound/);
    await page.keyboard.down("e");
    assert.ok((await asked).url().endsWith(`${point}&view=bound`), (await asked).url());
    await eventually("the words", async () => /No such view.*draws no bounds/.test(await text(page, "stop-note")));
    await page.keyboard.up("e");
    assert.equal(await shown(page), point);
    await page.unroute("**/*view=bound*");
    await page.route("**/*view=bound*", (route) => route.fulfill({ status: 303, headers: { Location: point } }));
    await page.keyboard.down("e");
    await eventually("the bound", async () => (await shown(page))?.endsWith("view=bound"));
    assert.ok(await page.locator("#scale").isVisible(), "its colours have a scale");
    await page.keyboard.up("e");
    await eventually("the point again", async () => (await shown(page)) === point);
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await rest(page);
    const seen = await page.locator("#download").getAttribute("href");
    const other = page.waitForRequest(/view=bound/);
    await page.locator("#bound").evaluate((button) => button.click());
    assert.ok((await other).url().endsWith(`${seen}&view=bound`), "that of what is seen");
    assert.equal(await page.locator("#bound").getAttribute("aria-pressed"), "true", "held without a pointer");
    await page.locator("#bound").evaluate((button) => button.click());
    assert.equal(await page.locator("#bound").getAttribute("aria-pressed"), "false");
  },
  { ...still, expected: /status of 422/ },
);

page_test(
  "a plan that is used is in the link, which gives the same picture again",
  "playing=0",
  async (page, context) => {
    const slider = await charted(page);
    await slider.press("Home");
    await slider.press("ArrowRight");
    const line = await text(page, "stop-line");
    await page.getByRole("button", { name: "Use" }).click();
    await page.locator("#overlay").waitFor({ state: "hidden" });
    await eventually("the plan's picture", async () => /^Plan: /.test(await text(page, "told")));
    const digest = await rest(page);
    const { plan } = await hash_of(page);
    const wanted = new URLSearchParams(plan);
    assert.equal(wanted.get("samples"), /(\d+) sample/.exec(line)[1]);
    assert.equal(wanted.get("width"), null);
    assert.match(await text(page, "told"), /error (unknown, because of|≤)/);
    const link = await page.evaluate(() => location.href);
    const other = await context.newPage();
    await other.goto(link);
    await eventually("the plan's words", async () => /^Plan: /.test(await text(other, "told")));
    assert.equal(await rest(other), digest);
    assert.deepEqual(await axe_violations(other), []);
    await other.getByRole("button", { name: "Back to automatic" }).click();
    await eventually("no plan", async () => (await hash_of(other)).plan === undefined);
    await eventually("another picture", async () => (await rest(other)) !== digest);
    assert.equal(await text(other, "told"), "");
  },
  still,
);

page_test(
  "the chart's drawing has its stops as buttons",
  "playing=0",
  async (page) => {
    const slider = await charted(page);
    await page.locator("#show-chart").click();
    const dialog = page.getByRole("dialog", { name: "Chart of speed against accuracy" });
    const marks = dialog.locator(".drawing [role=button]");
    const lines = await marks.evaluateAll((all) => all.map((each) => each.getAttribute("aria-label")));
    for (const line of lines) assert.match(line, line_shape);
    assert.deepEqual(await axe_violations(page), []);
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

page_test(
  "a budget that is missed says so and why, and its picture can be taken along",
  "scene=paper&playing=0",
  async (page) => {
    await page.route("**/frame.png?*error=*", async (route) => {
      const response = await route.fetch();
      const headers = {
        ...response.headers(),
        "orrery-budget": 'met=?0;error=0.005;error-met=?0;reason="8 bits can prove no less"',
        "orrery-error-bound": 'rms=unknown;kind=unknown;max=unknown;because="caustics";known=0.0031;known-kind=estimated',
      };
      return route.fulfill({ response, headers });
    });
    await rest(page);
    await page.getByRole("button", { name: "0.5 % error" }).click();
    await eventually("the budget", async () => /^Limit missed: 8 bits can prove no less/.test(await text(page, "told")));
    assert.match(await text(page, "told"), /error unknown, because of caustics; the rest ≤ 0\.0031 \(95 %, estimated\)$/);
    assert.equal(await page.locator("#told.missed").count(), 1);
    const rgb = await page.locator("#told").evaluate((each) => getComputedStyle(each).color);
    assert.equal(rgb, "rgb(138, 82, 0)", "amber");
    assert.equal((await hash_of(page)).error, "0.005");
    assert.deepEqual(await axe_violations(page), []);
    await page.locator("#download").hover();
    const link = await page.locator("#download").getAttribute("href");
    assert.equal(query(link).get("error"), null, "the plan that it came to");
    await page.getByRole("button", { name: "0.5 % error" }).click();
    await eventually("no budget", async () => (await text(page, "told")) === "");
    assert.equal((await hash_of(page)).error, undefined);
  },
  still,
);

page_test(
  "a budget of seconds is in the link and says what it took",
  "playing=0&seconds=0.3",
  async (page) => {
    await eventually("the budget", async () => /^Limit (kept|missed): /.test(await text(page, "told")));
    assert.match(await text(page, "told"), /error (unknown, because of|≤)/);
    await rest(page);
    assert.ok((await canvas_digest(page)).length > 0);
    const told = await text(page, "told");
    await page.evaluate(() => dispatchEvent(new Event("online")));
    await rest(page);
    assert.equal(await text(page, "told"), told, "of the same picture");
    await page.locator("#stage").hover();
    await page.mouse.wheel(0, 100);
    await eventually("nothing of another view", async () => (await text(page, "told")) === "");
    await eventually("its own", async () => (await text(page, "told")) !== "");
    await page.getByRole("button", { name: "2 s" }).click();
    await eventually("another budget", async () => (await hash_of(page)).seconds === "2");
    assert.equal(await page.getByRole("button", { name: "2 s" }).getAttribute("aria-pressed"), "true");
  },
  still,
);

page_test(
  "a chart that fails says why, and one that is cancelled leaves the offer",
  "playing=0",
  async (page) => {
    await rest(page);
    await page.route("**/charts", (route) =>
      route.fulfill({ status: 429, json: { title: "Too many jobs", detail: "2 jobs are under way." } }),
    );
    const make = page.locator("#make-chart");
    await make.click();
    await eventually("the words", async () => /No chart: Too many jobs\. 2 jobs/.test(await text(page, "stop-note")));
    await page.unroute("**/charts");
    await page.route("**/v1/jobs/*/events", () => {}); // never responds
    await make.click();
    await page.getByRole("button", { name: "Cancel the chart" }).click();
    await page.getByRole("button", { name: "Chart speed against accuracy" }).waitFor();
  },
  { ...still, expected: /status of 429/ },
);
