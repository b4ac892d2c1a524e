// URLs of pictures, relative so that the page works below any path. Numbers are rounded, so that equal views
// have equal URLs and hit the browser's cache.

// Returns the query of a picture {id, azimuth, elevation, distance, pan, width, height}, with {isAnimated,
// time} in a moving scene. Optional: {fov, technique, samples}, `more` options as a query, budgets {seconds,
// error}. `location`: URL that reproduces a picture rendered to a budget.
export function queryOf(picture) {
  const query = new URLSearchParams({
    azimuth: round(picture.azimuth, 2),
    elevation: round(picture.elevation, 2),
    distance: round(picture.distance, 4),
    width: picture.width,
    height: picture.height,
  });
  const pan = panText(picture.pan);
  if (pan) query.set("pan", pan);
  if (picture.isAnimated) query.set("time", round(picture.time, 3));
  if (picture.fov) query.set("fov", round(picture.fov, 3));
  if (picture.technique) query.set("technique", picture.technique);
  if (picture.samples) query.set("samples", picture.samples);
  for (const [key, text] of new URLSearchParams(picture.more)) query.set(key, text);
  for (const budget of ["seconds", "error"]) if (picture[budget]) query.set(budget, picture[budget]);
  return query;
}

// Formats a pan with six significant digits, for scenes of any scale. Returns "" without a pan.
export function panText(pan) {
  return pan?.some(Boolean) ? pan.map((metres) => Number(metres.toPrecision(6)) + 0).join() : "";
}

export function round(value, digits) {
  return Number(value.toFixed(digits)) + 0; // + 0 turns -0 into 0
}

export function frameUrl(picture) {
  return picture.location ?? `v1/scenes/${picture.id}/frame.png?${queryOf(picture)}`;
}

// Returns the URL of the stream that refines the picture in passes.
export function refinementUrl(picture) {
  return `v1/scenes/${picture.id}/refinement?${queryOf(picture)}`;
}

// Returns the URL of an orbit stream. `timeStep`: seconds of the scene's motion per frame, 0 if nothing
// moves.
export function orbitUrl(picture, { frames, fps, step, timeStep }) {
  const query = queryOf(picture);
  query.set("frames", frames);
  query.set("fps", fps);
  query.set("step", round(step, 5));
  if (timeStep) query.set("time_step", round(timeStep, 5));
  return `v1/scenes/${picture.id}/orbit?${query}`;
}

// Returns the body of POST v1/jobs for a picture.
export function jobBody(picture) {
  const { azimuth, elevation, distance, fov, width, height, samples, time } = numbersOf(queryOf(picture));
  const { technique, pan } = Object.fromEntries(queryOf(picture));
  const more = [...new URLSearchParams(picture.more)].map(([key, text]) => [
    key,
    text === "" || isNaN(text) ? text : Number(text),
  ]);
  return {
    scene_id: picture.id,
    camera: {
      azimuth_degrees: azimuth,
      elevation_degrees: elevation,
      distance,
      pan: pan?.split(",").map(Number),
      fov_degrees: fov,
    },
    image: { width, height },
    render: { samples, technique, time, ...Object.fromEntries(more) },
  };
}

// Returns the body of POST v1/scenes/{id}/charts. `extent`: {samples, rounds, width}.
export function chartBody(picture, extent) {
  const { camera, image, render } = jobBody({ ...picture, samples: undefined, more: undefined });
  return { camera, image, render: { ...render, samples: undefined }, chart: extent };
}

const numbersOf = (query) => Object.fromEntries([...query].map(([key, text]) => [key, Number(text)]));

export function fileName(name, view) {
  const plain = name.replace(/[^\w-]+/g, "-").slice(0, 40);
  return `${plain}-${Math.round(view.azimuth)}-${Math.round(view.elevation)}.png`;
}

// Returns a curl command. With `token`, the command reads the token from the environment.
export function curlCommand(picture, name, base, token = "") {
  const address = new URL(frameUrl(picture), base).href.replaceAll("'", "%27");
  const access = token ? '-H "Authorization: Bearer $ORRERY_TOKEN" ' : "";
  return `curl -fo ${fileName(name, picture)} ${access}'${address}'`;
}
