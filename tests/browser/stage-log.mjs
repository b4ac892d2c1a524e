// Log of the stage in each painted frame, for drafts.test.mjs and first-pictures.mjs.

import { middle } from "./support.mjs";

// Starts the log of a page that is not open yet. Adds to window.stageLog, for each painted frame, {at, scene,
// thumbnail, width}: time in ms, scene of the stage, file of the visible thumbnail or "", and width of the
// visible image or 0. Adds to window.pictures [time, width] of each drawn image.
export function logStage(page) {
  return page.addInitScript(() => {
    window.stageLog = [];
    window.pictures = [];
    const draw = CanvasRenderingContext2D.prototype.drawImage;
    CanvasRenderingContext2D.prototype.drawImage = function (...call) {
      if (this.canvas.id === "canvas") window.pictures.push([performance.now(), this.canvas.width]);
      return draw.apply(this, call);
    };
    const note = () => {
      requestAnimationFrame(note);
      const [stage, poster, canvas] = ["stage", "poster", "canvas"].map((id) => document.getElementById(id));
      if (!poster) return; // the page is not ready
      const seen = !poster.hidden && poster.complete && poster.naturalWidth > 0;
      const thumbnail = seen ? poster.src.split("/").at(-1) : "";
      window.stageLog.push({
        at: performance.now(),
        scene: stage.dataset.scene,
        thumbnail,
        width: canvas.hidden ? 0 : canvas.width,
      });
    };
    requestAnimationFrame(note);
  });
}

// Clicks the card of a sample scene. Resolves to the time of the click in the page's milliseconds.
export function pick(page, name) {
  return page.evaluate((wanted) => {
    const card = document.querySelector(`#gallery [data-name="${wanted}"]`);
    card.scrollIntoView({ block: "center", behavior: "instant" });
    window.stageLog = [];
    window.pictures = [];
    const start = performance.now();
    card.click();
    return start;
  }, name);
}

// Drags the view with the mouse for `ms` milliseconds. Resolves to [time, width] of each image drawn in this
// time.
export async function dragFor(page, ms) {
  const { x, y } = await middle(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.evaluate(() => void (window.pictures = []));
  const start = Date.now();
  for (let n = 0; Date.now() - start < ms; n += 1) await page.mouse.move(x + 60 * Math.sin(n / 12), y);
  const drawn = await page.evaluate(() => window.pictures);
  await page.mouse.up();
  return drawn;
}

export const sceneNames = (page) =>
  page.evaluate(() => [...document.querySelectorAll("#gallery [data-name]")].map((card) => card.dataset.name));

// Slows down the browser, but not the service, by the factor `times`.
export async function slowDown(page, times) {
  const device = await page.context().newCDPSession(page);
  await device.send("Emulation.setCPUThrottlingRate", { rate: times });
}
