#!/usr/bin/env python3
"""The library does not print, exit, allocate by hand, draw unseeded numbers or keep dead code.

A line that must break a rule says so and why: `// NOLINT(hbar-RULE): reason`,
or the line before it does with NOLINTNEXTLINE.
"""

import re

import lint

# Rules for the code of the library.
IN_LIBRARY = {
    "print": r"\bstd::(cout|cerr|clog)\b|\b(f|v|vf)?printf\s*\(|\b(f?puts|putchar|perror)\s*\(",
    "exit": r"\b(exit|_Exit|quick_exit|abort|terminate)\s*\(",
    "using-namespace": r"\busing\s+namespace\b",
    "naked-new": r"(?<!operator )\bnew\b(?!\s*\[?\]?\s*\()|(?<!operator )(?<!= )(?<!=)\bdelete\b|"
                 r"\b(malloc|calloc|realloc|free)\s*\(",
}
# Rules for all code. Outside the library a function may use a namespace, a file may not.
EVERYWHERE = {
    "using-namespace": r"^using\s+namespace\b",
    "random": r"(?<![\w.>])s?rand\s*\(|\brandom_device\b",
}
CODE_IN_COMMENT = re.compile(r"//(?!/)\s*(?P<text>\S.*[;{}])$")
LOOKS_LIKE_CODE = re.compile(r"\w\(.*\)|[\w\])] ?[-+*/]?= ?\S|->|::|^[{}]|"
                             r"^(return|else|break|continue)\b|^(if|for|while|switch) ?\(")


def allowed(lines, number, rule):
    """Whether line number, or the one before it, allows the rule to be broken there."""
    before = lines[number - 2] if number > 1 else ""
    return (re.search(rf"NOLINT\(hbar-{rule}\): \S", lines[number - 1]) or
            re.search(rf"NOLINTNEXTLINE\(hbar-{rule}\): \S", before))


def in_code(text, rules):
    original = text.splitlines()
    for number, line in enumerate(lint.code(text).splitlines(), 1):
        if re.match(r"\s*#\s*include\b", line):
            continue
        for rule, pattern in rules.items():
            if re.search(pattern, line) and not allowed(original, number, rule):
                yield number, rule, original[number - 1].strip()


def in_comments(text):
    original = text.splitlines()
    for first, comment in lint.comments(text):
        for number, line in enumerate(comment.splitlines(), first):
            if re.search(r"\b(TODO|FIXME|XXX)\b(?!\(#\d+\))", line):
                yield number, "todo", "write TODO(#issue)"
        dead = CODE_IN_COMMENT.match(comment)
        if dead and LOOKS_LIKE_CODE.search(dead["text"]):
            if not original[first - 1].split("//")[0].strip():
                yield first, "commented-out", dead["text"]


def check(root, files):
    for file in lint.cpp(files):
        text = lint.read(root, file)
        rules = EVERYWHERE | (IN_LIBRARY if file.split("/")[0] in lint.LIBRARY else {})
        for finding in [*in_code(text, rules), *in_comments(text)]:
            yield lint.Finding(file, *finding)


if __name__ == "__main__":
    lint.main("banned", check, lint.cpp)
