// Measures the latency of a drag in headless Chromium: from a pointer movement to the resulting preview, less
// the service's time for this image.

import { packageFile, startBrowser, startDaemon } from "../browser/support.mjs";

const SCENE = "paper";
const SECONDS = 8;
const MOVE_MS = 16; // interval of movements, as from a 60 Hz pointer
const TARGETS = { p50: 25, p95: 50 }; // ms

// Runs in the page. Records {input, asked, drawn, serverMs} for each preview, as times in ms. `input` is the
// newest movement before the request. `inputs` contains all movements.
function instrument() {
  const notes = (window.notes = { inputs: [], previews: [] });
  let pending = null;
  addEventListener("pointermove", (event) => notes.inputs.push(event.timeStamp), { capture: true });
  const realFetch = window.fetch;
  window.fetch = async (...call) => {
    const query = new URLSearchParams(String(call[0]).split("?")[1]);
    const asked = performance.now();
    const response = await realFetch(...call);
    if (String(call[0]).includes("/frame.png") && document.getElementById("stage").dataset.shows === "preview") {
      const timing = response.headers.get("Server-Timing") ?? "";
      const serverMs = [...timing.matchAll(/dur=([\d.]+)/g)].reduce((sum, [, ms]) => sum + Number(ms), 0);
      const input = notes.inputs.findLast((time) => time <= asked);
      pending = { input, asked, serverMs, width: Number(query.get("width")) };
    }
    return response;
  };
  const realDraw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...call) {
    realDraw.apply(this, call);
    if (!pending || call[0].width !== pending.width) return;
    notes.previews.push({ ...pending, drawn: performance.now() });
    pending = null;
  };
}

async function dragFor(page, seconds) {
  const box = await page.locator("#stage").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (const start = performance.now(); performance.now() - start < 1000 * seconds;) {
    const s = (performance.now() - start) / 1000;
    await page.mouse.move(x + 60 * s * Math.cos(s), y + 90 * Math.sin(1.3 * s));
    await new Promise((resolve) => setTimeout(resolve, MOVE_MS));
  }
  await page.mouse.up();
}

const percentile = (values, part) => values.toSorted((a, b) => a - b)[Math.floor(part * (values.length - 1))];

function printRow(name, values, targets) {
  const cells = Object.entries({ p50: 0.5, p95: 0.95 }).map(([key, part]) => {
    const ms = percentile(values, part).toFixed(1);
    return `${key} ${ms} ms${targets ? ` (aim ${targets[key]})` : ""}`;
  });
  console.log(`${name.padEnd(56)}${cells.join("   ")}`);
}

async function run() {
  const daemon = await startDaemon();
  const browser = await startBrowser();
  try {
    const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
    await page.addInitScript(instrument);
    await page.goto(`${daemon.url}#scene=${SCENE}&playing=0&samples=1`);
    await page.locator('#stage[data-shows="still"]').waitFor();
    await dragFor(page, SECONDS);
    const { inputs, previews } = await page.evaluate(() => window.notes);
    // Counts only the first preview of each movement. Later previews show the glide after the movement.
    const first = previews.filter(({ input }, at) => input && previews[at - 1]?.input !== input);
    console.log(
      `\n${inputs.length} movements, ${previews.length} previews of ${SCENE}, ${previews[0]?.width} pixels wide`,
    );
    printRow(
      "newest movement to its preview, less the service's time",
      first.map((p) => p.drawn - p.input - p.serverMs),
      TARGETS,
    );
    printRow(
      "newest movement to its preview",
      first.map((p) => p.drawn - p.input),
    );
    const waits = inputs.flatMap((time) => {
      const shown = previews.find(({ asked }) => asked >= time);
      return shown ? [shown.drawn - time] : [];
    });
    printRow("each movement to the first preview that shows it", waits);
    printRow(
      "the service's time",
      first.map((p) => p.serverMs),
    );
  } finally {
    await browser.close();
    await daemon.stop();
  }
}

export const DRAG = {
  name: "drag",
  what: "latency of a drag in the page, from pointer to preview",
  needs: ["chromium"],
  run: () => (packageFile("playwright-core") ? run() : console.log("drag skipped: playwright-core is not installed")),
};
