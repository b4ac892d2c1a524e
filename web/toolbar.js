// Buttons and speed slider under the picture.

const ARROWS = ["left", "right", "up", "down"];

// Attaches the buttons with data-do: a click calls the function of `actions` with that name. Moving the
// slider `speed` calls `onSpeed(degreesPerSecond)`.
export function attachToolbar(store, actions, onSpeed) {
  const [play, pan, speed, speedText] = ["play", "pan", "speed", "speed-text"].map((id) => document.getElementById(id));
  for (const button of document.querySelectorAll("[data-do]")) {
    button.addEventListener("click", actions[button.dataset.do]);
  }
  speed.addEventListener("input", () => onSpeed(Number(speed.value)));

  store.subscribe(["playing"], ({ playing }) => {
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.classList.toggle("playing", playing);
  });
  store.subscribe(["speed"], (values) => {
    speed.value = values.speed;
    speedText.textContent = `${values.speed}°/s`;
  });
  store.subscribe(["panning"], ({ panning }) => {
    pan.setAttribute("aria-pressed", String(panning));
    for (const name of ARROWS) {
      const button = document.querySelector(`[data-do="${name}"]`);
      button.ariaLabel = `${panning ? "Pan" : "Turn"} ${name}`;
      button.title = `${button.ariaLabel} (arrow key; Shift: small step)`;
    }
  });
}
