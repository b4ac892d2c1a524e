// One picture as a job of the service: its progress is measured there, tile by tile.

import { ApiError, get_frame, no_answer, post_json, request } from "./api.js";
import { chunks } from "./stream.js";
import { job_body } from "./urls.js";

// Returns {png, stats}, or null where the service takes no jobs. `tell({part, seconds_left})` hears how far it is.
// The job is cancelled unless it ended. Throws ApiError, or AbortError once `signal` fires.
export async function render_job(picture, signal, tell) {
  const address = await post_job(picture);
  if (!address) return null;
  let over = false;
  try {
    signal.throwIfAborted();
    for await (const job of job_states(`${address}/events`, signal)) {
      over = !["waiting", "running"].includes(job.state);
      if (over && job.state !== "done") throw new ApiError(job.error ?? { title: `The picture was ${job.state}` });
      if (job.tiles > 0) tell({ part: job.tiles_done / job.tiles, seconds_left: job.remaining_s });
      if (!over) continue;
      const { png, stats } = await get_frame(`${address}/frames/0.png`, signal);
      return { png, stats: { ...stats, render_ms: stats.render_ms ?? 1000 * job.elapsed_s } };
    }
    throw no_answer("The job's events broke off.");
  } finally {
    if (!over) request(address, { method: "DELETE", keepalive: true }).catch(() => {});
  }
}

// Not to be aborted: only its answer names the job that is then to be cancelled.
async function post_job(picture) {
  try {
    return `v1/jobs/${(await post_json("v1/jobs", JSON.stringify(job_body(picture)))).id}`;
  } catch (error) {
    if ([403, 404, 405].includes(error.status)) return null;
    throw error;
  }
}

// The data of server-sent events.
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
