// Tells how far the picture at work is: a bar, which moves to and fro while that is not known, and a text.

function duration(seconds) {
  return seconds < 60 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`;
}

// To two digits.
export const rounded = (rmse) => String(Number(rmse.toPrecision(2)));

// Of what is at most so much: never less than it is, but for the rounding of a double.
export function rounded_up(bound) {
  if (bound === 0) return "0";
  const unit = 10 ** (Math.floor(Math.log10(bound)) - 1);
  return rounded(Math.ceil(bound / unit - 1e-9) * unit);
}

// `shown` of `end` samples are on the canvas, with that root mean square error of a pixel, in linear radiance, if it is
// known; `part` of the next picture is done, `seconds_left` till the end.
export function progress_text({ shown, end, rmse, part, seconds_left }) {
  const words = end ? [`${shown} of ${end} samples`] : [];
  if (rmse > 0) words.push(`error ${rounded(rmse)}`);
  if (part !== undefined) words.push(`${Math.floor(100 * part)} %`);
  if (seconds_left > 0) words.push(`${part === undefined ? "about " : ""}${duration(seconds_left)} left`);
  return words.join(" · ");
}

// `figures` as above, {} where nothing is known, null where nothing is at work.
export function show_progress(bar, label, figures) {
  bar.hidden = label.hidden = !figures;
  if (!figures) return;
  const text = progress_text(figures);
  label.textContent = text;
  bar.ariaValueText = text || "Waiting for the picture";
  bar.classList.toggle("measured", figures.part !== undefined);
  bar.style.setProperty("--part", figures.part ?? 0);
  bar.ariaValueNow = figures.part === undefined ? null : Math.floor(100 * figures.part);
}
