// Delays between retries: doubling from 0.5 s to 16 s, or taken from Retry-After.

const FIRST = 0.5;
const LONGEST_SECONDS = 16;
const sleepers = new Set(); // resolve functions of the waiting retries

export class Backoff {
  #next = FIRST;

  // Returns the seconds to wait after `error`. Jitter of up to 10 % keeps pages from retrying at the same
  // time.
  after(error) {
    const seconds = error?.retryAfterSeconds ?? this.#next;
    this.#next = Math.min(LONGEST_SECONDS, this.#next * 2);
    return seconds * (1 + 0.1 * Math.random());
  }

  reset() {
    this.#next = FIRST;
  }
}

// Runs `task` until it succeeds, and returns its result. Calls `onWaiting(error, seconds)` before each wait
// between two attempts. wakeAll() ends every wait. Rethrows an error that is not retryable, or any error once
// `wanted()` is false. Returns undefined if `wanted()` is false before an attempt.
export async function withRetries(task, onWaiting, wanted = () => true) {
  for (const backoff = new Backoff(); wanted();) {
    try {
      return await task();
    } catch (error) {
      if (!error.retryable || !wanted()) throw error;
      const seconds = backoff.after(error);
      onWaiting(error, seconds);
      await sleep(seconds);
    }
  }
}

async function sleep(seconds) {
  let timer = 0;
  let wake = null;
  await new Promise((resolve) => {
    wake = resolve;
    sleepers.add(wake);
    timer = setTimeout(wake, 1000 * seconds);
  });
  clearTimeout(timer);
  sleepers.delete(wake);
}

export function wakeAll() {
  for (const wake of sleepers) wake();
}
