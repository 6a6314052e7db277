# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.design STUDY.toml: what `ciliaval study` runs."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from pathlib import Path
from typing import Any

from .. import _core
from .._core import StudyFile, StudyStore
from ..command import (
    PASS, SOLVER, UNDECIDED, Progress, declare_common, json_text, printable, provenance, run_command, terminal_width,
    write_file, write_out,
)  # fmt: skip
from ..files import text_of
from .summary import Points, results_of, study_csv, study_json, text
from .tolerances import tolerance_csv, tolerance_json, tolerance_text


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.design", description=__doc__)
    parser.add_argument("file", metavar="STUDY.toml", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=Path("results"), help="results in OUTPUT/NAME")
    parser.add_argument("--json", type=Path, help="file to write the results to, too")
    parser.add_argument("--fresh", action="store_true", help="forget what an earlier run has solved")
    declare_common(parser)
    options = parser.parse_args()
    study = StudyFile(str(options.file))
    if options.json:
        kept = options.output / study.name / "points.sqlite"
        _core.check_outputs([os.fsencode(options.json), None, None], [*study.files, os.fsencode(kept)])
    progress = Progress(options.quiet)
    # While the store is open no other process writes to the folder.
    with contextlib.closing(StudyStore(study, os.fsencode(options.output), options.fresh)) as store:
        try:
            return _execute(study, store, options, progress)
        finally:
            progress.clear()


def _execute(study: StudyFile, store: StudyStore, options: argparse.Namespace, progress: Progress) -> int:
    """Computes what is missing and writes everything; the figures come last: without matplotlib the rest
    is there. SOLVER if every point failed, UNDECIDED if no design keeps the limits."""
    _announce(study, store.size)
    folder = options.output / study.name
    width = terminal_width()
    source = provenance(options)
    points: Points = []
    if not study.optimises:
        points = results_of(store.run(progress))
    words = text(study, points, width)
    document = study_json(study, points, source)
    code = SOLVER if points and all(_all_failed(pairs) for pairs in points) else PASS
    if study.parameters:
        write_file(folder / "study.csv", study_csv(study, points))
    if study.tolerances:
        write_file(folder / "tolerances.csv", tolerance_csv(study, points))
        document["tolerances"] = tolerance_json(study, points)
        words += tolerance_text(study, points, width)
    if study.optimises:
        from .optimum import optimise  # SciPy is half a second
        from .optimum_report import optimum_csv, optimum_json, optimum_text

        optimum = optimise(study, store, progress)
        write_file(folder / "optimum.csv", optimum_csv(study, optimum))
        document["optimum"] = optimum_json(study, optimum)
        words += optimum_text(study, optimum, width)
        if not optimum.found:
            code = SOLVER if _all_failed(optimum.designs[0].results.values()) else UNDECIDED
    progress.clear()
    text_of_json = json_text(document)
    write_file(folder / "study.json", text_of_json)
    write_out(printable(f"{words}\nResults: {folder}", "\n\t"))
    if options.json:
        write_file(options.json, text_of_json)
    _draw(document, folder)
    return code


def _announce(study: StudyFile, kept: int) -> None:
    """Says what the study goes on from."""
    if kept == 0:
        return
    what = f"{kept} of {study.all_points * len(study.mechanics)} solutions"
    if study.optimises:
        what = f"{kept} evaluations"
    _warn(f'study "{study.name}": {what} are there already; --fresh starts anew')


def _all_failed(results: Any) -> bool:
    return all(result.status == "failed" for result in results)


def _draw(document: dict[str, Any], folder: Path) -> None:
    if not document["parameters"]:
        return
    try:
        from ..plot.__main__ import save_study
        from ..results import Document

        save_study(Document("study", document), folder)
    except Exception as error:  # whatever a matplotlib of another build may raise
        _warn(f"the study is without its figures: {text_of(error)}")


def _warn(line: str) -> None:
    print(printable(f"ciliaval: {line}"), file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(run_command(main))
