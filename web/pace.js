// Frame rate and quality level of an orbit. Every frame is rendered, so slow frames slow the orbit down. The
// stream is then requested again, at a coarser level if the orbit stutters, else at a lower frame rate with
// wider steps. A finer level is requested if the predicted rate is high enough.

import { firstWithin } from "./cost.js";

const MAX_FPS = 30;
const SMOOTH_FPS = 12; // an orbit stutters below this
const FINER_FPS = 16; // smallest predicted rate of a finer level
const FINER_AFTER_MS = 200; // shortest time in which the rate is measured before a finer level
const RETRY_MS = 5000; // delay before a level that was too slow is retried
const TOLERANCE = 0.85; // smallest accepted fraction of the requested rate
const WINDOW_MS = 1000; // shortest time in which the rate is measured, with at least three intervals
const LONG_GAP_MS = 1500; // shortest time in which the rate is measured, with one or two intervals
const MAX_STEP_DEGREES = 10; // degrees; an orbit with wider steps is a slide show

export class Pace {
  fps = MAX_FPS;
  level = 0; // 0: quality as requested; a larger level is coarser
  #kind = ""; // scene and picture options that the level applies to
  #slow = { level: -1, until: 0 }; // last level that was too slow
  #times = [];
  #longestMs = 0; // longest time that the service worked for a frame in #times

  // Starts an orbit at `level`. Keeps the current level if scene, technique, samples and fixed size have not
  // changed.
  play({ id, width, height, fills, technique, samples }, level = 0) {
    const kind = [id, fills || `${width}x${height}`, technique, samples].join();
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#slow = { level: -1, until: 0 };
    this.#changeLevel(level);
    this.restart();
  }

  // Drops the measurements before a new stream.
  restart() {
    this.#times = [];
    this.#longestMs = 0;
  }

  // Records a frame shown at `now` (ms) for which the service worked `workMs`. `speed`: degrees per second.
  // `costs`: relative costs of the levels, decreasing. Returns true if fps or level changed, so that the
  // stream must be requested again.
  note(now, workMs, speed, costs) {
    const expected = (ms) => costs.map((cost) => (ms * cost) / costs[this.level]);
    if (workMs > 1000 / SMOOTH_FPS && this.level < costs.length - 1) {
      const smooth = firstWithin(expected(workMs), 1000 / SMOOTH_FPS);
      return this.#getCoarser(now, Math.max(smooth, this.level + 1));
    }
    this.#times.push(now);
    this.#longestMs = Math.max(this.#longestMs, workMs);
    const span = now - this.#times[0];
    const count = this.#times.length - 1;
    const rate = (count * 1000) / span;
    if (count >= 3 && span >= FINER_AFTER_MS && rate >= FINER_FPS) {
      const finest = now < this.#slow.until ? this.#slow.level + 1 : 0;
      const level = Math.max(finest, firstWithin(expected(this.#longestMs), 1000 / FINER_FPS));
      if (level < this.level) return this.#changeLevel(level);
    }
    if (count < 1 || !((span >= WINDOW_MS && count >= 3) || span >= LONG_GAP_MS)) return false;
    this.restart();
    this.#times = [now];
    if (rate < TOLERANCE * this.fps) return this.#slowDown(now, rate, speed, this.level < costs.length - 1);
    const possible = Math.min(MAX_FPS, 700 / workMs);
    if (possible < 1.3 * this.fps) return false;
    this.fps = possible;
    return true;
  }

  #changeLevel(level) {
    this.level = level;
    this.fps = MAX_FPS;
    return true;
  }

  #getCoarser(now, level) {
    this.#slow = { level: level - 1, until: now + RETRY_MS };
    return this.#changeLevel(level);
  }

  #slowDown(now, rate, speed, coarser) {
    if (rate < SMOOTH_FPS && coarser) return this.#getCoarser(now, this.level + 1);
    const before = this.fps;
    this.fps = Math.min(before, Math.max(rate, Math.abs(speed) / MAX_STEP_DEGREES));
    return this.fps < before;
  }
}
