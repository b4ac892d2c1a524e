// Download link and curl command of the current picture.

import { access_token } from "./access.js";
import { get_frame } from "./api.js";
import { curl_command, file_name, frame_url } from "./urls.js";

const kThanksMs = 2000;

// Attaches the download link. `current()` returns {picture, name} of the stage, or null. With a token, which
// a link cannot carry, fetches the picture first; `failed(error)` is called if that fails. Returns a function
// that refreshes the link.
export function attach_download(link, current, failed) {
  const refresh = () => {
    const now = current();
    if (!now) return link.removeAttribute("href");
    const { width, height, samples } = now.picture;
    link.href = frame_url(now.picture);
    link.download = file_name(now.name, now.picture);
    const count = samples > 0 ? `, ${samples} ${samples === 1 ? "sample" : "samples"}` : "";
    link.title = `Download this view as PNG: ${width} × ${height}${count}`;
  };
  for (const event of ["pointerdown", "pointerenter", "focus", "click", "contextmenu"]) {
    link.addEventListener(event, refresh);
  }
  link.addEventListener("click", (event) => {
    if (!link.href || !access_token()) return;
    event.preventDefault();
    save(link.href, link.download).catch(failed);
  });
  return refresh;
}

async function save(address, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL((await get_frame(address)).png);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), kThanksMs);
}

// Attaches the curl button. Shows a prompt if the clipboard is unavailable (plain http from another host).
export function attach_curl(button, current, announcement) {
  const label = button.querySelector(".label");
  const usual = label.textContent;
  button.addEventListener("click", async () => {
    const now = current();
    if (!now) return;
    const command = curl_command(now.picture, now.name, document.baseURI, access_token());
    try {
      await navigator.clipboard.writeText(command);
    } catch {
      return prompt("This picture with curl", command);
    }
    label.textContent = "Copied";
    button.classList.add("done");
    announcement.textContent = "The curl command is on the clipboard.";
    setTimeout(() => {
      label.textContent = usual;
      button.classList.remove("done");
    }, kThanksMs);
  });
}
