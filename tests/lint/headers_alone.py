#!/usr/bin/env python3
"""Every library header compiles alone: it includes what it needs.

A header that compiled is remembered in build/lint by the contents of all it includes of hbar, so
only what changed is compiled again. What takes most of the time is compiled once: a header finds
the first of BASES that it includes, itself or through hbar's headers, precompiled.
"""

import hashlib
import os
import re
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import lint

FLAGS = ["-std=c++20", "-DEIGEN_MAX_ALIGN_BYTES=64",
         "-DEIGEN_MAX_STATIC_ALIGN_BYTES=16", "-DEIGEN_MALLOC_ALREADY_ALIGNED=0", "-Wall",
         "-Wextra", "-Werror"]


# From large to small; each is read by many headers. Eigen/Core comes last.
BASES = ["adjoint/terms/objective.h", "core/model/mechanism.h"]


def eigen_folder():
    run = subprocess.run(["pkg-config", "--variable=includedir", "eigen3"], capture_output=True,
                         text=True)
    folder = run.stdout.strip() or "/usr/include"
    return folder if folder.endswith("eigen3") else folder + "/eigen3"


def closure(root, file, seen):
    """file and all headers of hbar it includes, directly or not."""
    if file in seen or not (root / file).is_file():
        return seen
    seen.add(file)
    for included in re.findall(r'#\s*include\s*"hbar/([^"]+)"', lint.read(root, file)):
        closure(root, included, seen)
    return seen


def includes_eigen(root, file):
    return any(re.search(r"#\s*include\s*<Eigen/", lint.read(root, part))
               for part in closure(root, file, set()))


def base_of(root, file):
    """What `file` finds precompiled: the text of an include line; None if nothing is."""
    parts = closure(root, file, set())
    for base in BASES:
        if base in parts and base != file:
            return f'"hbar/{base}"'
    return "<Eigen/Core>" if includes_eigen(root, file) else None


def key(root, file, compiler):
    digest = hashlib.sha256(compiler.encode())
    for part in sorted(closure(root, file, set())):
        digest.update(part.encode() + b"\0" + (root / part).read_bytes())
    return digest.hexdigest()


def headers(files):
    return lint.cpp(files, lint.LIBRARY, (".h",))


def check(root, files):
    command = [os.environ.get("CXX", "g++"), *FLAGS, "-isystem", eigen_folder()]
    compiler = " ".join(command) + subprocess.run([command[0], "--version"], capture_output=True,
                                                  text=True).stdout
    memory = lint.REPOSITORY / "build" / "lint"
    memory.mkdir(parents=True, exist_ok=True)
    remembered = {file: memory / key(root, file, compiler) for file in headers(files)}
    new = [file for file in remembered if not remembered[file].exists()]
    if not new:
        return

    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "hbar").mkdir()
        for layer in lint.LIBRARY:
            Path(folder, "hbar", layer).symlink_to(root / layer)
        bases = {file: base_of(root, file) for file in new}
        names = {base: f"base_{i}.h" for i, base in enumerate(sorted(set(bases.values()) - {None}))}

        def precompile(base):
            header = Path(folder, names[base])
            header.write_text(f"#include {base}\n")
            run = subprocess.run([*command, "-I", folder, "-x", "c++-header", str(header), "-o",
                                  f"{header}.gch"], capture_output=True)
            if run.returncode != 0:  # a base that does not compile is found by itself
                header.write_text("")

        def compile_alone(file):
            first = ["-include", names[bases[file]]] if bases[file] else []
            run = subprocess.run([*command, "-fsyntax-only", "-I", folder, *first, "-include",
                                  f"hbar/{file}", "-x", "c++", "/dev/null"],
                                 cwd=folder, capture_output=True, text=True)
            if run.returncode == 0:
                remembered[file].touch()
                return []
            error = re.search(r"hbar/(\S+?):(\d+):\d+: (?:fatal )?error: (.*)", run.stderr)
            where = (error.group(1), int(error.group(2))) if error else (file, 1)
            text = error.group(3) if error else run.stderr.strip()[:200]
            return [lint.Finding(*where, "alone", f"{file} alone: {text}")]

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(precompile, names))
            for findings in pool.map(compile_alone, new):
                yield from findings


if __name__ == "__main__":
    lint.main("headers_alone", check, headers)
