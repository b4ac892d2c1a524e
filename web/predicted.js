// What the page's budgets would give, as the service foretells it from parts of the picture.

import { get_json } from "./api.js";
import { unit } from "./bound.js";
import { duration } from "./front.js";
import { rounded_up } from "./progress.js";
import { frame_url, query_of } from "./urls.js";

const kPatienceMs = 3000; // of a scene so heavy that this is too short nothing is said

export class Prediction {
  #tell;
  #last = { key: "", words: [] };
  #work = null; // AbortController of what is asked

  // `tell(text)` hears what is to be said, "" of nothing.
  constructor(tell) {
    this.#tell = tell;
  }

  // `pictures` are what the page shows at rest, each within another budget: they are asked for once.
  async of(pictures) {
    this.leave();
    const key = pictures.map(frame_url).join();
    if (key !== this.#last.key) {
      const work = (this.#work = new AbortController());
      const words = await words_of_all(pictures, work.signal);
      if (this.#work !== work) return;
      this.#last = { key, words };
    }
    if (this.#last.words.length > 0) this.#tell(`With a limit ${this.#last.words.join(" · ")}`);
  }

  // Another picture is due.
  leave() {
    this.#work?.abort();
    this.#work = null;
    this.#tell("");
  }
}

// One after the other, as far as the service tells them in time.
async function words_of_all(pictures, signal) {
  const words = [];
  const all = AbortSignal.any([signal, AbortSignal.timeout(kPatienceMs)]);
  try {
    for (const picture of pictures) {
      const query = query_of(picture);
      query.set("measure", "true");
      const { forecast } = await get_json(`v1/scenes/${picture.id}/explain?${query}`, { signal: all });
      words.push(prediction_words(picture, forecast));
    }
  } catch (error) {
    // Nobody asked for it, and the picture meets the same trouble and reports it.
  }
  return words;
}

// "of 2 s: error ≤ 0.011", "of 2 % error: 0.7 s"; of a budget and what is foretold of it.
export function prediction_words({ seconds, error }, { budget, certificate: { total, space } }) {
  const takes = duration(budget.used_s);
  const reached = total.kind === "unknown" ? "error unknown" : `error ≤ ${rounded_up(total.rms)}${unit(space)}`;
  if (seconds) return `of ${seconds} s: ${budget.seconds_met ? reached : `missed, takes ${takes}`}`;
  return `of ${Number((100 * error).toPrecision(6))} % error: ${budget.error_met ? takes : `missed, ${reached}`}`;
}
