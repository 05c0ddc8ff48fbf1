#!/usr/bin/env python3
"""A file includes its own folder and what its folder's row lists, nothing else; and no two files of
the library include each other, directly or through others."""

import re

import lint

STANDARD = re.compile(r"[a-z_0-9]+$")
# Third-party libraries by the spelling of their headers.
LIBRARIES = {
    "eigen": r"(unsupported/)?Eigen/",
    "tinyxml2": r"tinyxml2\.h$",
    "assimp": r"assimp/",
    "suitesparse": r"(suitesparse/)?(SuiteSparse_config|SuiteSparseQR|umfpack|klu|cholmod|amd|colamd|"
                   r"camd|ccolamd|btf|spqr|cs)\w*\.(h|hpp)$",
    "lapack": r"(lapacke|lapack|cblas)\.h$",
    "mumps": r"[sdcz]mumps_c\.h$",
    "ipopt": r"(coin|coin-or)/|Ip\w+\.hpp$",
    "nlopt": r"nlopt\.h$",
    "cli11": r"CLI/",
    "json": r"nlohmann/",
    "fmt": r"fmt/",
    "zlib": r"zlib\.h$",
    "gtest": r"g(test|mock)/",
    "benchmark": r"benchmark/",
    "mujoco": r"mujoco/",
    "posix": r"(sys/\w+|unistd|dirent|fcntl|signal|pthread|dlfcn|poll|stdlib|stdio)\.h$",
}
# folder: (folders it may include, and with them what those may; third-party libraries)
LAYERS = {
    "core/base": ((), ("eigen",)),
    "core/geometry": (("core/base",), ("eigen",)),
    "core/model": (("core/geometry",), ("eigen",)),
    "core/dynamics": (("core/model",), ("eigen",)),
    "core/parameters": (("core/dynamics",), ("eigen",)),
    "core/files": (("core/base",), ("eigen", "posix")),
    "core/scene": (("core/files", "core/model"), ("eigen", "tinyxml2", "assimp", "posix")),
    "contact": (("core/parameters",), ("eigen",)),
    "solvers/linear": (("core/base",), ("eigen", "suitesparse", "lapack", "mumps")),
    "solvers/newton": (("core/base",), ("eigen",)),
    "solvers/nlp": (("solvers/linear",), ("eigen", "ipopt", "nlopt")),
    "adjoint/stage": (("contact",), ("eigen",)),
    "adjoint/outputs": (("contact",), ("eigen",)),
    "adjoint/trajectory": (("adjoint/stage", "adjoint/outputs", "solvers/newton"), ("eigen",)),
    "adjoint/terms": (("adjoint/trajectory",), ("eigen",)),
    "adjoint/design": (("core/parameters",), ("eigen",)),
    "adjoint/derivatives": (("adjoint/terms", "solvers/nlp"), ("eigen",)),
    "adjoint/systems": (("adjoint/derivatives",), ("eigen",)),
    "adjoint/programs": (("adjoint/derivatives", "adjoint/design"), ("eigen",)),
    "adjoint/study": (("adjoint/programs", "core/files"), ("eigen", "posix")),
    # The headers for users.
    "solvers": (("solvers/nlp",), ()),
    "adjoint": (("adjoint/programs", "adjoint/systems", "core/scene"), ()),
}
# Single files that may include more than their folder: the one place where scenes meet
# trajectories, and the header of a component.
MORE = {"adjoint/programs/load_problem": ("core/scene",), "adjoint/study": ("adjoint/study",)}
# Has the same table for people.
PAGE = "doc/architecture.md"
# Programs stand on the whole library.
PROGRAMS = {
    "examples": ("eigen", "cli11", "json", "fmt", "posix", "zlib"),
    "tests": tuple(LIBRARIES),
}
# Mechanics opens no file and prints nothing.
NO_FILES = ("fstream", "filesystem", "iostream", "cstdio", "print")
MAY_OPEN_FILES = ("core/files", "core/scene", "adjoint/programs", "adjoint/study")
# A reader of a library's header needs Eigen and the standard library, nothing else.
IN_HEADERS = ("eigen",)


