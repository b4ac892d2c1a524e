#!/usr/bin/env bash
# Checks packaging/orrery.service.in: systemd accepts every line and rates its sandboxing as sufficient.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "skipped: systemd-analyze is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
# Replaces the program and its user, which need not exist on this machine.
sed 's|@CMAKE_INSTALL_FULL_BINDIR@/orrery|/bin/true|; s|^User=orrery|User=root|; s|/bin/kill|/bin/true|' packaging/orrery.service.in >"$folder/orrery.service"
complaints=$(systemd-analyze verify "$folder/orrery.service" 2>&1 || true)
[ -z "$complaints" ] || { echo "$complaints"; exit 1; }
sed -i 's|^User=root|User=nobody|' "$folder/orrery.service"
# systemd rates exposure from 0 (fully sandboxed) to 10 (unrestricted). The threshold is 2.0, its limit for
# "OK".
systemd-analyze security --offline=true --threshold=20 --no-pager "$folder/orrery.service" | tail -1
