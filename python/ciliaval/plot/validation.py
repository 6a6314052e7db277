# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of models against measurements."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..arrays import Array
from ..results import Result, ValidationSeries
from ..units import number, shown
from .case import abscissa
from .style import Figure, best_first, dashes, legend, look, style


def measurands(result: Result) -> list[tuple[str, tuple[float, float]]]:
    """Quantity and point of each measurand, in the order of the file."""
    if result.validation is None:
        return []
    return list(dict.fromkeys((s.quantity, s.point) for s in result.validation.series))


def describe(quantity: str, point: tuple[float, float]) -> str:
    """ "tip.deflection, point (0.4, 0) mm of the end"."""
    if not any(point):
        return quantity
    return f"{quantity}, point ({number(point[0], 1e-3, 3)}, {number(point[1], 1e-3, 3)}) mm of the end"


def validation(result: Result, which: int = 0) -> Figure:
    """The values of a measurand (of several the `which`-th) with ± 2 u_D beside the models', and
    below E = S - D with ± 2 u_val: where a bar leaves out zero, the model's error is seen.

    Bands around the models' curves: ± 2 √(u_num² + u_input²).
    """
    known = measurands(result)
    if not known:
        raise ValueError(f"{result.name} has no measurements")
    quantity, point = known[which]
    assert result.validation is not None
    of = {s.model: s for s in result.validation.of(quantity=quantity, point=point)}
    order = best_first(list(of))
    unit = shown(next(iter(of.values())).unit)
    load, label = abscissa(result)
    with style():
        figure = Figure(figsize=(5.6, 5.2), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
        first = of[order[0]]
        x = load[[p.step for p in first.points]]
        gaps = np.diff(np.unique(x))
        width = min([(np.ptp(load) or 1.0) / 60, *gaps / (len(order) + 1)])
        for i, model in enumerate(reversed(order)):
            looks = {**look(model), "linestyle": dashes(model, order)}
            _curve(upper, of[model], load, unit.size, model, looks)
            error, u_val = _columns(of[model], "error", "u_val")
            shift = width * (i - (len(order) - 1) / 2)  # so that bars of models do not hide each other
            lower.errorbar(
                x + shift, error / unit.size, 2 * u_val / unit.size, fmt=looks["marker"],
                color=looks["color"], markersize=3, linewidth=1, capsize=2,
            )  # fmt: skip
        measured, u_D = _columns(first, "measured", "u_D")
        upper.errorbar(
            x, measured / unit.size, 2 * u_D / unit.size, fmt="x", color="black", markersize=5,
            linewidth=1, capsize=3, label="measured", zorder=5,
        )  # fmt: skip
        lower.axhline(0, color="black", linewidth=0.8)
        upper.set(title=describe(quantity, point), ylabel=f"in {unit.name}")
        lower.set(xlabel=label, ylabel=f"E ± 2 u_val in {unit.name}")
        legend(figure, upper, ["measured", *order])
        return figure


def _curve(
    axes: Axes, series: ValidationSeries, load: Array, size: float, label: str, looks: dict[str, Any]
) -> None:
    """The model's values in the order of the load, with the band of its uncertainties."""
    x = load[[p.step for p in series.points]]
    y, u_num, u_input = _columns(series, "simulated", "u_num", "u_input")
    order = np.argsort(x, kind="stable")
    x, y, u = x[order], y[order] / size, np.hypot(u_num, u_input)[order] / size
    axes.plot(x, y, label=label, markersize=3, linewidth=1.2, **looks)
    if np.isfinite(u).any():
        axes.fill_between(x, y - 2 * u, y + 2 * u, color=looks["color"], alpha=0.2, linewidth=0)


def _columns(series: ValidationSeries, *names: str) -> list[Array]:
    """Numbers of the points, NaN for None."""
    return [np.array([getattr(p, name) for p in series.points], dtype=float) for name in names]
