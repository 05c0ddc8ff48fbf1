#!/bin/sh
# The optimisation examples, from a bare Debian 12 or Ubuntu 24.04:
#
#   examples/run.sh [EXAMPLE] [options of the example]
#
# EXAMPLE is finger_reach (the default), swing_up, walker, identify, rotate_box, flip_box or assemble.
# Installs what is missing, builds hbar and the example, and runs it. The results are written to
# results/EXAMPLE.
set -eu
cd "$(dirname "$0")/.."

example=finger_reach
folder=finger_reach
case "${1-}" in
  finger_reach) shift ;;
  swing_up | walker | identify)
    example=$1
    folder=$1
    shift
    ;;
  rotate_box | flip_box | assemble)
    example=$1
    folder=manipulation
    shift
    ;;
  -* | "") ;;
  *)
    echo "examples/run.sh: no example '$1'; known: finger_reach, swing_up, walker, identify," \
      "rotate_box, flip_box, assemble" >&2
    exit 2
    ;;
esac

tests/install_packages.sh build
launcher=
! command -v ccache >/dev/null || launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --preset release -DHBAR_BUILD_TESTS=OFF $launcher
cmake --build --preset release --target "$example" --parallel "$(nproc)"
mkdir -p "results/$example"
exec "build/release/examples/$folder/$example" --out "results/$example" "$@"
