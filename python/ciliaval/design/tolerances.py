# SPDX-License-Identifier: LGPL-2.1-or-later
"""Effect of the tolerances of a study on its outputs, to first order."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .. import _core
from .._core import StudyFile, tolerance_step
from .summary import Points, csv_text, heading, number_json, number_text


@dataclass(frozen=True)
class Share:
    """Share of one number p with the standard deviation sigma in an output y; None where a point has no value."""

    slope: float | None = None  # dy/dp = (4 D(h) - D(2h))/3, central differences, h = sigma/4
    error: float | None = None  # |dy/dp - D(h)|: its truncation, seen from below
    spread: float | None = None  # |dy/dp| sigma


@dataclass(frozen=True)
class Propagation:
    """Spread of one output y of one pair at the case with its fixed numbers."""

    nominal: float | None
    shares: list[Share]  # in the order of the study's tolerances
    deviation: float | None  # sqrt(sum (dy/dp sigma)^2), independent numbers; None if a slope is missing


def propagate(study: StudyFile, points: Points, pair: int, output: int) -> Propagation:
    """The points behind the sweep: the nominal one, then of each number -2, -1, 1 and 2 steps."""
    first = study.point_count
    value = [results[pair].values[output] for results in points[first:]]
    shares = []
    deviation: float | None = 0.0
    for i, tolerance in enumerate(study.tolerances):
        sigma = tolerance.deviation
        h = tolerance_step * sigma
        far_below, below, above, far_above = value[1 + 4 * i : 5 + 4 * i]
        if far_below is None or below is None or above is None or far_above is None:
            shares.append(Share())
            deviation = None
            continue
        fine = (above - below) / (2 * h)
        coarse = (far_above - far_below) / (4 * h)
        slope = (4 * fine - coarse) / 3
        shares.append(Share(slope, abs(slope - fine), abs(slope) * sigma))
        deviation = math.hypot(deviation, abs(slope) * sigma) if deviation is not None else None
    return Propagation(value[0], shares, deviation)


def tolerance_text(study: StudyFile, points: Points, width: int = 0) -> str:
    """For a terminal: for each pair a table of the spreads and their sum; empty without tolerances."""
    if not study.tolerances:
        return ""
    text = "\nTolerances: what one standard deviation (sigma) of each number does, to first order; all "
    text += "together if they are independent\n"
    for p, pair in enumerate(study.pairs):
        nominal = points[study.point_count][p]
        if nominal.status == "converged":
            text += f"\n{pair}\n{_pair_table(study, points, p, width)}"
        else:
            text += f"\n{pair}\n  {nominal.status}: {nominal.message}\n"
    return text


def _pair_table(study: StudyFile, points: Points, pair: int, width: int) -> str:
    rows = [["", "value", "sigma"], ["nominal", "", ""]]
    for t in study.tolerances:
        value, sigma = (f"{x / t.shown_size:.{n}g} {t.shown_unit}" for x, n in ((t.nominal, 6), (t.deviation, 4)))
        rows.append([t.path, value, sigma])
    rows.append(["all together", "", ""])
    for i, output in enumerate(study.outputs):
        found = propagate(study, points, pair, i)
        column = [found.nominal, *(share.spread for share in found.shares), found.deviation]
        for row, cell in zip(rows, [heading(output), *(number_text(x, output.shown_size, 4) for x in column)]):
            row.append(cell)
    return _core.text_table(rows, ">", width)


def tolerance_csv(study: StudyFile, points: Points) -> str:
    """A line for each pair, output and number, SI units."""
    rows: list[list[Any]] = [
        ["pair", "output", "output_unit", "number", "number_unit", "nominal", "deviation", "slope", "error", "spread"]
    ]
    for p, pair in enumerate(study.pairs):
        for i, output in enumerate(study.outputs):
            found = propagate(study, points, p, i)
            for t, share in zip(study.tolerances, found.shares):
                row = [pair, output.id, output.unit, t.path, t.unit, t.nominal, t.deviation]
                rows.append([*row, share.slope, share.error, share.spread])
            rows.append([pair, output.id, output.unit, "all", "", "", "", "", "", found.deviation])
    return csv_text(
        rows,
        "units: SI, of the number (deviation), of the output (spread), of the output over the number (slope, error)",
    )


def tolerance_json(study: StudyFile, points: Points) -> dict[str, Any]:
    """{"numbers": [{"path", "unit", "nominal", "deviation"}], "pairs": {PAIR: {"status", OUTPUT: {"nominal",
    "deviation", "slopes", "errors"}}}}, SI units."""
    pairs: dict[str, Any] = {}
    for p, pair in enumerate(study.pairs):
        pairs[pair] = {"status": points[study.point_count][p].status}
        for i, output in enumerate(study.outputs):
            found = propagate(study, points, p, i)
            pairs[pair][output.id] = {
                "nominal": number_json(found.nominal),
                "deviation": number_json(found.deviation),
                "slopes": [number_json(share.slope) for share in found.shares],
                "errors": [number_json(share.error) for share in found.shares],
            }
    numbers = [
        {"path": t.path, "unit": t.unit, "nominal": t.nominal, "deviation": t.deviation} for t in study.tolerances
    ]
    return {"numbers": numbers, "pairs": pairs}
