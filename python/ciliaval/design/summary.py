# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study's results as a table for the terminal, study.csv and study.json, and what all its tables and
files share. Numbers in files are in SI units, with the digits that give them back."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from .. import _core
from .._core import StudyFile, StudyOutput, StudyParameter
from ..command import printable

_MOST_ROWS = 25
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|-?(inf|nan)")


class Result(NamedTuple):
    """Results of a pair of models at a point. SI units."""

    status: str  # "converged", "slipped_off", "pulled_in", "failed"
    message: str  # why it failed or slipped off, or why a value is missing; else empty
    values: Sequence[float | None]  # of the study's outputs, in their order
    uncertainty: float | None = None  # numerical, of the components of dB, T
    range_uncertainty: float | None = None  # numerical, in the range's unit
    model_uncertainty: float | None = None  # what the models leave out, of the components of dB, T
    range_model_uncertainty: float | None = None  # likewise of a range by slip-off


Points = Sequence[Sequence[Result]]  # of each point, in the order of the pairs


def results_of(points: Iterable[Iterable[tuple[Any, ...]]]) -> list[list[Result]]:
    """Results from the tuples that StudyStore returns."""
    return [[Result(*pair) for pair in pairs] for pairs in points]


# Texts.


def number_text(value: float | None, size: float = 1.0, digits: int = 5) -> str:
    """A value in a unit of this size; "-" if there is none, and no sign of a zero."""
    if value is None or not math.isfinite(value):
        return "-"
    text = f"{value / size:.{digits}g}"
    return text if text.strip("-0.") else text.lstrip("-")


def csv_text(rows: Sequence[Sequence[Any]], comment: str) -> str:
    """The first row names the columns, the comment follows it. What is None is empty; a text that a
    spreadsheet would take for a formula gets an apostrophe in front."""

    def cell(value: Any) -> str:
        if value is None:
            return ""
        if isinstance(value, float):
            return repr(value + 0.0).removesuffix(".0")  # -0.0 + 0.0 = 0.0
        text = str(value)
        is_formula = text[:1] in ("=", "+", "-", "@") and text and not _NUMBER.fullmatch(text)
        return ("'" if is_formula else "") + printable(text, "\n")

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(cell, rows[0]))
    text.write(f"# {printable(comment)}\n")
    for row in rows[1:]:
        writer.writerow(map(cell, row))
    return text.getvalue()


def heading(of: StudyParameter | StudyOutput) -> str:
    """ "E1(MPa)", "|dB|(uT)", for a column of a table."""
    if isinstance(of, StudyOutput):
        return f"{of.symbol}({of.shown_unit})"
    return f"{of.name}({of.shown_unit})" if of.shown_unit else of.name


def value_text(parameter: StudyParameter, value: float) -> str:
    """ "0.1 MPa" """
    return f"{value / parameter.shown_size:.6g} {parameter.shown_unit}".rstrip()


def cell(result: Result, i: int, output: StudyOutput) -> str:
    """An output of a result in its unit for people, or what has become of it."""
    if result.values[i] is None and result.status != "converged":
        return result.status
    return number_text(result.values[i], output.shown_size)


def text(study: StudyFile, points: Points, width: int = 0) -> str:
    """For a terminal: a table of the points, thinned to at most 25 of them, then those without a result."""
    lines = f'Study "{study.name}": {study.title}\n'
    count = study.point_count
    if count == 0:
        return lines
    shown = _shown_points(study)
    if len(shown) < count:
        lines += f"{count} points, {len(shown)} of them below, {count - len(shown)} left out; all are in study.csv\n"
    for p, pair in enumerate(study.pairs):
        rows = [[*map(heading, study.parameters), *map(heading, study.outputs)]]
        for point in shown:
            values = zip(study.parameters, study.values_at(point))
            row = [f"{value / parameter.shown_size:.5g}" for parameter, value in values]
            rows.append(row + [cell(points[point][p], i, output) for i, output in enumerate(study.outputs)])
        lines += f"\n{pair}\n" + _core.text_table(rows, ">", width)
    return lines + _exceptions(study, points)


