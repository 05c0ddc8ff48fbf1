#!/usr/bin/env python3
"""Every declaration at namespace scope in a library header carries a `///` comment.

Overloads written without a blank line between them share the first one's comment. Aliases, forward
declarations, specialisations, definitions of members that were declared above and namespaces named
`detail` or `internal` need none.
"""

import re

import lint

TEMPLATE = r"(template\s*<[^{}]*?>\s*(requires[^{}]*?)?)?"
EXEMPT = re.compile(
    r"template\s*<\s*>|extern\s+template|static_assert|using\s|"
    rf"{TEMPLATE}using\s|"
    rf"{TEMPLATE}(class|struct|union|enum(\s+class)?)\s+\w+(\s*:\s*[\w:]+)?;|"  # forward
    rf"{TEMPLATE}(class|struct)\s+[\w:]+\s*<|"                                   # specialisation
    rf"{TEMPLATE}[^(=]*\b\w+(<[^()]*>)?::(~?\w+|operator\W+)\s*\(")                # member, outside
NAMESPACE = re.compile(r"(inline\s+)?namespace\b|extern\s*\"")
PRIVATE = re.compile(r"namespace(\s+(\w+::)*(detail|internal))?$")


def closing(text, at):
    """Position of the brace that closes the one at `at`."""
    depth = 0
    for position in range(at, len(text)):
        depth += (text[position] == "{") - (text[position] == "}")
        if depth == 0:
            return position
    return len(text) - 1


def declarations(text):
    """(start, end, text up to its `;` or `{`) of every declaration at namespace scope."""
    at = 0
    start = None
    parentheses = 0
    while at < len(text):
        char = text[at]
        if start is None and not (char.isspace() or char in ";}"):
            start = at
        parentheses += (char == "(") - (char == ")")
        if start is None or parentheses:
            pass
        elif char == ";":
            yield start, at, text[start:at + 1]
            start = None
        elif char == "{":
            head = text[start:at].strip()
            if NAMESPACE.match(head):
                if PRIVATE.match(head):
                    at = closing(text, at)
            else:
                brace, at = at, closing(text, at)
                yield start, at, text[start:brace + 1]
            start = None
        at += 1


def check(root, files):
    for file in lint.cpp(files, lint.LIBRARY, (".h",)):
        text = lint.read(root, file)
        lines = text.splitlines()
        code = lint.code(text, directives=False)
        group = -1  # the line that a declaration must start in to share the comment above it
        for start, end, head in declarations(code):
            first = code.count("\n", 0, start)
            comment = "///<" in lines[first] or lines[first - 1].lstrip().startswith("///")
            if comment or (first == group and "(" in head):
                group = code.count("\n", 0, end) + 1
            elif not EXEMPT.match(head):
                yield lint.Finding(file, first + 1, "documented", " ".join(head.split())[:80])


if __name__ == "__main__":
    lint.main("documented", check, lambda files: lint.cpp(files, lint.LIBRARY, (".h",)))
