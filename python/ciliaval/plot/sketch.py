# SPDX-License-Identifier: LGPL-2.1-or-later
"""The set-up of a case, drawn to scale: cilium, load, surface, sensors."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch, Rectangle

from ..arrays import Array
from ..plain_cilium import PlainCilium
from ..plain_surface import PlainSurface
from ..results import Result
from ..units import describe_touch, number, quantity
from .case import bent
from .labels import Label, place
from .style import SEGMENTS, Figure, best_first, style

_ARROW = {"arrowstyle": "-|>", "mutation_scale": 9, "shrinkA": 0, "shrinkB": 0}
_LOAD = "#B00020"
_FIELD = "#1F5FA8"
_LEFT, _UP, _DOWN = np.pi, np.pi / 2, -np.pi / 2  # where a label is looked for first


def setup(case: Result | Any) -> Figure:
    """A case as a sketch: from the side, in the plane of the load, and from above.

    case: a Case, or the Result of one, which shows the bent cilium too, by the most detailed model at
    the last step. A sweep's surface is drawn where it is at that step; of a profile in a file its level
    alone. Raises FileError if the result's folder has no case.toml.

    >>> import ciliaval as cv
    >>> rod = cv.Cilium(3e-3, [cv.Segment(20e-3, 1e6, magnetization=75e3, name="rod")])
    >>> case = cv.Case.from_objects(rod, cv.Load("contact", force=1e-3, height=16e-3), [0, 0, -2e-3])
    >>> figure = cv.plot.setup(case)
    >>> [text.get_text() for text in figure.axes[0].texts if "sensor" in text.get_text()]
    ['sensor 0: z = −2 mm']
    """
    text = case.case_text if isinstance(case, Result) else case.toml()
    load = _last_load(case) if isinstance(case, Result) else case.loads[-1]
    cilium, surface = PlainCilium.of(text), PlainSurface.of(text)
    sensors = list(zip(case.sensor_names, 1e3 * np.asarray(case.sensors).reshape(-1, 3)))
    azimuth = load.parameters.get("azimuth", 0.0)
    with style():
        figure = Figure(figsize=(4.6, 5.6), layout="constrained")
        side, above = figure.subplots(2, 1, height_ratios=[1.7, 1])
        for axes in (side, above):
            axes.grid(visible=False)
            axes.patch.set_visible(False)
            axes.set_aspect("equal", adjustable="datalim")
        segments = _draw_cilium(side, cilium, azimuth)
        if load.type == "sweep" and surface is not None:
            labels = _draw_surface(side, cilium, load.parameters, surface)
        else:
            labels = _draw_load(side, cilium, load, azimuth)
        labels += _draw_environment(side, cilium, load, azimuth)
        if isinstance(case, Result):
            labels += _draw_bent(side, case)
        labels += segments + _draw_sensors(side, sensors, azimuth)
        labels += _draw_above(above, cilium, load, sensors, azimuth)
        for axes in (side, above):
            axes.margins(0.02)
        place(figure, labels)
        return figure


def _last_load(result: Result) -> SimpleNamespace:
    """Last load of the result, with the attributes of a ciliaval.Load."""
    load, around = result.loads[-1], result.environments[-1]
    vectors = {name: np.array(around.get(name, [0.0] * 3)) for name in ("gravity", "uniform_field")}
    parameters = {key: value for key, value in load.items() if key != "type"}
    return SimpleNamespace(type=load["type"], parameters=parameters, environment=SimpleNamespace(**vectors))


def _arrow(axes: Axes, start: Any, end: Any, colour: str = _LOAD, width: float = 1.4) -> None:
    axes.add_patch(FancyArrowPatch(tuple(start), tuple(end), color=colour, linewidth=width, **_ARROW))


def _draw_cilium(axes: Axes, cilium: PlainCilium, azimuth: float) -> list[Label]:
    """Segments with their magnetization, and the base; sets the axes' limits."""
    d, length = 1e3 * cilium.extent(azimuth), 1e3 * cilium.length
    labels = [Label(axes, f"{'b' if cilium.sides else 'd'} = {number(d)} mm", (0, length), _UP)]
    z = 0.0
    for i, segment in enumerate(cilium.segments):
        h, M = 1e3 * segment.length, segment.magnetization
        colour = SEGMENTS[i % len(SEGMENTS)] if any(M) or i == 0 else SEGMENTS[0]
        axes.add_patch(Rectangle((-d / 2, z), d, h, facecolor=colour, edgecolor="0.3", linewidth=0.8))
        lines = [
            f"{segment.name or f'segment {i}'}: {number(h)} mm",
            f"E = {quantity(segment.young_modulus, 'Pa')}, ν = {number(segment.poisson_ratio)}",
        ]
        if any(M):
            across = M[0] * np.cos(azimuth) + M[1] * np.sin(azimuth)
            arrow = np.array([across * d / 3, M[2] * h / 4]) / np.linalg.norm(M)
            if arrow.any():
                _arrow(axes, (0, z + h / 2) - arrow, (0, z + h / 2) + arrow, "0.2", 1.2)
            lines.append("M = " + ", ".join(quantity(m, "A/m") for m in (M if any(M[:2]) else M[2:])))
        labels.append(Label(axes, "\n".join(lines), (-d / 2, z + h / 2), _LEFT))
        z += h
    size = max(d, length)
    reach = max(1.2 * d, 0.55 * length)
    below = Rectangle((-reach, -0.06 * size), 2 * reach, 0.06 * size)
    below.set(hatch="////", facecolor="none", edgecolor="0.6", linewidth=0)
    axes.add_patch(below)
    axes.plot([-reach, reach], [0, 0], color="0.3", linewidth=1)
    axes.set(xlabel="along the load in mm", ylabel="z in mm")
    axes.update_datalim([(-d / 2 - 1.1 * size, -0.25 * size), (reach, 1.2 * length)])
    return labels


