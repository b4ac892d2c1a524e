// Picture requests of the page: options from the user and the link, at the size of the stage. `page` contains
// the values of the store, with a scene, and `box`, the size of the stage. `view` is the camera's view.

import { amount } from "./cost.js";
import { optionsOf } from "./pareto-front.js";
import { qualityLevels, samplesAtRest } from "./quality.js";
import { pictureSize } from "./size.js";

const chosenOptions = ({ technique, samples, plan }) => (plan ? optionsOf(plan) : { technique, samples, more: "" });

// Returns the picture of a view, reduced to a quality level if one is given. `purpose` is "still", "preview"
// or "stream".
export function pictureFor(page, purpose, view, { part, samples } = {}) {
  const { scene, limits, box } = page;
  const options = chosenOptions(page);
  const size = pictureSize({
    mode: page.size,
    purpose,
    part,
    box,
    pixelRatio: devicePixelRatio,
    scene,
    limits,
  });
  return {
    id: scene.id,
    isAnimated: Boolean(scene.motion),
    ...view,
    ...size,
    ...options,
    samples: samples ?? options.samples,
  };
}

// Returns pictures of a moving view, each cheaper than the one before. A stream keeps the samples and the
// fixed size that the user has chosen. A preview may reduce both.
export function movingPictures(page, purpose, view) {
  const chosen = page.plan ? 0 : page.samples; // the samples of a plan apply only at rest
  const isStream = purpose === "stream";
  const size = isStream || page.size === "half" ? page.size : "fit";
  const levels = qualityLevels({ samples: isStream ? chosen : 0, size, own: chosen || page.scene.samples });
  const pictures = levels.map((level) => pictureFor(page, purpose, view, level));
  return pictures.filter((picture, at) => at === 0 || amount(picture) < amount(pictures[at - 1]));
}

// Returns the picture at rest. With a budget, its `samples` are the sample count that the user has chosen, or
// 0, and its `own` is the scene's sample count.
export function pictureAtRest(page, view) {
  const picture = pictureFor(page, "still", view);
  const { scene, limits, samples, seconds, error } = page;
  if (seconds || error) return { ...picture, samples, own: scene.samples, seconds, error };
  return { ...picture, samples: samplesAtRest(picture.samples, scene.samples, limits.samples) };
}

// Returns the picture for a chart, without the options that the chart varies.
export function pictureToChart(page, view) {
  const { technique } = page;
  return { ...pictureFor(page, "still", view), technique, samples: undefined, more: undefined };
}
