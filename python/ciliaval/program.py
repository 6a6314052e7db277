# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program's commands as functions. Each starts `ciliaval` and reads what it has written."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .errors import Error, FileError, InputError, SolverError

# The program's exit codes, docs/guide/README.md.
_ERRORS = {2: InputError, 3: SolverError, 4: FileError}


def program() -> str:
    """The program: $CILIAVAL_PROGRAM, the one installed with this package or of its build tree, or
    that in PATH."""
    package = Path(__file__).parent
    places = [package / "bin" / "ciliaval", package.parents[1] / "ciliaval"]
    beside = next((str(p) for p in places if p.is_file()), None)
    found = os.environ.get("CILIAVAL_PROGRAM") or beside or shutil.which("ciliaval")
    if not found:
        raise FileError(
            "the program `ciliaval` was not found: put it in PATH or name it in CILIAVAL_PROGRAM"
        )
    return found


def call(*arguments: str | Path, accept: Sequence[int] = (0,)) -> str:
    """Runs the program and returns what it prints. Raises its error, with its text."""
    done = subprocess.run(
        [program(), "--quiet", *map(str, arguments)], capture_output=True, text=True, check=False
    )
    if done.returncode not in accept:
        kind = _ERRORS.get(done.returncode, Error)
        raise kind(done.stderr.strip() or f"ciliaval ended with {done.returncode}")
    return done.stdout


def _json(command: str, *arguments: str | Path, accept: Sequence[int] = (0,)) -> Any:
    from .results import read

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{command}.json"
        call(command, *arguments, "--json", file, accept=accept)
        return read(file)


def run(case: str | Path, folder: str | Path = "results") -> Any:
    """`ciliaval run`: runs a case and writes all results to folder/name; returns load() of it."""
    from .model import Case
    from .results import load

    call("run", case, "-o", folder, accept=(0, 3))  # a failed step is a result
    return load(Path(folder) / Case(case).name)


def converge(case: str | Path, *arguments: str) -> Any:
    """`ciliaval converge`: errors over refinement, with extrapolation and observed orders."""
    return _json("converge", case, *arguments, accept=(0, 1, 3))


def budget(case: str | Path, *arguments: str) -> Any:
    """`ciliaval budget`: what each assumption of the paper's model costs."""
    return _json("budget", case, *arguments)


def sense(case: str | Path, *arguments: str | Path) -> Any:
    """`ciliaval sense`: loads from a file of readings, sense(case, "readings.csv")."""
    return _json("sense", case, *arguments, accept=(0, 5))


def study(file: str | Path, folder: str | Path | None = None, client: Any = None) -> Any:
    """`ciliaval study`: a parameter study.

    Args:
        folder: where its results go, and what it goes on from if it was stopped; None: they are
            read and thrown away.
        client: a dask.distributed.Client, whose workers then solve the points
            (docs/guide/studies.md).
    """
    with tempfile.TemporaryDirectory() as scratch:
        if client is not None:
            from .cluster import solve

            solve(file, folder or scratch, client)
        return _json("study", file, "-o", folder or scratch, accept=(0, 3))
