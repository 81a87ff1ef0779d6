#!/usr/bin/env bash
# Runs the checks, the C++ tests and the Python tests, all three whatever the ones before gave, so that one run shows
# everything that is wrong. The last lines name every test that was skipped. Usage: toolchain/run-tests.sh PRESET, after
# a build.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=$1
failed=()
results=("$PWD/build/tests-cpp.xml" "$PWD/build/tests-editions.xml" "$PWD/build/tests-python.xml")
rm -rf "${results[@]}" build/editions

.venv/bin/python toolchain/check.py || failed+=("checks (make lint)")
cpp() { ctest --preset "$preset" --progress "$@" || failed+=("C++ tests (ctest --preset $preset $1 '$2')"); }
cpp -E '^Edition\.' --output-junit "${results[0]}"
# A case of ctest each: what they skip stands in what they write themselves.
GTEST_OUTPUT="xml:$PWD/build/editions/" cpp -R '^Edition\.' --output-junit "${results[1]}"
.venv/bin/python -m pytest -q -c sim_host/pyproject.toml --rootdir . \
  -n "$(nproc)" --dist loadfile --no-loadscope-reorder --junit-xml "${results[2]}" tests/python || failed+=("Python tests")

if ((${#failed[@]})); then
  printf 'failed: %s\n' "${failed[@]}" >&2
fi
.venv/bin/python toolchain/tally.py "${results[@]}"
exit $((${#failed[@]} > 0))
