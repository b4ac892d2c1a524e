// What the page's budgets would give, as the service foretells it from parts of the picture.

import { get_json, is_abort } from "./api.js";
import { fields_of } from "./bound.js";
import { duration } from "./front.js";
import { rounded } from "./progress.js";
import { frame_url, query_of } from "./urls.js";

export class Prediction {
  #budgets;
  #tell;
  #picture = null; // that was asked for last
  #words = ""; // once the service has answered
  #work = new AbortController();

  // `budgets`: {seconds, error} each, of which one is 0. `tell(text)` hears what is to be said, "" of nothing.
  constructor(budgets, tell) {
    this.#budgets = budgets;
    this.#tell = tell;
  }

  // Of the picture at rest, as often as it is seen. Where only the view is another than before, that is said: to ask at
  // each turn would cost the service as much as the pictures do. What fails is asked again the next time.
  async of(picture) {
    const before = this.#picture;
    if (before?.width === picture.width && before.height === picture.height) {
      const elsewhere = frame_url(before) === frame_url(picture) ? "" : " in another view";
      if (this.#words) this.#tell(`Predicted${elsewhere}: ${this.#words}`);
      return;
    }
    this.drop();
    this.#picture = picture;
    const { signal } = this.#work;
    try {
      this.#words = await words_of_all(picture, this.#budgets, signal);
      this.#tell(`Predicted: ${this.#words}`);
    } catch (error) {
      if (!is_abort(error)) this.#picture = null;
    }
  }

  // Another scene, or other options.
  drop() {
    this.#work.abort();
    this.#work = new AbortController();
    this.#picture = null;
    this.#words = "";
    this.#tell("");
  }
}

// One after the other: each takes the service some tenths of a second.
async function words_of_all(picture, budgets, signal) {
  const words = [];
  for (const budget of budgets) {
    const query = query_of({ ...picture, ...budget });
    query.set("measure", "true");
    const { forecast } = await get_json(`v1/scenes/${picture.id}/explain?${query}`, { signal });
    words.push(prediction_words(budget, forecast));
  }
  return words.join("; ");
}

// "2 s gives error ≤ 0.011", "2 % takes 0.7 s"; of a budget and what is foretold of it.
export function prediction_words({ seconds, error }, { budget, certificate }) {
  const { total, known } = certificate;
  const besides = total.kind === "unknown" ? ` besides ${fields_of(certificate).because}` : "";
  const reached = known.kind === "unknown" ? "an unknown error" : `error ≤ ${rounded(known.rms)}${besides}`;
  if (seconds) return `${seconds} s gives ${reached}`;
  const takes = duration(budget.used_s);
  return `${rounded(100 * error)} % ${budget.error_met ? `takes ${takes}` : `is out of reach: ${reached} in ${takes}`}`;
}
