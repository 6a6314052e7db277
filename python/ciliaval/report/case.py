# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part of a page that shows a case."""

from __future__ import annotations

from collections.abc import Callable

from typing import Any

import numpy as np

from .. import plot
from ..plot.style import best_first
from ..results import Result
from ..units import in_words, number, quantity
from . import view3d
from .blocks import (
    Block, Code, Details, Heading, Image, Images, Items, Opening, Table, guarded, image,
)  # fmt: skip
from .sentences import findings, remarks
from .validation import validation_blocks

_MOST_ROWS = 120  # of a table: of a sweep's hundreds of samples some


def case_blocks(result: Result) -> list[Block]:
    """A sketch and at most five sentences, figures, an interactive view, the numbers. What a damaged file
    keeps from being shown is named in its place."""
    parts: list[tuple[str, Callable[[], list[Block]]]] = [
        ("What was found", lambda: [Opening(_sketch(result), findings(result))]),
        ("Remarks of the models", lambda: _remarks(result)),
        ("Figures", lambda: [Images(_figures(result))]),
        ("Against measurements", lambda: validation_blocks(result)),
        ("The interactive view", lambda: [view] if (view := view3d.view(result)) else []),
        ("The field's numbers", lambda: _field_details(result)),
        ("The shapes' numbers", lambda: [Details("The shapes' numbers", [_shapes(result)])]),
        ("Differences", lambda: _differences(result)),
        ("The case file", lambda: _case_file(result)),
    ]
    return [block for what, make in parts for block in guarded(what, make)]


def _remarks(result: Result) -> list[Block]:
    said = list(remarks(result))
    return [Heading("Range and remarks of the models"), Items(said)] if said else []


def _field_details(result: Result) -> list[Block]:
    if not result.pairs:
        return []
    components = [
        image(f"B at sensor {name}", "The curves are the flux density itself, drawn as its change above.", lambda: plot.signal(result, sensor, "B"))
        for sensor, name in enumerate(result.sensor_names)
    ]
    return [Details("B itself, and the field's numbers", [Images(components), _fields(result)])]


def _differences(result: Result) -> list[Block]:
    tables = [t for t in (_over_path(result), _agreement(result)) if t.rows]
    return [Details("Differences over the load path", list(tables))] if tables else []


def _case_file(result: Result) -> list[Block]:
    if not result.has_case():
        return []
    return [Details("The case with every value that was used", [Code("Case file", result.case_text)])]


def _sketch(result: Result) -> Image | None:
    if not result.has_case():
        return None
    text = f"The sketch is to scale and shows the last load. The cilium is bent by {in_words(best_first(result.models))}"
    fields = dict.fromkeys(pair.split("/", 1)[-1] for pair in best_first(result.pairs))
    text += f", its field is computed by {in_words(fields)}." if result.pairs else "; no field is computed."
    return image(f"The set-up of {result.name}", text, lambda: plot.setup(result))


def _figures(result: Result) -> list[Image]:
    drawn = []
    if any("converged" in result.status(model) for model in result.models):
        text = "The lines are the centrelines of all models in the plane of the load"
        text += "; the numbers are loads, as on the axis of the signals." if len(result.steps) > 1 else "."
        drawn.append(image("Shapes", text, lambda: plot.shapes(result)))
    if result.pairs:
        for sensor, name in enumerate(result.sensor_names):
            title = f"Signal at sensor {name}"
            text = "The colour tells the bending model, the line the field model; the band is ± of ΔB at 95 %."
            drawn.append(image(title, text, lambda: plot.signal(result, sensor)))
    if result.loads[0]["type"] == "sweep":
        text = "N, T and the tip's place are drawn along the way; where it is shaded, a model jumps between two samples."
        drawn.append(image("Contact forces and tip", text, lambda: plot.sweep(result)))
    step = _last_compared(result)
    for name, text in [
        ("centreline", "A cell is the largest distance of two shapes over the reference's deflection"),
        ("dB", "A cell is the largest difference of a component of ΔB over the reference's largest |ΔB|"),
    ]:
        if step is not None and any(c.relative is not None for c in result.compare(quantity=name, step=step)):
            title = {"centreline": "Differences of shapes", "dB": "Differences of signals"}[name]
            caption = f"{text} at load step {step + 1}. The reference leaves out less; it is not the truth. "
            caption += "A grey cell is below the numerical error, or that is not known."
            drawn.append(image(title, caption, lambda: plot.pairs(result, name, step or 0)))
    return drawn


