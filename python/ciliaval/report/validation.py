# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part of a case's page that holds its models against measurements."""

from __future__ import annotations

from .. import plot
from ..plot.validation import describe, measurands
from ..results import Result, Validation, ValidationPoint, ValidationSeries
from ..units import in_words, number, percent, quantity, shown
from .blocks import Block, Details, Heading, Images, Items, Table, image


def validation_blocks(result: Result) -> list[Block]:
    """Sentences, a figure of each measurand, the numbers; nothing without measurements."""
    validation = result.validation
    if validation is None:
        return []
    drawn = [
        image(
            f"Measured: {describe(*measurand)}",
            "Above, the crosses with ± 2 u_D are measured, and the bands are ± 2 √(u_num² + u_input²) of a model. "
            "Below is E = S − D with ± 2 u_val; where a bar leaves out zero, the model's error is seen.",
            lambda: plot.validation(result, which),
        )
        for which, measurand in enumerate(measurands(result))
    ]
    return [
        Heading("Against measurements (ASME V&V 20)"),
        Items([*_findings(validation), *validation.remarks, _domain(validation)]),
        Images(drawn),
        _summary(validation),
        Details("Each measured value", [_points(series) for series in validation.series]),
        *([_inputs(validation)] if validation.inputs else []),
    ]


def _findings(validation: Validation) -> list[str]:
    found = []
    for series in validation.series:
        name = f"{series.model}, {describe(series.quantity, series.point)}"
        known = [p for p in series.points if p.verdict == "bounded"]
        if not series.assessed:
            found.append(f"{name}: not known: {series.points[0].note}.")
        elif known:
            least = max(p.least or 0.0 for p in known)
            worst = max(p.bound or 0.0 for p in known)
            found.append(
                f"{name}: the model's error is seen at {len(known)} of {series.assessed} values. There it is below "
                f"{quantity(worst, series.unit, 3)}, and where it shows most above {quantity(least, series.unit, 2)}.{_over(series)}"
            )
        else:
            worst = max((p.bound or 0.0 for p in series.points), default=0.0)
            found.append(
                f"{name}: the model's error is not seen: it is below {quantity(worst, series.unit, 3)}.{_over(series)}"
            )
    return found


def _over(series: ValidationSeries) -> str:
    """Dependence of the verdicts on u_D, which may be assumed, and on u_input by another model."""
    others = [of for of in series.bounded_with_u_D if of["factor"] != 1]
    if not others:
        return ""
    factors, counts = (in_words(number(of[key]) for of in others) for key in ("factor", "bounded"))
    text = f" With a u_D {factors} times as large it would be seen at {counts} values."
    if series.bounded_with_twice_u_input is not None and series.sensitivities_by not in (None, series.model):
        twice = series.bounded_with_twice_u_input
        text += f" Its u_input is that of {series.sensitivities_by}: with twice as much, at {twice}."
    return text


def _domain(validation: Validation) -> str:
    parts = []
    for name, of in validation.domain.items():
        low, high = (quantity(of[key], of["unit"]) for key in ("from", "to"))
        parts.append(f"{name.replace('_', ' ')} {low if low == high else f'{low} to {high}'}")
    return f"This holds in its domain alone: {'; '.join(parts)}."


def _summary(validation: Validation) -> Table:
    table = Table(
        "χ² of all values, an input's error being the same at all of them; without any error of the "
        "model it is about their number",
        ["model", "measured", "values", "error seen", "not seen", "r.m.s. of E", "χ²", "u_input by"],
    )
    for s in validation.series:
        row = [s.model, describe(s.quantity, s.point), *(str(n) for n in (s.assessed, s.bounded, s.not_resolved))]
        row.append(quantity(s.rms_error, s.unit, 3) if s.rms_error is not None else "–")
        table.rows.append([*row, number(s.chi_squared, 1, 3), s.sensitivities_by or "–"])
    return table


def _points(series: ValidationSeries) -> Table:
    unit = shown(series.unit)
    table = Table(
        f"{series.model}: {describe(series.quantity, series.point)}, in {unit.name}",
        ["step", "D", "S", "E", "u_num", "u_input", "u_D", "2 u_val", "model error"],
    )
    for p in series.points:
        row = [f"{p.step + 1}{' (fitted)' if p.fitted else ''}"]
        row += [number(value, unit.size, 4) for value in (p.measured, p.simulated, p.error)]
        row += [number(value, unit.size, 2) for value in (p.u_num, p.u_input, p.u_D)]
        row.append(number(None if p.u_val is None else 2 * p.u_val, unit.size, 2))
        table.rows.append([*row, _verdict(p, series)])
    return table


def _verdict(point: ValidationPoint, series: ValidationSeries) -> str:
    if point.bound is not None and point.verdict == "bounded":
        least = number(point.least, shown(series.unit).size, 2)
        return f"seen, {least} to {quantity(point.bound, series.unit, 3)}"
    if point.bound is not None:
        return f"not seen, below {quantity(point.bound, series.unit, 3)}"
    return f"{point.verdict}: {point.note}" if point.note else point.verdict


def _inputs(validation: Validation) -> Table:
    table = Table("Inputs and their standard uncertainties", ["number", "uncertainty", "source"])
    for of in validation.inputs:
        u = of["uncertainty"]
        text = percent(u) if of["relative"] else quantity(u, of["unit"])
        table.rows.append([of["number"], text, of["source"]])
    return table
