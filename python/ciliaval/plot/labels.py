# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts beside what they name, where the sheet is empty."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg

from ..arrays import Array
from .style import Figure

_DISTANCES = (4, 8, 14, 22, 32, 44, 58, 74, 92, 112, 134, 158, 184, 212)  # of a text from its point, pt
_TURNS = [np.pi / 12 * n for n in range(-11, 13)]  # from the direction that is looked at first, rad
_NEAR = 14  # from here on a line leads to the text, pt
_GAP = 2  # around a text, pt


class Label(NamedTuple):
    """A text and the point that it names, in the axes' data; direction, rad: where the text is looked for first."""

    axes: Axes
    text: str
    point: tuple[float, float]
    direction: float
    colour: str = "black"
    size: float = 7


def place(figure: Figure, labels: list[Label]) -> None:
    """Writes each label inside its axes near its point, where nothing is drawn; the first labels first.

    A text away from its point has a line to it, which crosses no other text. Where all is full, a text
    takes the place that hides least. The figure's layout is fixed from now on.
    """
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    figure.set_layout_engine("none")
    picture = np.asarray(canvas.buffer_rgba())[::-1].astype(int)  # rows from below
    drawn = (picture != picture[0, 0]).any(axis=2)
    texts = np.zeros_like(drawn)
    point = figure.dpi / 72  # in pixels
    for label in labels:
        note = label.axes.annotate(
            label.text, label.point, (0, 0), textcoords="offset points", ha="center", va="center",
            color=label.colour, fontsize=label.size, annotation_clip=False,
        )  # fmt: skip
        box = note.get_window_extent()
        half = np.array([box.width, box.height]) / 2 + _GAP * point
        at = label.axes.transData.transform(label.point)
        sheet = label.axes.bbox.extents.reshape(2, 2)
        best, middle = np.inf, at
        for distance, turn in ((d, t) for d in _DISTANCES for t in _TURNS):
            cost = distance + 8 * abs(turn)
            if cost >= best:
                continue
            way = np.array([np.cos(label.direction + turn), np.sin(label.direction + turn)])
            there = at + way * (distance * point + half)
            cost += 1000 * _hidden(drawn, there - half, there + half, sheet)
            if distance >= _NEAR and cost < best:
                line = _line(at, np.clip(at, there - half, there + half), drawn.shape)
                cost += 0.3 * drawn[line].sum() + 1000 * texts[line].sum()
            if cost < best:
                best, middle = cost, there
        note.set_position(tuple((middle - at) / point))
        (left, low), (right, high) = (np.clip((middle + s * half).astype(int), 0, None) for s in (-1, 1))
        texts[low:high, left:right] = drawn[low:high, left:right] = True
        end = np.clip(at, middle - half + _GAP * point, middle + half - _GAP * point)
        if np.linalg.norm(end - at) >= _NEAR * point:
            look: dict[str, Any] = {"color": label.colour, "linewidth": 0.5, "alpha": 0.6, "shrinkA": 0, "shrinkB": 0}
            label.axes.annotate("", label.point, tuple((end - at) / point), textcoords="offset points",
                                arrowprops={"arrowstyle": "-", **look})  # fmt: skip
            drawn[_line(at, end, drawn.shape)] = True


def _hidden(drawn: Array, low: Array, high: Array, sheet: Array) -> float:
    """Pixels of a box, (2,) and (2,), that are drawn on, or that lie beyond the sheet, (2, 2)."""
    inside = np.clip([low, high], *sheet)
    (left, bottom), (right, top) = np.floor(inside[0]).astype(int), np.ceil(inside[1]).astype(int)
    beyond = np.prod(high - low) - np.prod(inside[1] - inside[0])
    return float(beyond + drawn[bottom:top, left:right].sum())


def _line(start: Array, end: Array, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """The pixels of a line on a sheet of this shape: rows, columns."""
    x, y = np.linspace(start, end, 2 + int(np.linalg.norm(end - start))).astype(int).T
    inside = (x >= 0) & (y >= 0) & (x < shape[1]) & (y < shape[0])
    return y[inside], x[inside]
