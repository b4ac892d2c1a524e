// Pictures and charts rendered as jobs, whose progress the service reports by tile.

import { ApiError, getFrame, getJson, getText, connectionError, postJson, request } from "./api.js";
import { chunks } from "./stream.js";
import { chartBody, jobBody } from "./urls.js";

// Renders a picture as a job. Returns {png, stats}, or null if the service accepts no jobs. Calls
// `onProgress({part, secondsLeft})` on progress. Throws ApiError, or AbortError once `signal` fires. Cancels
// an unfinished job before it throws.
export async function renderJob(picture, signal, onProgress) {
  const address = await postJob("v1/jobs", jobBody(picture));
  if (!address) return null;
  const job = await followJob(address, signal, onProgress);
  const { png, stats } = await getFrame(`${address}/frames/0.png`, signal);
  return { png, stats: { ...stats, renderMs: stats.renderMs ?? 1000 * job.elapsed_s } };
}

// Makes a chart of speed and accuracy. Returns {chart, drawing} as JSON and SVG, or null if the service makes
// no charts. Times are predicted for the size of `picture`. The chart's own pictures are `extent.width`
// pixels wide. Progress and errors as in renderJob().
export async function makeChart(picture, extent, signal, onProgress) {
  const address = await postJob(`v1/scenes/${picture.id}/charts`, chartBody(picture, extent));
  if (!address) return null;
  const job = await followJob(address, signal, onProgress);
  const [chart, drawing] = await Promise.all([
    getJson(job.chart.replace(/svg$/, "json"), { signal }),
    getText(job.chart, { signal }),
  ]);
  return { chart, drawing };
}

// Waits until the job at the URL `address` is done. Returns its last state. Errors and cancellation as in
// renderJob().
async function followJob(address, signal, onProgress) {
  let over = false;
  try {
    signal.throwIfAborted();
    for await (const job of jobStates(`${address}/events`, signal)) {
      over = !["waiting", "running"].includes(job.state);
      if (over && job.state !== "done") throw new ApiError(job.error ?? { title: `The job was ${job.state}` });
      if (job.tiles > 0) onProgress({ part: job.tiles_done / job.tiles, secondsLeft: job.remaining_s });
      if (over) return job;
    }
    throw connectionError("The event stream of the job ended early.");
  } finally {
    if (!over) request(address, { method: "DELETE", keepalive: true }).catch(() => {});
  }
}

// Returns the URL of the posted job, or null if the service accepts no such jobs. Takes no abort signal: only
// the response names the job to cancel.
async function postJob(path, body) {
  try {
    return `v1/jobs/${(await postJson(path, JSON.stringify(body))).id}`;
  } catch (error) {
    if ([403, 405].includes(error.status) || (path === "v1/jobs" && error.status === 404)) return null;
    throw error;
  }
}

// Yields the parsed JSON data of each server-sent event.
async function* jobStates(path, signal) {
  const { body } = await request(path, { headers: { Accept: "text/event-stream" }, signal });
  const decoder = new TextDecoder();
  let text = "";
  for await (const chunk of chunks(body)) {
    text += decoder.decode(chunk, { stream: true });
    const events = text.split(/\r?\n\r?\n/);
    text = events.pop();
    for (const event of events) {
      const data = /^data: ?(.*)$/m.exec(event);
      if (data) yield JSON.parse(data[1]);
    }
  }
}
