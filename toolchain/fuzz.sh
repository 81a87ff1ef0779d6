#!/usr/bin/env bash
# Searches for octets on the serial port and frames on the CAN bus that break the firmware: libFuzzer with address and undefined-behaviour
# sanitizers over tests/fuzz. Usage: toolchain/fuzz.sh RUNS. What it finds is left in build/fuzz/found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

runs=${1:-1000000}
build=build/fuzz
clang=$(bash toolchain/find-clang.sh)
mkdir -p "$build/found" "$build/corpus" "$build/corpus-bus"
if ! echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
  "${clang/clang/clang++}" -x c++ - -fsanitize=fuzzer -o "$build/probe" 2>"$build/probe.log"; then
  echo "fuzz: $clang has no libFuzzer; by hand: sudo apt-get install libclang-rt-${clang#clang-}-dev" >&2
  exit 1
fi
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DSTILLSPIN_FUZZ=ON -DSTILLSPIN_SIM=OFF -DSTILLSPIN_PYTHON=OFF \
  -DCMAKE_C_COMPILER="$clang" -DCMAKE_CXX_COMPILER="${clang/clang/clang++}" \
  -DCMAKE_C_FLAGS="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all" \
  -DCMAKE_CXX_FLAGS="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all" >"$build/configure.log"
cmake --build "$build" --target stillspin_fuzz_link stillspin_fuzz_bus >"$build/build.log" || { cat "$build/build.log"; exit 1; }
"$build/tests/fuzz/stillspin_fuzz_link" -runs="$runs" -max_len=400 -dict=tests/fuzz/link.dict -verbosity=0 -print_funcs=0 \
  -print_final_stats=1 -artifact_prefix="$build/found/" "$build/corpus"
"$build/tests/fuzz/stillspin_fuzz_bus" -runs="$runs" -max_len=400 -verbosity=0 -print_funcs=0 \
  -print_final_stats=1 -artifact_prefix="$build/found/" "$build/corpus-bus"
