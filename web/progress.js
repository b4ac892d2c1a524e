// Progress of the current render: a bar, indeterminate while progress is unknown, and a text.

function duration(seconds) {
  return seconds < 60 ? `${Math.ceil(seconds)} s` : `${Math.round(seconds / 60)} min`;
}

// Rounds to two significant digits.
export const rounded = (rmse) => String(Number(rmse.toPrecision(2)));

// Rounds an upper bound up to two significant digits. Ignores rounding errors of a double.
export function roundedUp(bound) {
  if (bound === 0) return "0";
  const unit = 10 ** (Math.floor(Math.log10(bound)) - 1);
  return rounded(Math.ceil(bound / unit - 1e-9) * unit);
}

// Returns the progress in words. `shown` of `end` samples are on the canvas. `rmse`: root mean square error
// of a pixel in linear radiance, if known. `part`: finished fraction of the next picture. `secondsLeft`: time
// until all samples are rendered.
export function progressText({ shown, end, rmse, part, secondsLeft }) {
  const words = end ? [`${shown} of ${end} samples`] : [];
  if (rmse > 0) words.push(`error ${rounded(rmse)}`);
  if (part !== undefined) words.push(`${Math.floor(100 * part)} %`);
  if (secondsLeft > 0) words.push(`${part === undefined ? "about " : ""}${duration(secondsLeft)} left`);
  return words.join(" · ");
}

// Shows the progress. `figures`: as in progressText(), {} if nothing is known, null if nothing is being
// rendered.
export function showProgress(bar, label, figures) {
  bar.hidden = label.hidden = !figures;
  if (!figures) return;
  const text = progressText(figures);
  label.textContent = text;
  bar.ariaValueText = text || "Waiting for the image";
  bar.classList.toggle("measured", figures.part !== undefined);
  bar.style.setProperty("--part", figures.part ?? 0);
  bar.ariaValueNow = figures.part === undefined ? null : Math.floor(100 * figures.part);
}
