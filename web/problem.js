// Error card: message, places (one entry each), actions, and the request id for a bug report.

export function element(name, text, className) {
  const made = document.createElement(name);
  if (text) made.textContent = text;
  if (className) made.className = className;
  return made;
}

// Returns the places of an error, each {label, detail, pointer} or {label, line, column}.
export function placesOf(error) {
  const places = (error.errors ?? []).map(({ pointer, detail }) => ({
    label: pointer || "/",
    detail,
    pointer: pointer ?? "",
  }));
  if (places.length === 0 && error.line) {
    places.push({
      label: `line ${error.line}, column ${error.column}`,
      line: error.line,
      column: error.column,
    });
  }
  return places;
}

// Fills and shows `card`. Calls `onPlace` with the place that the user picks. Without `onPlace`, places are
// plain text. `actions` are buttons, each [label, function].
export function showProblem(card, error, onPlace, actions = []) {
  const title = element("h2", error.title ?? error.message);
  const close = element("button", "", "close");
  close.ariaLabel = "Dismiss";
  close.addEventListener("click", () => hideProblem(card));
  const parts = [close, title];
  const places = placesOf(error);
  const repeated = places[0]?.detail && error.detail?.includes(places[0].detail);
  if (error.detail && !repeated) parts.push(element("p", error.detail));
  if (places.length > 1) parts.push(element("p", `${places.length} errors:`));
  if (places.length > 0) {
    const list = element("ul");
    for (const place of places) {
      const entry = element(onPlace ? "button" : "span", "", "place");
      if (onPlace) entry.addEventListener("click", () => onPlace(place));
      entry.append(element("code", place.label), element("span", place.detail));
      const row = element("li");
      row.append(entry);
      list.append(row);
    }
    parts.push(list);
  }
  if (actions.length > 0) parts.push(buttons(actions));
  if (error.requestId) {
    const request = element("p", "Request ID ", "request");
    request.append(element("code", error.requestId));
    parts.push(request);
  }
  card.replaceChildren(...parts);
  card.hidden = false;
}

function buttons(actions) {
  const row = element("p", "", "actions");
  for (const [label, act] of actions) {
    const button = element("button", label);
    button.addEventListener("click", act);
    row.append(button);
  }
  return row;
}

export function hideProblem(card) {
  card.hidden = true;
  card.replaceChildren();
}
