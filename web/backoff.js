// Waiting times between attempts: they double from half a second to sixteen, or follow Retry-After.

const kFirst = 0.5;
const kLongest = 16;
const sleepers = new Set(); // resolve functions of the attempts that wait now

export class Backoff {
  #next = kFirst;

  // Seconds to wait after `error`. A random tenth keeps many pages from coming back at once.
  after(error) {
    const seconds = error?.retry_after_seconds ?? this.#next;
    this.#next = Math.min(kLongest, this.#next * 2);
    return seconds * (1 + 0.1 * Math.random());
  }

  reset() {
    this.#next = kFirst;
  }
}

// Runs `task` until it succeeds, fails for good, or is no longer `wanted` (then the result is undefined).
// Before each wait `on_waiting(error, seconds)` is called; wake_all() ends every wait.
export async function persist(task, on_waiting, wanted = () => true) {
  for (const backoff = new Backoff(); wanted();) {
    try {
      return await task();
    } catch (error) {
      if (!error.retryable || !wanted()) throw error;
      const seconds = backoff.after(error);
      on_waiting(error, seconds);
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

export function wake_all() {
  for (const wake of sleepers) wake();
}
