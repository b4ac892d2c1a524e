// Pictures and charts rendered as jobs, whose progress the service reports by tile.

import { ApiError, get_frame, get_json, get_text, no_answer, post_json, request } from "./api.js";
import { chunks } from "./stream.js";
import { chart_body, job_body } from "./urls.js";

// Renders a picture as a job. Returns {png, stats}, or null if the service accepts no jobs. Calls
// `tell({part, seconds_left})` on progress. Cancels the job if it has not ended. Throws ApiError, or
// AbortError once `signal` fires.
export async function render_job(picture, signal, tell) {
  const address = await post_job("v1/jobs", job_body(picture));
  if (!address) return null;
  const job = await follow_job(address, signal, tell);
  const { png, stats } = await get_frame(`${address}/frames/0.png`, signal);
  return { png, stats: { ...stats, render_ms: stats.render_ms ?? 1000 * job.elapsed_s } };
}

// Makes a chart of speed and accuracy. Returns {chart, drawing} as JSON and SVG, or null if the service makes
// no charts. Times are predicted for the size of `picture`. The chart's own pictures are `extent.width`
// pixels wide. Progress and errors as in render_job().
export async function make_chart(picture, extent, signal, tell) {
  const address = await post_job(`v1/scenes/${picture.id}/charts`, chart_body(picture, extent));
  if (!address) return null;
  const job = await follow_job(address, signal, tell);
  const [chart, drawing] = await Promise.all([
    get_json(job.chart.replace(/svg$/, "json"), { signal }),
    get_text(job.chart, { signal }),
  ]);
  return { chart, drawing };
}

// Follows a job to its end. Returns its last state.
async function follow_job(address, signal, tell) {
  let over = false;
  try {
    signal.throwIfAborted();
    for await (const job of job_states(`${address}/events`, signal)) {
      over = !["waiting", "running"].includes(job.state);
      if (over && job.state !== "done") throw new ApiError(job.error ?? { title: `The job was ${job.state}` });
      if (job.tiles > 0) tell({ part: job.tiles_done / job.tiles, seconds_left: job.remaining_s });
      if (over) return job;
    }
    throw no_answer("The job's events broke off.");
  } finally {
    if (!over) request(address, { method: "DELETE", keepalive: true }).catch(() => {});
  }
}

// Returns the address of the posted job, or null if the service accepts none. Takes no abort signal: only the
// response names the job to cancel.
async function post_job(path, body) {
  try {
    return `v1/jobs/${(await post_json(path, JSON.stringify(body))).id}`;
  } catch (error) {
    if ([403, 405].includes(error.status) || (path === "v1/jobs" && error.status === 404)) return null;
    throw error;
  }
}

// Yields the data of server-sent events.
async function* job_states(path, signal) {
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
