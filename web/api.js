// Requests to the service. A failed request throws ApiError, an aborted request AbortError.

import { accessToken, bearer, askForToken } from "./access.js";

const RETRYABLE_STATUSES = new Set([0, 429, 502, 503]); // 0: no response

// Error response (problem+json of RFC 9457). Status 0 if there was no response.
export class ApiError extends Error {
  // Takes the members of a problem+json object.
  constructor({ title, status, detail, request_id: requestId, retry_after_seconds: retryAfterSeconds, ...more }) {
    super(title ?? "The request failed");
    this.name = "ApiError";
    this.title = this.message;
    this.status = status ?? 0;
    this.detail = detail ?? "";
    this.requestId = requestId ?? "";
    this.retryAfterSeconds = retryAfterSeconds;
    const { errors, line, column } = more;
    Object.assign(this, { errors, line, column }); // positions in a rejected text
  }

  // Returns whether the same request may succeed later.
  get retryable() {
    return RETRYABLE_STATUSES.has(this.status);
  }
}

export function connectionError(detail = "") {
  return new ApiError({ status: 0, title: "The service does not respond", detail });
}

export function isAbort(error) {
  return error?.name === "AbortError";
}

// Converts an error of fetch() or of reading a body. AbortError is kept, any other error becomes an ApiError
// with status 0.
export const toApiError = (error) => (isAbort(error) ? error : connectionError(error.message));

// Resolves to the error that the response of a failed request describes.
export async function problemOf(response) {
  const fields = { status: response.status, title: response.statusText || `Status ${response.status}` };
  try {
    Object.assign(fields, JSON.parse(await response.text()));
  } catch (error) {
    if (isAbort(error)) throw error; // else not JSON: keeps the text of the status line
  }
  const seconds = Number(response.headers.get("Retry-After"));
  return new ApiError({
    ...fields,
    status: response.status,
    request_id: fields.request_id ?? response.headers.get("X-Request-ID") ?? "",
    retry_after_seconds: seconds > 0 ? seconds : undefined,
  });
}

// Resolves to a successful response of fetch(). After status 401, asks the user for a token and repeats the
// request. Throws ApiError, or AbortError once `signal` fires.
export async function request(path, options = {}) {
  const token = accessToken();
  let response;
  try {
    response = await fetch(path, { ...options, headers: { ...options.headers, ...bearer() } });
  } catch (error) {
    throw toApiError(error);
  }
  if (response.ok) return response;
  if (response.status !== 401 || !(await askForToken(token))) throw await problemOf(response);
  options.signal?.throwIfAborted();
  return request(path, options);
}

export async function getText(path, options) {
  return whole((await request(path, options)).text());
}

export async function getJson(path, options) {
  return JSON.parse(await getText(path, options));
}

export function postJson(path, text) {
  const headers = { "Content-Type": "application/json" };
  return getJson(path, { method: "POST", headers, body: text });
}

// Resolves to a response body. Throws ApiError if the body is truncated.
const whole = (body) =>
  body.catch((error) => {
    throw toApiError(error);
  });

// Posts a scene. Resolves to {id, width, height, camera, objects, lights}.
export const postScene = (text) => postJson("v1/scenes", text);

// Parses a Server-Timing header into {name: milliseconds}.
export function serverTiming(header) {
  const timing = {};
  for (const entry of (header ?? "").split(",")) {
    const duration = /;\s*dur=([\d.]+)/.exec(entry);
    if (duration) timing[entry.split(";")[0].trim()] = Number(duration[1]);
  }
  return timing;
}

// Returns the service's warning about the picture in `response`, or "".
export const warningOf = (response) => response.headers.get("Orrery-Warning") ?? "";

// Fetches a picture as {png, stats}. A picture from the browser's cache has the figures of its first render.
export async function getFrame(url, signal) {
  const response = await request(url, { signal });
  const { render: renderMs, encode: encodeMs } = serverTiming(response.headers.get("Server-Timing"));
  const rays = Number(response.headers.get("Orrery-Rays") ?? NaN);
  const rmse = parseFloat(response.headers.get("Orrery-RMSE") ?? "") || undefined;
  const warning = warningOf(response);
  const bound = response.headers.get("Orrery-Error-Bound");
  const budget = response.headers.get("Orrery-Budget");
  const location = response.headers.get("Content-Location") ?? undefined;
  const png = await whole(response.blob());
  return { png, stats: { renderMs, encodeMs, rays, rmse, warning, bound, budget, location } };
}
