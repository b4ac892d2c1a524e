// Picture sizes in pixels.

const STREAM_PIXELS = 1e6; // PNG encoding and decoding limit the frame rate of larger streams

export const MODES = ["fit", "half", "scene", "1280x720", "1920x1080", "3840x2160"];

export function fixedSize(mode) {
  const match = /^(\d+)x(\d+)$/.exec(mode);
  return match ? { width: Number(match[1]), height: Number(match[2]) } : null;
}

// Shrinks a size to at most `side` per side and `pixels` in total. Keeps the aspect ratio.
export function within(size, side, pixels) {
  const factor = Math.min(1, side / Math.max(size.width, size.height), Math.sqrt(pixels / (size.width * size.height)));
  return {
    width: Math.max(1, Math.floor(size.width * factor + 1e-6)),
    height: Math.max(1, Math.floor(size.height * factor + 1e-6)),
  };
}

// Returns {width, height, fov, fills} for `purpose` "still", "stream" or "preview". `part` is a factor of
// each side. `fov`, a vertical angle in degrees, is set if the picture fills a box that is narrower than the
// scene's own picture. The angle is wider than the scene's, so that the sides stay in view.
export function pictureSize({ mode, purpose, box, pixelRatio, scene, limits, part = 1 }) {
  const own = { width: scene.width, height: scene.height };
  const fills = mode === "fit" || mode === "half";
  let size = fixedSize(mode) ?? own;
  let fov;
  if (fills) {
    const factor = pixelRatio * (mode === "half" ? 0.5 : 1);
    size = fit(own, { width: box.width * factor, height: box.height * factor }, scene.camera);
    fov = fovFor(own, size, scene.camera);
  }
  const most = purpose === "stream" && fills ? Math.min(STREAM_PIXELS, limits.pixels) : limits.pixels;
  size = within(size, limits.side, most);
  const width = Math.ceil(size.width * part);
  const height = Math.ceil(size.height * part);
  return { width, height, fov, fills };
}

const aspect = (size) => size.width / size.height;

// Orthographic views and panoramas have no angle to widen.
const hasAngle = (camera) => !["orthographic", "panorama"].includes(camera?.type);

// Returns the box. If the camera has no angle and the box is narrower than the scene's own picture, reduces
// the height to the scene's aspect ratio.
function fit(own, box, camera) {
  if (hasAngle(camera) || aspect(box) >= aspect(own)) return box;
  return { width: box.width, height: box.width / aspect(own) };
}

function fovFor(own, size, camera) {
  if (!hasAngle(camera) || aspect(size) >= aspect(own)) return undefined;
  const half = ((camera?.fov_degrees ?? 45) * Math.PI) / 360;
  return (Math.atan(Math.tan(half) * (aspect(own) / aspect(size))) * 360) / Math.PI;
}
