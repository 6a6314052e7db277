# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of error budgets, convergence studies and of loads found from readings."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..arrays import Array
from ..units import number, shown
from .style import COLOURS, Figure, legend, look, new_figure, style

_VERDICTS = {
    "resolved": {"facecolor": COLOURS[0], "edgecolor": COLOURS[0]},
    "below_uncertainty": {"facecolor": "0.75", "edgecolor": "0.6"},
    "inconclusive": {"facecolor": "none", "edgecolor": "0.4"},
}


def budget(data: dict[str, Any], step: int | None = None) -> Figure | None:
    """An error budget as waterfalls, from the paper's model to the best one, at the last step
    unless said: a panel for each component of the tip and of ΔB at the first sensor. Whiskers:
    numerical uncertainty; grey: below it; hollow: it is not known. None if nothing differs."""
    rows = [r for r in data["rows"] if r["quantity"] in ("tip", "dB") and not r["sensor"]]
    rows = [r for r in rows if any(link["value"] for link in r["links"])]
    if not rows:
        return None
    step = max(r["step"] for r in rows) if step is None else step
    rows = [r for r in rows if r["step"] == step]
    names = [stage["name"] for stage in data["chain"]]
    panels = min(3, len(rows))
    with style():
        lines = -(-len(rows) // panels)
        size = (2.2 + 1.9 * panels, 0.5 + lines * (0.9 + 0.24 * (len(names) + 1)))
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(lines, panels, sharey=True, squeeze=False)
        for axes, row in zip(grid.flat, rows):
            _waterfall(axes, row, names)
        for axes in grid.flat[len(rows) :]:
            axes.remove()
        for axes in grid[:, 0]:
            axes.set_yticks(range(1, len(names) + 1), [*names[1:], "total"], fontsize=7.5)
        return figure


def _waterfall(axes: Axes, row: dict[str, Any], names: list[str]) -> None:
    unit = shown(row["unit"])
    at, previous = 0.0, None
    places = [_place(link["to"], names) for link in row["links"]]
    for place, link in zip([*places, len(names)], [*row["links"], row["total"]]):
        total = place == len(names)
        value = link["value"] / unit.size
        start = 0.0 if total else at
        looks = _VERDICTS[link["verdict"].replace(" ", "_")]
        if total:
            looks = {"facecolor": COLOURS[4], "edgecolor": COLOURS[4]}
        error = {}
        if link["uncertainty"]:
            u = link["uncertainty"] / unit.size
            error = {"xerr": u, "error_kw": {"elinewidth": 0.9, "capsize": 2}}
        axes.barh(place, value, left=start, height=0.65, linewidth=0.8, **looks, **error)
        if previous is not None:
            axes.plot([at, at], [previous, place], color="0.4", linewidth=0.7)
        at, previous = at + value, place
    axes.axvline(0, color="0.4", linewidth=0.8)
    axes.use_sticky_edges = False
    axes.margins(x=0.1)
    axes.set_ylim(len(names) + 0.6, 0.4)
    axes.grid(axis="y", visible=False)
    symbol = {"tip": "tip ", "dB": "ΔB_"}[row["quantity"]] + row["component"]
    paper = number(row["paper"], unit.size)
    axes.set_xlabel(f"{symbol} less {paper} {unit.name},\nin {unit.name}", fontsize=8)


def _place(name: str, names: list[str]) -> int:
    """Index of a link's model in the chain. A link between shapes names the mechanics model alone."""
    if name in names:
        return names.index(name)
    return next(i for i, stage in enumerate(names) if stage.split("/", 1)[0] == name)


def convergence(data: dict[str, Any], model: str | None = None) -> Figure | None:
    """Errors over the sizes of a model's levels, of all models unless one is named, at the last load
    step: distance from the extrapolated limit, with the observed order; grey crosses: inconclusive,
    distance from the finest level. None if nothing differs."""
    studies = [s for s in data["studies"] if model in (None, s["model"]) and _curves(s)]
    if not studies:
        return None
    with style():
        figure = Figure(figsize=(4.6 * len(studies), 4.4), layout="constrained")
        for axes, study in zip(figure.subplots(1, len(studies), squeeze=False).flat, studies):
            _errors(axes, study)
        return figure


def _curves(study: dict[str, Any]) -> list[tuple[str, dict[str, Any], Array, Array]]:
    """Name, quantity, sizes and relative errors of what is drawn."""
    quantities = study["quantities"] or []
    last = max((q["step"] for q in quantities if q["step"] is not None), default=0)
    found = []
    for q in quantities:
        name = _curve_name(q, study["model"])
        if q["step"] != last or name is None or not q["levels"]:
            continue
        h = np.array([level["size"] for level in q["levels"]])
        values = np.array([level["value"] for level in q["levels"]])
        limit = q["limit"] if q["conclusive"] else values[0]
        error = np.abs(values - limit) / max(abs(values[0]), 1e-300)
        seen = np.isfinite(error) & (error > 0)
        if seen.any():
            found.append((name, q, h[seen], error[seen]))
    return found


def _errors(axes: Axes, study: dict[str, Any]) -> None:
    for name, q, h, error in _curves(study):
        if not q["conclusive"]:
            axes.plot(h, error, "x", color="0.5", label=f"{name}: inconclusive")
            continue
        label = name
        if q["order"]:
            interval = number(q["uncertainty"] / abs(q["levels"][0]["value"]), 0.01, 2)
            label += f": order {q['order']:.2f}, ±{interval} %"
        (line,) = axes.plot(h, error, "o", markersize=4, label=label)
        if q["order"]:
            fit = np.mean(np.log(error) - q["order"] * np.log(h))
            ends = np.array([h.min(), h.max()])
            along = np.exp(fit + q["order"] * np.log(ends))
            axes.plot(ends, along, color=line.get_color(), linewidth=1)
    axes.set(xscale="log", yscale="log", xlabel=study["size_name"], ylabel="|f − f₀| / |f|")
    axes.set_title(f"{study['model']}, {study['option']}", fontsize=9)
    sizes = sorted({level["size"] for q in study["quantities"] for level in q["levels"] or []})
    axes.set_xticks(sizes, [number(size) for size in sizes])
    axes.minorticks_off()
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False, fontsize=8)


