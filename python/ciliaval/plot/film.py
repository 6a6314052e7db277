# SPDX-License-Identifier: LGPL-2.1-or-later
"""A load path or a sweep as an animation."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.animation import FuncAnimation, HTMLWriter, PillowWriter

from ..arrays import Array
from ..errors import FileError
from ..files import replacing
from ..plain_cilium import PlainCilium
from ..plain_surface import PlainSurface
from ..results import Result
from .case import abscissa, bent
from .style import Figure, best_first, dashes, legend, look, style


def animate(result: Result, path: str | Path, sensor: int | str = 0, rate: float = 10) -> None:
    """Writes an animation with a frame for each load step: the shapes of all models on the left, the norm of ΔB at a
    sensor, by its number or name, over the load on the right, with a mark at the step.

    path: a file .gif, or .html with a slider. rate: frames a second. A sweep's surface is drawn if the
    result has its case. Raises InputError for a sensor that there is not, FileError for another kind of
    file or one that cannot be written.

    >>> import tempfile, ciliaval as cv
    >>> rod = cv.Cilium(3e-3, [cv.Segment(20e-3, 1e6, magnetization=75e3, name="rod")])
    >>> path = [cv.Load("contact", force=force, height=16e-3) for force in (1e-3, 2e-3)]
    >>> result = cv.Case.from_objects(rod, path, [0, 0, -2e-3]).run()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     cv.plot.animate(result, f"{folder}/bending.gif")
    """
    path = Path(path)
    if path.suffix not in (".gif", ".html"):
        raise FileError(f"{path}: an animation's name ends in .gif or .html")
    writer = PillowWriter(rate) if path.suffix == ".gif" else HTMLWriter(rate, embed_frames=True)
    sensor = result.sensor(sensor)
    count, (load, label) = len(result.steps), abscissa(result)
    signals = {pair: 1e6 * np.linalg.norm(result.dB(pair)[:, sensor], axis=1) for pair in best_first(result.pairs)}
    shapes = {model: [_shape(result, model, i) for i in range(count)] for model in result.models}
    surface = PlainSurface.of(result.case_text) if result.has_case() else None
    surface = surface if surface and surface.kind != "file" else None
    length = PlainCilium.of(result.case_text).length if surface else 0
    x = np.linspace(-5 * length, 5 * length, 1001)
    # Beyond this limit, MB, matplotlib leaves frames out.
    with style(), matplotlib.rc_context({"animation.embed_limit": 1000}):
        figure = Figure(figsize=(7.5, 4), layout="constrained")
        left, right = figure.subplots(1, 2)
        left.update_datalim([(0, 0), (0, 1200 * length), *np.hstack([np.hstack(of) for of in shapes.values()]).T])
        left.set_aspect("equal", adjustable="datalim")
        left.set(xlabel="deflection in mm", ylabel="z in mm")
        lines = {model: left.plot([], [], color=look(model)["color"])[0] for model in result.models}
        (above,) = left.plot([], [], color="0.4", linewidth=1)
        marks = {pair: right.plot([], [], "o", color=look(pair)["color"], markersize=5)[0] for pair in signals}
        for pair, values in signals.items():
            right.plot(load, values, dashes(pair, list(signals)), label=pair, color=look(pair)["color"])
        right.set(xlabel=label, ylabel=f"|ΔB| at sensor {result.sensor_names[sensor]} in µT")
        legend(figure, right, list(signals))

        def draw(i: int) -> None:
            left.set_title(f"step {i + 1} of {count}", fontsize=9)
            for model, line in lines.items():
                line.set_data(shapes[model][i])
            for pair, mark in marks.items():
                mark.set_data([load[i]], [signals[pair][i]])
            if surface:
                above.set_data(1e3 * x, 1e3 * surface.z(x, length, result.loads[i]))

        film = FuncAnimation(figure, draw, frames=count, cache_frame_data=False)
        with replacing(path) as scratch:
            film.save(scratch, writer=writer, dpi=100)


def _shape(result: Result, model: str, step: int) -> Array:
    """In mm, (2, n); without a point where the model has none."""
    return 1e3 * bent(result, model, step) if result.status(model)[step] == "converged" else np.zeros((2, 0))
