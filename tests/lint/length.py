#!/usr/bin/env python3
"""A file has at most 400 lines, a function at most 80."""

import re

import lint

FILE_LINES = 400
FUNCTION_LINES = 80
CONTAINER = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")

ACCESS = re.compile(r"(?<!\S)(public|protected|private)\s*$")


def functions(text):
    """(first line, lines) of every function: a brace with parentheses before it, in no function."""
    text = lint.code(text, directives=False)
    depth = 0       # braces open inside the present function or initialiser; 0: between them
    head = ""       # text since the last declaration ended
    start = 0       # where the present block's head begins
    for at, char in enumerate(text):
        if depth == 0:
            if char == "{":
                stripped = head.strip()
                if CONTAINER.search(stripped) and not stripped.endswith(")"):
                    head = ""
                    continue
                depth = 1
            elif char in ";}" or (char == ":" and ACCESS.search(head)):
                head = ""
            else:
                if not head.strip():
                    start = at
                head += char
        elif char == "{":
            depth += 1
        elif char == "}":
            depth -= 1
            if depth == 0:
                if "(" in head and not head.rstrip().endswith("="):
                    first = text.count("\n", 0, start) + 1
                    yield first, text.count("\n", 0, at) + 2 - first
                # `: a_{1}, b_{2} {`: a brace of an initialiser list is not the end of the head.
                if not re.match(r"\s*[,{]", text[at + 1:at + 200]):
                    head = ""


def check(root, files):
    for file in lint.cpp(files):
        text = lint.read(root, file)
        lines = len(text.splitlines())
        if lines > FILE_LINES:
            yield lint.Finding(file, FILE_LINES + 1, "file-length",
                               f"{lines} lines, at most {FILE_LINES} are allowed")
        for first, length in functions(text):
            if length > FUNCTION_LINES:
                yield lint.Finding(file, first, "function-length",
                                   f"{length} lines, at most {FUNCTION_LINES} are allowed")


if __name__ == "__main__":
    lint.main("length", check, lint.cpp)
