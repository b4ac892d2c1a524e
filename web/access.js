// Where the service answers 401, the page asks for a token, once for all requests that wait, and keeps it for as
// long as the tab is open.

import { recall, remember } from "./storage.js";

const kStorageKey = "orrery.token";

let token = recall(kStorageKey) ?? "";
let asking = null;

export const access_token = () => token;

export const bearer = () => (token ? { Authorization: `Bearer ${token}` } : {});

// `sent` was refused. Resolves to whether there is another token now; false: the user has closed the form.
export function other_token(sent) {
  if (sent !== token) return Promise.resolve(true);
  asking ??= ask(document.getElementById("access"), sent !== "").finally(() => (asking = null));
  return asking;
}

function ask(dialog, refused) {
  const field = dialog.querySelector("input");
  dialog.querySelector("p").textContent = refused ? "The service did not accept this token." : "";
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    const close = () => {
      if (dialog.returnValue) remember(kStorageKey, (token = field.value));
      field.value = "";
      resolve(dialog.returnValue !== "");
    };
    dialog.addEventListener("close", close, { once: true });
  });
}
