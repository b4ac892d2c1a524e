// How fast and how fine an orbit is asked for. Every frame is rendered, so slow frames make it turn too slowly. Then
// the stream is asked for anew: coarser as long as it would stutter, else with fewer frames and a wider step; and finer
// again once that would not stutter by far.

const kMostFps = 30;
const kSmoothFps = 12; // below this it stutters
const kFinerFps = 2 * kSmoothFps; // what a finer orbit has to promise
const kTolerance = 0.85; // of the planned rate
const kWindowMs = 1000; // a judgement of the rate rests on this much, and on three frames or one long gap
const kLongGapMs = 1500;
const kWidestStep = 10; // degrees; beyond this an orbit is a slide show

export class Pace {
  fps = kMostFps;
  level = 0; // 0: as asked; each level above is coarser
  #kind = ""; // what was found out holds for
  #times = [];
  #longest_ms = 0; // of the frames at #times

  // An orbit of `picture` begins. Another size of the window changes nothing, but what the user chooses does.
  play({ id, width, height, fills, technique, samples }) {
    const kind = [id, fills || `${width}x${height}`, technique, samples].join();
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#change_level(0);
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
    const expected_ms = (level) => (work_ms * costs[level]) / costs[this.level];
    const coarsest = costs.length - 1;
    if (work_ms > 1000 / kSmoothFps && this.level < coarsest) {
      const smooth = costs.findIndex((_, level) => level > this.level && expected_ms(level) <= 1000 / kSmoothFps);
      return this.#change_level(smooth < 0 ? coarsest : smooth);
    }
    this.#times.push(now);
    this.#longest_ms = Math.max(this.#longest_ms, work_ms);
    const span = now - this.#times[0];
    const count = this.#times.length - 1;
    if (count < 1 || !((span >= kWindowMs && count >= 3) || span >= kLongGapMs)) return false;
    const rate = (count * 1000) / span;
    const longest_ms = this.#longest_ms;
    this.restart();
    this.#times = [now];
    if (rate < kTolerance * this.fps) return this.#slow_down(rate, speed, this.level < coarsest);
    if (this.level > 0 && (longest_ms * costs[this.level - 1]) / costs[this.level] < 1000 / kFinerFps)
      return this.#change_level(this.level - 1);
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

  #slow_down(rate, speed, coarser) {
    if (rate < kSmoothFps && coarser) return this.#change_level(this.level + 1);
    const before = this.fps;
    this.fps = Math.min(before, Math.max(rate, Math.abs(speed) / kWidestStep));
    return this.fps < before;
  }
}
