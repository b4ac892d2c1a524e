#!/usr/bin/env bash
# The systemd unit: systemd understands every line of it, and finds it well locked in.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "skipped: systemd-analyze is not installed"; exit 77; }
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
# The program need not be installed for that, nor its user.
sed 's|/opt/orrery/orrery|/bin/true|; s|^User=orrery|User=root|; s|/bin/kill|/bin/true|' packaging/orrery.service >"$folder/orrery.service"
complaints=$(systemd-analyze verify "$folder/orrery.service" 2>&1 || true)
[ -z "$complaints" ] || { echo "$complaints"; exit 1; }
sed -i 's|^User=root|User=nobody|' "$folder/orrery.service"
# 0 is locked in, 10 is free to do anything; systemd calls up to 2 "OK".
systemd-analyze security --offline=true --threshold=20 --no-pager "$folder/orrery.service" | tail -1
