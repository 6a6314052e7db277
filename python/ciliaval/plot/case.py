# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of a case: shapes, signals, contact along a sweep, differences of all pairs of models."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from ..arrays import Array
from ..files import declared
from ..results import Result
from ..units import number, shown
from .style import Figure, best_first, dashes, legend, look, new_figure, not_finer_than, style

_MAY_BE_MOVED_BY = ("travel", "velocity")  # rather than by the load's magnitude
_MOST_SHAPES = 5


def shapes(result: Result, step: int | None = None) -> Figure:
    """The centrelines of all models in the plane of bending: at a step, or at some of all steps."""
    count = len(result.steps)
    drawn = [range(count)[step]] if step is not None else _evenly(count)
    load, _ = abscissa(result)
    with style():
        figure, axes = new_figure(4.5, 5)
        for model in result.models:
            label = model  # once in the legend
            for i in drawn:
                if result.status(model)[i] != "converged":
                    continue
                axes.plot(*(1e3 * bent(result, model, i)), label=label, markevery=[-1], **look(model))
                label = "_"
        best = best_first(result.models)[0]
        if len(drawn) > 1:
            labelled: list[Array] = []
            for i in drawn:
                tip = result.tip(best)[i]
                at = 1e3 * np.array([np.hypot(tip[0], tip[1]), tip[2]])
                near = [p for p in labelled if np.linalg.norm(p - at) < 0.05 * np.abs(at).max()]
                if np.isfinite(at).all() and not near:
                    text = number(load[i], 1.0, 3)
                    axes.annotate(text, at, (4, 4), textcoords="offset points", fontsize=7)
                    labelled.append(at)
        axes.set(xlabel="deflection in mm", ylabel="z in mm")
        axes.set_aspect("equal")
        low, high = axes.get_xlim()
        top = axes.get_ylim()[1]
        axes.set_xlim(min(0.0, low) - 0.05 * top, max(high, 0.6 * top))
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]), top=1.05 * top)
        legend(figure, axes, best_first(result.models))
        return figure


def bent(result: Result, model: str, step: int) -> Array:
    """A centreline in the plane of its load: along the load and z, (2, n), m."""
    azimuth = result.loads[step].get("azimuth", 0.0)
    line = result.centreline(model, step)
    return np.array([line["x"] * np.cos(azimuth) + line["y"] * np.sin(azimuth), line["z"]])


def signal(result: Result, sensor: int | str = 0, quantity_name: str = "dB") -> Figure:
    """ΔB ("dB") or B ("B") at a sensor, by its number or name, by components and in magnitude, over
    the load.

    Bands are those of dB at 95 %: numerical error, what the models leave out, inputs; a pair of which the
    second is not known has none, which the legend says, as where it is thinner than the line. A curve of ΔB begins where there is no load,
    unless the load is a sweep's travel. Samples between which a model jumps are shaded.
    """
    if quantity_name not in ("dB", "B"):
        raise ValueError(f'a signal is "dB" or "B", not "{quantity_name}"')
    sensor = result.sensor(sensor)
    change = quantity_name == "dB"
    symbol, unit, size = ("ΔB", "µT", 1e-6) if change else ("B", "mT", 1e-3)
    load, label = abscissa(result)
    rising = (np.diff(load) > 0).all() and load[0] > 0
    from_nothing = change and rising and _begins_straight(result)
    with style():
        figure = Figure(figsize=(5.6, 4.6), layout="constrained")
        grid = figure.subplots(2, 2, sharex=True)
        pairs = best_first(result.pairs)
        values = result.dB if change else result.B
        largest = 0.0
        names: dict[str, str] = {}
        for pair in reversed(pairs):
            field = values(pair)[:, sensor] / size
            error = result.dB_band(pair)[:, sensor] / size if change else np.nan * field
            x = load
            if from_nothing:
                x = np.append(0, x)
                field, error = (np.vstack([np.zeros((1, 3)), a]) for a in (field, error))
            norm = np.linalg.norm(field, axis=1)
            largest = max([largest, *norm[np.isfinite(norm)]])
            columns = [*field.T, norm]
            errors = [*error.T, np.linalg.norm(error, axis=1)]
            names[pair] = pair + _of_band(errors[-1], norm) if change else pair
            for axes, y, u in zip(grid.flat, columns, errors):
                looks = {**look(pair), "linestyle": dashes(pair, pairs)}
                if len(x) > 25:
                    looks["marker"] = ""
                axes.plot(x, y, label=names[pair], markersize=3, linewidth=1.2, **looks)
                if np.isfinite(u).any():
                    axes.fill_between(x, y - u, y + u, color=looks["color"], alpha=0.2, linewidth=0)
        for axes, of in zip(grid.flat, ["_x", "_y", "_z", None]):
            axes.set_ylabel(f"{symbol}{of} in {unit}" if of else f"|{symbol}| in {unit}")
            not_finer_than(axes, 1e-3 * largest)
            _shade_jumps(axes, result, load, "0.5")
        for axes in grid[1]:
            axes.set_xlabel(label)
        legend(figure, grid[0, 0], [names[pair] for pair in pairs])
        return figure


