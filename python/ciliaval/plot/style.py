# SPDX-License-Identifier: LGPL-2.1-or-later
"""The look that all figures share."""

from __future__ import annotations

import io
from contextlib import AbstractContextManager
from typing import Any

import matplotlib
import matplotlib.figure
from matplotlib.axes import Axes

from ..files import declared

# Okabe and Ito's colours, which the colour-blind tell apart; in the order of the models.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
_MARKS = ["o", "s", "D", "^", "v", "P", "X"]
_DASHES = ["-", "--", ":", "-."]
# Colours of the base, then of magnetised segments, as in ParaView's script.
SEGMENTS = ["#C9CED6", "#E8998D", "#8FB8DE", "#A8D5BA", "#E9C46A"]

_STYLE = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "ciliaval",  # the same figure, the same file
    "font.family": ["DejaVu Sans"],
    "text.parse_math": False,  # people's texts have dollars
}


def style() -> AbstractContextManager[None]:
    """The settings of matplotlib in which a figure is made."""
    settings: AbstractContextManager[None] = matplotlib.rc_context(_STYLE)
    return settings


class Figure(matplotlib.figure.Figure):  # type: ignore[misc]
    """A matplotlib figure that a notebook shows by itself. pyplot does not know it: nothing is to be closed."""

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        """Sharp on screens of up to 192 dpi, and its size in CSS pixels."""
        stream = io.BytesIO()
        with style():
            self.savefig(stream, format="png", dpi=192)
        width, height = (round(96 * size) for size in self.get_size_inches())
        return stream.getvalue(), {"width": width, "height": height}


def detail(kind: str, model: str) -> int:
    """The place of a model among all: those that leave out less come later."""
    known = list(declared()["models"][kind])
    return known.index(model) if model in known else len(known)


def look(model: str) -> dict[str, Any]:
    """Colour and mark of a mechanics model, or of the one of a pair."""
    i = detail("mechanics", model.split("/", 1)[0])
    return {"color": COLOURS[i % len(COLOURS)], "marker": _MARKS[i % len(_MARKS)]}


def dashes(pair: str, pairs: list[str]) -> str:
    """The line of a pair's field model: full for the most detailed one among the pairs."""
    fields = {p.split("/", 1)[1] for p in pairs if "/" in p}
    order = sorted(fields, key=lambda f: -detail("fields", f))
    return _DASHES[order.index(pair.split("/", 1)[1]) % len(_DASHES)] if "/" in pair else "-"


def best_first(pairs: list[str]) -> list[str]:
    """Pairs or mechanics models, those that leave out least first."""

    def order(pair: str) -> tuple[int, int]:
        mechanics, _, field = pair.partition("/")
        return -detail("mechanics", mechanics), -detail("fields", field)

    return sorted(pairs, key=order)


def new_figure(width: float = 4.5, height: float = 3.4) -> tuple[Figure, Axes]:
    """A sheet, in inches, with axes that fill it."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.add_subplot()


def legend(figure: Figure, axes: Axes, order: list[str] | None = None) -> None:
    """In a strip below all axes, where it hides nothing; labels in this order."""
    found = dict(zip(*reversed(axes.get_legend_handles_labels())))
    labels = [name for name in order if name in found] if order else list(found)
    if not labels:
        return
    widest = 0.6 + 0.075 * max(len(label) for label in labels)  # inches, at 9 pt
    columns = max(1, min(len(labels), 4, int(figure.get_figwidth() / widest)))
    rows = -(-len(labels) // columns)
    strip = (0.2 + 0.2 * rows) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
    handles = [found[label] for label in labels]
    figure.legend(handles, labels, loc="lower center", ncols=columns, frameon=False)


def not_finer_than(axes: Axes, least: float) -> None:
    """Widens the vertical axis to this height: what is smaller is noise, not a signal."""
    low, high = axes.get_ylim()
    if high - low < least:
        middle = (low + high) / 2
        axes.set_ylim(middle - least / 2, middle + least / 2)
