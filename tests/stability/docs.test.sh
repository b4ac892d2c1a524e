#!/usr/bin/env bash
# Checks that docs/stability.md and its charts equal the measurements of this build.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${TEST_ORRERY:-build/orrery}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
mkdir "$folder/pictures"
"$program" stability --docs "$folder"
compare() {
  diff -u "docs/$1" "$folder/$1" && return
  echo "docs/$1 differs from the measurements of this build. To update it: $program stability --docs docs" >&2
  exit 1
}
compare stability.md
for picture in "$folder"/pictures/*.svg docs/pictures/stability-*.svg; do compare "pictures/$(basename "$picture")"; done
