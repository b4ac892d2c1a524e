// Button that opens the history of rendering. Its dialog and style are loaded when first used.

// `currentPicture()` returns {picture}, or null while no scene is shown.
export function attachHistory(button, dialog, store, currentPicture) {
  let opened = null;
  const open = async () => {
    const { HistoryDialog } = await import("./history-dialog.js");
    const style = Object.assign(document.createElement("link"), { rel: "stylesheet", href: "history.css" });
    const loaded = new Promise((resolve) => (style.onload = style.onerror = resolve));
    document.head.append(style);
    await loaded;
    return new HistoryDialog(dialog);
  };
  button.addEventListener("click", async () => {
    const current = currentPicture();
    if (!current) return;
    opened ??= open();
    const { techniques } = store.get().catalog;
    (await opened).show({ ...current.picture, more: undefined, seconds: 0, error: 0, location: undefined }, techniques);
  });
}
