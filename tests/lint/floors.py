#!/usr/bin/env python3
"""A file includes its own floor and what its floor's row lists, nothing else."""

import re

import lint

STANDARD = re.compile(r"[a-z_0-9]+$")
# Third-party libraries by the spelling of their headers.
LIBRARIES = {
    "eigen": r"(unsupported/)?Eigen/",
    "tinyxml2": r"tinyxml2\.h$",
    "suitesparse": r"(suitesparse/)?(SuiteSparse_config|SuiteSparseQR|umfpack|klu|cholmod|amd|colamd|"
                   r"camd|ccolamd|btf|spqr|cs)\w*\.(h|hpp)$",
    "lapack": r"(lapacke|lapack|cblas)\.h$",
    "mumps": r"[sdcz]mumps_c\.h$",
    "ipopt": r"(coin|coin-or)/|Ip\w+\.hpp$",
    "nlopt": r"nlopt\.h$",
    "cli11": r"CLI/",
    "json": r"nlohmann/",
    "fmt": r"fmt/",
    "gtest": r"g(test|mock)/",
    "benchmark": r"benchmark/",
    "mujoco": r"mujoco/",
    "posix": r"(sys/\w+|unistd|fcntl|signal|pthread|dlfcn|poll|stdlib|stdio)\.h$",
}
BELOW_STUDY = ("core", "scene", "solvers", "adjoint")
EVERY_FLOOR = (*BELOW_STUDY, "study")
SHARED = ("core/error.h", "core/scalar.h")  # what a floor without mechanics may know of core
# floor: (floors or single headers it may include, third-party libraries)
FLOORS = {
    "core": (("core",), ("eigen",)),
    "scene": (("core", "scene"), ("eigen", "tinyxml2", "posix")),
    "solvers": (("solvers", *SHARED),
                ("eigen", "suitesparse", "lapack", "mumps", "ipopt", "nlopt")),
    "adjoint": (("core", "solvers", "adjoint"), ("eigen",)),
    "study": (EVERY_FLOOR, ("eigen", "posix")),
    "examples": (EVERY_FLOOR, ("eigen", "cli11", "json", "fmt", "posix", "suitesparse")),
    "tests": (EVERY_FLOOR, tuple(LIBRARIES)),
}
# The composition root knows every floor but the one above it.
COMPOSITION_ROOT = re.compile(r"adjoint/load_problem\.(h|cpp)$")
# core evaluates: it opens no file and prints nothing.
NO_FILES = ("fstream", "filesystem", "iostream", "cstdio", "print")
# A reader of a library's header needs Eigen and the standard library, nothing else.
IN_HEADERS = ("eigen",)


def floors_of(file, floor):
    return BELOW_STUDY if COMPOSITION_ROOT.match(file) else FLOORS[floor][0]


def verdict(file, floor, bracket, path):
    """Why file may not include path, or None."""
    is_library = floor in EVERY_FLOOR
    house = re.match(r"hbar/((\w+)/.+)$", path)
    if house:
        allowed = floors_of(file, floor)
        if house.group(2) not in allowed and house.group(1) not in allowed:
            return "floor", f"{floor} may not include {path}"
        return None
    if bracket == '"':
        if is_library:
            return "floor", f'"{path}": house headers are spelled "hbar/FLOOR/name.h"'
        return None
    if STANDARD.match(path):
        if floor == "core" and path in NO_FILES:
            return "third-party", f"core opens no file and prints nothing: <{path}>"
        return None
    for library, spelling in LIBRARIES.items():
        if re.match(spelling, path):
            if library not in FLOORS[floor][1]:
                return "third-party", f"{floor} may not use {library}: <{path}>"
            if is_library and file.endswith(".h") and library not in IN_HEADERS:
                return "third-party", f"{library} belongs in a .cpp, not in a header: <{path}>"
            return None
    return "third-party", f"<{path}> is in no row of tests/lint/floors.py"


def check(root, files):
    for file in lint.cpp(files, FLOORS):
        floor = file.split("/")[0]
        for number, line in enumerate(lint.read(root, file).splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
            reason = include and verdict(file, floor, *include.groups())
            if reason:
                yield lint.Finding(file, number, *reason)


if __name__ == "__main__":
    lint.main("floors", check, lambda files: lint.cpp(files, FLOORS))
