#!/bin/sh
# Installs the Debian and Ubuntu packages that hbar needs:
#
#   tests/install_packages.sh build|test|fuzz|full
#
# `build` is what the library and its examples need, `test` adds what the tests need, `fuzz` what
# fuzzing needs, `full` that and what the benchmarks need. Nothing is downloaded, and no network is
# needed, when all of it is there. Needs root or sudo otherwise.
set -eu

build="g++ cmake ninja-build pkg-config libeigen3-dev libsuitesparse-dev coinor-libipopt-dev
       liblapack-dev libmumps-seq-dev libnlopt-dev libtinyxml2-dev libcli11-dev
       nlohmann-json3-dev libfmt-dev zlib1g-dev"
test="python3 git libgtest-dev"
fuzz="clang"
# Left out with a message where the distribution has none: one of each line is enough.
optional="libassimp-dev:DAE,_PLY_and_glTF_meshes
          libmujoco-dev:the_comparison_with_MuJoCo
          clang-format-14|clang-format:the_format_check
          gnuplot-nox|gnuplot:the_figures_of_hbar_solvers"
# That of the distribution's clang: 18 in Ubuntu 24.04, 14 in Debian 12.
libfuzzer="libclang-rt-18-dev|libclang-rt-14-dev:fuzzing"

installed() {
  dpkg-query -W -f '${Status}\n' "$1" 2>/dev/null | grep -q '^install ok installed'
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "install_packages: needs root or sudo to run: $*" >&2
    exit 1
  fi
}

apt_install() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

# The first of the packages a|b|c that is installed, or else the first that can be.
choose() {
  for package in $(echo "$1" | tr '|' ' '); do
    if installed "$package"; then echo "$package"; return; fi
  done
  for package in $(echo "$1" | tr '|' ' '); do
    if LC_ALL=C apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [0-9]'; then
      echo "$package"
      return
    fi
  done
}

case ${1:-} in
  build) wanted=$build; optional= ;;
  test) wanted="$build $test" ;;
  fuzz) wanted="$build $test $fuzz"; optional="$optional $libfuzzer" ;;
  full) wanted="$build $test $fuzz libbenchmark-dev"; optional="$optional $libfuzzer" ;;
  *) echo "usage: install_packages.sh build|test|fuzz|full" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null; then
  echo "install_packages: no Debian or Ubuntu; install the equivalents of:" $wanted >&2
  exit 1
fi

missing=
for package in $wanted; do
  installed "$package" || missing="$missing $package"
done
if [ -n "$missing" ]; then
  echo "install_packages: installing$missing"
  as_root apt-get update -q
  apt_install $missing
fi

for line in $optional; do
  package=$(choose "${line%%:*}")
  if [ -z "$package" ]; then
    echo "install_packages: no package ${line%%:*} here; left out: $(echo "${line#*:}" | tr _ ' ')"
  elif ! installed "$package"; then
    apt_install "$package" ||
      echo "install_packages: could not install $package; left out: $(echo "${line#*:}" | tr _ ' ')"
  fi
done
