// Picture requests of the page: options from the user and the link, at the size of the stage.
// `at` is a camera view. `page` is {state, scene, view, limits}; its scene is not null.

import { amount } from "./cost.js";
import { options_of } from "./front.js";
import { rungs, samples_at_rest } from "./quality.js";
import { picture_size } from "./size.js";

const chosen = ({ technique, samples, plan }) => (plan ? options_of(plan) : { technique, samples, more: "" });

// Returns the picture for a view, or for a rung of quality.js. `purpose` is "still", "preview" or "stream".
export function picture_for({ state, scene, view, limits }, purpose, at, { part, samples } = {}) {
  const { technique, samples: asked, more } = chosen(state);
  const size = picture_size({
    mode: state.size,
    purpose,
    part,
    box: view.box,
    pixel_ratio: devicePixelRatio,
    scene,
    limits,
  });
  return { id: scene.id, moves: Boolean(scene.motion), ...at, ...size, technique, samples: samples ?? asked, more };
}

// Returns pictures for a moving view, each cheaper than the one before. A stream keeps the samples and the
// fixed size that the user has chosen. A preview may reduce both.
export function moving_pictures(page, purpose, at) {
  const { state, scene } = page;
  const asked = state.plan ? 0 : state.samples; // the samples of a plan apply only at rest
  const kept = purpose === "stream";
  const size = !kept && state.size !== "half" ? "fit" : state.size;
  const all = rungs({ samples: kept ? asked : 0, size, own: asked || scene.samples });
  const pictures = all.map((rung) => picture_for(page, purpose, at, rung));
  return pictures.filter((picture, rung) => rung === 0 || amount(picture) < amount(pictures[rung - 1]));
}

// Returns the picture at rest. With a budget, `samples` is the user's choice, 0 if open, and `own` is the
// scene's.
export function picture_at_rest(page, at) {
  const { state, scene, limits } = page;
  const picture = picture_for(page, "still", at);
  const { seconds, error } = state;
  if (seconds || error) return { ...picture, samples: state.samples, own: scene.samples, seconds, error };
  return { ...picture, samples: samples_at_rest(chosen(state).samples, scene.samples, limits.samples) };
}

// Returns the picture for a chart, without the options that the chart varies.
export function picture_to_chart(page, at) {
  const { technique } = page.state;
  return { ...picture_for(page, "still", at), technique, samples: undefined, more: undefined };
}
