#!/usr/bin/env node
// The layers of the source tree, lowest first. A file includes files of lower layers and of its own folder only.
//
//   node tests/lint/rooms.mjs > docs/pictures/rooms.svg     draws the layers

import { fileURLToPath } from "node:url";

export const kLayers = [
  ["core/base", "core/math"],
  ["core/params", "core/image", "core/meshes"],
  ["core/model"],
  [
    "core/shapes",
    "core/cameras",
    "core/materials",
    "core/lights",
    "core/environments",
    "core/atmospheres",
    "core/textures",
    "core/accelerators",
    "core/channels",
    "core/occlusion",
  ],
  ["core/lighting", "core/raster"],
  ["core/reuse"],
  ["core/techniques"],
  ["core/plan"],
  ["core/prepare", "core/load", "core/framing"],
  ["core/accuracy"],
  ["core/render"],
  ["core/budget"],
  ["core/study"],
  ["core/stability"],
  ["server/base"],
  ["server/telemetry", "server/config"],
  ["server/scheduler"],
  ["server/http", "server/cache"],
  ["server/security", "server/api"],
  ["server/rendering"],
  ["server/jobs"],
  ["server/app"],
  ["server/routes"],
  ["server/service", "server/import"],
  ["server/commands"],
  ["server"], // main.cpp
];

const kWidth = 960,
  kRow = 34,
  kGap = 6,
  kMargin = 12; // pixels
const kFill = { core: "#d7e6f5", server: "#f6e3c8" };

// Returns an SVG drawing with one row per layer, the highest at the top.
export function drawRooms() {
  const rows = [...kLayers].reverse();
  const height = rows.length * (kRow + kGap) - kGap + 2 * kMargin;
  const boxes = rows.flatMap((rooms, row) => {
    const width = (kWidth - 2 * kMargin - (rooms.length - 1) * kGap) / rooms.length;
    return rooms.map((room, column) => {
      const x = kMargin + column * (width + kGap),
        y = kMargin + row * (kRow + kGap);
      const fill = kFill[room.split("/")[0]],
        name = room === "server" ? "server/main.cpp" : room;
      return (
        `<rect x="${x}" y="${y}" width="${width}" height="${kRow}" rx="4" fill="${fill}"/>` +
        `<text x="${x + width / 2}" y="${y + kRow / 2 + 4}">${name}</text>`
      );
    });
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${kWidth} ${height}" font-family="sans-serif" font-size="12" text-anchor="middle" fill="#222">
<title>Layers of the source tree. Files include files of lower layers only.</title>
<rect width="${kWidth}" height="${height}" fill="#fff"/>
${boxes.join("\n")}
</svg>
`;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) process.stdout.write(drawRooms());
