"""Shared by all checkers: the files, code without comments and strings, and the report.

A checker is one file with one idea: a function `check(root, files)` that yields Findings, handed to
`lint.main`. `--planted` runs it on tests/planted/NAME instead, where it must report exactly the
lines that are marked: `planted: RULE` marks the next line, `planted-file: RULE` the first line.
"""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

REPOSITORY = Path(__file__).resolve().parents[2]
PLANTED = "tests/planted/"
LIBRARY = ("core", "contact", "solvers", "adjoint")
CPP = (".h", ".cpp")


class Finding(NamedTuple):
    file: str
    line: int
    rule: str
    text: str = ""


class Skipped(Exception):
    """The checker cannot run on this machine, and says why."""


def tracked_files(root):
    """Paths below root, relative: what git tracks, or all files where root is no git checkout."""
    paths = []
    if (root / ".git").exists():
        git = subprocess.run(["git", "-C", str(root), "ls-files", "-z"],
                             capture_output=True, text=True)
        paths = [p for p in git.stdout.split("\0") if p]
    if not paths:
        for folder, folders, names in os.walk(root):
            folders[:] = [f for f in folders if f not in ("build", "results", ".git")]
            paths += [os.path.relpath(os.path.join(folder, n), root) for n in names]
    return sorted(p for p in paths if not p.startswith(PLANTED) and (root / p).is_file())


def cpp(files, folders=None, suffixes=CPP):
    """The C++ files among files, of the given top-level folders only."""
    return [f for f in files
            if f.endswith(suffixes) and (folders is None or f.split("/")[0] in folders)]


_TOKENS = re.compile(
    r'''R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)"'''  # raw string
    r'''|"(?:\\.|[^"\\\n])*"'''                          # string
    r'''|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+\''''         # character, not a digit separator
    r'''|//[^\n]*|/\*.*?\*/''', re.DOTALL)               # comments


def _blank(match, keep_quotes):
    text = match.group(0)
    blanked = re.sub(r"[^\n]", " ", text)
    if text[0] == "/" or not keep_quotes or len(text) < 2:
        return blanked
    return '"' + blanked[1:-1] + '"'


def code(text, directives=True):
    """text with comments and the insides of strings blanked, every line break where it was."""
    text = _TOKENS.sub(lambda m: _blank(m, keep_quotes=True), text)
    if not directives:
        text = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", lambda m: _blank(m, False), text,
                      flags=re.MULTILINE)
    return text


def comments(text):
    """(line, comment) of every comment of text."""
    for match in _TOKENS.finditer(text):
        if match.group(0)[0] == "/":
            yield text.count("\n", 0, match.start()) + 1, match.group(0)


def read(root, file):
    return (root / file).read_text(encoding="utf-8")


def _expected(root):
    for file in tracked_files(root):
        for number, line in enumerate(read(root, file).splitlines(), 1):
            match = re.search(r"planted(-file)?: ([\w-]+)", line)
            if match:
                yield Finding(file, 1 if match.group(1) else number + 1, match.group(2))


def _check_planted(name, check):
    root = REPOSITORY / PLANTED / name
    expected = {f[:3] for f in _expected(root)}
    found = {f[:3] for f in check(root, tracked_files(root))}
    for file, line, rule in sorted(expected - found):
        print(f"{PLANTED}{name}/{file}:{line}: {rule}: planted, and not found")
    for file, line, rule in sorted(found - expected):
        print(f"{PLANTED}{name}/{file}:{line}: {rule}: found, and not planted")
    if not expected:
        print(f"{PLANTED}{name}: nothing planted")
    ok = bool(expected) and expected == found
    if ok:
        print(f"{name}: detects ({len(expected)} planted)")
    return ok


def main(name, check, subject):
    """Runs check over the repository, or over what is planted; subject picks the files counted."""
    parser = argparse.ArgumentParser(prog=name)
    parser.add_argument("--planted", action="store_true", help="verify that planted errors are found")
    parser.add_argument("--root", type=Path, default=REPOSITORY)
    options = parser.parse_args()
    try:
        if options.planted:
            sys.exit(0 if _check_planted(name, check) else 1)
        root = options.root.resolve()
        files = tracked_files(root)
        findings = sorted(set(check(root, files)))
    except Skipped as reason:
        print(f"{name}: skipped: {reason}")
        sys.exit(0)
    for finding in findings:
        print(f"{finding.file}:{finding.line}: {finding.rule}: {finding.text}")
    if not findings:
        print(f"{name}: ok ({len(subject(files))} files)")
    sys.exit(1 if findings else 0)
