#!/usr/bin/env bash
# Names a page and opens it in the browser where a person sits in front of a display. Usage: toolchain/show.sh FILE
set -euo pipefail

page=$(realpath "$1")
[[ -f $page ]] || { echo "show: $page does not exist" >&2; exit 1; }
echo "written: $page"
if [[ -z ${CI:-} && -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]] && command -v xdg-open >/dev/null; then
  xdg-open "$page" >/dev/null 2>&1 </dev/null &
fi
