#!/usr/bin/env python3
"""Every if, else, for, while and do has a body in braces; `else if` is the one exception."""

import re

import lint

KEYWORD = re.compile(r"\b(if|else|for|while|do)\b")
GAP = re.compile(r"(?:\s|\[\[[^\]]*\]\])*")  # blanks, and attributes such as [[likely]]


def skip(text, at):
    """Where the next word or sign after at begins."""
    return GAP.match(text, at).end()


def closing(text, at, pair):
    """Where the bracket opened at at is closed, or the end of text."""
    depth = 0
    for place in range(at, len(text)):
        if text[place] in pair:
            depth += 1 if text[place] == pair[0] else -1
            if depth == 0:
                return place
    return len(text)


def body(text, keyword):
    """Where the body of the statement that the match keyword begins stands, or None without one."""
    at = skip(text, keyword.end())
    if keyword.group() in ("else", "do"):
        return at
    if text.startswith("constexpr", at):
        at = skip(text, at + len("constexpr"))
    return skip(text, closing(text, at, "()") + 1) if text.startswith("(", at) else None


def unbraced(text):
    """(keyword, where its body begins) of every body without braces; text is code alone."""
    tails = set()  # where the `while` of a do-while stands
    for keyword in KEYWORD.finditer(text):
        at = body(text, keyword)
        if at is None or keyword.start() in tails:
            continue
        braced = text.startswith("{", at)
        if keyword.group() == "do":
            after = closing(text, at, "{}") + 1 if braced else at
            tail = re.compile(r"\bwhile\b").search(text, after)
            tails.add(tail.start() if tail else len(text))
        if not braced and not (keyword.group() == "else" and re.match(r"if\b", text[at:at + 3])):
            yield keyword, at


def check(root, files):
    for file in lint.cpp(files):
        text = lint.read(root, file)
        lines = text.splitlines()
        for keyword, _ in unbraced(lint.code(text, directives=False)):
            line = text.count("\n", 0, keyword.start()) + 1
            yield lint.Finding(file, line, "braces", lines[line - 1].strip())


if __name__ == "__main__":
    lint.main("braces", check, lint.cpp)
