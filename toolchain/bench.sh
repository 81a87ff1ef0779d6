#!/usr/bin/env bash
# Measures the simulation's speed and the instructions of the control interrupt. Usage: toolchain/bench.sh BUILD_DIRECTORY
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program=$1/sim_host/bench/stillspin_bench_speed
if [[ ! -x $program ]]; then
  echo "bench: $program is not built" >&2
  exit 1
fi
"$program"

counts=$(mktemp)
figures=build/bench/figures.json
mkdir -p "${figures%/*}"
rm -f "$figures"
trap 'rm -f "$counts"' EXIT
for rpm in 5 80 2000; do
  echo
  echo "instructions of the firmware per control interrupt, native build, on the way to $rpm rpm"
  valgrind --quiet --tool=callgrind --callgrind-out-file="$counts" "$program" "$rpm" >/dev/null
  .venv/bin/python toolchain/isr/host.py "$counts" "$figures" "$rpm"
done
echo
size "$1/firmware/libstillspin_firmware.a" | awk 'NR > 1 { data += $2 + $3 } END { printf "firmware variables: %d bytes, %d words of 16 bits\n", data, data / 2 }'
