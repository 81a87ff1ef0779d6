#!/usr/bin/env bash
# Runs the speed benchmark of the simulation. Usage: toolchain/bench.sh BUILD_DIRECTORY
set -euo pipefail

program=$1/sim_host/bench/stillspin_bench_speed
if [[ ! -x $program ]]; then
  echo "bench: $program is not built" >&2
  exit 1
fi
exec "$program"
