#!/bin/sh
# Installs what is missing, builds hbar and runs all tests, from a bare Debian 12 or Ubuntu 24.04:
#
#   tests/run.sh                 release build, checkers, tests, a stranger's project
#   tests/run.sh --dev           and the same tests under address and undefined-behaviour sanitizers
#   tests/run.sh --tsan          and under the thread sanitizer
#   tests/run.sh --fuzz          and a short search for inputs that a reader mistreats (needs clang)
#   tests/run.sh --full          and all of it, without the optional components as well; every
#                                allocation of short runs of the command fails once, and a solve is
#                                killed at more moments; the benchmarks are built
#   tests/run.sh --no-install    install no packages
#
# Ends with ctest's closing line over all of it, and exits with 0 only if everything passed.
cd "$(dirname "$0")/.." || exit 2

install=yes
presets=release
full=no
fuzz=no
for option in "$@"; do
  case $option in
    --dev) presets="$presets dev" ;;
    --tsan) presets="$presets tsan" ;;
    --fuzz) fuzz=yes ;;
    --full) full=yes; fuzz=yes ;;
    --no-install) install=no ;;
    *) sed -n '2,13s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
done
[ "$full" = no ] || presets="release bare dev tsan"

passed=0
failed=0

# What --full adds to the presets chosen.
left_out() {
  for preset in bare dev tsan; do
    case " $presets " in
      *" $preset "*) ;;
      *) printf '%s build, ' "$preset" ;;
    esac
  done
  [ "$fuzz" = yes ] || printf 'fuzzing, '
  echo "every place of the fault injection, build of the benchmarks"
}

finish() {
  total=$((passed + failed))
  [ "$total" -gt 0 ] || { total=1; failed=1; }
  echo
  [ "$full" = yes ] || echo "not run: $(left_out) (tests/run.sh --full)"
  echo "$((100 * (total - failed) / total))% tests passed, $failed tests failed out of $total"
  [ "$failed" -eq 0 ]
  exit
}

# A step that is no test: its failure is one failed test and the end.
step() {
  echo "== $*"
  "$@" || { echo "tests/run.sh: failed: $*" >&2; failed=$((failed + 1)); finish; }
}

# ctest of one preset; counts what it ran.
run_tests() {
  echo "== ctest --preset $1"
  log=build/$1/ctest.log
  # The checkers and the stranger's project are the same in every build: once is enough.
  once=; [ "$1" = release ] || once="-LE once"
  { ctest --preset "$1" --no-tests=error -j "$(nproc)" $once; echo "status $?"; } \
    2>&1 | tee "$log" | grep -v '^status '
  counts=$(sed -n 's/.* tests passed, \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' "$log")
  status=$(sed -n 's/^status //p' "$log")
  bad=${counts% *}
  all=${counts#* }
  if [ -z "$counts" ] || { [ "$status" != 0 ] && [ "$bad" = 0 ]; }; then
    failed=$((failed + 1))
  fi
  failed=$((failed + ${bad:-0}))
  passed=$((passed + ${all:-0} - ${bad:-0}))
  # A test of ctest is a suite of several; GoogleTest says how many, and names what it skipped.
  ran=build/$1/Testing/Temporary/LastTest.log
  [ ! -f "$ran" ] || awk -v preset="$1" '
    /^\[  PASSED  \] [0-9]+ test/ { single += $4 }
    /^\[  SKIPPED \] [0-9]+ test/ { skipped += $4 }
    /^\[  SKIPPED \] [^ ]+$/ { print "skipped: " $4 }
    END { print preset ": " single " single tests passed in these suites, " skipped + 0 " skipped" }
  ' "$ran"
}

kind=test
[ "$fuzz" = no ] || kind=fuzz
[ "$full" = no ] || kind=full
[ "$install" = no ] || step tests/install_packages.sh $kind

launcher=
! command -v ccache >/dev/null || launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
for preset in $presets; do
  step cmake --preset "$preset" -DHBAR_BUILD_TESTS=ON $launcher
  # A job per core: more only fight for its cache (8 % slower with two jobs per core).
  step cmake --build --preset "$preset" --parallel "$(nproc)"
  run_tests "$preset"
done
if [ "$fuzz" = yes ]; then
  echo "== tests/fuzz/run.sh"
  if tests/fuzz/run.sh; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
fi
if [ "$full" = yes ]; then
  step env HBAR_EVERY_FAULT=1 ctest --preset release -R "Faults|Resume" -j "$(nproc)" \
    --timeout 7200
  step cmake --preset release -DHBAR_BUILD_BENCHMARKS=ON
  step cmake --build --preset release --parallel "$(nproc)" --target hbar_benchmarks
  step cmake --preset release -DHBAR_BUILD_BENCHMARKS=OFF
fi
finish
