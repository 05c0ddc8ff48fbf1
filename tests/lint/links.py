#!/usr/bin/env python3
"""Relative links in the documents lead to a file, and to a heading where they name one."""

import re

import lint

LINK = re.compile(r"\[[^\]\n]*\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)|^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
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
        text = prose(lint.read(root, file))
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
