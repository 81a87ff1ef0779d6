#!/usr/bin/env bash
# Searches for what breaks the drive or its client: libFuzzer with address and undefined-behaviour sanitizers over the
# firmware's serial port and CAN bus, once with this computer's int (link, bus) and once with one of 16 bits (link16,
# bus16; toolchain/int16), a generator over the SLCAN adapter and the client's readers (tests/fuzz).
# Usage: toolchain/fuzz.sh RUNS [SEARCH]..., of each search: two for the client, all when none is named. What it finds is
# left in build/fuzz/found. The search `short` is not among all: that of link16 and bus16 that always takes the same way,
# and has to find planted defects (toolchain/fuzz16.py).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

runs=${1:-1000000}
which=${*:2}
which=${which:-link bus link16 bus16 client}
build=build/fuzz
clang=$(bash toolchain/find-clang.sh)
mkdir -p "$build/found" "$build"/corpus-{link,bus}{,16}
if ! echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
  "${clang/clang/clang++}" -x c++ - -fsanitize=fuzzer -o "$build/probe" 2>"$build/probe.log"; then
  echo "fuzz: $clang has no libFuzzer; by hand: sudo apt-get install libclang-rt-${clang#clang-}-dev" >&2
  exit 1
fi
# Only what reads input guides the search, by its branches alone: ten times as many executions as with everything.
flags="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fsanitize-address-use-after-return=never"
flags+=" -fno-sanitize-coverage=trace-cmp -fsanitize-coverage-allowlist=$PWD/tests/fuzz/coverage.list"
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DSTILLSPIN_FUZZ=ON -DSTILLSPIN_SIM=OFF \
  -DSTILLSPIN_PYTHON=OFF -DCMAKE_C_COMPILER="$clang" -DCMAKE_CXX_COMPILER="${clang/clang/clang++}" \
  -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags" >"$build/configure.log"
targets=()
for each in $which; do
  case $each in
    link | bus | link16 | bus16) targets+=("stillspin_fuzz_$each") ;;
    short) targets+=(stillspin_fuzz_{link,bus}16) ;;
    client) ;;
    *) echo "fuzz: there is no search $each" >&2 && exit 2 ;;
  esac
done
if ((${#targets[@]})); then
  cmake --build "$build" --target "${targets[@]}" >"$build/build.log" || { cat "$build/build.log"; exit 1; }
fi

export ASAN_OPTIONS=quarantine_size_mb=16
search() { # target, options
  echo "fuzz: $1, $runs runs"
  "$build/tests/fuzz/stillspin_fuzz_$1" -runs="$runs" -max_len=300 -verbosity=0 -print_funcs=0 -print_final_stats=1 \
    -artifact_prefix="$build/found/$1-" "${@:2}" "$build/corpus-$1"
}
for each in $which; do
  case $each in
    link*) search "$each" -dict=tests/fuzz/link.dict ;;
    bus*) search "$each" ;;
    client) .venv/bin/python tests/fuzz/client_fuzz.py "$runs" ;;
    short) .venv/bin/python toolchain/fuzz16.py "$build/tests/fuzz" "$runs" ;;
  esac
done
