# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.sensing CASE [READINGS]: what `ciliaval sense` runs."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from .. import _core
from ..command import (
    PASS, SOLVER, UNDECIDED, Outputs, Progress, declare_common, provenance, run_command, terminal_width, write_out,
)  # fmt: skip
from ..errors import InputError
from ..model import Case
from .readings import OPTIONS
from .response import Pair
from .loads import case_of, noise_of, readings_of, sensed

_GIVEN = (*OPTIONS, "models", "joints", "noise", "largest", "background")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.sensing", description=__doc__)
    parser.add_argument("files", type=Path, nargs="+", help="case or bench; readings")
    parser.add_argument("--fit", help="calibrate: numbers of the case, with commas between")
    parser.add_argument("-o", "--output", help="calibrate: the case to write")
    parser.add_argument("--validate", action="store_true", help="only check the benches that the files are")
    parser.add_argument("--skip", action="store_true")
    parser.add_argument("--models", help="mechanics/field; of several, with commas between, the spread of their loads")
    for name in _GIVEN:
        if name not in ("skip", "models"):
            parser.add_argument(f"--{name}")
    declare_common(parser)
    Outputs.declare(parser)
    options = parser.parse_args()
    if options.validate:
        return _validate(options.files)
    options.case, options.readings, *more = [*options.files, None][:2] + options.files[2:]
    if more:
        parser.error(f"a case and a file of readings, not {more[0]} too")
    progress = Progress(options.quiet)
    source = provenance(options)
    given = {name: value for name in _GIVEN if (value := getattr(options, name))}
    if options.case.name.endswith(".sense.toml"):
        return _simulate(options, given, source, progress)
    if options.readings is None:
        raise InputError(
            f"there is no file of readings after {options.case}; a test bench to be simulated is called NAME.sense.toml"
        )
    case = case_of(options.case)
    if options.fit is not None:
        options.csv = options.output  # checked as an output
    outputs = Outputs(options, [options.case, *case._core.files, options.readings, options.background])
    if options.fit is not None:
        return _calibrate(case, options, given, outputs, source, progress)
    of = _surface if case.loads[0].type == "sweep" else _loads
    result, text, code = of(case, options.readings, given, progress)
    progress.clear()
    write_out(text)
    outputs.write(lambda: dict(result.json(source)), result.csv)
    return code


def _validate(files: list[Path]) -> int:
    from .bench import read_bench

    for file in files:
        bench = read_bench(file)
        loads = len(bench.case.loads)
        write_out(
            f"{file}: the test bench is valid: {loads} loads at {bench.azimuths} azimuths, {bench.draws} draws"
        )
    return PASS


def _loads(case: Case, readings: Path, given: dict[str, Any], progress: Progress) -> tuple[Any, str, int]:
    """The load and its direction, with intervals, from each reading of the case's sensors."""
    result = sensed(case, readings, progress=progress, **given)
    status = result.loads.status
    if (status == "failed").any():
        code = SOLVER
    else:
        code = PASS if ((status == "found") | (status == "nothing")).any() else UNDECIDED
    return result, result.text(terminal_width()), code


def _calibrate(
    case: Case, options: argparse.Namespace, given: dict[str, Any], outputs: Outputs, source: Any, progress: Progress
) -> int:
    """Numbers of the case from readings at its loads. source: the provenance."""
    from .calibration import calibrate

    fit = [name.strip() for name in options.fit.split(",")]
    result = calibrate(case, options.readings, fit, progress=progress, **given)
    progress.clear()
    write_out(result.text(terminal_width()))
    outputs.write(lambda: result.json(source), result.case.toml)
    return PASS


def _surface(case: Case, readings: Path, given: dict[str, Any], progress: Progress) -> tuple[Any, str, int]:
    """The surface's levels from the readings of a sweep."""
    from .levels import LevelCurve, sense_surface

    pair, noise = Pair.of(given.pop("models", "elastica/volume")), noise_of(given.pop("noise", "1 uT"))
    asked, _ = given.pop("largest", None), given.pop("joints", None)
    read = readings_of(case, readings, **given)
    largest = _core.quantity(asked, "m") if asked else max(0.0, *(4 * load.magnitude for load in case.loads))
    if not 0 < largest < case.cilium.length:
        raise InputError("--largest: the largest interference lies between 0 and the length of the cilium")
    read.require_offset(f"{readings}: a surface")
    curve = LevelCurve(case, pair, largest, progress)
    result = sense_surface(case, read, pair, noise, curve)
    lines = [*read.remarks]
    if curve.limit:
        lines.append(
            f"Interferences are looked for up to {1e3 * curve.largest:.4g} mm, not {1e3 * largest:.4g} mm: {curve.limit}"
        )
    text = "\n".join([*lines, result.text(terminal_width())])
    return result, text, PASS if result.levels else UNDECIDED


def _simulate(options: argparse.Namespace, given: dict[str, Any], source: Any, progress: Progress) -> int:
    """The test bench."""
    from .bench import bench_json, bench_text, read_bench, run_bench

    if options.readings is not None:
        raise InputError(
            f"{options.case} is a test bench, which makes its own readings: leave {options.readings} out"
        )
    for name in [*given, *["csv"] * bool(options.csv)]:
        raise InputError(
            f"--{name}: a test bench states its models and errors in its file and has no table: leave it out"
        )
    bench = read_bench(options.case)
    outputs = Outputs(options, [options.case, bench.case.file, *bench.case._core.files])
    result = run_bench(bench, progress)
    progress.clear()
    write_out(bench_text(bench, result, terminal_width()))
    outputs.write(lambda: bench_json(bench, result, source))
    return PASS


if __name__ == "__main__":
    sys.exit(run_command(main))
