// Taking the picture along: the download link and the curl command.

import { curl_command, file_name, frame_url } from "./urls.js";

const kThanksMs = 2000;

// `current()` is {picture, name} of the view as it is now, or null while there is none.
export function attach_download(link, current) {
  const refresh = () => {
    const now = current();
    if (!now) return;
    link.href = frame_url(now.picture);
    link.download = file_name(now.name, now.picture);
  };
  for (const event of ["pointerdown", "pointerenter", "focus", "click", "contextmenu"]) {
    link.addEventListener(event, refresh);
  }
  return refresh;
}

// Where the clipboard is out of reach (plain http from another host) a dialog shows the command instead.
export function attach_curl(button, dialog, current, announce) {
  const label = button.querySelector(".label");
  const usual = label.textContent;
  button.addEventListener("click", async () => {
    const now = current();
    if (!now) return;
    const command = curl_command(now.picture, now.name, document.baseURI);
    try {
      await navigator.clipboard.writeText(command);
    } catch {
      const field = dialog.querySelector("textarea");
      field.value = command;
      dialog.showModal();
      field.select();
      return;
    }
    label.textContent = "Copied";
    button.classList.add("done");
    announce("The curl command is on the clipboard.");
    setTimeout(() => {
      label.textContent = usual;
      button.classList.remove("done");
    }, kThanksMs);
  });
}
