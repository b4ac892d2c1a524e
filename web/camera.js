// The orbit camera: where the view is (`now`), where it is going (`goal`), and the glide between.
// Degrees relative to the scene's own view, `distance` as a factor of its own, `pan` in metres by which eye and
// target move along the scene's axes, and the `time` of what moves in it, in seconds.

const kElevationLimit = 89.9; // at 90 the view direction would be parallel to up
const kDamping = 0.05; // part of the way to the goal covered in a sixtieth of a second
const kNearest = 0.02;
const kFarthest = 50;
const kSettledDegrees = 0.1;
const kSettledFactor = 0.001; // of the distance

const own_view = () => ({ azimuth: 0, elevation: 0, distance: 1, pan: [0, 0, 0], time: 0 });
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const turn = (degrees) => ((degrees % 360) + 360) % 360;
const radians = (degrees) => (degrees * Math.PI) / 180;
const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
const mix = (a, p, b, q) => a.map((value, axis) => p * value + q * b[axis]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

// Of the scene's own camera: {pole, elevation, out, side, metres}: degrees of its eye over the plane that `pole`
// stands on; `out` and `side` lie in this plane, towards the eye and to its right; metres from eye to target.
function frame_of({ eye = [0, 0, 4], look_at = [0, 0, 0], up = [0, 1, 0] } = {}) {
  const offset = mix(eye, 1, look_at, -1);
  const pole = unit(up);
  const direction = unit(offset);
  const sine = clamp(dot(direction, pole), -1, 1);
  const out = unit(mix(direction, 1, pole, -sine));
  const elevation = (Math.asin(sine) * 180) / Math.PI;
  return { pole, elevation, out, side: cross(pole, out), metres: Math.hypot(...offset) };
}

// Degrees of the scene's own eye above the plane that `up` stands on.
export const elevation_of = (camera) => frame_of(camera).elevation;

export class OrbitCamera {
  damped = true; // false: every move is a jump (reduced motion)
  #now = own_view();
  #goal = own_view();
  #scene = undefined;
  #own = frame_of();

  // The scene's own elevation limits how far the view may rise and sink.
  use_scene_camera(camera) {
    this.#scene = camera;
    this.#own = frame_of(camera);
  }

  get view() {
    return { ...this.#now, azimuth: turn(this.#now.azimuth) };
  }

  get goal() {
    return { ...this.#goal, azimuth: turn(this.#goal.azimuth) };
  }

  rotate(azimuth, elevation) {
    this.#goal.azimuth += azimuth;
    this.#goal.elevation = this.#allowed_elevation(this.#goal.elevation + elevation);
  }

  dolly(factor) {
    this.#goal.distance = clamp(this.#goal.distance * factor, kNearest, kFarthest);
  }

  // Moves eye and target in the picture's plane, by parts of the height that the picture shows at the target's
  // distance. `fov` is the picture's angle where it is not the scene's own.
  pan(right, up, fov) {
    const { distance, azimuth, elevation } = this.#now;
    const { pole, out, side, metres } = this.#own;
    const turned = radians(azimuth);
    const lifted = radians(this.#own.elevation + elevation);
    const camera_right = mix(side, Math.cos(turned), out, -Math.sin(turned));
    const camera_up = mix(pole, Math.cos(lifted), cross(camera_right, pole), -Math.sin(lifted));
    const half = radians((fov ?? this.#scene?.fov_degrees ?? 45) / 2);
    const flat = this.#scene?.type === "orthographic";
    const height = distance * (flat ? (this.#scene.height ?? 2) : 2 * metres * Math.tan(half));
    const move = mix(camera_right, right * height, camera_up, up * height);
    this.#goal.pan = mix(this.#goal.pan, 1, move, 1);
  }

  // Glides back to the scene's own view, the short way round.
  reset() {
    const { azimuth, time } = this.#now;
    this.#goal = { ...own_view(), azimuth: 360 * Math.round(azimuth / 360), time };
  }

  jump(view) {
    this.#now = {
      azimuth: turn(view.azimuth),
      elevation: this.#allowed_elevation(view.elevation),
      distance: clamp(view.distance, kNearest, kFarthest),
      pan: view.pan ?? [0, 0, 0],
      time: view.time ?? 0,
    };
    this.#goal = { ...this.#now };
  }

  // Takes over where a streamed frame was.
  follow(azimuth, time) {
    this.#now.azimuth = this.#goal.azimuth = turn(azimuth);
    this.#now.time = this.#goal.time = time;
  }

  // Moves on by `seconds`. Returns whether the view still moves.
  step(seconds) {
    const now = this.#now;
    const goal = this.#goal;
    const part = this.damped ? 1 - (1 - kDamping) ** (60 * seconds) : 1;
    now.azimuth += (goal.azimuth - now.azimuth) * part;
    now.elevation += (goal.elevation - now.elevation) * part;
    now.distance *= (goal.distance / now.distance) ** part;
    now.pan = mix(now.pan, 1 - part, goal.pan, part);
    const moving =
      Math.abs(goal.azimuth - now.azimuth) > kSettledDegrees ||
      Math.abs(goal.elevation - now.elevation) > kSettledDegrees ||
      Math.abs(goal.distance / now.distance - 1) > kSettledFactor ||
      Math.hypot(...mix(goal.pan, 1, now.pan, -1)) > kSettledFactor * this.#own.metres * now.distance;
    if (!moving) this.#now = { ...goal };
    return moving;
  }

  #allowed_elevation(elevation) {
    const own = this.#own.elevation;
    return clamp(elevation, Math.min(0, -kElevationLimit - own), Math.max(0, kElevationLimit - own));
  }
}
