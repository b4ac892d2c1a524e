// Predicts the outcome of the page's budgets. The service estimates each outcome from some pixels of the
// picture.

import { getJson } from "./api.js";
import { unit } from "./bound.js";
import { duration } from "./pareto-front.js";
import { roundedUp } from "./progress.js";
import { frameUrl, queryOf } from "./urls.js";

const TIMEOUT_MS = 3000; // for all budgets together; later predictions are dropped

export class BudgetPrediction {
  #onChange;
  #last = { key: "", texts: [] };
  #work = null; // AbortController of the requests

  // Calls `onChange(text)` with the prediction, or "" when there is none.
  constructor(onChange) {
    this.#onChange = onChange;
  }

  // Predicts `pictures`, the picture at rest with each budget. Reuses the last prediction for equal pictures.
  async predict(pictures) {
    this.cancel();
    const key = pictures.map(frameUrl).join();
    if (key !== this.#last.key) {
      const work = (this.#work = new AbortController());
      const texts = await predictAll(pictures, work.signal);
      if (this.#work !== work) return;
      this.#last = { key, texts };
    }
    if (this.#last.texts.length > 0) this.#onChange(`Prediction: ${this.#last.texts.join(" · ")}`);
  }

  // Cancels the requests and clears the text.
  cancel() {
    this.#work?.abort();
    this.#work = null;
    this.#onChange("");
  }
}

// Requests the predictions one after another until one fails or the timeout expires. Returns the texts of the
// predictions received.
async function predictAll(pictures, signal) {
  const texts = [];
  const all = AbortSignal.any([signal, AbortSignal.timeout(TIMEOUT_MS)]);
  try {
    for (const picture of pictures) {
      const query = queryOf(picture);
      query.set("measure", "true");
      const { forecast } = await getJson(`v1/scenes/${picture.id}/explain?${query}`, { signal: all });
      texts.push(predictionText(picture, forecast));
    }
  } catch {
    // The render of the picture fails in the same way and reports the error.
  }
  return texts;
}

// Returns a text such as "2 s gives error ≤ 0.011" or "2 % error takes 0.7 s" for a budget and its forecast.
export function predictionText({ seconds, error }, { budget, certificate: { total, space } }) {
  const takes = duration(budget.used_s);
  const bound = total.kind === "unknown" ? null : `error ≤ ${roundedUp(total.rms)}${unit(space)}`;
  if (seconds)
    return `${seconds} s ${budget.seconds_met ? `gives ${bound ?? "an unknown error"}` : `is too short (${takes})`}`;
  const limit = `${Number((100 * error).toPrecision(6))} % error`;
  return budget.error_met ? `${limit} takes ${takes}` : `${limit} is out of reach (${bound ?? "error unknown"})`;
}
