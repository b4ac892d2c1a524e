// Addresses of pictures, relative so that the page works below any path. Numbers are rounded, so equal views
// have equal addresses and hit the browser's cache.

// Returns the query of a picture {id, azimuth, elevation, distance, pan, width, height}, with {moves, time}
// in a moving scene. Optional: {fov, technique, samples}, `more` options as a query, budgets {seconds,
// error}. `location`: address that reproduces a picture made to a budget.
export function query_of(picture) {
  const query = new URLSearchParams({
    azimuth: round(picture.azimuth, 2),
    elevation: round(picture.elevation, 2),
    distance: round(picture.distance, 4),
    width: picture.width,
    height: picture.height,
  });
  const pan = pan_text(picture.pan);
  if (pan) query.set("pan", pan);
  if (picture.moves) query.set("time", round(picture.time, 3));
  if (picture.fov) query.set("fov", round(picture.fov, 3));
  if (picture.technique) query.set("technique", picture.technique);
  if (picture.samples) query.set("samples", picture.samples);
  for (const [key, text] of new URLSearchParams(picture.more)) query.set(key, text);
  for (const budget of ["seconds", "error"]) if (picture[budget]) query.set(budget, picture[budget]);
  return query;
}

// Formats a pan with six significant digits, for scenes of any scale. Returns "" without a pan.
export function pan_text(pan) {
  return pan?.some(Boolean) ? pan.map((metres) => Number(metres.toPrecision(6)) + 0).join() : "";
}

export function round(value, digits) {
  return Number(value.toFixed(digits)) + 0; // + 0: no minus zero
}

export function frame_url(picture) {
  return picture.location ?? `v1/scenes/${picture.id}/frame.png?${query_of(picture)}`;
}

// Returns the address of the picture's refinement in passes.
export function refinement_url(picture) {
  return `v1/scenes/${picture.id}/refinement?${query_of(picture)}`;
}

// Returns the address of an orbit. `time_step`: seconds of the scene's motion per frame, 0 if nothing moves.
export function orbit_url(picture, { frames, fps, step, time_step }) {
  const query = query_of(picture);
  query.set("frames", frames);
  query.set("fps", fps);
  query.set("step", round(step, 5));
  if (time_step) query.set("time_step", round(time_step, 5));
  return `v1/scenes/${picture.id}/orbit?${query}`;
}

// Returns the body of POST v1/jobs for a picture.
export function job_body(picture) {
  const { azimuth, elevation, distance, fov, width, height, samples, time } = numbers_of(query_of(picture));
  const { technique, pan } = Object.fromEntries(query_of(picture));
  const more = [...new URLSearchParams(picture.more)].map(([key, text]) => [key, text === "" || isNaN(text) ? text : Number(text)]);
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
export function chart_body(picture, extent) {
  const { camera, image, render } = job_body({ ...picture, samples: undefined, more: undefined });
  return { camera, image, render: { ...render, samples: undefined }, chart: extent };
}

const numbers_of = (query) => Object.fromEntries([...query].map(([key, text]) => [key, Number(text)]));

export function file_name(name, view) {
  const plain = name.replace(/[^\w-]+/g, "-").slice(0, 40);
  return `${plain}-${Math.round(view.azimuth)}-${Math.round(view.elevation)}.png`;
}

// Returns a curl command. With `token`, the command reads the token from the environment.
export function curl_command(picture, name, base, token = "") {
  const address = new URL(frame_url(picture), base).href.replaceAll("'", "%27");
  const access = token ? '-H "Authorization: Bearer $ORRERY_TOKEN" ' : "";
  return `curl -fo ${file_name(name, picture)} ${access}'${address}'`;
}
