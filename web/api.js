// Requests to the service. Every failure becomes an ApiError, whatever its cause.

const kRetryable = new Set([0, 429, 502, 503]); // 0: no answer

// A refusal (problem+json of RFC 9457), or no answer at all: then status is 0.
export class ApiError extends Error {
  constructor(fields) {
    super(fields.title ?? "The request failed");
    this.name = "ApiError";
    this.status = fields.status ?? 0;
    this.title = this.message;
    this.detail = fields.detail ?? "";
    this.request_id = fields.request_id ?? "";
    this.errors = Array.isArray(fields.errors) ? fields.errors : [];
    this.offset = fields.offset;
    this.line = fields.line;
    this.column = fields.column;
    this.retry_after_seconds = fields.retry_after_seconds;
  }

  // Whether the same request may succeed later.
  get retryable() {
    return kRetryable.has(this.status);
  }
}

export function no_answer(detail = "") {
  return new ApiError({ status: 0, title: "The service does not answer", detail });
}

export function is_abort(error) {
  return error?.name === "AbortError";
}

async function problem_of(response) {
  const fields = { status: response.status, title: response.statusText || `Status ${response.status}` };
  try {
    Object.assign(fields, JSON.parse(await response.text()));
  } catch (error) {
    if (is_abort(error)) throw error; // else the body is no JSON: the status line has to do
  }
  const seconds = Number(response.headers.get("Retry-After"));
  return new ApiError({
    ...fields,
    status: response.status,
    request_id: fields.request_id ?? response.headers.get("X-Request-ID") ?? "",
    retry_after_seconds: seconds > 0 ? seconds : undefined,
  });
}

// fetch() that resolves only to a successful response. Throws ApiError, or AbortError once `signal` fires.
export async function request(path, options = {}) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    throw is_abort(error) ? error : no_answer(error.message);
  }
  if (!response.ok) throw await problem_of(response);
  return response;
}

export async function get_json(path) {
  return (await request(path, { headers: { Accept: "application/json" } })).json();
}

export async function get_text(path) {
  return (await request(path)).text();
}

// POST v1/scenes: {id, width, height, camera, objects, lights}.
export async function post_scene(text) {
  const headers = { "Content-Type": "application/json" };
  return (await request("v1/scenes", { method: "POST", headers, body: text })).json();
}

// Server-Timing as {name: milliseconds}.
export function server_timing(header) {
  const timing = {};
  for (const entry of (header ?? "").split(",")) {
    const duration = /;\s*dur=([\d.]+)/.exec(entry);
    if (duration) timing[entry.split(";")[0].trim()] = Number(duration[1]);
  }
  return timing;
}

// One picture: {png, stats}. A picture from the browser's cache carries the figures of its first rendering.
export async function get_frame(url, signal) {
  const response = await request(url, { signal });
  const timing = server_timing(response.headers.get("Server-Timing"));
  const rays = Number(response.headers.get("X-Rays") ?? NaN);
  try {
    return {
      png: await response.blob(),
      stats: { render_ms: timing.render, encode_ms: timing.encode, rays },
    };
  } catch (error) {
    throw is_abort(error) ? error : no_answer(error.message);
  }
}