def _of_band(band: Array, values: Array) -> str:
    """Words of a legend on a band that is not seen."""
    if not np.isfinite(band[1:] if len(band) > 1 else band).any():
        return ", ± not known"
    return ", ± below the line" if np.nanmax(band) < 4e-3 * np.nanmax(values) else ""


def sweep(result: Result) -> Figure:
    """Normal and friction force and the tip's position over the travel; where a model jumps is
    shaded in its colour."""
    travel = 1e3 * result.load("travel")
    rows: list[tuple[str, Callable[[str], Array]]] = [
        ("N in mN", lambda m: 1e3 * result.contact(m)),
        ("T in mN", lambda m: 1e3 * result.contact(m, "friction_force")),
        ("tip x in mm", lambda m: 1e3 * result.tip(m)[:, 0]),
    ]
    with style():
        figure = Figure(figsize=(5.6, 5.2), layout="constrained")
        grid = figure.subplots(len(rows), 1, sharex=True)
        for axes, (label, values) in zip(grid, rows):
            for model in result.models:
                colour = look(model)["color"]
                axes.plot(travel, values(model), label=model, color=colour, linewidth=1.2)
                _shade_jumps(axes, result, travel, colour, model)
            axes.set_ylabel(label)
        grid[-1].set_xlabel("travel of the surface in mm")
        legend(figure, grid[0], best_first(result.models))
        return figure


def pairs(result: Result, quantity_name: str = "centreline", step: int = -1) -> Figure:
    """Every model (rows) less every reference (columns) at a step, the best reference first.

    quantity_name: "centreline" (largest distance over the reference's deflection) or "dB" (largest
    component's difference at any sensor over the magnitude of the reference's ΔB). Cells in %, ±
    the numerical uncertainty of the two; grey: below it, or not known.
    """
    step = range(len(result.steps))[step]
    found: dict[tuple[str, str], tuple[float, float | None, str]] = {}
    for c in result.compare(quantity=quantity_name, step=step):
        if c.relative is None or c.statistic not in ("maximum", "value"):
            continue
        u = None if c.uncertainty is None or not c.scale else c.uncertainty / abs(c.scale)
        key = (c.model, c.reference)
        if key not in found or abs(c.relative) > abs(found[key][0]):
            found[key] = (c.relative, u, c.verdict)
    models = best_first(sorted({m for m, _ in found}))
    references = best_first(sorted({r for _, r in found}))
    with style():
        size = (1.5 + 0.8 * max(len(references), 1), 0.9 + 0.32 * max(len(models), 1))
        figure, axes = new_figure(*size)
        values = np.full((len(models), len(references)), np.nan)
        for (m, r), (relative, _, verdict) in found.items():
            if verdict == "resolved":
                values[models.index(m), references.index(r)] = 100 * abs(relative)
        axes.set_facecolor("0.93")
        axes.grid(visible=False)
        axes.imshow(values, cmap="YlOrRd", norm=LogNorm(0.1, 100, clip=True), aspect="auto")
        for (m, r), (relative, u, verdict) in found.items():
            text = number(relative, 0.01, 3)
            if u is not None and (verdict != "resolved" or u > 1e-2 * abs(relative)):
                text += f"\n± {number(u, 0.01, 1)}"
            dark = verdict == "resolved" and abs(relative) > 0.15
            looks = {"color": "white" if dark else "black" if verdict == "resolved" else "0.45"}
            at = references.index(r), models.index(m)
            axes.text(*at, text, ha="center", va="center", fontsize=7, **looks)
        axes.set_xticks(range(len(references)), [r.replace("/", "/\n") for r in references])
        axes.set_yticks(range(len(models)), models)
        axes.tick_params(labelsize=7.5, top=True, labeltop=True, bottom=False, labelbottom=False)
        axes.set_ylabel("model")
        axes.set_xlabel("reference; cells in %")
        return figure


