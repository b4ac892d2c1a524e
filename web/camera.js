// Orbit camera: the current view (`now`), its target (`goal`) and the glide between them. Degrees are
// relative to the scene's own view. `distance` is a factor of the scene's own distance. `pan` moves eye and
// target along the scene's axes, in metres. `time` is the time of the scene's motion in seconds.

const ELEVATION_LIMIT = 89.9; // degrees; at 90 the view direction would be parallel to up
const DAMPING = 0.05; // fraction of the way to the goal per 1/60 s
const MIN_PIXELS = 1; // pixels added per 1/60 s, so that the glide ends
const MIN_DISTANCE = 0.02;
const MAX_DISTANCE = 50;
const FLOOR_CLEARANCE = 0.01; // smallest height above the floor, as a fraction of the scene's own distance

const defaultView = () => ({ azimuth: 0, elevation: 0, distance: 1, pan: [0, 0, 0], time: 0 });
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const turn = (degrees) => ((degrees % 360) + 360) % 360;
const radians = (degrees) => (degrees * Math.PI) / 180;
const degrees = (angle) => (angle * 180) / Math.PI;
const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
const mix = (a, p, b, q) => a.map((value, axis) => p * value + q * b[axis]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

// Returns the coordinate frame of the scene's own camera:
// `elevation`: degrees of the eye above the plane with the normal `pole`
// `out`, `side`: unit vectors in this plane, towards the eye and to its right
// `metres`: distance from eye to target
// `level`: height of the target along `pole`
function frameOf({ eye = [0, 0, 4], look_at: lookAt = [0, 0, 0], up = [0, 1, 0] } = {}) {
  const offset = mix(eye, 1, lookAt, -1);
  const pole = unit(up);
  const direction = unit(offset);
  const sine = clamp(dot(direction, pole), -1, 1);
  const out = unit(mix(direction, 1, pole, -sine));
  const elevation = degrees(Math.asin(sine));
  const level = dot(lookAt, pole);
  return { pole, elevation, out, side: cross(pole, out), metres: Math.hypot(...offset), level };
}

// Returns the elevation of the scene's own eye above the plane with the normal `up`, in degrees.
export const elevationOf = (camera) => frameOf(camera).elevation;

export class OrbitCamera {
  damped = true; // false: every move is a jump (reduced motion)
  #now = defaultView();
  #goal = defaultView();
  #scene = undefined;
  #own = frameOf();
  #floor = -Infinity;

  // Sets the scene's own camera and the height of the scene's floor along `up` (see floor.js). Both limit the
  // elevation of the view.
  useSceneCamera(camera, floor = -Infinity) {
    this.#scene = camera;
    this.#own = frameOf(camera);
    this.#floor = floor;
  }

  get view() {
    return { ...this.#now, azimuth: turn(this.#now.azimuth) };
  }

  get goal() {
    return { ...this.#goal, azimuth: turn(this.#goal.azimuth) };
  }

  rotate(azimuth, elevation) {
    this.#goal.azimuth += azimuth;
    this.#goal.elevation += elevation;
    this.#keepAllowed();
  }

  // Multiplies the distance by `factor`. Returns the factor applied after clamping to the distance limits.
  dolly(factor) {
    const { distance } = this.#goal;
    this.#goal.distance *= factor;
    this.#keepAllowed();
    return this.#goal.distance / distance;
  }

  // Moves eye and target of the goal parallel to its picture plane. `right` and `up`: fractions of the
  // picture's height at the target's distance. `fov`: vertical angle in degrees if it differs from the
  // scene's own.
  pan(right, up, fov) {
    const { azimuth, elevation, distance } = this.#goal;
    const { pole, out, side } = this.#own;
    const turned = radians(azimuth);
    const lifted = radians(this.#own.elevation + elevation);
    const cameraRight = mix(side, Math.cos(turned), out, -Math.sin(turned));
    const cameraUp = mix(pole, Math.cos(lifted), cross(cameraRight, pole), -Math.sin(lifted));
    const height = this.#shownMetres(distance, fov);
    const move = mix(cameraRight, right * height, cameraUp, up * height);
    this.#goal.pan = mix(this.#goal.pan, 1, move, 1);
    this.#keepAllowed();
  }

  // Glides back to the scene's own view along the shorter arc.
  reset() {
    const { azimuth, time } = this.#now;
    this.#goal = { ...defaultView(), azimuth: 360 * Math.round(azimuth / 360), time };
  }

  jump({ azimuth, elevation, distance, pan = [0, 0, 0], time = 0 }) {
    this.#goal = { azimuth: turn(azimuth), elevation, distance, pan, time };
    this.#keepAllowed();
    this.#now = { ...this.#goal };
  }

  // Jumps to the azimuth and time of a streamed frame.
  follow(azimuth, time) {
    this.#now.azimuth = this.#goal.azimuth = turn(azimuth);
    this.#now.time = this.#goal.time = time;
  }

  // Advances the glide by `seconds` in a picture `pixels` high. Returns whether the view still moves.
  step(seconds, pixels) {
    const now = this.#now;
    const goal = this.#goal;
    const left = pixels * this.#heightsLeft();
    const least = left > 0 ? (MIN_PIXELS * 60 * seconds) / left : 1;
    const part = this.damped ? Math.min(1, 1 - (1 - DAMPING) ** (60 * seconds) + least) : 1;
    if (part === 1) {
      this.#now = { ...goal };
      return false;
    }
    now.azimuth += (goal.azimuth - now.azimuth) * part;
    now.elevation += (goal.elevation - now.elevation) * part;
    now.distance *= (goal.distance / now.distance) ** part;
    now.pan = mix(now.pan, 1 - part, goal.pan, part);
    return true;
  }

  // Returns the remaining motion, in picture heights, of points at the picture's edge and the target's
  // distance.
  #heightsLeft() {
    const now = this.#now;
    const goal = this.#goal;
    const turned = Math.hypot(radians(goal.azimuth - now.azimuth), radians(goal.elevation - now.elevation)) / 2;
    const zoomed = Math.abs(Math.log(goal.distance / now.distance)) / 2;
    return Math.max(turned, zoomed, Math.hypot(...mix(goal.pan, 1, now.pan, -1)) / this.#shownMetres(now.distance));
  }

  // Returns the metres that the picture's height covers at `distance`, a factor of the scene's own distance.
  // `fov` as in pan().
  #shownMetres(distance, fov = this.#scene?.fov_degrees ?? 45) {
    if (this.#scene?.type === "orthographic") return distance * (this.#scene.height ?? 2);
    return distance * 2 * this.#own.metres * Math.tan(radians(fov / 2));
  }

  // Clamps the goal. Keeps the distance within its limits, and the eye off the poles and above the floor.
  #keepAllowed() {
    const { elevation: own, metres, pole, level } = this.#own;
    const goal = this.#goal;
    goal.distance = clamp(goal.distance, MIN_DISTANCE, MAX_DISTANCE);
    const highest = Math.max(0, ELEVATION_LIMIT - own);
    let lowest = Math.min(0, -ELEVATION_LIMIT - own);
    if (this.#floor > -Infinity) {
      const ownHeight = level + metres * Math.sin(radians(own));
      const minHeight = Math.min(this.#floor + FLOOR_CLEARANCE * metres, ownHeight);
      const sine = (minHeight - level - dot(goal.pan, pole)) / (metres * goal.distance);
      lowest = clamp(degrees(Math.asin(clamp(sine, -1, 1))) - own, lowest, highest);
    }
    goal.elevation = clamp(goal.elevation, lowest, highest);
  }
}
