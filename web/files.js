// Files from the user: the button that opens them, and the page as a drop zone. The code that reads and
// uploads files is loaded when first used.

const $ = (id) => document.getElementById(id);
const carriesFiles = ({ dataTransfer }) => dataTransfer?.types.includes("Files");

// `on` has
//   aspect() -> width of the stage divided by its height
//   show(text, title) -> promise of false if another scene was opened meanwhile; posts a scene text and shows
//     it under `title`, by default its own
//   play() starts the orbit, unless the user prefers reduced motion
export function attachFiles(store, on) {
  const input = $("files");
  const zone = $("drop-zone");
  let opener = null;
  // Opens File and FileSystemEntry objects.
  const open = async (entries) => {
    if (entries.length === 0) return;
    opener ??= import("./file-opener.js").then(({ FileOpener }) => new FileOpener(store, on));
    (await opener).open(entries);
  };
  $("open-files").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    const files = [...input.files];
    input.value = ""; // so that the same files can be chosen again
    open(files);
  });
  const highlight = (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    zone.hidden = false;
  };
  addEventListener("dragenter", highlight);
  addEventListener("dragover", highlight);
  addEventListener("dragleave", ({ relatedTarget }) => relatedTarget ?? (zone.hidden = true));
  addEventListener("drop", (event) => {
    zone.hidden = true;
    if (!carriesFiles(event)) return;
    event.preventDefault();
    // The items are valid only during the event.
    const items = [...event.dataTransfer.items].filter(({ kind }) => kind === "file");
    open(items.map((item) => item.webkitGetAsEntry() ?? item.getAsFile()));
  });
}
