// Requests to the service. Every failure but an abort throws ApiError.

import { access_token, bearer, other_token } from "./access.js";

const kRetryable = new Set([0, 429, 502, 503]); // 0: no response

// Error response (problem+json of RFC 9457), or no response at all: status 0.
export class ApiError extends Error {
  constructor(fields) {
    super(fields.title ?? "The request failed");
    this.name = "ApiError";
    // Optional fields from the service: errors, line and column, retry_after_seconds.
    Object.assign(this, { status: 0, detail: "", request_id: "" }, fields, { title: this.message });
  }

  // Returns whether the same request may succeed later.
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

// Returns the error to throw if a response breaks off with `error`.
export const broken = (error) => (is_abort(error) ? error : no_answer(error.message));

async function problem_of(response) {
  const fields = { status: response.status, title: response.statusText || `Status ${response.status}` };
  try {
    Object.assign(fields, JSON.parse(await response.text()));
  } catch (error) {
    if (is_abort(error)) throw error; // not JSON: falls back to the status line
  }
  const seconds = Number(response.headers.get("Retry-After"));
  return new ApiError({
    ...fields,
    status: response.status,
    request_id: fields.request_id ?? response.headers.get("X-Request-ID") ?? "",
    retry_after_seconds: seconds > 0 ? seconds : undefined,
  });
}

// Resolves to a successful response of fetch(). Throws ApiError, or AbortError once `signal` fires.
export async function request(path, options = {}) {
  const token = access_token();
  let response;
  try {
    response = await fetch(path, { ...options, headers: { ...options.headers, ...bearer() } });
  } catch (error) {
    throw broken(error);
  }
  if (response.ok) return response;
  if (response.status !== 401 || !(await other_token(token))) throw await problem_of(response);
  options.signal?.throwIfAborted();
  return request(path, options);
}

export async function get_text(path, options) {
  return whole((await request(path, options)).text());
}

export async function get_json(path, options) {
  return JSON.parse(await get_text(path, options));
}

export function post_json(path, text) {
  const headers = { "Content-Type": "application/json" };
  return get_json(path, { method: "POST", headers, body: text });
}

// Resolves to a response body. Throws ApiError if the body breaks off.
const whole = (body) =>
  body.catch((error) => {
    throw broken(error);
  });

// Posts a scene. Resolves to {id, width, height, camera, objects, lights}.
export const post_scene = (text) => post_json("v1/scenes", text);

// Parses a Server-Timing header into {name: milliseconds}.
export function server_timing(header) {
  const timing = {};
  for (const entry of (header ?? "").split(",")) {
    const duration = /;\s*dur=([\d.]+)/.exec(entry);
    if (duration) timing[entry.split(";")[0].trim()] = Number(duration[1]);
  }
  return timing;
}

// Returns the service's warning about a picture that shows little, or "".
export const warning_of = (response) => response.headers.get("Orrery-Warning") ?? "";

// Fetches a picture as {png, stats}. A picture from the browser's cache has the figures of its first render.
export async function get_frame(url, signal) {
  const response = await request(url, { signal });
  const { render: render_ms, encode: encode_ms } = server_timing(response.headers.get("Server-Timing"));
  const rays = Number(response.headers.get("X-Rays") ?? NaN);
  const rmse = parseFloat(response.headers.get("X-RMSE") ?? "") || undefined;
  const warning = warning_of(response);
  const bound = response.headers.get("Orrery-Error-Bound");
  const budget = response.headers.get("Orrery-Budget");
  const location = response.headers.get("Content-Location") ?? undefined;
  const png = await whole(response.blob());
  return { png, stats: { render_ms, encode_ms, rays, rmse, warning, bound, budget, location } };
}
