# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of parameter studies: curves, slices through an optimum, tornado charts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..units import Unit, number, shown
from .style import Figure, best_first, dashes, legend, look, new_figure, style

_MOST_FAMILIES = 6

_SYMBOLS = {
    "dB_norm": "|ΔB|",
    "sensitivity": "sensitivity d|ΔB|/dF",
    "range": "range: largest load",
    "resolution": "resolution: smallest change of load",
}


def symbol(output: str) -> str:
    """ "|ΔB|" for "dB_norm"."""
    return _SYMBOLS.get(output, output.replace("dB_", "ΔB_"))


def unit_of(parameter: dict[str, Any]) -> Unit:
    """The unit of a study's parameter, as the study states it."""
    if "shown_unit" in parameter:
        return Unit(parameter["shown_unit"], parameter["shown_unit_size"])
    return shown(parameter["unit"])


def label_of(parameter: dict[str, Any]) -> str:
    unit = unit_of(parameter).name
    return f"{parameter['name']} in {unit}" if unit else str(parameter["name"])


@dataclass
class Family:
    """The points that differ in the first parameter alone."""

    name: str
    points: list[dict[str, Any]]


def families(study: dict[str, Any]) -> list[Family]:
    """All families of a study; one if there is one parameter or if the parameters' values go
    together."""
    parameters = study["parameters"]
    together = len(study["points"]) == len(parameters[0]["values"])
    found: dict[str, Family] = {}
    for point in study["points"]:
        names = []
        for p in parameters[len(parameters) if together else 1 :]:
            unit = unit_of(p)
            value = number(point["parameters"][p["path"]], unit.size)
            names.append(f"{p['name']} = {value} {unit.name}".rstrip())
        name = ", ".join(names)
        found.setdefault(name, Family(name, [])).points.append(point)
    return list(found.values())


def curves(study: dict[str, Any], output: str) -> Figure:
    """An output of all pairs over the first parameter; a line for each value of the others, of many
    some. Crosses at the foot: a pair slipped off or failed there."""
    x = study["parameters"][0]
    size = unit_of(x).size
    unit = shown(next(o["unit"] for o in study["outputs"] if o["id"] == output))
    every = families(study)
    some = [every[i] for i in np.unique(np.linspace(0, len(every) - 1, _MOST_FAMILIES).astype(int))]
    with style():
        figure, axes = new_figure(5.2, 3.9)
        names = best_first(study["pairs"])
        for pair in names:
            for n, family in enumerate(some):
                points = sorted(family.points, key=lambda p: float(p["parameters"][x["path"]]))
                at = np.array([p["parameters"][x["path"]] for p in points]) / size
                values = np.array([_value(p["pairs"][pair].get(output)) for p in points])
                looks: dict[str, Any] = {**look(pair), "linestyle": dashes(pair, names)}
                label = pair
                if len(some) > 1:  # a shade for each family, the line tells the field model
                    looks["alpha"] = 1 - 0.75 * n / len(some)
                    looks["marker"] = ""
                    label = f"{pair}, {family.name}"
                if len(points) > 25:
                    looks["marker"] = ""
                axes.plot(at, values / unit.size, label=label, markersize=3, linewidth=1.2, **looks)
                lost = np.array([p["pairs"][pair]["status"] != "converged" for p in points]) & np.isnan(values)
                foot = {"transform": axes.get_xaxis_transform(), "clip_on": False}
                if lost.any():
                    axes.plot(at[lost], 0 * at[lost], "x", color=looks["color"], ms=4, **foot)
        if x.get("logarithmic"):
            axes.set_xscale("log")
        axes.set_xlabel(label_of(x))
        axes.set_ylabel(f"{symbol(output)} in {unit.name}")
        if axes.get_ylim()[0] > 0:
            axes.set_ylim(bottom=0)
        legend(figure, axes)
        return figure


