#!/usr/bin/env python3
"""Every C++ snippet of a document is compiled: its lines stand one after the other, but for a common
indentation, in a .cpp file of tests/doc or examples."""

import re

import lint

COMPILED = ("tests/doc/", "examples/")
BLOCK = re.compile(r"^ *```(?:cpp|c\+\+)[ \t]*\n(?P<code>.*?)^ *```", re.MULTILINE | re.DOTALL)


def documents(files):
    """The Markdown files that a user reads. The changelog also quotes what is no more."""
    return [f for f in files if f.endswith(".md") and f != "CHANGELOG.md" and
            (f.startswith("doc/") or "/" not in f)]


def dedent(lines):
    """lines without their common indentation and without blanks at their ends."""
    lines = [line.rstrip() for line in lines]
    indent = min((len(line) - len(line.lstrip()) for line in lines if line), default=0)
    return [line[indent:] for line in lines]


def agreement(snippet, lines):
    """How many lines of the snippet, from its first on, stand in lines: the longest such run."""
    best = 0
    for start, line in enumerate(lines):
        count = 0
        if line.strip() == snippet[0].strip():
            count = 1
            while (count < len(snippet) and
                   dedent(lines[start:start + count + 1]) == dedent(snippet[:count + 1])):
                count += 1
        best = max(best, count)
    return best


def complaint(snippet, sources):
    """Why a snippet is not compiled, or None."""
    if not snippet:
        return "the block is empty"
    counts = {source: agreement(snippet, lines) for source, lines in sources.items()}
    nearest = max(counts, key=counts.get, default=None)
    count = counts.get(nearest, 0)
    if count == len(snippet):
        return None
    if count == 0:
        return f"'{snippet[0].strip()}' is in no .cpp file of tests/doc or examples"
    after = next(line for line in snippet[count - 1::-1] if line.strip()).strip()
    return f"'{snippet[count].strip()}' does not follow '{after}' in {nearest}"


def check(root, files):
    sources = {f: lint.read(root, f).splitlines() for f in lint.cpp(files, suffixes=(".cpp",))
               if f.startswith(COMPILED)}
    for file in documents(files):
        text = lint.read(root, file)
        for block in BLOCK.finditer(text):
            snippet = block["code"].splitlines()
            while snippet and not snippet[0].strip():
                snippet.pop(0)
            while snippet and not snippet[-1].strip():
                snippet.pop()
            reason = complaint(snippet, sources)
            if reason:
                line = text.count("\n", 0, block.start()) + 1
                yield lint.Finding(file, line, "snippet", reason)


if __name__ == "__main__":
    lint.main("snippets", check, documents)
