#!/usr/bin/env bash
# Installs the core library into a temporary folder, builds docs/example outside the tree with find_package(orrery), and
# compares its image with that of `orrery render`.
set -euo pipefail
orrery=${TEST_ORRERY:-build/orrery}
build=$(dirname "$orrery")
if ! grep -q '^ORRERY_SANITIZE:STRING=$' "$build/CMakeCache.txt"; then
  echo "skipped: a program without sanitizers cannot use a library with them"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
DESTDIR= cmake --install "$build" --prefix "$scratch/prefix" >"$scratch/install.log"
cp -r docs/example "$scratch/example"
cmake -S "$scratch/example" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" >"$scratch/configure.log"
cmake --build "$scratch/build" >"$scratch/build.log" || { cat "$scratch/build.log"; exit 1; }
for scene in scenes/glass.json scenes/shape-mesh.json scenes/outdoors.json; do
  "$scratch/build/render" "$scene" "$scratch/library.png"
  "$orrery" render "$scene" --width 640 --height 480 -o "$scratch/program.png"
  cmp "$scratch/library.png" "$scratch/program.png"
done
