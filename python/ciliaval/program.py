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
from .results import load, read

# The program's exit codes, docs/guide/README.md.
_ERRORS = {2: InputError, 3: SolverError, 4: FileError}
_TOLD = (1, 3, 5)  # beside a result that says the same


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


def call(*arguments: str | Path, result: Path | None = None) -> str:
    """Runs the program and returns what it prints. Raises its error, with its text; not where the
    program has written `result` and says by its exit code what is to be seen there: a failed step,
    nothing to judge."""
    done = subprocess.run(
        [program(), "--quiet", *map(str, arguments)], capture_output=True, text=True, check=False
    )
    is_told = done.returncode in _TOLD and result is not None and result.exists()
    if done.returncode != 0 and not is_told:
        kind = _ERRORS.get(done.returncode, Error)
        raise kind(done.stderr.strip() or f"ciliaval ended with {done.returncode}")
    return done.stdout


def _json(command: str, *arguments: str | Path, **options: Any) -> Any:
    """A command's JSON. options: those of the program, `unit="mG"` for `--unit mG`; None is left out, of
    a list each is given."""
    words: list[str | Path] = []
    for name, value in options.items():
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is not None:
                words += [f"--{name}={one}"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{command}.json"
        call(command, *arguments, *words, "--json", file, result=file)
        return read(file)


def run(case: str | Path, folder: str | Path = "results") -> Any:
    """`ciliaval run`: runs a case and writes all results to folder/name; returns load() of it."""
    from .model import Case  # loads deal.II, which the other commands need not wait for

    written = Path(folder) / Case(case).name
    call("run", case, "-o", folder, result=written / "summary.json")
    return load(written)


def converge(case: str | Path, *, levels: int | None = None) -> Any:
    """`ciliaval converge`: errors over refinement, with extrapolation and observed orders.

    levels: of each refinement, from the coarsest; None: the program's 3. Returns the Document of its
    JSON (docs/guide/validation.md). Raises InputError, SolverError.
    """
    return _json("converge", case, levels=levels)


def budget(case: str | Path, *, without: Sequence[str] = ()) -> Any:
    """`ciliaval budget`: what each assumption of the paper's model costs.

    without: models that are left out; without=["solid", "potential"] takes a second. Returns the
    Document of its JSON (docs/guide/validation.md). Raises InputError, SolverError.
    """
    names = [without] if isinstance(without, str) else list(without)
    return _json("budget", case, without=names)


def study(
    file: str | Path, folder: str | Path | None = None, client: Any = None, *, fresh: bool = False
) -> Any:
    """`ciliaval study`: a parameter study.

    Args:
        folder: where its results go, and what it goes on from if it was stopped; None: they are
            read and thrown away.
        fresh: forget what an earlier run has solved.
        client: a dask.distributed.Client, whose workers then solve the points
            (docs/guide/studies.md).
    """
    with tempfile.TemporaryDirectory() as scratch:
        if client is not None:
            from .cluster import solve

            solve(file, folder or scratch, client)
        return _json("study", file, "-o", folder or scratch, *(["--fresh"] if fresh else []))
