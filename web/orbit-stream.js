// Plays one orbit stream and always shows its newest frame.

import { ApiError, request, warningOf } from "./api.js";
import { figuresOf, FRAME_TYPE, readFrames } from "./stream.js";
import { decode } from "./view.js";

// Calls `show(bitmap, figures)` for the frames of `url` until the stream ends or `show` returns false.
// figures.skipped counts the frames dropped by the service and by the page. figures.warning is the warning of
// the response. Throws ApiError, or AbortError once `signal` fires.
export async function playStream(url, signal, show) {
  const response = await request(url, { headers: { Accept: FRAME_TYPE }, signal });
  const warning = warningOf(response);
  const playing = { newest: null, busy: false, over: false, failure: null, late: 0 };
  let seen = 0;
  for await (const frame of readFrames(response.body)) {
    if (playing.newest) playing.late += 1;
    playing.newest = { png: frame.png, figures: { ...figuresOf(frame.header), warning } };
    seen += 1;
    if (!playing.busy) showNewest(playing, signal, show);
    if (playing.failure) throw playing.failure;
    if (playing.over) return;
  }
  if (seen === 0) throw new ApiError({ status: 0, title: "The stream ended before its first frame" });
}

async function showNewest(playing, signal, show) {
  playing.busy = true;
  try {
    while (playing.newest && !playing.over) {
      const { figures, png } = playing.newest;
      playing.newest = null;
      const bitmap = await decode(png);
      if (signal.aborted) return bitmap.close();
      playing.over = !show(bitmap, { ...figures, skipped: (figures.skipped ?? 0) + playing.late });
    }
  } catch (error) {
    playing.failure = error;
  } finally {
    playing.busy = false;
  }
}
