// Floor of a scene: an opaque plane perpendicular to the camera's up, below the scene's own eye.

const MIN_COSINE = 0.9999; // cosine of the largest angle between the plane's normal and up

const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
const unit = (a) => a.map((value) => value / Math.hypot(...a));

// Returns the height along up of the highest floor in a scene's JSON, or -Infinity without a floor.
export function floorHeight({ objects = [], materials = {} }, { eye, up = [0, 1, 0] }) {
  const pole = unit(up);
  const heights = objects
    .filter(({ type, material }) => type === "plane" && materials[material]?.type !== "refractive")
    .filter(({ normal }) => Math.abs(dot(unit(normal), pole)) > MIN_COSINE)
    .map(({ point }) => dot(point, pole));
  return Math.max(...heights.filter((height) => height < dot(eye, pole)));
}
