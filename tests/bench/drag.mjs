// Latency of a drag in Chromium without a display: from a pointer movement to the preview drawn for it, less
// the service's own work on that picture.

import { package_file, start_browser, start_daemon } from "../browser/support.mjs";

const kScene = "paper";
const kSeconds = 8;
const kMoveMs = 16; // between movements, as of a 60 Hz pointer
const kTargets = { p50: 25, p95: 50 }; // ms

// Runs in the page. Records for each preview {input, asked, drawn, server_ms}, times in ms. `input` is the
// newest movement before the request, `inputs` are all movements.
function instrument() {
  const notes = (window.notes = { inputs: [], previews: [] });
  let pending = null;
  addEventListener("pointermove", (event) => notes.inputs.push(event.timeStamp), { capture: true });
  const real_fetch = window.fetch;
  window.fetch = async (...call) => {
    const query = new URLSearchParams(String(call[0]).split("?")[1]);
    const asked = performance.now();
    const response = await real_fetch(...call);
    if (String(call[0]).includes("/frame.png") && document.getElementById("stage").dataset.shows === "preview") {
      const timing = response.headers.get("Server-Timing") ?? "";
      const server_ms = [...timing.matchAll(/dur=([\d.]+)/g)].reduce((sum, [, ms]) => sum + Number(ms), 0);
      const input = notes.inputs.findLast((time) => time <= asked);
      pending = { input, asked, server_ms, width: Number(query.get("width")) };
    }
    return response;
  };
  const real_draw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...call) {
    real_draw.apply(this, call);
    if (!pending || call[0].width !== pending.width) return;
    notes.previews.push({ ...pending, drawn: performance.now() });
    pending = null;
  };
}

async function drag_for(page, seconds) {
  const box = await page.locator("#stage").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (const start = performance.now(); performance.now() - start < 1000 * seconds; ) {
    const s = (performance.now() - start) / 1000;
    await page.mouse.move(x + 60 * s * Math.cos(s), y + 90 * Math.sin(1.3 * s));
    await new Promise((resolve) => setTimeout(resolve, kMoveMs));
  }
  await page.mouse.up();
}

const percentile = (values, part) => values.toSorted((a, b) => a - b)[Math.floor(part * (values.length - 1))];

function print_row(name, values, targets) {
  const cells = Object.entries({ p50: 0.5, p95: 0.95 }).map(([key, part]) => {
    const ms = percentile(values, part).toFixed(1);
    return `${key} ${ms} ms${targets ? ` (aim ${targets[key]})` : ""}`;
  });
  console.log(`${name.padEnd(56)}${cells.join("   ")}`);
}

async function run() {
  const daemon = await start_daemon();
  const browser = await start_browser();
  try {
    const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
    await page.addInitScript(instrument);
    await page.goto(`${daemon.url}#scene=${kScene}&playing=0&samples=1`);
    await page.locator('#stage[data-shows="still"]').waitFor();
    await drag_for(page, kSeconds);
    const { inputs, previews } = await page.evaluate(() => window.notes);
    // Counts the first preview of each movement: while the view glides on, later previews show it too.
    const first = previews.filter(({ input }, at) => input && previews[at - 1]?.input !== input);
    console.log(`\n${inputs.length} movements, ${previews.length} previews of ${kScene}, ${previews[0]?.width} pixels wide`);
    print_row("newest movement to its preview, less the service's work", first.map((p) => p.drawn - p.input - p.server_ms), kTargets);
    print_row("newest movement to its preview", first.map((p) => p.drawn - p.input));
    const waits = inputs.flatMap((time) => {
      const shown = previews.find(({ asked }) => asked >= time);
      return shown ? [shown.drawn - time] : [];
    });
    print_row("any movement to the first preview that shows it", waits);
    print_row("the service's work", first.map((p) => p.server_ms));
  } finally {
    await browser.close();
    await daemon.stop();
  }
}

export const kDrag = {
  name: "drag",
  what: "a drag in the page: pointer to preview",
  needs: ["chromium"],
  run: () => (package_file("playwright-core") ? run() : console.log("drag skipped: playwright-core is not installed")),
};
