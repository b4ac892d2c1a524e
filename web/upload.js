// Uploads with progress, which fetch() does not report.

import { accessToken, askForToken, bearer } from "./access.js";
import { connectionError, problemOf } from "./api.js";

// Posts `blob`. Calls `progress(part)` with the fraction of the bytes that were sent. Resolves to a successful
// Response. After status 401, asks the user for a token and repeats the request. Throws ApiError, or
// AbortError once `signal` fires.
export async function upload(path, blob, signal, progress) {
  const token = accessToken();
  const response = await send(path, blob, signal, progress);
  if (response.ok) return response;
  if (response.status !== 401 || !(await askForToken(token))) throw await problemOf(response);
  signal.throwIfAborted();
  return upload(path, blob, signal, progress);
}

function send(path, blob, signal, progress) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", path);
    request.responseType = "blob";
    const headers = { "Content-Type": "application/octet-stream", ...bearer() };
    for (const [name, value] of Object.entries(headers)) request.setRequestHeader(name, value);
    request.upload.addEventListener("progress", ({ loaded, total }) => progress(total > 0 ? loaded / total : 1));
    request.addEventListener("load", () => resolve(responseOf(request)));
    request.addEventListener("error", () => reject(connectionError()));
    request.addEventListener("abort", () => reject(signal.reason));
    signal.addEventListener("abort", () => request.abort(), { once: true });
    request.send(blob);
  });
}

function responseOf(request) {
  const lines = request.getAllResponseHeaders().trim().split("\r\n");
  const headers = lines.map((line) => [line.slice(0, line.indexOf(":")), line.slice(line.indexOf(":") + 1)]);
  const { status, statusText, response } = request;
  return new Response(status === 204 ? null : response, { status, statusText, headers });
}
