// The orbit camera: where the view is (`now`), where it is going (`goal`), and the glide between.
// Angles are degrees and relative to the scene's own view, `distance` is a factor of its eye's distance. With
// it goes the `time` of what moves in the scene, in seconds.

const kElevationLimit = 89.9; // at 90 the view direction would be parallel to up
const kDamping = 0.05; // part of the way to the goal covered in a sixtieth of a second
const kNearest = 0.02;
const kFarthest = 50;
const kSettledDegrees = 0.1;
const kSettledFactor = 0.001;

const own_view = () => ({ azimuth: 0, elevation: 0, distance: 1, time: 0 });
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const turn = (degrees) => ((degrees % 360) + 360) % 360;

// Degrees of the scene's own eye above the plane that `up` stands on.
export function elevation_of(camera) {
  if (!camera?.eye || !camera.look_at) return 0;
  const out = camera.eye.map((value, axis) => value - camera.look_at[axis]);
  const up = camera.up ?? [0, 1, 0];
  const product = out.reduce((sum, value, axis) => sum + value * up[axis], 0);
  const sine = product / (Math.hypot(...out) * Math.hypot(...up));
  return Number.isFinite(sine) ? (Math.asin(clamp(sine, -1, 1)) * 180) / Math.PI : 0;
}

export class OrbitCamera {
  damped = true; // false: every move is a jump (reduced motion)
  #now = own_view();
  #goal = own_view();
  #own_elevation = 0;

  // The scene's own elevation limits how far the view may rise and sink.
  use_scene_camera(camera) {
    this.#own_elevation = elevation_of(camera);
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
    const moving =
      Math.abs(goal.azimuth - now.azimuth) > kSettledDegrees ||
      Math.abs(goal.elevation - now.elevation) > kSettledDegrees ||
      Math.abs(goal.distance / now.distance - 1) > kSettledFactor;
    if (!moving) this.#now = { ...goal };
    return moving;
  }

  #allowed_elevation(elevation) {
    const own = this.#own_elevation;
    return clamp(elevation, Math.min(0, -kElevationLimit - own), Math.max(0, kElevationLimit - own));
  }
}