def _curve_name(q: dict[str, Any], model: str) -> str | None:
    if q["quantity"] == "tip/deflection" and q["mechanics"] == model:
        return "tip"
    if (q["quantity"], q["sensor"], q["component"]) == ("dB", 0, "norm"):
        return f"|ΔB| {q['mechanics']}/{q['field']}"
    return None


def bench(data: dict[str, Any]) -> Figure:
    """A simulated test bench: the loads found over the true ones, of the first sensor drawn."""
    unit = shown(data["unit"])
    truth, found = (
        np.array([point[key] for point in data["first_draw"]]) / unit.size
        for key in ("truth", "found")
    )
    with style():
        figure, axes = new_figure(4.2, 4.6)
        axes.plot(*truth.T, "o", markerfacecolor="none", color="0.4", label="true load")
        looks = {**look(data["models"]), "marker": ".", "linestyle": ""}
        axes.plot(*found.T, label=f"found by {data['models']}", **looks)
        axes.set_aspect("equal")
        axes.set(xlabel=f"load along x in {unit.name}", ylabel=f"load along y in {unit.name}")
        legend(figure, axes)
        return figure


def readings(data: Any) -> Figure:
    """Load and direction found from readings, over time or over the samples, with their 95 %
    bands; crosses: no load was found. data: what cv.sense() gives, or a Document of `ciliaval sense`."""
    is_frame = hasattr(data, "attrs")
    about = data.attrs if is_frame else data
    samples = data.to_dict("records") if is_frame else data["samples"]
    unit = shown(about["unit"])
    times = [s.get("time") for s in samples]
    timed = all(isinstance(t, (int, float)) for t in times)
    x = np.array(times if timed else range(len(samples)), dtype=float)
    rows = [
        ("magnitude", "load", unit.size, unit.name),
        ("azimuth", "direction", np.pi / 180, "°"),
    ]
    with style():
        figure = Figure(figsize=(5.6, 4), layout="constrained")
        grid = figure.subplots(2, 1, sharex=True)
        for axes, (key, words, size, name) in zip(grid, rows):
            y = np.array([_number(s[key]) for s in samples]) / size
            u = np.array([_number(s[f"{key}_interval"]) for s in samples]) / size
            if key == "azimuth":  # its band would fill the whole circle where there is no load
                y = np.where(u < 180, y, np.nan)
            looks = {"color": look(about["models"])["color"], "markersize": 3}
            axes.plot(x, y, ".-" if len(x) < 200 else "-", linewidth=1, label="found", **looks)
            axes.fill_between(x, y - u, y + u, color=looks["color"], alpha=0.2, linewidth=0,
                              label="95 %")
            lost = np.array([s["magnitude"] is None for s in samples])
            foot = {"transform": axes.get_xaxis_transform(), "clip_on": False}
            if lost.any():
                axes.plot(x[lost], 0 * x[lost], "x", color="0.3", label="no load found", **foot)
            axes.set_ylabel(f"{words} in {name}")
        grid[-1].set_xlabel("time in s" if timed else "sample")
        legend(figure, grid[0])
        return figure


def levels(data: dict[str, Any]) -> Figure:
    """Interference of each reading of a sweep, and the levels found, with their 95 % intervals. Readings that no level
    surface gives are left out."""
    readings_of = data["readings"]
    x = np.arange(1, len(readings_of) + 1)
    known = np.array([r["status"] == "level" for r in readings_of])
    y = np.where(known, [_number(r["interference"]) for r in readings_of], np.nan) * 1e3
    colour = look(data["models"])["color"]
    with style():
        figure, axes = new_figure(5.6, 3.4)
        axes.plot(x, y, ".", color="0.6", markersize=2.5, label="a reading")
        for i, level in enumerate(data["levels"]):
            ends = np.array([level["first"] + 1, level["last"] + 1])
            at, u = 1e3 * level["interference"], 1e3 * level["interval"]
            axes.fill_between(ends, at - u, at + u, color=colour, alpha=0.3, linewidth=0)
            label = "a level, 95 %" if i == 0 else "_"
            axes.plot(ends, [at, at], color=colour, label=label)
        axes.set(xlabel="row of the file", ylabel="interference in mm")
        legend(figure, axes)
        return figure


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


__all__ = ["bench", "budget", "convergence", "levels", "readings"]
