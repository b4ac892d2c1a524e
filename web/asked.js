// The pictures that the page asks for: what the user and the link have chosen, at the size that the stage has room for.
// `at` is a view of the camera; `page` is {state, scene, view, limits}, of which the scene is one that is shown.

import { options_of } from "./front.js";
import { quality, samples_at_rest } from "./quality.js";
import { picture_size } from "./size.js";

const chosen = ({ technique, samples, plan }) => (plan ? options_of(plan) : { technique, samples, more: "" });

// For `purpose` "still", "preview" or "stream" at `level`; see quality.js.
export function picture_for({ state, scene, view, limits }, purpose, level, at) {
  const { technique, samples: asked, more } = chosen(state);
  const own = { size: state.size, own: scene.samples };
  // A plan's samples are for the picture at rest.
  const { part, samples } = quality(purpose, level, { samples: state.plan ? 0 : asked, ...own });
  const size = picture_size({
    mode: state.size,
    purpose,
    part,
    box: view.box,
    pixel_ratio: devicePixelRatio,
    scene,
    limits,
  });
  return { id: scene.id, moves: Boolean(scene.motion), ...at, ...size, technique, samples, more };
}

// A budget leaves the samples open that nobody has chosen; `own` are the scene's.
export function picture_at_rest(page, at) {
  const { state, scene, limits } = page;
  const picture = picture_for(page, "still", 0, at);
  const { seconds, error } = state;
  if (seconds || error) return { ...picture, samples: state.samples, own: scene.samples, seconds, error };
  return { ...picture, samples: samples_at_rest(chosen(state).samples, scene.samples, limits.samples) };
}

// What a chart varies itself is left open.
export function picture_to_chart(page, at) {
  const { technique } = page.state;
  return { ...picture_for(page, "still", 0, at), technique, samples: undefined, more: undefined };
}
