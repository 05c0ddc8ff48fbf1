#!/bin/sh
# Searches for inputs that a reader mistreats:
#
#   tests/fuzz/run.sh [SECONDS] [TARGET...]
#
# Builds the fuzzing targets (with clang) and runs each, or those named, for so many seconds (20),
# starting from tests/fuzz/corpus/TARGET and from what earlier runs found worth keeping. Prints
# executions and findings of each; exits with 0 only if there is no finding. An input that was found
# is left in build/fuzz/findings/TARGET, and the report on it in build/fuzz/findings/TARGET.log.
cd "$(dirname "$0")/../.." || exit 2

seconds=20
case ${1:-} in
  -*) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  [0-9]*) seconds=$1; shift ;;
esac

launcher=
! command -v ccache >/dev/null || launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache
mkdir -p build/fuzz
{ cmake --preset fuzz $launcher && cmake --build --preset fuzz --parallel "$(nproc)"; } \
  > build/fuzz/build.log 2>&1 || { cat build/fuzz/build.log; exit 2; }

bin=build/fuzz/tests/fuzz
found=build/fuzz/findings
[ $# -gt 0 ] || set -- $(ls tests/fuzz/corpus)
"$bin/fuzz_dictionary" > build/fuzz/scene.dict || exit 2

# Files that targets write and read again; in memory if that is possible.
TMPDIR=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d) || exit 2
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
trap 'exit 130' INT TERM

failed=0
for target in "$@"; do
  if [ ! -x "$bin/fuzz_$target" ]; then
    echo "fuzz_$target: not built: it needs what is not installed (see build/fuzz/build.log)"
    failed=1
    continue
  fi
  mkdir -p "$found/$target" "build/fuzz/corpus/$target"
  dictionary=
  [ "$target" != scene ] || dictionary=-dict=build/fuzz/scene.dict
  log=$found/$target.log
  UBSAN_OPTIONS=print_stacktrace=1 "$bin/fuzz_$target" -max_total_time="$seconds" -timeout=10 \
    -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1 -artifact_prefix="$found/$target/" \
    $dictionary "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" > "$log" 2>&1
  status=$?
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  findings=0
  [ $status = 0 ] || { findings=1; failed=1; }  # libFuzzer ends at the first
  echo "fuzz_$target: ${executions:-unknown} executions, $findings findings"
  [ $status = 0 ] || grep -E '^(finding|SUMMARY|==[0-9]*== ?ERROR|.*runtime error|.*Test unit written)' "$log"
done
exit $failed
