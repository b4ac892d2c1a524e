// Camera moves from pointer, touch, wheel and keyboard input on the stage.
// `on` has
//   rotate(azimuth, elevation) in degrees
//   dolly(factor) -> the applied factor
//   pan(right, up), motion of the camera in pixels
//   isPanning() -> whether plain drags and arrows pan
//   reset(), togglePlay(), hold(bool)

const DOLLY_STEP = 0.95; // distance factor of a wheel notch
export const ZOOM_STEP = DOLLY_STEP ** 3; // distance factor of a key or a button
export const TURN_STEP = 180 / 8; // degrees for an arrow key or a button
export const PAN_STEP = 1 / 8; // fraction of the stage's height for an arrow key or a button
const FINE_FACTOR = 1 / 22.5; // factor of a step with Shift: turns by one degree
const DRAG_THRESHOLD = 3; // pixels; a shorter drag is a click
const WHEEL_NOTCH = 100; // pixels of wheel movement that count as one step
const PINCH_GAIN = 8; // a trackpad pinch arrives as small wheel movements with ctrlKey

export function attachControls(stage, on) {
  attachPointers(stage, on);
  attachWheel(stage, on);
  attachKeys(stage, on);
  stage.addEventListener("dblclick", () => on.reset());
}

// Moves the view by one step of an arrow key or button. `right` and `up` are -1, 0 or 1.
export function step(stage, on, right, up, { pans, fine }) {
  const size = (pans ? PAN_STEP * stage.clientHeight : TURN_STEP) * (fine ? FINE_FACTOR : 1);
  if (pans) on.pan(right * size, up * size);
  else on.rotate(right * size, up * size);
}

function attachPointers(stage, on) {
  const pointers = new Map(); // id -> {x, y}
  let dragging = false;
  let pans = false;

  // Returns the distance between two fingers, and their midpoint relative to the middle of the stage.
  const pinch = () => {
    const [a, b] = [...pointers.values()];
    const { left, top, width, height } = stage.getBoundingClientRect();
    const x = (a.x + b.x) / 2 - (left + width / 2);
    const y = (a.y + b.y) / 2 - (top + height / 2);
    return { gap: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)), x, y };
  };

  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  stage.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse" && event.button !== 0 && event.button !== 2) return;
    stage.setPointerCapture(event.pointerId);
    pans = (event.button === 2 || event.shiftKey || event.ctrlKey || event.metaKey) !== on.isPanning();
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });

  stage.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x;
    const dy = event.clientY - last.y;
    if (!dragging && Math.hypot(dx, dy) < DRAG_THRESHOLD) return;
    if (!dragging && Math.abs(dy) > Math.abs(dx) && scrollsPage(stage, event)) return;
    if (!dragging) {
      dragging = true;
      on.hold(true);
    }
    const before = pointers.size === 2 ? pinch() : null;
    last.x = event.clientX;
    last.y = event.clientY;
    const degreesPerPixel = 360 / stage.clientHeight;
    if (before) {
      const after = pinch();
      const factor = on.dolly(before.gap / after.gap);
      on.pan(before.x / factor - after.x, after.y - before.y / factor); // keeps the scene under the fingers
    } else if (pans) {
      on.pan(-dx, dy);
    } else {
      on.rotate(-dx * degreesPerPixel, dy * degreesPerPixel);
    }
  });

  const release = (event) => {
    if (!pointers.delete(event.pointerId) || pointers.size > 0 || !dragging) return;
    dragging = false;
    on.hold(false);
  };
  stage.addEventListener("pointerup", release);
  stage.addEventListener("pointercancel", release);
  stage.addEventListener("lostpointercapture", release);
}

// Returns whether a vertical touch drag scrolls the page. The browser then soon cancels the pointer.
function scrollsPage(stage, { pointerType }) {
  return pointerType === "touch" && getComputedStyle(stage).touchAction === "pan-y";
}

function attachWheel(stage, on) {
  const pixelsPerUnit = [1, 16, 400]; // by deltaMode: pixels, lines, pages
  stage.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * pixelsPerUnit[event.deltaMode] * (event.ctrlKey ? PINCH_GAIN : 1);
      const steps = Math.max(-3, Math.min(3, pixels / WHEEL_NOTCH));
      if (steps !== 0) on.dolly(DOLLY_STEP ** -steps);
    },
    { passive: false },
  );
}

// Handles keys on the stage and, if the page does not scroll, on the body. Ignores keys in form fields. Space
// plays and pauses even if the page scrolls.
function attachKeys(stage, on) {
  const arrow = (right, up) => (event) =>
    step(stage, on, right, up, { pans: event.ctrlKey !== on.isPanning(), fine: event.shiftKey });
  const actions = {
    ArrowLeft: arrow(-1, 0),
    ArrowRight: arrow(1, 0),
    ArrowUp: arrow(0, 1),
    ArrowDown: arrow(0, -1),
    PageUp: () => on.dolly(ZOOM_STEP),
    PageDown: () => on.dolly(1 / ZOOM_STEP),
    "+": () => on.dolly(ZOOM_STEP),
    "=": () => on.dolly(ZOOM_STEP),
    "-": () => on.dolly(1 / ZOOM_STEP),
    0: () => on.reset(),
    " ": () => on.togglePlay(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.target !== stage && event.target !== document.body) return;
    if (event.target !== stage && event.key !== " " && pageScrolls()) return;
    if (event.altKey || event.metaKey || (event.ctrlKey && !event.key.startsWith("Arrow"))) return;
    const action = actions[event.key];
    if (!action || (event.key === " " && event.repeat)) return;
    event.preventDefault();
    action(event);
  });
}

function pageScrolls() {
  return document.documentElement.scrollHeight > innerHeight;
}
