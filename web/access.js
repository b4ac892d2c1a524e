// Access token of the page. A 401 response opens one form for all waiting requests. The token lasts as long
// as the tab.

import { recall, remember } from "./storage.js";

const STORAGE_KEY = "orrery.token";

let token = recall(STORAGE_KEY) ?? "";
let asking = null;

export const accessToken = () => token;

export const bearer = () => (token ? { Authorization: `Bearer ${token}` } : {});

// Asks the user for a token after the service has rejected the token `sent`. Resolves to true if there is
// another token to try, and to false if the user closed the form.
export function askForToken(sent) {
  if (sent !== token) return Promise.resolve(true);
  asking ??= ask(document.getElementById("access"), sent !== "").finally(() => (asking = null));
  return asking;
}

function ask(dialog, refused) {
  const field = dialog.querySelector("input");
  dialog.querySelector("p").textContent = refused ? "The service did not accept this access token." : "";
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    const close = () => {
      if (dialog.returnValue) remember(STORAGE_KEY, (token = field.value));
      field.value = "";
      resolve(dialog.returnValue !== "");
    };
    dialog.addEventListener("close", close, { once: true });
  });
}
