#!/usr/bin/env bash
# Checks that clang-format would change no C++ file.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v clang-format >/dev/null; then
  echo "clang-format is not installed"
  exit 77
fi
find core server tests \( -name '*.cpp' -o -name '*.h' \) -print0 |
  xargs -0 -r clang-format --dry-run -Werror
