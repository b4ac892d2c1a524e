// The pictures that the page asks for: what the user and the link have chosen, at the size that the stage has room for.
// `at` is a view of the camera; `page` is {state, scene, view, limits}, of which the scene is one that is shown.

import { amount } from "./cost.js";
import { options_of } from "./front.js";
import { rungs, samples_at_rest } from "./quality.js";
import { picture_size } from "./size.js";

const chosen = ({ technique, samples, plan }) => (plan ? options_of(plan) : { technique, samples, more: "" });

// The whole picture of a view, or that of a rung, see quality.js; `purpose`: "still", "preview" or "stream".
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

// Those for a moving view, each cheaper than the one before. What the user has chosen is kept in an orbit, but not
// while the view is moved by hand.
export function moving_pictures(page, purpose, at) {
  const { state, scene } = page;
  const asked = state.plan ? 0 : state.samples; // a plan's samples are for the picture at rest
  const kept = purpose === "stream";
  const size = !kept && state.size !== "half" ? "fit" : state.size;
  const all = rungs({ samples: kept ? asked : 0, size, own: asked || scene.samples });
  const pictures = all.map((rung) => picture_for(page, purpose, at, rung));
  return pictures.filter((picture, rung) => rung === 0 || amount(picture) < amount(pictures[rung - 1]));
}

// A budget leaves the samples open that nobody has chosen; `own` are the scene's.
export function picture_at_rest(page, at) {
  const { state, scene, limits } = page;
  const picture = picture_for(page, "still", at);
  const { seconds, error } = state;
  if (seconds || error) return { ...picture, samples: state.samples, own: scene.samples, seconds, error };
  return { ...picture, samples: samples_at_rest(chosen(state).samples, scene.samples, limits.samples) };
}

// What a chart varies itself is left open.
export function picture_to_chart(page, at) {
  const { technique } = page.state;
  return { ...picture_for(page, "still", at), technique, samples: undefined, more: undefined };
}
