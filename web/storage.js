// JSON in the session storage, which lasts as long as the tab and may be full or disabled.

export function recall(key) {
  try {
    return JSON.parse(sessionStorage.getItem(key));
  } catch {
    return null;
  }
}

export function remember(key, value) {
  try {
    sessionStorage.setItem(key, JSON.stringify(value));
  } catch {
    // The value then lasts until the page is reloaded.
  }
}
