// Chart of speed against accuracy for the current scene, made on demand. A slider selects its stops, from
// fastest to most accurate, and shows their pictures over the stage.

import { boundText, fieldsOf } from "./bound.js";
import { atView, boundOf, planOf, stopAt, stopsOf } from "./pareto-front.js";
import { HoldButton } from "./hold-button.js";
import { makeChart } from "./job.js";
import { BudgetPrediction } from "./budget-prediction.js";
import { progressText } from "./progress.js";
import { frameUrl, queryOf } from "./urls.js";

const CHART_EXTENT = { samples: 16, rounds: 3, width: 200 }; // takes seconds, or a minute for path tracing
const OFFER = "The chart renders this view with different settings and shows the time and error of each.";
const SLIDER_STEPS = 1000; // steps of the range input, finer than the stops

export class Tradeoff {
  #parts;
  #overlay;
  #on;
  #kind = ""; // scene and technique of the chart
  #view = ""; // view of the chart
  #chart = null;
  #stops = [];
  #at = -1; // index of the chosen stop, or -1
  #replaced = null; // URL of the picture that a held button replaces, or null
  #work = null; // AbortController of the chart being made
  #prediction;
  #predicted = ""; // prediction shown while there is no chart
  #fetching = new AbortController();

  // `parts`: elements by name, and the `budgets` to predict. `on` has
  //   picture() -> the picture at rest without plan and budget, or null
  //   withBudget(budget) -> the picture at rest with this budget and no plan
  //   shownAddress() -> URL of the picture on the stage, or null
  //   pause(), use(plan), chart(drawing, points), announce(text)
  constructor(parts, overlay, on) {
    this.#parts = parts;
    this.#overlay = overlay;
    this.#on = on;
    parts.make.addEventListener("click", () => (this.#work ? this.#work.abort() : this.#make()));
    parts.slider.addEventListener("input", () => this.#slide(Number(parts.slider.value) / SLIDER_STEPS));
    parts.slider.addEventListener("keydown", (event) => this.#onKey(event));
    parts.slider.addEventListener("change", () => this.#snapThumb());
    parts.use.addEventListener("click", () => this.#at >= 0 && on.use(planOf(this.#point)));
    new HoldButton(parts.reference, "r", (held) => this.#hold(held, this.#reference()));
    new HoldButton(parts.bound, "e", (held) => this.#hold(held, this.#bound()));
    this.#prediction = new BudgetPrediction((text) => {
      this.#predicted = text;
      this.#showOffer();
    });
    this.#showParts();
  }

  // Drops the chart if `picture` has another scene or technique. `picture` is null while no scene is shown.
  setPicture(picture) {
    const kind = picture ? `${picture.id} ${picture.technique}` : "";
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#work?.abort();
    this.#drop();
  }

  // Predicts the outcome of each budget for the picture at rest, unless a chart exists or is being made.
  predictBudgets() {
    if (!this.#chart && !this.#work) this.#prediction.predict(this.#parts.budgets.map(this.#on.withBudget));
  }

  cancelPrediction() {
    this.#prediction.cancel();
  }

  hideOverlay() {
    this.#overlay.hide();
  }

  // Selects the stop of the point `index` of the chart. Does nothing if the point is not a stop.
  choose(index) {
    const at = this.#stops.findIndex(({ point }) => point === this.#chart.points[index]);
    if (at >= 0) this.#select(at);
  }

  get #point() {
    return this.#stops[this.#at].point;
  }

  async #make() {
    this.#on.pause();
    const picture = this.#on.picture();
    if (!picture) return;
    const { progress, part } = this.#parts;
    this.#work = new AbortController();
    const { signal } = this.#work;
    this.#showParts();
    const onProgress = (figures) => {
      progress.value = figures.part ?? 0;
      part.textContent = progressText(figures);
    };
    onProgress({});
    try {
      const made = await makeChart(picture, CHART_EXTENT, signal, onProgress);
      signal.throwIfAborted();
      if (made) this.#showChart(made, picture);
      else this.#showNote("This service does not offer charts.", true);
    } catch (error) {
      if (!signal.aborted)
        this.#showNote(`The chart failed: ${error.title ?? error.message}. ${error.detail ?? ""}`, true);
    } finally {
      this.#work = null;
      this.#showParts();
    }
  }

  #showChart({ chart, drawing }, picture) {
    this.#drop();
    this.#chart = chart;
    this.#view = viewOf(picture);
    this.#stops = stopsOf(chart);
    this.#parts.ticks.replaceChildren(
      ...this.#stops.map(({ place }) => new Option("", String(Math.round(place * SLIDER_STEPS)))),
    );
    const selectable = this.#stops.map(({ point, line }) => ({ index: chart.points.indexOf(point), line }));
    this.#on.chart(drawing, selectable);
    this.#showParts();
    this.#select(this.#stops.length - 1);
    // Focuses the slider unless the user has moved the focus elsewhere.
    if ([this.#parts.make, document.body].includes(document.activeElement)) this.#parts.slider.focus();
  }

  #drop() {
    this.#fetching.abort();
    this.#overlay.clear();
    this.#chart = null;
    this.#stops = [];
    this.#at = -1;
    this.#showNote("");
    this.#showParts();
  }

  #showParts() {
    const { make, stops, progress, part, reference } = this.#parts;
    make.hidden = Boolean(this.#chart);
    make.textContent = this.#work ? "Cancel chart" : "Make speed and accuracy chart";
    progress.hidden = part.hidden = !this.#work;
    stops.hidden = reference.hidden = !this.#chart;
  }

  #slide(place) {
    const at = stopAt(this.#stops, place);
    if (at === this.#at && this.#overlay.shown) return;
    this.#select(at, place);
  }

  // Moves the thumb to the selected stop.
  #snapThumb() {
    if (this.#at >= 0) this.#parts.slider.value = Math.round(this.#stops[this.#at].place * SLIDER_STEPS);
  }

  #onKey(event) {
    const last = this.#stops.length - 1;
    const to = {
      ArrowLeft: this.#at - 1,
      ArrowDown: this.#at - 1,
      PageDown: this.#at - 1,
      ArrowRight: this.#at + 1,
      ArrowUp: this.#at + 1,
      PageUp: this.#at + 1,
      Home: 0,
      End: last,
    }[event.key];
    if (to === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    this.#select(Math.min(last, Math.max(0, to)));
  }

  #select(at, place) {
    this.#at = at;
    const { line } = this.#stops[at];
    const { slider, line: text } = this.#parts;
    if (place === undefined) this.#snapThumb();
    slider.ariaValueText = line;
    text.textContent = text.title = line;
    this.#on.pause();
    const elsewhere = this.#isOtherView ? "Measured for another view. " : "";
    this.#showNote(`${elsewhere}Bound without a reference image: ${boundText(fieldsOf(this.#point.certificate))}`);
    this.#showPicture(this.#address());
    this.#fetchAll();
  }

  get #isOtherView() {
    return this.#view !== viewOf(this.#on.picture());
  }

  // Returns the URL of a chart's picture, changed to the current view.
  #atCurrentView(address) {
    return this.#isOtherView ? atView(address, queryOf(this.#on.picture())) : address;
  }

  #address() {
    return this.#at >= 0 ? this.#atCurrentView(this.#point.picture) : null;
  }

  #reference() {
    return this.#chart && this.#atCurrentView(this.#chart.reference.picture);
  }

