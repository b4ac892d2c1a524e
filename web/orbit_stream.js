// Player of one orbit stream, which always shows the newest frame.

import { ApiError, request, warning_of } from "./api.js";
import { kFrameType, read_frames } from "./stream.js";
import { decode } from "./view.js";

// Calls `show(bitmap, header)` for the frames of `url` until the stream ends or `show` returns false.
// header.skipped includes frames dropped here. header.warning is that of the response. Throws ApiError, or
// AbortError once `signal` fires.
export async function play_stream(url, signal, show) {
  const response = await request(url, { headers: { Accept: kFrameType }, signal });
  const warning = warning_of(response);
  const playing = { newest: null, busy: false, over: false, failure: null, late: 0 };
  let seen = 0;
  for await (const frame of read_frames(response.body)) {
    if (playing.newest) playing.late += 1;
    playing.newest = { ...frame, header: { ...frame.header, warning } };
    seen += 1;
    if (!playing.busy) show_newest(playing, signal, show);
    if (playing.failure) throw playing.failure;
    if (playing.over) return;
  }
  if (seen === 0) throw new ApiError({ status: 0, title: "The stream ended before its first frame" });
}

async function show_newest(playing, signal, show) {
  playing.busy = true;
  try {
    while (playing.newest && !playing.over) {
      const { header, png } = playing.newest;
      playing.newest = null;
      const bitmap = await decode(png);
      if (signal.aborted) return bitmap.close();
      playing.over = !show(bitmap, { ...header, skipped: (header.skipped ?? 0) + playing.late });
    }
  } catch (error) {
    playing.failure = error;
  } finally {
    playing.busy = false;
  }
}