def tornado(study: dict[str, Any], pair: str, output: str) -> Figure:
    """Effect of one standard deviation of each uncertain number on an output, the largest on top, and of all together
    by first order."""
    tolerances = study["tolerances"]
    entry = tolerances["pairs"][pair][output]
    unit = shown(next(o["unit"] for o in study["outputs"] if o["id"] == output))
    bars: list[tuple[str, float]] = [
        (n["path"], slope * n["deviation"] / unit.size)
        for n, slope in zip(tolerances["numbers"], entry["slopes"])
        if slope is not None
    ]
    bars.sort(key=lambda bar: abs(bar[1]))
    with style():
        figure, axes = new_figure(5.8, 1.1 + 0.24 * (len(bars) + 1))
        axes.grid(axis="y", visible=False)
        names = ["all together", *(name for name, _ in bars)]
        sizes = [entry["deviation"] / unit.size, *(size for _, size in bars)]
        for i, (name, size) in enumerate(zip(names, sizes)):
            colour = "0.6" if i == 0 else look(pair)["color"]
            axes.barh(i, 2 * abs(size), left=-abs(size), color=colour, alpha=0.8, height=0.7)
            text = number(abs(size), 1, 2)
            axes.annotate(f"±{text}", (abs(size), i), (3, 0), textcoords="offset points",
                          va="center", fontsize=7)
        axes.set_yticks(range(len(names)), [name.removeprefix("cilium.") for name in names])
        axes.tick_params(axis="y", labelsize=7.5, length=0)
        reach = 1.25 * max(abs(size) for size in sizes)
        axes.set_xlim(-reach, reach)
        axes.set_xlabel(f"change of {symbol(output)} in {unit.name}, {pair}")
        return figure


def optimum_slices(study: dict[str, Any]) -> Figure | None:
    """The goal over each parameter through the best design, the others held: None if the file has
    no slices."""
    optimum = study.get("optimum") or {}
    if not optimum.get("slices"):
        return None
    goal = optimum["maximise"]
    unit = shown(next(o["unit"] for o in study["outputs"] if o["id"] == goal))
    slices = optimum["slices"]
    with style():
        figure = Figure(figsize=(5.6, 2.3 * -(-len(slices) // 2)), layout="constrained")
        grid = np.atleast_1d(figure.subplots(-(-len(slices) // 2), 2)).flat
        for axes, cut in zip(grid, slices):
            parameter = next(p for p in optimum["parameters"] if p["path"] == cut["path"])
            size = unit_of(parameter).size
            values = np.array([_value(v) for v in cut["values"]]) / unit.size
            kept = np.array(cut["kept"], dtype=bool)
            at = np.array(cut["at"]) / size
            axes.plot(at, values, color="0.7", linewidth=1, label="breaks a limit")
            looks = look(optimum["pair"])
            axes.plot(at, np.where(kept, values, np.nan), color=looks["color"], label="allowed")
            axes.axvline(cut["best"] / size, color="0.3", linestyle=":", label="best design")
            if parameter.get("logarithmic"):
                axes.set_xscale("log")
            axes.set(xlabel=label_of(parameter), ylabel=f"{symbol(goal)} in {unit.name}")
        for axes in list(grid)[len(slices) :]:
            axes.remove()
        legend(figure, figure.axes[0])
        return figure


def largest(study: dict[str, Any], output: str) -> Iterable[str]:
    """ "elastica/line 83.2 µT at E1 = 0.1 MPa, d = 3 mm": of each pair where the output is largest in
    magnitude."""
    unit = shown(next(o["unit"] for o in study["outputs"] if o["id"] == output))
    for pair in best_first(study["pairs"]):
        known = [p for p in study["points"] if p["pairs"][pair].get(output) is not None]
        if not known:
            continue
        best = max(known, key=lambda p: float(abs(p["pairs"][pair][output])))
        at = []
        for p in study["parameters"]:
            value = number(best["parameters"][p["path"]], unit_of(p).size)
            at.append(f"{p['name']} = {value} {unit_of(p).name}".rstrip())
        value = number(best["pairs"][pair][output], unit.size)
        yield f"{pair} {value} {unit.name} at {', '.join(at)}"


def _value(value: float | None) -> float:
    return float("nan") if value is None else value
