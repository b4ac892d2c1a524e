// Hint on the gestures that move the view, worded for mouse or touch.

const coarsePointer = matchMedia("(pointer: coarse)");
const shortScreen = matchMedia("(pointer: coarse) and (max-height: 500px)"); // same condition as in picture.css

function words() {
  if (shortScreen.matches) return "Drag sideways to turn, drag with two fingers to pan, pinch to zoom";
  if (coarsePointer.matches) return "Drag to turn, drag with two fingers to pan, pinch to zoom";
  return "Drag to turn, right-drag or Ctrl+drag to pan, scroll to zoom. Arrow keys turn, with Shift in small steps.";
}

export function attachHint(hint) {
  const show = () => (hint.textContent = words());
  for (const query of [coarsePointer, shortScreen]) query.addEventListener("change", show);
  show();
}
