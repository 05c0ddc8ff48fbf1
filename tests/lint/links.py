#!/usr/bin/env python3
"""Relative links in the documents lead to a file, and to a heading where they name one; files that
the documents name by their paths are there."""

import re

import lint

LINK = re.compile(r"\[[^\]\n]*\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)|^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
PATH = re.compile(r"`((?:adjoint|cmake|contact|core|doc|examples|solvers|tests)/[a-z_\d./-]+\.\w+)`")
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)


def prose(text):
    return CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


def anchors(text):
    """The names that headings get: lower case, words joined by hyphens, punctuation dropped."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+\s+(.*?)\s*#*$", text, re.MULTILINE):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def markdown(files):
    return [f for f in files if f.endswith(".md")]


def check(root, files):
    for file in markdown(files):
        whole = lint.read(root, file)
        if file != "CHANGELOG.md":  # which names what was
            for match in PATH.finditer(whole):
                if not (root / match.group(1)).exists():
                    line = whole.count("\n", 0, match.start()) + 1
                    yield lint.Finding(file, line, "path", f"{match.group(1)} does not exist")
        text = prose(whole)
        for match in LINK.finditer(text):
            target = match.group(1) or match.group(2)
            if re.match(r"[a-z][a-z0-9+.-]*:", target):
                continue
            path, _, anchor = target.partition("#")
            line = text.count("\n", 0, match.start()) + 1
            place = (root / file).parent / path if path else root / file
            if path.startswith("/") or not place.exists():
                yield lint.Finding(file, line, "link", f"{target} does not exist")
            elif anchor and place.suffix == ".md" and anchor not in anchors(place.read_text("utf-8")):
                yield lint.Finding(file, line, "link", f"{target}: no such heading")


if __name__ == "__main__":
    lint.main("links", check, markdown)
