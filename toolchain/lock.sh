#!/usr/bin/env bash
# Writes requirements.lock from requirements.in: the newest versions that fit, for every Python from 3.11 on and every
# platform at once, with the hashes of all files. Run by `make lock`, needs the network. The locking tool lives in a
# virtual environment of its own, since no build needs it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tool=build/lock-tool
.venv/bin/python -m venv "$tool"
"$tool/bin/python" -m pip install --quiet --disable-pip-version-check uv

lock=toolchain/requirements.lock
{
  sed '/^[^#]/,$d' "$lock"  # the opening comment stays
  "$tool/bin/uv" pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest --upgrade \
    --generate-hashes --no-emit-index-url --no-annotate --no-header toolchain/requirements.in
} >"$lock.new"
if grep -q '://' "$lock.new"; then
  echo "lock: $lock.new names an address; a lock file must not" >&2
  exit 1
fi
mv "$lock.new" "$lock"