def below(folder):
    """The folder and all that it may include."""
    folders = {folder}
    for other in LAYERS.get(folder, ((), ()))[0]:
        folders |= below(other)
    return folders


def row_of(file):
    """(name of the row, folders that the file may include, libraries, whether it is the library's)."""
    top, folder = file.split("/")[0], file.rsplit("/", 1)[0]
    if top in PROGRAMS:
        return top, set(LAYERS), PROGRAMS[top], False
    allowed = below(folder)
    for other in MORE.get(file.rsplit(".", 1)[0], ()):
        allowed |= below(other)
    return folder, allowed, LAYERS.get(folder, ((), ()))[1], True


def verdict(file, bracket, path):
    """Why file may not include path, or None."""
    row, folders, libraries, is_library = row_of(file)
    if re.match(r"hbar/[^/]+$", path):
        return ("layer", f"{path} is for users") if is_library else None
    own = re.match(r"hbar/(.+)/[^/]+$", path)
    if own:
        return None if own.group(1) in folders else ("layer", f"{row} may not include {path}")
    if bracket == '"':
        if is_library:
            return "layer", f'"{path}": hbar\'s headers are spelled "hbar/LAYER/FOLDER/name.h"'
        return None
    if STANDARD.match(path):
        if is_library and path in NO_FILES and row not in MAY_OPEN_FILES and "solvers" not in row:
            return "third-party", f"{row} opens no file and prints nothing: <{path}>"
        return None
    for library, spelling in LIBRARIES.items():
        if re.match(spelling, path):
            if library not in libraries:
                return "third-party", f"{row} may not use {library}: <{path}>"
            if is_library and file.endswith(".h") and library not in IN_HEADERS:
                return "third-party", f"{library} belongs in a .cpp, not in a header: <{path}>"
            return None
    return "third-party", f"<{path}> is in no row of tests/lint/layers.py"


def includes(root, file):
    """(line, bracket, path) of every include directive."""
    for number, line in enumerate(lint.read(root, file).splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        if match:
            yield number, *match.groups()


def cycles(root, files):
    """Includes between files of the library, a header and its source as one, that close a cycle."""
    stems = {}  # stem: [(other stem, file, line)]
    for file in lint.cpp(files, lint.LIBRARY):
        stem = file.rsplit(".", 1)[0]
        for number, _, path in includes(root, file):
            own = re.match(r"hbar/(.+)\.h$", path)
            if own and own.group(1) != stem:
                stems.setdefault(stem, []).append((own.group(1), file, number))

    def reaches(start, goal):
        seen, waiting = set(), [start]
        while waiting:
            stem = waiting.pop()
            if stem == goal:
                return True
            if stem not in seen:
                seen.add(stem)
                waiting += [other for other, _, _ in stems.get(stem, ())]
        return False

    for stem, edges in stems.items():
        for other, file, number in edges:
            if reaches(other, stem):
                yield lint.Finding(file, number, "cycle", f"{other} includes {stem}, too")


def documented(root, page):
    """Rows of the page's table of folders that differ from LAYERS, and rows that are missing there."""
    tabled = {}
    for number, line in enumerate(lint.read(root, page).splitlines(), 1):
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) == 4 and re.fullmatch(r"`[\w/]+`", cells[0]):
            tabled[cells[0].strip("`")] = number, tuple(re.findall(r"`([\w/]+)`", cells[2]))
    for folder, (number, names) in tabled.items():
        if names != LAYERS.get(folder, (None,))[0]:
            yield lint.Finding(page, number, "page", f"{folder} differs from tests/lint/layers.py")
    for folder, (_, libraries) in LAYERS.items():
        if libraries and folder not in tabled:
            yield lint.Finding(page, 1, "page", f"{folder} has no row")


def check(root, files):
    if PAGE in files:
        yield from documented(root, PAGE)
    for file in lint.cpp(files, (*lint.LIBRARY, *PROGRAMS)):
        for number, bracket, path in includes(root, file):
            reason = verdict(file, bracket, path)
            if reason:
                yield lint.Finding(file, number, *reason)
    yield from cycles(root, files)


if __name__ == "__main__":
    lint.main("layers", check, lambda files: lint.cpp(files, (*lint.LIBRARY, *PROGRAMS)))
