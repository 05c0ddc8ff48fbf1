#!/bin/sh
# The main example, from a bare Debian 12 or Ubuntu 24.04: examples/run.sh [options of finger_reach]
#
# Installs what is missing, builds hbar and the example, and runs the co-design of a four-joint
# finger. The results are written to results/finger_reach.
set -eu
cd "$(dirname "$0")/.."

tests/install_packages.sh build
launcher=
! command -v ccache >/dev/null || launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --preset release -DHBAR_BUILD_TESTS=OFF $launcher
cmake --build --preset release --target finger_reach
mkdir -p results/finger_reach
exec build/release/examples/finger_reach/finger_reach --out results/finger_reach "$@"
