// Predicted outcome of the page's budgets, which the service estimates from parts of the picture.

import { get_json } from "./api.js";
import { unit } from "./bound.js";
import { duration } from "./front.js";
import { rounded_up } from "./progress.js";
import { frame_url, query_of } from "./urls.js";

const kPatienceMs = 3000; // limit; a heavier scene gets no prediction

export class Prediction {
  #tell;
  #last = { key: "", words: [] };
  #work = null; // AbortController of the requests

  // Calls `tell(text)` with the prediction, "" for none.
  constructor(tell) {
    this.#tell = tell;
  }

  // Predicts `pictures`, the picture at rest with each budget. Requests equal pictures once.
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

  // Cancels the requests and clears the text.
  leave() {
    this.#work?.abort();
    this.#work = null;
    this.#tell("");
  }
}

// Requests the predictions one after another. Returns those that arrive in time.
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
    // The picture fails in the same way and reports it.
  }
  return words;
}

// Returns a text such as "of 2 s: error ≤ 0.011" or "of 2 % error: 0.7 s" for a budget and its forecast.
export function prediction_words({ seconds, error }, { budget, certificate: { total, space } }) {
  const takes = duration(budget.used_s);
  const reached = total.kind === "unknown" ? "error unknown" : `error ≤ ${rounded_up(total.rms)}${unit(space)}`;
  if (seconds) return `of ${seconds} s: ${budget.seconds_met ? reached : `missed, takes ${takes}`}`;
  return `of ${Number((100 * error).toPrecision(6))} % error: ${budget.error_met ? takes : `missed, ${reached}`}`;
}
