// How fast and how fine an orbit is asked for. Every frame is rendered, so slow frames make it turn too slowly. Then
// the stream is asked for anew: coarser as long as it would stutter, else with fewer frames and a wider step; and finer
// again as far as that would not stutter.

import { first_within } from "./cost.js";

const kMostFps = 30;
const kSmoothFps = 12; // below this it stutters
const kFinerFps = 16; // what a finer orbit has to promise
const kFinerAfterMs = 200; // and the rate that it is judged by is measured this long
const kAgainMs = 5000; // what was too slow is not tried again before
const kTolerance = 0.85; // of the planned rate
const kWindowMs = 1000; // a judgement of the rate rests on this much, and on three frames or one long gap
const kLongGapMs = 1500;
const kWidestStep = 10; // degrees; beyond this an orbit is a slide show

export class Pace {
  fps = kMostFps;
  level = 0; // 0: as asked; each level above is coarser
  #kind = ""; // what was found out holds for
  #slow = { level: -1, until: 0 }; // the last level that was too slow
  #times = [];
  #longest_ms = 0; // of the frames at #times

  // An orbit of `picture` begins, at `level` unless one was found already. Another size of the window changes nothing,
  // but what the user chooses does.
  play({ id, width, height, fills, technique, samples }, level = 0) {
    const kind = [id, fills || `${width}x${height}`, technique, samples].join();
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#slow = { level: -1, until: 0 };
    this.#change_level(level);
    this.restart();
  }

  // A new stream begins: what was measured does not count for it.
  restart() {
    this.#times = [];
    this.#longest_ms = 0;
  }

  // A frame was shown at `now` (ms); the service worked `work_ms` for it. `costs` are those of the levels, each in the
  // same unit and less than the one before. Returns whether fps or level changed, so that the stream should be asked
  // for anew.
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
