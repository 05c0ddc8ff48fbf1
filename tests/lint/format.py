#!/usr/bin/env python3
"""Every C++ file is as clang-format 14 writes it."""

import re
import shutil
import subprocess

import lint


def clang_format():
    for name in ("clang-format-14", "clang-format"):
        if shutil.which(name):
            version = subprocess.run([name, "--version"], capture_output=True, text=True).stdout
            if " 14." in version:
                return name
    raise lint.Skipped("clang-format 14 is not installed, and other versions format differently")


def check(root, files):
    sources = lint.cpp(files)
    if not sources:
        return
    run = subprocess.run([clang_format(), "--dry-run", "-Werror", *sources], cwd=root,
                         capture_output=True, text=True)
    lines = {}
    for line in run.stderr.splitlines():
        match = re.match(r"(.+?):(\d+):\d+: error: .*clang-formatted", line)
        if match:
            lines.setdefault(match.group(1), set()).add(int(match.group(2)))
    for file, wrong in lines.items():
        yield lint.Finding(file, min(wrong), "format",
                           f"clang-format 14 writes {len(wrong)} lines differently")



if __name__ == "__main__":
    lint.main("format", check, lint.cpp)
