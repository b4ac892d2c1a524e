#!/usr/bin/env bash
# Checks that the PNG of every sample scene does not depend on --threads and --slice. Compares a render on one
# thread with two variants, or with four variants of a larger image if TEST_EXHAUSTIVE=yes. If
# TEST_LEVELS=yes, also compares the lower instruction levels of this machine, which GLIBC_TUNABLES selects.
set -euo pipefail
orrery=${TEST_ORRERY:-build/orrery}
size="--width 60 --height 44" exhaustive=${TEST_EXHAUSTIVE:-no}
if [ $exhaustive = yes ]; then size="--width 150 --height 110"; fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
lower=()

level_with() { # TUNABLES: prints the level that the loader selects
  GLIBC_TUNABLES=$1 "$orrery" render scenes/shape-plane.json --width 8 --height 8 --stats | grep -o 'x86-64-v[234]\|plain'
}

if [ "${TEST_LEVELS:-no}" = yes ]; then
  build=$(dirname "$orrery")
  cmake --build "$build" --target levels >/dev/null
  orrery=$build/levels/orrery
  lower=("glibc.cpu.hwcaps=-AVX512F" "glibc.cpu.hwcaps=-AVX512F,-AVX2")
  levels="$(level_with '') $(level_with "${lower[0]}") $(level_with "${lower[1]}")"
  echo "levels: $levels"
  case $levels in
    "x86-64-v4 x86-64-v3 x86-64-v2" | "x86-64-v3 x86-64-v3 x86-64-v2") ;;
    *) echo "the loader did not select the lower levels" && exit 1 ;;
  esac
fi

failed=0
for scene in scenes/*.json; do
  render() { # NAME TUNABLES OPTIONS...
    GLIBC_TUNABLES=$2 "$orrery" render "$scene" $size "${@:3}" -o "$scratch/$1.png" 2>/dev/null
    cmp -s "$scratch/first.png" "$scratch/$1.png" || { echo "$scene: $1 differs"; failed=1; }
  }
  "$orrery" render "$scene" $size --threads 1 -o "$scratch/first.png" 2>/dev/null
  render threads-8 "" --threads 8
  render slice-64 "" --threads 1 --slice 64
  if [ $exhaustive = yes ]; then
    render threads-2 "" --threads 2
    render slice-1024 "" --threads 1 --slice 1024
  fi
  for level in "${lower[@]}"; do render "$level" "$level" --threads 2; done
done
[ $failed = 0 ] && echo "$(ls scenes/*.json | wc -l) scenes: all variants have the same bytes"
exit $failed
