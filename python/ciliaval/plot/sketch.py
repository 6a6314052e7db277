# SPDX-License-Identifier: LGPL-2.1-or-later
"""The set-up of a case, drawn to scale: cilium, load, sensors, axes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Polygon, Rectangle

from ..arrays import Array
from ..plain_cilium import PlainCilium
from ..results import Result
from ..units import number, quantity
from .style import SEGMENTS, best_first, style

_ARROW = {"arrowstyle": "-|>", "mutation_scale": 9, "shrinkA": 0, "shrinkB": 0}
_LOAD = "#B00020"
_FIELD = "#1F5FA8"


def setup(case: Result | Any) -> Figure:
    """A case as a sketch: from the side, in the plane of the load, and from above.

    case: a Case, or the Result of one, which shows the bent cilium too, by the most detailed model at
    the last step. Raises FileError if its folder has no case.toml.
    """
    result = case if isinstance(case, Result) else None
    cilium: Any
    load: Any
    if isinstance(case, Result):
        cilium, load = PlainCilium.of(case.case_text), _last_load(case)
    else:
        cilium, load = case.cilium, case.loads[-1]
    sensors = np.asarray(case.sensors).reshape(-1, 3)
    names = case.sensor_names
    azimuth = load.parameters.get("azimuth", 0.0)
    with style():
        figure = Figure(figsize=(6.4, 3.5), layout="constrained")
        side, above = figure.subplots(1, 2, width_ratios=[1.7, 1])
        for axes in (side, above):
            axes.grid(visible=False)
            axes.set_aspect("equal")
        _draw_side(side, cilium, load, sensors, names, azimuth)
        if result is not None:
            _draw_bent(side, result, azimuth)
        _draw_above(above, cilium, load, sensors, names, azimuth)
        return figure


def _last_load(result: Result) -> SimpleNamespace:
    """Last load of the result, with the attributes of a ciliaval.Load."""
    load, around = result.loads[-1], result.environments[-1]
    vectors = {name: np.array(around.get(name, [0.0] * 3)) for name in ("gravity", "uniform_field")}
    parameters = {key: value for key, value in load.items() if key != "type"}
    return SimpleNamespace(type=load["type"], parameters=parameters, environment=SimpleNamespace(**vectors))


def _draw_side(
    axes: Axes, cilium: Any, load: Any, sensors: Array, names: list[str], azimuth: float
) -> None:
    d, length = 1e3 * cilium.extent(azimuth), 1e3 * cilium.length
    z = 0.0
    for i, segment in enumerate(cilium.segments):
        h = 1e3 * segment.length
        M = segment.magnetization if isinstance(segment.magnetization, tuple) else (0.0, 0.0, segment.magnetization)
        magnetic = any(M)
        colour = SEGMENTS[i % len(SEGMENTS)] if magnetic or i == 0 else SEGMENTS[0]
        axes.add_patch(Rectangle((-d / 2, z), d, h, facecolor=colour, edgecolor="0.3", linewidth=0.8))
        if magnetic:
            across = M[0] * np.cos(azimuth) + M[1] * np.sin(azimuth)
            arrow = np.array([across * d / 3, M[2] * h / 4]) / np.linalg.norm(M)
            if arrow.any():
                ends = [(-arrow[0], z + h / 2 - arrow[1]), (arrow[0], z + h / 2 + arrow[1])]
                axes.add_patch(FancyArrowPatch(*ends, color="0.2", linewidth=1.2, **_ARROW))
        lines = [
            f"{segment.name or f'segment {i}'}: {number(h)} mm",
            f"E = {quantity(segment.young_modulus, 'Pa')}, ν = {number(segment.poisson_ratio)}",
        ]
        if magnetic:
            shown = [quantity(m, "A/m") for m in (M if any(M[:2]) else M[2:])]
            lines.append("M = " + ", ".join(shown))
        axes.text(-0.5 * d - 0.22 * length, z + h / 2, "\n".join(lines), ha="right", va="center", fontsize=7)
        z += h
    reach = max(1.2 * d, 0.55 * length)
    base = Polygon(
        [(-reach, 0), (reach, 0), (reach, -0.06 * length), (-reach, -0.06 * length)],
        hatch="////", facecolor="none", edgecolor="0.6", linewidth=0,
    )
    axes.add_patch(base)
    axes.plot([-reach, reach], [0, 0], color="0.3", linewidth=1)
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    for name, at in zip(names, 1e3 * sensors):
        x = float(at[:2] @ along)
        axes.plot(x, at[2], "s", color="k", markersize=5)
        text = f"sensor {name}: {number(at[2])} mm"
        axes.annotate(text, (x, at[2]), (8, -9), textcoords="offset points", fontsize=7)
    _draw_load(axes, cilium, load, d)
    _draw_environment(axes, load, along, length)
    axes.annotate(f"{'b' if cilium.sides else 'd'} = {number(d)} mm", (0, length), (0, 6), textcoords="offset points",
                  ha="center", fontsize=7)
    deepest = min([0.0, *(1e3 * sensors[:, 2])]) if len(sensors) else 0.0
    axes.set(xlabel="along the load in mm", ylabel="z in mm")
    axes.set_xlim(-1.15 * max(reach, 0.95 * length), 1.15 * reach)
    axes.set_ylim(min(-0.12 * length, 1.6 * deepest - 0.05 * length), 1.15 * length)


def _draw_load(axes: Axes, cilium: Any, load: Any, d: float) -> None:
    length = 1e3 * cilium.length
    p = load.parameters

    def arrow(x: float, z: float, size: float) -> None:
        ends = [(x - size, z), (x, z)]
        axes.add_patch(FancyArrowPatch(*ends, color=_LOAD, linewidth=1.4, **_ARROW))

    spread = {"flow": "q", "dead": "q"}
    if load.type in spread:
        for z in np.linspace(0.12, 1, 7) * length:
            arrow(-d / 2, z, 0.16 * length)
        key = next(k for k in p if k.startswith("force"))
        text, z = f"{load.type}, {quantity(p[key], 'N/m')}", 1.04 * length
    elif load.type == "sweep":
        z = length - 1e3 * p["interference"]
        wide = 0.5 * length
        axes.plot([-wide, wide], [z, z], color=_LOAD, linewidth=1.4)
        arrow(wide, z + 0.03 * length, 0.3 * length)
        text = f"surface, {quantity(p['interference'], 'm')} below the tip"
    elif load.type == "environment":
        return  # its arrows are drawn beside the cilium
    elif load.type == "moment":
        z, r = length, 0.16 * length
        ends = [(-0.6 * r, z), (r, z - 0.4 * r)]
        axes.add_patch(FancyArrowPatch(*ends, connectionstyle="arc3,rad=-0.8", color=_LOAD, linewidth=1.4, **_ARROW))
        text = f"moment, {quantity(p['moment'], 'N m')}"
    else:
        z = 1e3 * p.get("height", p.get("arclength", cilium.length))
        arrow(-d / 2, z, 0.3 * length)
        size = quantity(p["displacement"], "m") if "displacement" in p else quantity(p["force"], "N")
        text = f"{load.type}, {size} at {number(z)} mm"
    axes.annotate(text, (-d / 2 - 0.05 * length, z), (0, 6), textcoords="offset points", ha="right",
                  color=_LOAD, fontsize=7.5)


def _draw_environment(axes: Axes, load: Any, along: Array, length: float) -> None:
    """Gravity and uniform field by their directions in the plane of the load."""
    around = load.environment
    rows = [
        ("g", around.gravity, "m/s²", 1.0, "0.3"),
        ("B₀", around.uniform_field, "mT", 1e-3, _FIELD),
    ]
    x = 0.42 * length
    for symbol, vector, unit, size, colour in rows:
        strength = float(np.linalg.norm(vector))
        if strength == 0:
            continue
        seen = np.array([vector[:2] @ along, vector[2]]) / strength
        middle = np.array([x, 0.8 * length if symbol == "g" else 0.4 * length])
        reach = 0.11 * length * seen
        if np.linalg.norm(seen) > 0.05:
            ends = [tuple(middle - reach), tuple(middle + reach)]
            axes.add_patch(FancyArrowPatch(*ends, color=colour, linewidth=1.4, **_ARROW))
        else:  # across the plane
            axes.plot(*middle, "o", color=colour, markersize=5, fillstyle="none")
        text = f"{symbol} = {number(strength, size)} {unit}"
        below = middle[1] - abs(reach[1]) - 0.03 * length
        axes.text(x, below, text, ha="center", va="top", color=colour, fontsize=7.5)


def _draw_bent(axes: Axes, result: Result, azimuth: float) -> None:
    for model in best_first(result.models):
        if result.status(model)[-1] != "converged":
            continue
        line = result.centreline(model, -1)
        x = 1e3 * (line["x"] * np.cos(azimuth) + line["y"] * np.sin(azimuth))
        axes.plot(x, 1e3 * line["z"], color="0.25", linestyle="--", linewidth=1.2)
        axes.annotate(f"bent, {model}", (x[-1], 1e3 * line["z"][-1]), (4, -8),
                      textcoords="offset points", fontsize=7, color="0.25")
        right = axes.get_xlim()[1]
        axes.set_xlim(right=max(right, 1.35 * x[-1]))
        return


def _draw_above(
    axes: Axes, cilium: Any, load: Any, sensors: Array, names: list[str], azimuth: float
) -> None:
    look = {"facecolor": SEGMENTS[0], "edgecolor": "0.3", "linewidth": 0.8}
    if cilium.sides:
        width, height = 1e3 * np.array(cilium.sides)
        d = max(width, height)
        turn = {"angle": np.degrees(cilium.orientation), "rotation_point": "center"}
        axes.add_patch(Rectangle((-width / 2, -height / 2), width, height, **turn, **look))
    else:
        d = 1e3 * cilium.diameter
        axes.add_patch(Circle((0, 0), d / 2, **look))
    radii = np.hypot(*(1e3 * sensors[:, :2]).T) if len(sensors) else np.zeros(1)
    reach = max(1.1 * d, 1.3 * radii.max())
    tip = 0.95 * reach * np.array([np.cos(azimuth), np.sin(azimuth)])
    axes.add_patch(FancyArrowPatch((0, 0), tip, color=_LOAD, linewidth=1.4, **_ARROW))
    degrees = number(np.degrees(azimuth), 1, 3)
    side = "left" if np.cos(azimuth) > -1e-9 else "right"
    word = "plane" if load.type == "environment" else "load"
    beside = 0.14 * reach * np.array([np.sin(azimuth), -np.cos(azimuth)])  # clear of the axes' names
    axes.text(*(0.9 * tip + beside), f"{word}, {degrees}°", color=_LOAD, fontsize=7.5, ha=side, va="center")
    for name, at in zip(names, 1e3 * sensors):
        axes.plot(at[0], at[1], "s", color="k", markersize=4)
        axes.annotate(name, at[:2], (4, -9), textcoords="offset points", fontsize=7)
    for ends, label in (((0.8 * reach, 0), "x"), ((0, 0.8 * reach), "y")):
        axes.add_patch(FancyArrowPatch((0, 0), ends, color="0.5", linewidth=0.8, **_ARROW))
        axes.text(1.08 * ends[0], 1.08 * ends[1], label, color="0.4", ha="center", va="center")
    axes.set(xlim=(-1.25 * reach, 1.25 * reach), ylim=(-1.25 * reach, 1.25 * reach))
    axes.set(xlabel="x in mm", title="from above")
    axes.title.set_fontsize(8)
