// What lasts as long as the tab: JSON in the session storage, which may be full or forbidden.

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
    // Then it lasts until the page is loaded again.
  }
}
