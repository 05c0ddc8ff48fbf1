#!/usr/bin/env python3
"""Every source of the library has a twin test, and every test asserts something.

FOLDER/name.cpp is tested by tests/FOLDER/name_test.cpp, or by the file that COVERED names with its
reason.
"""

import re

import lint

# source: (test that covers it, why it has no twin of its own)
COVERED = {
    "core/scene/no_assimp.cpp": ("tests/core/scene/read_mesh_test.cpp", "a build without Assimp"),
}
TEST = re.compile(r"^\s*(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
ASSERTS = re.compile(r"\b(EXPECT|ASSERT)_\w+|\b(ADD_FAILURE|FAIL|SUCCEED|GTEST_SKIP)\b|\bexpect_\w+")


def body(text, at):
    """The block that opens after `at`."""
    start = text.find("{", at)
    depth = 0
    for position in range(start, len(text)):
        depth += (text[position] == "{") - (text[position] == "}")
        if depth == 0:
            return text[start:position]
    return text[start:]


def check(root, files):
    present = set(files)
    for file in lint.cpp(files, lint.LIBRARY, (".cpp",)):
        folder, name = file.rsplit("/", 1)
        twin = f"tests/{folder}/{name[:-4]}_test.cpp"
        covering = COVERED.get(file, (twin,))[0]
        if covering not in present:
            yield lint.Finding(file, 1, "twin", f"{covering} does not exist")
    for file in lint.cpp(files, ("tests",), (".cpp",)):
        text = lint.code(lint.read(root, file), directives=False)
        for test in TEST.finditer(text):
            if not ASSERTS.search(body(text, test.end())):
                line = text.count("\n", 0, test.start(1)) + 1
                yield lint.Finding(file, line, "asserts",
                                   f"{test.group(1)}.{test.group(2)} asserts nothing")


if __name__ == "__main__":
    lint.main("twins", check, lambda files: lint.cpp(files, lint.LIBRARY, (".cpp",)))
