// Download link and curl command of the current picture.

import { accessToken } from "./access.js";
import { getFrame } from "./api.js";
import { curlCommand, fileName, frameUrl } from "./urls.js";

const FEEDBACK_MS = 2000;

// Attaches the download link. `current()` returns {picture, name} of the stage, or null. A link cannot send
// an access token, so with a token a click fetches the picture and saves it. Calls `failed(error)` if the
// fetch fails. Returns a function that refreshes the link.
export function attachDownload(link, current, failed) {
  const refresh = () => {
    const now = current();
    if (!now) return link.removeAttribute("href");
    const { width, height, samples } = now.picture;
    link.href = frameUrl(now.picture);
    link.download = fileName(now.name, now.picture);
    const count = samples > 0 ? `, ${samples} ${samples === 1 ? "sample" : "samples"}` : "";
    link.title = `Download this image as PNG: ${width} × ${height}${count}`;
  };
  for (const event of ["pointerdown", "pointerenter", "focus", "click", "contextmenu"]) {
    link.addEventListener(event, refresh);
  }
  link.addEventListener("click", (event) => {
    if (!link.href || !accessToken()) return;
    event.preventDefault();
    save(link.href, link.download).catch(failed);
  });
  return refresh;
}

async function save(address, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL((await getFrame(address)).png);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), FEEDBACK_MS);
}

// Attaches the curl button. Shows a prompt if the clipboard is unavailable (plain http from another host).
export function attachCurl(button, current, announce) {
  const label = button.querySelector(".label");
  const usual = label.textContent;
  button.addEventListener("click", async () => {
    const now = current();
    if (!now) return;
    const command = curlCommand(now.picture, now.name, document.baseURI, accessToken());
    try {
      await navigator.clipboard.writeText(command);
    } catch {
      return prompt("Copy this curl command:", command);
    }
    label.textContent = "Copied";
    button.classList.add("done");
    announce("The curl command was copied to the clipboard.");
    setTimeout(() => {
      label.textContent = usual;
      button.classList.remove("done");
    }, FEEDBACK_MS);
  });
}
