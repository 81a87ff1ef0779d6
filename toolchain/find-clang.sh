#!/usr/bin/env bash
# Prints the newest installed clang that can compile for msp430, the target with a 16-bit int that stands in for the
# C28x in the checks. Exit status 1 when there is none.
set -uo pipefail

for name in clang-{22,21,20,19,18,17,16,15,14} clang; do
  # Captured first: grep -q closes the pipe early, which pipefail would report as a failure of clang.
  if command -v "$name" >/dev/null && targets=$("$name" --print-targets 2>/dev/null) && [[ $targets == *msp430* ]]; then
    echo "$name"
    exit 0
  fi
done
exit 1
