#!/bin/sh
# clang-tidy 14 on the sources that differ from a base: tests/lint/tidy.sh [BASE [BUILD]]
#
# BASE is a commit, by default origin/main or else the last one; BUILD a configured build folder, by
# default build/release. A file takes 10 to 20 s, so this is not part of tests/run.sh.
cd "$(dirname "$0")/../.." || exit 2
base=${1:-}
build=${2:-build/release}
[ -n "$base" ] || base=$(git rev-parse --verify -q origin/main || echo HEAD~1)
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || {
  echo "tidy: clang-tidy 14 is not installed (apt-get install clang-tidy-14)" >&2
  exit 2
}
[ -f "$build/build.ninja" ] || {
  echo "tidy: $build is not configured (cmake --preset release)" >&2
  exit 2
}
cmake -B "$build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON > "$build/tidy.log" 2>&1 || {
  cat "$build/tidy.log"
  exit 2
}
changed=$(git diff --name-only --diff-filter=d "$base" -- \
          'core/*.cpp' 'scene/*.cpp' 'solvers/*.cpp' 'contact/*.cpp' 'adjoint/*.cpp' 'study/*.cpp' \
          'examples/*.cpp')
[ -n "$changed" ] || {
  echo "tidy: ok (0 files)"
  exit 0
}
if printf '%s\n' "$changed" | xargs -P "$(nproc)" -n 1 "$tidy" -p "$build" --quiet; then
  echo "tidy: ok ($(printf '%s\n' "$changed" | wc -l) files)"
else
  exit 1
fi