def _draw_load(axes: Axes, cilium: PlainCilium, load: Any, azimuth: float) -> list[Label]:
    d, length = 1e3 * cilium.extent(azimuth), 1e3 * cilium.length
    p = load.parameters
    if load.type == "environment":
        return []  # its arrows are drawn beside the cilium
    if load.type == "moment":
        end, size = (0.16 * length, 0.94 * length), 0.1 * length
        bow = FancyArrowPatch((-size, length), end, connectionstyle="arc3,rad=-0.8", color=_LOAD, linewidth=1.4, **_ARROW)
        axes.add_patch(bow)
        return [Label(axes, f"moment, {quantity(p['moment'], 'N m')}", (-size, length), _UP, _LOAD)]
    if load.type in ("flow", "dead"):
        heights, size = np.linspace(0.12, 1, 7) * length, 0.16 * length
        text = f"{load.type}, {quantity(next(v for k, v in p.items() if k.startswith('force')), 'N/m')}"
    else:
        heights, size = np.array([1e3 * p.get("height", p.get("arclength", cilium.length))]), 0.3 * length
        strength = quantity(p["displacement"], "m") if "displacement" in p else quantity(p["force"], "N")
        text = f"{load.type}, {strength} at {number(heights[0])} mm"
    left = -d / 2
    if touch := p.get("touch"):
        text += f"\n{describe_touch(touch)}"
        left = _draw_pin(axes, touch, d, heights[0], 1e3 * p.get("displacement", 0.0))
    for z in heights:
        _arrow(axes, (left - size, z), (left, z))
    return [Label(axes, text, (-d / 2 - size, heights[-1]), _UP, _LOAD)]


def _draw_pin(axes: Axes, touch: dict[str, Any], d: float, height: float, displacement: float) -> float:
    """The pin where it first touches, and dashed where it has gone, lengths in mm. Returns where its left side is."""
    radius = 1e3 * float(touch["radius"])
    middle = -radius - (d / 2 if touch["at"] == "mantle" else 0)
    axes.add_patch(Circle((middle, height), radius, facecolor="0.75", edgecolor=_LOAD, linewidth=0.8, zorder=3))
    if displacement:
        gone = Circle((middle + displacement, height), radius, facecolor="none", edgecolor=_LOAD, linewidth=0.8)
        gone.set(linestyle="--", zorder=3)
        axes.add_patch(gone)
    return middle - radius


def _draw_surface(axes: Axes, cilium: PlainCilium, load: dict[str, Any], surface: PlainSurface) -> list[Label]:
    """At the last step, with an arrow of its travel."""
    length = cilium.length
    x = np.linspace(-5 * length, 5 * length, 2001)  # beyond the axes, which show a part
    z = surface.z(x, length, load)
    dashes = "--" if surface.kind == "file" else "-"
    axes.add_artist(Line2D(1e3 * x, 1e3 * z, color=_LOAD, linewidth=1.4, linestyle=dashes, label="surface"))
    top = 1e3 * max(length, z[np.abs(x) < length].max()) + 60 * length
    start, end = (300 * length, top), (700 * length, top)
    axes.update_datalim([end, (0, top + 150 * length)])
    _arrow(axes, start, end)
    text = f"surface, {quantity(load['interference'], 'm')} below the tip"
    text += "; its profile is in a file" if surface.kind == "file" else ""
    return [Label(axes, text, start, _UP, _LOAD)]


