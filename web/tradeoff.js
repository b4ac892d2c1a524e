// Chart of speed against accuracy for the current scene, made on demand. A slider selects its stops, from
// fastest to most accurate, and shows their pictures over the stage.

import { bound_words, fields_of } from "./bound.js";
import { at_view, bound_of, plan_of, stop_at, stops_of } from "./front.js";
import { Hold } from "./hold.js";
import { make_chart } from "./job.js";
import { Prediction } from "./predicted.js";
import { progress_text } from "./progress.js";
import { frame_url, query_of } from "./urls.js";

const kExtent = { samples: 16, rounds: 3, width: 200 }; // chart size; takes some seconds, with paths a minute
const kOffer = "The chart renders this view in many ways and shows how long each takes and how large its error is.";
const kSlider = 1000; // steps of the range input, finer than the stops

export class Tradeoff {
  #parts;
  #overlay;
  #on;
  #kind = ""; // scene and technique of the chart
  #view = ""; // view of the chart
  #chart = null;
  #stops = [];
  #at = -1; // index of the chosen stop, or -1
  #was = null; // address of the picture that a held one replaced
  #work = null; // AbortController of the chart being made
  #prediction;
  #predicted = ""; // prediction shown while there is no chart
  #fetching = new AbortController();

  // `parts`: elements by name, and the `budgets` to predict. `on` has
  //   picture() -> the picture at rest without plan and budget, or null
  //   within(budget) -> the same with that budget only
  //   seen() -> address of the picture on the stage, or null
  //   pause(), use(plan), chart(drawing, points), say(text)
  constructor(parts, overlay, on) {
    this.#parts = parts;
    this.#overlay = overlay;
    this.#on = on;
    parts.make.addEventListener("click", () => (this.#work ? this.#work.abort() : this.#make()));
    parts.slider.addEventListener("input", () => this.#slide(Number(parts.slider.value) / kSlider));
    parts.slider.addEventListener("keydown", (event) => this.#key(event));
    parts.slider.addEventListener("change", () => this.#settle());
    parts.use.addEventListener("click", () => this.#at >= 0 && on.use(plan_of(this.#point)));
    new Hold(parts.reference, "r", (held) => this.#hold(held, this.#reference()));
    new Hold(parts.bound, "e", (held) => this.#hold(held, this.#bound()));
    this.#prediction = new Prediction((words) => {
      this.#predicted = words;
      this.#offer();
    });
    this.#show_parts();
  }

  // Drops the chart if `picture` has another scene or technique.
  show(picture) {
    const kind = picture ? `${picture.id} ${picture.technique}` : "";
    if (kind === this.#kind) return;
    this.#kind = kind;
    this.#work?.abort();
    this.#drop();
  }

  // Predicts the budgets of the picture at rest while there is no chart.
  rest() {
    if (!this.#chart && !this.#work) this.#prediction.of(this.#parts.budgets.map(this.#on.within));
  }

  // Cancels the prediction.
  stale() {
    this.#prediction.leave();
  }

  // Hides the overlay.
  leave() {
    this.#overlay.hide();
  }

  // Chooses the stop of the chart's point `index`, if it is a stop.
  choose(index) {
    const at = this.#stops.findIndex(({ point }) => point === this.#chart.points[index]);
    if (at >= 0) this.#go(at);
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
    this.#show_parts();
    const tell = (figures) => {
      progress.value = figures.part ?? 0;
      part.textContent = progress_text(figures);
    };
    tell({});
    try {
      const made = await make_chart(picture, kExtent, signal, tell);
      signal.throwIfAborted();
      if (made) this.#take(made, picture);
      else this.#say("This service makes no charts.", true);
    } catch (error) {
      if (!signal.aborted) this.#say(`No chart: ${error.title ?? error.message}. ${error.detail ?? ""}`, true);
    } finally {
      this.#work = null;
      this.#show_parts();
    }
  }

  #take({ chart, drawing }, picture) {
    this.#drop();
    this.#chart = chart;
    this.#view = view_of(picture);
    this.#stops = stops_of(chart);
    this.#parts.ticks.replaceChildren(
      ...this.#stops.map(({ place }) => new Option("", String(Math.round(place * kSlider)))),
    );
    const selectable = this.#stops.map(({ point, line }) => ({ index: chart.points.indexOf(point), line }));
    this.#on.chart(drawing, selectable);
    this.#show_parts();
    this.#go(this.#stops.length - 1);
    // Keeps the focus if the user has moved it elsewhere.
    if ([this.#parts.make, document.body].includes(document.activeElement)) this.#parts.slider.focus();
  }

  #drop() {
    this.#fetching.abort();
    this.#overlay.clear();
    this.#chart = null;
    this.#stops = [];
    this.#at = -1;
    this.#say("");
    this.#show_parts();
  }

  #show_parts() {
    const { make, stops, progress, part, reference } = this.#parts;
    make.hidden = Boolean(this.#chart);
    make.textContent = this.#work ? "Cancel the chart" : "Chart speed against accuracy";
    progress.hidden = part.hidden = !this.#work;
    stops.hidden = reference.hidden = !this.#chart;
  }

  #slide(place) {
    const at = stop_at(this.#stops, place);
    if (at === this.#at && this.#overlay.shown) return;
    this.#go(at, place);
  }

  // Moves the thumb to its stop.
  #settle() {
    if (this.#at >= 0) this.#parts.slider.value = Math.round(this.#stops[this.#at].place * kSlider);
  }

  #key(event) {
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
    this.#go(Math.min(last, Math.max(0, to)));
  }

  #go(at, place) {
    this.#at = at;
    const { line } = this.#stops[at];
    const { slider, line: told } = this.#parts;
    if (place === undefined) this.#settle();
    slider.ariaValueText = line;
    told.textContent = told.title = line;
    this.#on.pause();
    const elsewhere = this.#elsewhere ? "Measured in another view. " : "";
    this.#say(`${elsewhere}The picture alone tells: ${bound_words(fields_of(this.#point.certificate))}`);
    this.#see(this.#address());
    this.#fetch_all();
  }

  get #elsewhere() {
    return this.#view !== view_of(this.#on.picture());
  }

  // Returns the address of a point's picture in the current view.
  #in_view(address) {
    return this.#elsewhere ? at_view(address, query_of(this.#on.picture())) : address;
  }

  #address() {
    return this.#at >= 0 ? this.#in_view(this.#point.picture) : null;
  }

  #reference() {
    return this.#chart && this.#in_view(this.#chart.reference.picture);
  }

  // Returns the error view of the visible stop, else of the picture on the stage.
  #bound() {
    const address = (this.#overlay.shown && this.#address()) || this.#on.seen();
    return address && bound_of(address);
  }

  #fetch_all() {
    this.#fetching.abort();
    this.#fetching = new AbortController();
    const away = (at) => Math.abs(at - this.#at);
    const near = this.#stops.map((_, at) => at).sort((a, b) => away(a) - away(b));
    const addresses = near.map((at) => this.#in_view(this.#stops[at].point.picture));
    this.#overlay.prefetch(addresses, this.#fetching.signal);
  }

  async #see(address) {
    try {
      await this.#overlay.show(address);
    } catch (error) {
      this.#say(`The picture cannot be shown: ${error.title ?? error.message}. ${error.detail ?? ""}`, true);
    }
  }

  // Shows the picture at `address` while held, then the former one.
  #hold(held, address) {
    if (!held) {
      if (this.#was) this.#see(this.#was);
      else this.#overlay.hide();
    } else if (!address) {
      this.#on.say("There is nothing to compare with before a chart is made.");
    } else {
      this.#was = this.#overlay.shown ? this.#address() : null;
      this.#on.pause();
      this.#see(address);
    }
  }

  #say(text, alarms = false) {
    const { note } = this.#parts;
    note.textContent = text;
    note.classList.toggle("missed", alarms);
    this.#offer();
  }

  #offer() {
    const { line } = this.#parts;
    if (!this.#chart) line.textContent = line.title = this.#predicted || kOffer;
  }
}

// Returns the view of a picture as an address, for comparison.
function view_of(picture) {
  const { width, height, technique, samples, more, ...view } = picture;
  return frame_url(view);
}
