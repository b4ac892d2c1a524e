// Hint on the gestures that move the view, worded for mouse or touch.

const kFingers = matchMedia("(pointer: coarse)");
const kScrolls = matchMedia("(pointer: coarse) and (max-height: 500px)"); // same condition as in picture.css

function words() {
  if (kScrolls.matches) return "Drag sideways to turn, two fingers to move, pinch to zoom";
  if (kFingers.matches) return "Drag to turn, two fingers to move, pinch to zoom";
  return "Drag to turn, ctrl or right button to move, wheel to zoom; arrow keys too, with shift finely";
}

export function attach_hint(hint) {
  const show = () => (hint.textContent = words());
  for (const query of [kFingers, kScrolls]) query.addEventListener("change", show);
  show();
}
