// How fast and how fine an orbit is asked for. Every frame is rendered, so slow frames make it turn too slowly. Then
// the stream is asked for anew: coarser as long as it would stutter, else with fewer frames and a wider step.

const kMostFps = 30;
const kSmoothFps = 12; // below this it stutters
const kTolerance = 0.85; // of the planned rate
const kWindowMs = 1000; // a judgement rests on this much, and on three frames or one long gap
const kLongGapMs = 1500;
const kWidestStep = 10; // degrees; beyond this an orbit is a slide show

export class Pace {
  fps = kMostFps;
  level = 0; // 0: as asked; each level above is coarser
  #times = [];

  reset() {
    this.fps = kMostFps;
    this.level = 0;
    this.restart();
  }

  // A new stream begins: what was measured does not count for it.
  restart() {
    this.#times = [];
  }

  // A frame was shown at `now` (ms); the service worked `work_ms` for it. `coarser` tells whether there is a
  // level above. Returns whether fps or level changed, so that the stream should be asked for anew.
  note(now, work_ms, speed, coarser) {
    this.#times.push(now);
    const span = now - this.#times[0];
    const count = this.#times.length - 1;
    if (count < 1 || !((span >= kWindowMs && count >= 3) || span >= kLongGapMs)) return false;
    const rate = (count * 1000) / span;
    this.#times = [now];
    if (rate < kTolerance * this.fps) return this.#slow_down(rate, speed, coarser);
    const possible = Math.min(kMostFps, 700 / work_ms);
    if (possible < 1.3 * this.fps) return false;
    this.fps = possible;
    return true;
  }

  #slow_down(rate, speed, coarser) {
    if (rate < kSmoothFps && coarser) {
      this.level += 1;
      this.fps = kMostFps;
      return true;
    }
    const before = this.fps;
    this.fps = Math.min(before, Math.max(rate, Math.abs(speed) / kWidestStep));
    return this.fps < before;
  }
}
