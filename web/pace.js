// Frame rate and quality level of an orbit. Every frame is rendered, so slow frames slow the orbit down. The
// stream is then requested again: at a coarser level if it stutters, else with fewer frames and a wider step.
// A finer level is requested if it would not stutter.

import { first_within } from "./cost.js";

const kMostFps = 30;
const kSmoothFps = 12; // an orbit stutters below this
const kFinerFps = 16; // predicted rate that a finer level needs
const kFinerAfterMs = 200; // shortest measurement before a finer level
const kAgainMs = 5000; // delay before a level that was too slow is retried
const kTolerance = 0.85; // smallest fraction of the planned rate
const kWindowMs = 1000; // shortest measurement of the rate, with three frames or one gap of kLongGapMs
const kLongGapMs = 1500;
const kWidestStep = 10; // degrees; an orbit with wider steps is a slide show

export class Pace {
  fps = kMostFps;
  level = 0; // 0: as requested; each level above is coarser
  #kind = ""; // picture options that the level was found for
  #slow = { level: -1, until: 0 }; // last level that was too slow
  #times = [];
  #longest_ms = 0; // longest work for a frame in #times

  // Starts an orbit of `picture` at `level`, or at the level found before. A new window size keeps that
  // level, a new choice of the user does not.
  play({ id, width, height, fills, technique, samples }, level = 0) {
    const kind = [id, fills || `${width}x${height}`, technique, samples].join();
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#slow = { level: -1, until: 0 };
    this.#change_level(level);
    this.restart();
  }

  // Drops the measurements before a new stream.
  restart() {
    this.#times = [];
    this.#longest_ms = 0;
  }

  // Records a frame shown at `now` (ms) that took the service `work_ms`. `costs`: relative costs of the
  // levels, decreasing. Returns whether fps or level changed, and the stream should be requested again.
  note(now, work_ms, speed, costs) {
    const expected = (ms) => costs.map((cost) => (ms * cost) / costs[this.level]);
    if (work_ms > 1000 / kSmoothFps && this.level < costs.length - 1) {
      const smooth = first_within(expected(work_ms), 1000 / kSmoothFps);
      return this.#get_coarser(now, Math.max(smooth, this.level + 1));
    }
    this.#times.push(now);
    this.#longest_ms = Math.max(this.#longest_ms, work_ms);
    const span = now - this.#times[0];
    const count = this.#times.length - 1;
    const rate = (count * 1000) / span;
    if (count >= 3 && span >= kFinerAfterMs && rate >= kFinerFps) {
      const finest = now < this.#slow.until ? this.#slow.level + 1 : 0;
      const level = Math.max(finest, first_within(expected(this.#longest_ms), 1000 / kFinerFps));
      if (level < this.level) return this.#change_level(level);
    }
    if (count < 1 || !((span >= kWindowMs && count >= 3) || span >= kLongGapMs)) return false;
    this.restart();
    this.#times = [now];
    if (rate < kTolerance * this.fps) return this.#slow_down(now, rate, speed, this.level < costs.length - 1);
    const possible = Math.min(kMostFps, 700 / work_ms);
    if (possible < 1.3 * this.fps) return false;
    this.fps = possible;
    return true;
  }

  #change_level(level) {
    this.level = level;
    this.fps = kMostFps;
    return true;
  }

  #get_coarser(now, level) {
    this.#slow = { level: level - 1, until: now + kAgainMs };
    return this.#change_level(level);
  }

  #slow_down(now, rate, speed, coarser) {
    if (rate < kSmoothFps && coarser) return this.#get_coarser(now, this.level + 1);
    const before = this.fps;
    this.fps = Math.min(before, Math.max(rate, Math.abs(speed) / kWidestStep));
    return this.fps < before;
  }
}
