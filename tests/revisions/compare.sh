#!/usr/bin/env bash
# Builds another revision in build-revision/ and renders every sample scene with both: in float and double,
# with every accelerator, as PNG and EXR, and some orbit frames. Reports the images that differ in a byte.
#   tests/revisions/compare.sh REVISION [--width PIXELS]       status 0: all are equal
# The checkout and the build of the revision remain for the next run.
set -euo pipefail
cd "$(dirname "$0")/../.."

usage() { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
[ $# -ge 1 ] || usage
revision=$(git rev-parse --verify "$1^{commit}")
width=160
if [ $# -gt 1 ]; then
  { [ "$2" = --width ] && [ $# -eq 3 ]; } || usage
  width=$3
fi

other=build-revision/$revision
if [ ! -x "$other/build/orrery" ]; then
  mkdir -p "$other"
  git archive "$revision" | tar -x -C "$other"
  cmake -S "$other" -B "$other/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DORRERY_LEVELS=host >/dev/null
  cmake --build "$other/build" --parallel "$(nproc)" --target orrery
fi
[ -x build/orrery ] || script/setup --no-tests

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
accelerators=$(build/orrery catalog | node -e '
  const catalog = JSON.parse(require("fs").readFileSync(0));
  console.log(["auto", ...catalog.accelerators.map(({type}) => type)].join(" "));')

pictures=0 different=0
# Renders the scene with both builds and compares the files. Further arguments go to `orrery render`.
compare() {
  local scene=$1 ending=$2
  shift 2
  for side in ours theirs; do
    local program=build/orrery
    [ $side = ours ] || program=$other/build/orrery
    "$program" render "$scene" -o "$folder/$side.$ending" --width "$width" --height $((width * 3 / 4)) "$@"
  done
  pictures=$((pictures + 1))
  if ! cmp -s "$folder/ours.$ending" "$folder/theirs.$ending"; then
    different=$((different + 1))
    echo "different: $scene as $ending with $*"
  fi
}

for scene in scenes/*.json; do
  for precision in float double; do
    for accelerator in $accelerators; do
      for ending in png exr; do
        compare "$scene" $ending --precision $precision --accelerator "$accelerator"
      done
    done
  done
  compare "$scene" exr --samples 5 --azimuth 33 --elevation 12 --distance 1.2 --seed 7
  compare "$scene" png --technique raycast --time 0.4
done
echo "$pictures images compared with $(git rev-parse --short "$revision"), $different different"
[ $different -eq 0 ]