def abscissa(result: Result) -> tuple[Array, str]:
    """Number that changes along the path, in the unit of its label, and the label: the load's parameter, or the uniform
    field under one load."""
    load = result.loads[0]
    parameters = declared()["loads"][load["type"]]
    name = next((name for name in _MAY_BE_MOVED_BY if name in load), next(iter(parameters)))
    values = result.load(name)
    if _is_path_of_fields(result):
        return _along_strongest(1e3 * result.uniform_field())
    if name == "velocity":
        return values, "flow speed in m/s"
    if name == "scale":
        return values, "factor on gravity and field"
    unit = shown(parameters[name].rsplit(", ", 1)[-1])
    return values / unit.size, f"{name.replace('_', ' ')} in {unit.name}"


def _is_path_of_fields(result: Result) -> bool:
    """True if the field alone changes from step to step."""
    fields = result.uniform_field()
    same_load = all(load == result.loads[0] for load in result.loads)
    return same_load and bool((fields != fields[0]).any())


def _along_strongest(fields: Array) -> tuple[Array, str]:
    """Fields along the direction of the strongest, mT; of others the number of the step."""
    strongest = fields[np.argmax(np.linalg.norm(fields, axis=1))]
    along = fields @ strongest / np.linalg.norm(strongest)
    across = np.linalg.norm(fields - np.outer(along, strongest / np.linalg.norm(strongest)), axis=1)
    if across.max() > 1e-6 * np.linalg.norm(strongest):
        return np.arange(1.0, len(fields) + 1), "step, each with its uniform field"
    return along, "uniform field in mT"


def _begins_straight(result: Result) -> bool:
    """True if nothing bends the cilium where the axis is zero."""
    if result.loads[0]["type"] == "sweep" or not any(result.environments):
        return bool(result.loads[0]["type"] != "sweep")
    has_weight = any(any(around.get("gravity", [])) for around in result.environments)
    if result.loads[0]["type"] != "environment":
        return False
    return not _is_path_of_fields(result) or (
        not has_weight and abscissa(result)[1].startswith("uniform field")
    )


def _evenly(count: int) -> list[int]:
    """Indices of some of `count` steps, the last among them."""
    number_of = min(count, _MOST_SHAPES)
    return [i * count // number_of - 1 for i in range(1, number_of + 1)]


def _shade_jumps(axes: Axes, result: Result, x: Array, colour: str, model: str = "") -> None:
    for i, step in enumerate(result.steps):
        of = step["mechanics"]
        if i > 0 and any(m.get("jump") for name, m in of.items() if model in ("", name)):
            axes.axvspan(x[i - 1], x[i], color=colour, alpha=0.15, linewidth=0)
