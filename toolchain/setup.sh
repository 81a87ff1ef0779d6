#!/usr/bin/env bash
# Installs what a build of stillspin needs and this machine lacks, and nothing else. Run by `make setup`.
#
#   1. Debian packages (debian-packages.txt) and a clang with the msp430 target, through apt-get, only if one is missing;
#   2. the locked Python packages (requirements.lock) into .venv, only if the lock, the Python or the place has changed;
#   3. the project's own Python package, editable, from sim_host/;
#   4. for group `test` on a distribution without a Chromium of its own (Ubuntu has a snap), the one of Playwright.
#
# When nothing is missing, nothing is fetched and the network is not touched.
# Usage: toolchain/setup.sh [GROUP]...   (groups of debian-packages.txt; default: build). Group `llvm` is opt, llc and the
# runtime libraries of the clang that there is.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

groups=("${@:-build}")
root=$PWD
table=toolchain/debian-packages.txt
lock=toolchain/requirements.lock
venv=.venv
logs=build/setup

say() { echo "setup: $*"; }
die() {
  echo "setup: $*" >&2
  exit 1
}

# ---- Debian packages ---------------------------------------------------------------------------------------------

packages_of_group() { sed -nE "s/^$1[ ]*\|[ ]*([^ |]+)[ ]*\|.*/\1/p" "$table"; }
reason_of() { sed -nE "s/^[a-z]+[ ]*\|[ ]*${1//+/\\+}[ ]*\|[ ]*(.*)/\1/p" "$table"; }

is_installed() { [[ $(dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | head -n 1) == installed ]]; }

has_group() { [[ " ${groups[*]} " == *" $1 "* ]]; }

missing_packages() {
  local group package
  for group in "${groups[@]}"; do
    for package in $(packages_of_group "$group"); do
      is_installed "$package" || { [[ $package == chromium ]] && has_browser; } || echo "$package"
    done
  done
}

has_browser() {
  command -v chromium || command -v chromium-browser || command -v google-chrome ||
    { [[ -x $venv/bin/python ]] && "$venv/bin/python" tests/python/browser.py; }
} >/dev/null 2>&1

# Fills `become_root`, the words put before a command that needs root.
choose_root() {
  if [[ $(id -u) == 0 ]]; then
    become_root=()
  elif ! command -v sudo >/dev/null; then
    die "Debian packages are missing, and there is no sudo; run once as root: apt-get install ${wanted[*]}"
  elif [[ -t 0 ]]; then
    become_root=(sudo)
  else
    become_root=(sudo -n)  # nobody is there to type a password: fail rather than wait
  fi
}