def _last_compared(result: Result) -> int | None:
    steps = [c.step for c in result.comparisons if c.step is not None]
    return max(steps, default=None)


def _listed(result: Result) -> list[int]:
    rows = max(1, len(result.models))
    most = max(2, _MOST_ROWS // rows)
    count = len(result.steps)
    return sorted({int(i) for i in np.linspace(0, count - 1, min(count, most)).round()})


def _shapes(result: Result) -> Table:
    table = Table(
        "What each mechanics model found",
        ["step, model", "status", "tip x, mm", "y", "z", "± at 95 %, µm", "angle, °", "force, mN",
         "unknowns", "iterations", "time, s"],
    )  # fmt: skip
    for i in _listed(result):
        for model, m in result.steps[i]["mechanics"].items():
            tip = m.get("tip") or [None] * 3
            row = [f"{i + 1}, {model}", m["status"], *(number(t, 1e-3, 5) for t in tip)]
            row.append(_band(m))
            row.append(number(m.get("tip_angle"), np.pi / 180, 5))
            row.append(number(m.get("applied_force"), 1e-3, 5))
            row += [number(m.get(key), 1, 9) for key in ("unknowns", "iterations")]
            table.rows.append([*row, number(m.get("seconds"), 1, 3)])
    return table


def _band(mechanics: dict[str, Any]) -> str:
    """The tip's, or "> 3", the numerical error, where it is not known what the model leaves out."""
    band = (mechanics.get("band") or {}).get("tip")
    if band is not None:
        return number(band, 1e-6, 2)
    numerical = mechanics.get("tip_uncertainty")
    return "–" if numerical is None else f"> {number(numerical, 1e-6, 2)}"


def _fields(result: Result) -> Table:
    table = Table(
        "B and its change at the sensors",
        ["step, sensor, pair", "Bx, mT", "By", "Bz", "ΔBx, µT", "ΔBy", "ΔBz"],
    )
    for i in _listed(result):
        for s, name in enumerate(result.sensor_names):
            for pair, f in result.steps[i]["fields"].items():
                row = [f"{i + 1}, {name}, {pair}"]
                for key, unit in (("B", 1e-3), ("dB", 1e-6)):
                    values = (f.get(key) or [None] * (s + 1))[s] or [None] * 3
                    row += [number(value, unit, 6) for value in values]
                table.rows.append(row)
    return table


def _over_path(result: Result) -> Table:
    table = Table(
        "Root mean square of a model's ΔB less its reference's over that of the reference, all steps, in %",
        ["model", "reference", "sensor", "component", "RRMSE", "verdict"],
    )
    for c in result.compare(quantity="dB", step=None, statistic="rrmse"):
        name = result.sensor_names[c.sensor or 0]
        row = [c.model, c.reference, name, c.component or "", number(c.relative, 0.01, 3), c.verdict]
        table.rows.append(row)
    return table


def _agreement(result: Result) -> Table:
    table = Table(
        "Agreement of the shapes w(z): R² without a fit, and the squared correlation",
        ["step", "model", "reference", "R²", "correlation²"],
    )
    for c in result.summary["comparisons"]:
        if c["statistic"] == "r2":
            values = [number(c.get(key), 1, 7) for key in ("r2", "correlation")]
            table.rows.append([str(c["step"] + 1), c["model"], c["reference"], *values])
    return table


def case_row(result: Result) -> list[str]:
    """Row of the table of all cases: models, tip and |ΔB| by the best of them at the last step."""
    best = best_first(result.models)[0]
    tip = result.tip(best)[-1]
    row = [str(len(result.steps)), in_words(best_first(result.models))]
    row.append(quantity(float(np.hypot(tip[0], tip[1])), "m") if np.isfinite(tip).all() else "no shape")
    pairs = [p for p in best_first(result.pairs) if p.startswith(best + "/")]
    signal = np.linalg.norm(result.dB(pairs[0])[-1, 0]) if pairs and len(result.sensors) else None
    row.append(quantity(signal, "T") if signal is not None and np.isfinite(signal) else "–")
    return row