  // Returns the URL of the error map of the visible stop, else of the picture on the stage.
  #bound() {
    const address = (this.#overlay.shown && this.#address()) || this.#on.shownAddress();
    return address && boundOf(address);
  }

  #fetchAll() {
    this.#fetching.abort();
    this.#fetching = new AbortController();
    const away = (at) => Math.abs(at - this.#at);
    const near = this.#stops.map((_, at) => at).sort((a, b) => away(a) - away(b));
    const addresses = near.map((at) => this.#atCurrentView(this.#stops[at].point.picture));
    this.#overlay.prefetch(addresses, this.#fetching.signal);
  }

  async #showPicture(address) {
    try {
      await this.#overlay.show(address);
    } catch (error) {
      this.#showNote(`Cannot show the image: ${error.title ?? error.message}. ${error.detail ?? ""}`, true);
    }
  }

  // Shows the picture at `address` while the button is held, then the previous picture.
  #hold(held, address) {
    if (!held) {
      if (this.#replaced) this.#showPicture(this.#replaced);
      else this.#overlay.hide();
    } else if (!address) {
      this.#on.announce("Make a chart first to get a reference image.");
    } else {
      this.#replaced = this.#overlay.shown ? this.#address() : null;
      this.#on.pause();
      this.#showPicture(address);
    }
  }

  #showNote(text, isError = false) {
    const { note } = this.#parts;
    note.textContent = text;
    note.classList.toggle("missed", isError);
    this.#showOffer();
  }

  #showOffer() {
    const { line } = this.#parts;
    if (!this.#chart) line.textContent = line.title = this.#predicted || OFFER;
  }
}

// Returns the scene and view of a picture as a URL, for comparison.
function viewOf(picture) {
  const { width, height, technique, samples, more, ...view } = picture;
  return frameUrl(view);
}
