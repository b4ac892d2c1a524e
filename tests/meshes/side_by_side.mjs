// Renders models with `orrery view` and with another renderer, and arranges both images side by side.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";

export const kSide = 512; // pixels
const kProgram = process.env.TEST_ORRERY ?? "build/orrery";

// Calls renderOther(model, scene, file) for each model, with the scene that the view consists of. It writes the PNG
// file `file`. Prints the RMS difference of the codes, divided by 255. Writes the pairs to `sheet`.
export async function compareSideBySide(sheet, models, renderOther) {
  const scratch = mkdtempSync(join(tmpdir(), "orrery-"));
  try {
    const images = [];
    for (const model of models.map((path) => resolve(path))) {
      const view = (...args) =>
        execFileSync(kProgram, ["view", model, ...args], { stdio: ["ignore", "pipe", "ignore"] });
      const names = ["ours", "other"].map((name) => join(scratch, `${images.length}-${name}.png`));
      view("-o", names[0], "--samples", "64", "--width", kSide, "--height", kSide);
      await renderOther(model, JSON.parse(view("--print-scene", "-o", "-")), names[1]);
      const { stderr } = spawnSync("compare", ["-metric", "RMSE", ...names, "null:"], { encoding: "utf8" });
      console.log(`${stderr.match(/\((.*)\)/)?.[1] ?? stderr}  ${basename(model)}`);
      images.push(...names);
    }
    execFileSync("montage", [...images, "-tile", "4x", "-geometry", "256x256+2+2", "-quality", "88", sheet]);
  } finally {
    rmSync(scratch, { recursive: true, force: true });
  }
}