apt() {
  ${become_root[@]+"${become_root[@]}"} env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

# `apt-cache show` succeeds for a package that others only mention; what can be installed has a candidate version.
is_installable() { LC_ALL=C apt-cache policy "$1" 2>/dev/null | grep 'Candidate: [^(]' >/dev/null; }

newest_clang_package() {
  local version
  for version in 22 21 20 19 18 17 16 15 14; do
    if is_installable "clang-$version"; then
      echo "clang-$version"
      return
    fi
  done
}

refresh_package_lists() {
  say "refreshing the package lists"
  apt update >"$logs/apt.log" 2>&1 || say "the package lists could not be refreshed (see $logs/apt.log); going on with the old ones"
}

# Takes out of `wanted` what install_browser brings, after the Python packages.
without_browser_of_elsewhere() {
  local package kept=()
  for package in ${wanted[@]+"${wanted[@]}"}; do
    [[ $package == chromium ]] && ! is_installable chromium || kept+=("$package")
  done
  wanted=(${kept[@]+"${kept[@]}"})
}

# The packages of `wanted`, together; one by one if that fails, so that the culprit can be named.
install_wanted() {
  local package failed=()
  if apt install -y --no-install-recommends "${wanted[@]}" >>"$logs/apt.log" 2>&1; then
    return
  fi
  for package in "${wanted[@]}"; do
    apt install -y --no-install-recommends "$package" >>"$logs/apt.log" 2>&1 || failed+=("$package")
  done
  if ((${#failed[@]})); then
    die "cannot install ${failed[*]}; by hand: sudo apt-get install ${failed[*]}, then run make again" \
      "(what apt-get says: $logs/apt.log)"
  fi
}

# What of group llvm is wanted and not there for a clang ("clang-19" or "clang").
missing_llvm() {
  has_group llvm || return 0
  command -v "opt${1#clang}" >/dev/null || echo "llvm${1#clang}"
  local version
  if version=$("$1" -dumpversion 2>/dev/null); then
    is_installed "libclang-rt-${version%%.*}-dev" || echo "libclang-rt-${version%%.*}-dev"
  elif [[ $1 == *-* ]]; then
    echo "libclang-rt${1#clang}-dev"
  fi
}

install_debian_packages() {
  local need_clang='' package clang llvm=()
  clang=$(bash toolchain/find-clang.sh) || need_clang=1
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian or Ubuntu machine: it must have what $table lists"
    [[ -z $need_clang ]] || die "no clang with the msp430 target: install LLVM's clang 14 or newer, then run make again"
    return
  fi
  mapfile -t wanted < <(missing_packages)
  mapfile -t llvm < <([[ -n $need_clang ]] || missing_llvm "$clang")
  if ((!${#wanted[@]} && !${#llvm[@]})) && [[ -z $need_clang ]]; then
    return
  fi
  mkdir -p "$logs"
  choose_root
  refresh_package_lists
  without_browser_of_elsewhere
  ((${#wanted[@]} + ${#llvm[@]})) || [[ -n $need_clang ]] || return 0
  say "installing Debian packages:"
  for package in ${wanted[@]+"${wanted[@]}"}; do
    say "  $package: $(reason_of "$package")"
  done
  if [[ -n $need_clang ]]; then
    clang=$(newest_clang_package)
    [[ -n $clang ]] || die "cannot install clang: none of clang-14 to clang-22 is in the package lists; by hand:" \
      "install any LLVM clang 14 or newer whose --print-targets names msp430, then run make again"
    say "  $clang: checks the firmware's C with a 16-bit int, as on the DSP"
    wanted+=("$clang")
    mapfile -t llvm < <(missing_llvm "$clang")
  fi
  for package in ${llvm[@]+"${llvm[@]}"}; do
    say "  $package: belongs to $clang; runs C that was compiled with a 16-bit int, and counts what the tests cover"
    wanted+=("$package")
  done
  install_wanted
}

# ---- Python packages ---------------------------------------------------------------------------------------------

# The distribution's Python first: its headers match, and it is there for as long as the machine is.
find_python() {
  local candidate
  for candidate in /usr/bin/python3 python3.14 python3.13 python3.12 python3.11 python3; do
    if "$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
      command -v "$candidate"
      return
    fi
  done
  die "no Python 3.11 or newer with the venv module; by hand: sudo apt-get install python3 python3-venv (Debian 12," \
    "Ubuntu 24.04 or newer)"
}

digest() { sha256sum "$@" | sha256sum | cut -d' ' -f1; }

install_python_packages() {
  local python stamp
  python=$(find_python)
  # The place belongs to it: a moved virtual environment still points to where it was made.
  stamp="$root $("$python" -c 'import sys; print(sys.version)' | tr '\n' ' ') $(digest "$lock")"
  if [[ -f $venv/stillspin.stamp && $(<"$venv/stillspin.stamp") == "$stamp" ]]; then
    return
  fi
  mkdir -p "$logs"
  say "installing the Python packages of $lock into $venv ($("$python" --version))"
  "$python" -m venv --clear "$venv" >"$logs/pip.log" 2>&1 || die "cannot make $venv; by hand: $python -m venv $venv (see $logs/pip.log)"
  if ! "$venv/bin/python" -m pip install --disable-pip-version-check --no-compile --require-hashes \
    --only-binary :all: -r "$lock" >>"$logs/pip.log" 2>&1; then
    die "cannot install the Python packages: $(grep -m 1 '^ERROR' "$logs/pip.log" || echo "see $logs/pip.log"); by hand:" \
      "$venv/bin/python -m pip install --require-hashes -r $lock, then run make again"
  fi
  echo "$stamp" >"$venv/stillspin.stamp"
}

install_own_package() {
  local stamp
  stamp=$(digest sim_host/pyproject.toml)
  if [[ -f $venv/stillspin-package.stamp && $(<"$venv/stillspin-package.stamp") == "$stamp" ]]; then
    return
  fi
  mkdir -p "$logs"
  say "installing the stillspin command, editable, from sim_host"
  "$venv/bin/python" -m pip install --disable-pip-version-check --no-index --no-deps --no-build-isolation -e sim_host \
    >"$logs/package.log" 2>&1 || die "cannot install sim_host into $venv (see $logs/package.log)"
  echo "$stamp" >"$venv/stillspin-package.stamp"
}

# ---- The browser of the page's tests --------------------------------------------------------------------------------

install_browser() {
  has_group test && ! has_browser || return 0
  mkdir -p "$logs"
  say "installing the Chromium of Playwright, for the tests of the page in the browser"
  "$venv/bin/python" -m playwright install --with-deps chromium >"$logs/browser.log" 2>&1 </dev/null || die "cannot install" \
    "Chromium (see $logs/browser.log); by hand: install any chromium, chromium-browser or google-chrome"
}

wanted=()
become_root=()
install_debian_packages
install_python_packages
install_own_package
install_browser
