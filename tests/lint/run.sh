#!/bin/sh
# Runs every checker: tests/lint/run.sh [--planted]
#
# Prints one line per checker, `name: ok (N files)`, or its findings as `file:line: rule: text`; exits
# with 1 if there are any. --planted runs each on the violations planted for it in tests/planted.
cd "$(dirname "$0")" || exit 2
failed=0
for checker in *.py; do
  [ "$checker" = lint.py ] || python3 -B "$checker" "$@" || failed=1
done
exit $failed
