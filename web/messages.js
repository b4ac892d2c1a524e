// Messages on and under the stage: progress, retries, errors and warnings.

import { hideProblem, showProblem } from "./problem.js";
import { showProgress } from "./progress.js";

const $ = (id) => document.getElementById(id);

export function attachMessages(store) {
  store.subscribe(["progress"], ({ progress }) => showProgress($("busy"), $("progress"), progress));
  store.subscribe(["retry"], ({ retry }) => {
    $("notice").hidden = !retry;
    if (!retry) return;
    const seconds = Math.max(1, Math.round(retry.seconds));
    $("notice-text").textContent = `${retry.title}. Retrying in ${seconds} s.`;
  });
  store.subscribe(["failure"], ({ failure }) => {
    if (failure) showProblem($("stage-problem"), failure.error, undefined, failure.actions);
    else hideProblem($("stage-problem"));
  });
  store.subscribe(["warning"], ({ warning }) => {
    $("warning").title = warning;
    $("warning").textContent = warning && `Warning: ${warning}`;
  });
}