def _evenly(count: int, shown: int) -> list[int]:
    """The indices of `shown` of `count` things, the first and the last among them."""
    n = min(count, shown)
    return [0 if n < 2 else i * (count - 1) // (n - 1) for i in range(n)]


def _shown_points(study: StudyFile) -> list[int]:
    """Indices of as many points as fit a screen; of a product whole values are left out, of the longest parameter."""
    if study.zipped:
        return _evenly(study.point_count, _MOST_ROWS)
    counts = [len(p.values) for p in study.parameters]
    shown = list(counts)
    while math.prod(shown) > _MOST_ROWS:
        shown[max(range(len(shown)), key=lambda i: (shown[i], i))] -= 1
    points = [0]
    for count, some in zip(counts, shown):
        points = [point * count + i for point in points for i in _evenly(count, some)]
    return points


def _exceptions(study: StudyFile, points: Points) -> str:
    """Numbers of points of each pair that slipped off, were pulled in or failed, and the reason of the first one."""
    lines = ""
    for p, pair in enumerate(study.pairs):
        for status in ("slipped_off", "pulled_in", "failed"):
            found = [i for i in range(study.point_count) if points[i][p].status == status]
            if found:
                lines += f"{pair}: {status} at {len(found)} of {study.point_count} points, "
                lines += f"first at {study.describe(found[0])}: {points[found[0]][p].message}\n"
    return "\n" + lines if lines else ""


# Files.


def csv_header(study: StudyFile, parameters: Sequence[StudyParameter], first: str) -> tuple[list[str], str]:
    """The columns of a CSV file of the study, `first` the first one, and the comment with their units."""
    units = [f"{p.path} {p.unit}" for p in parameters if p.unit] + [f"{o.id} {o.unit}" for o in study.outputs]
    columns = [first, *(p.path for p in parameters), "pair", "status", *(o.id for o in study.outputs), "message"]
    return columns, f"units: {', '.join(units)}"


def study_csv(study: StudyFile, points: Points) -> str:
    """study.csv: a line for each point and pair, in their order."""
    columns, comment = csv_header(study, study.parameters, "point")
    rows: list[list[Any]] = [columns]
    for i in range(study.point_count):
        for pair, result in zip(study.pairs, points[i]):
            rows.append([i, *study.values_at(i), pair, result.status, *result.values, result.message])
    return csv_text(rows, comment)


def number_json(value: float | None) -> float | None:
    """A number without negative zero."""
    return None if value is None else value + 0.0


def parameter_json(parameter: StudyParameter, values: dict[str, Any]) -> dict[str, Any]:
    return {
        "path": parameter.path,
        "name": parameter.name,
        "unit": parameter.unit,
        **values,
        "shown_unit": parameter.shown_unit,
        "shown_unit_size": parameter.shown_size,
        "logarithmic": parameter.logarithmic,
    }


def pair_json(study: StudyFile, result: Result) -> dict[str, Any]:
    """Results of a pair at a point: status, message, outputs, dB_uncertainty; range_uncertainty and the models' parts
    of both if known."""
    document: dict[str, Any] = {"status": result.status, "message": result.message}
    for output, value in zip(study.outputs, result.values):
        document[output.id] = number_json(value)
    document["dB_uncertainty"] = number_json(result.uncertainty)
    if result.range_uncertainty is not None:
        document["range_uncertainty"] = number_json(result.range_uncertainty)
    if result.model_uncertainty is not None:
        document["dB_model_uncertainty"] = number_json(result.model_uncertainty)
    if result.range_model_uncertainty is not None:
        document["range_model_uncertainty"] = number_json(result.range_model_uncertainty)
    return document


def study_json(study: StudyFile, points: Points, provenance: dict[str, Any]) -> dict[str, Any]:
    """study.json (docs/guide/studies.md). Nothing in it says when or how often the program ran."""
    return {
        "schema": 1,
        "study": study.name,
        "title": study.title,
        "case": study.case,
        "provenance": {key: provenance[key] for key in ("version", "git", "libraries")},
        "resolved": [f"{name} = {value}" for name, value in study.fingerprint if name != "program"],
        "parameters": [parameter_json(p, {"values": p.values}) for p in study.parameters],
        "outputs": [{"id": o.id, "unit": o.unit} for o in study.outputs],
        "pairs": list(study.pairs),
        "points": [
            {
                "point": i,
                "parameters": dict(zip((p.path for p in study.parameters), study.values_at(i))),
                "pairs": {pair: pair_json(study, result) for pair, result in zip(study.pairs, points[i])},
            }
            for i in range(study.point_count)
        ],
    }