def _draw_environment(axes: Axes, cilium: PlainCilium, load: Any, azimuth: float) -> list[Label]:
    """Gravity and uniform field by their directions in the plane of the load."""
    d, length = 1e3 * cilium.extent(azimuth), 1e3 * cilium.length
    beside = max(0.42 * length, d / 2 + 0.2 * length)
    rows = [
        ("g", load.environment.gravity, "m/s²", 1.0, "0.3"),
        ("B₀", load.environment.uniform_field, "mT", 1e-3, _FIELD),
    ]
    labels = []
    for symbol, vector, unit, size, colour in rows:
        strength = float(np.linalg.norm(vector))
        if strength == 0:
            continue
        seen = np.array([vector[0] * np.cos(azimuth) + vector[1] * np.sin(azimuth), vector[2]]) / strength
        middle = np.array([beside, (0.8 if symbol == "g" else 0.4) * length])
        reach = 0.11 * length * seen
        if np.linalg.norm(seen) > 0.05:
            _arrow(axes, middle - reach, middle + reach, colour)
        else:  # across the plane
            axes.plot(*middle, "o", color=colour, markersize=5, fillstyle="none")
        labels.append(Label(axes, f"{symbol} = {number(strength, size)} {unit}", (middle[0], middle[1]), 0, colour))
    return labels


def _draw_bent(axes: Axes, result: Result) -> list[Label]:
    for model in best_first(result.models):
        if result.status(model)[-1] != "converged":
            continue
        x, z = 1e3 * bent(result, model, -1)
        axes.plot(x, z, color="0.25", linestyle="--", linewidth=1.2)
        return [Label(axes, f"bent, {model}", (x[-1], z[-1]), 0, "0.25")]
    return []


def _draw_sensors(axes: Axes, sensors: list[tuple[str, Array]], azimuth: float) -> list[Label]:
    labels = []
    word = "sensor " if len(sensors) < 3 else ""
    for name, at in sensors:
        x = float(at[0] * np.cos(azimuth) + at[1] * np.sin(azimuth))
        axes.plot(x, at[2], "s", color="k", markersize=5)
        labels.append(Label(axes, f"{word}{name}: z = {number(at[2])} mm", (x, at[2]), _DOWN / 2))
    if sensors:  # room for their texts
        low, high = axes.dataLim.get_points()[:, 1]
        lowest = min(at[2] for _, at in sensors)
        axes.update_datalim([(0, min(low, lowest - (0.1 + 0.03 * len(sensors)) * (high - lowest)))])
    return labels


def _draw_above(
    axes: Axes, cilium: PlainCilium, load: Any, sensors: list[tuple[str, Array]], azimuth: float
) -> list[Label]:
    look = {"facecolor": SEGMENTS[0], "edgecolor": "0.3", "linewidth": 0.8}
    if cilium.sides:
        width, height = 1e3 * np.array(cilium.sides)
        d = float(np.hypot(width, height))
        turn = {"angle": np.degrees(cilium.orientation), "rotation_point": "center"}
        axes.add_patch(Rectangle((-width / 2, -height / 2), width, height, **turn, **look))
    else:
        d = 1e3 * cilium.diameter
        axes.add_patch(Circle((0, 0), d / 2, **look))
    reach = max([1.1 * d, *(1.4 * np.hypot(at[0], at[1]) for _, at in sensors)])
    tip = 0.95 * reach * np.array([np.cos(azimuth), np.sin(azimuth)])
    _arrow(axes, (0, 0), tip)
    word = "plane" if load.type == "environment" else "load"
    labels = [Label(axes, f"{word}, {number(np.degrees(azimuth), 1, 3)}°", (tip[0], tip[1]), azimuth, _LOAD)]
    for name, at in sensors:
        axes.plot(at[0], at[1], "s", color="k", markersize=4)
        labels.append(Label(axes, name, (at[0], at[1]), float(np.arctan2(at[1], at[0]))))
    axes.update_datalim([(-1.25 * reach, -1.25 * reach), (1.25 * reach, 1.25 * reach)])
    axes.set(xlabel="x in mm", ylabel="y in mm", title="from above")
    axes.title.set_fontsize(8)
    return labels
