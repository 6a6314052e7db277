# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.plot FILE.json FIGURE: the main figure of a result file.

FIGURE is a file (.svg, .pdf, .png). A case file (TOML) is drawn as a sketch of the set-up. A study has a figure for each output: there it is a folder that
takes them as SVG. Of a case it is the signal at the first sensor.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any


from .. import plot
from ..errors import Error, FileError
from ..files import replacing
from ..results import Document, Result, read
from .style import Figure, style


def main_figure(data: Result | Document) -> Figure | None:
    """Main figure of a result or document; None if there is nothing to draw."""
    if isinstance(data, Result):
        return plot.signal(data)
    if data.kind == "budget":
        return plot.budget(data)
    if data.kind == "converge":
        return plot.convergence(data)
    if data.kind == "sense":
        draw: Any = {"by_magnitude": plot.bench, "levels": plot.levels, "samples": plot.readings}
        figure: Figure = next(make for key, make in draw.items() if key in data)(data)
        return figure
    raise FileError(f"a result of `{data.kind}` has no figure")


def save(figure: Figure, file: Path) -> None:
    """An old figure is replaced at once or not at all."""
    kind = file.suffix.lstrip(".").lower()
    if kind not in ("svg", "pdf", "png"):
        raise FileError(f"{file}: a figure's name ends in .svg, .pdf or .png")
    date = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    with replacing(file) as scratch, style():
        figure.savefig(scratch, format=kind, dpi=200, metadata=date)


def save_study(study: Document, folder: Path) -> None:
    """A figure of each output that any point has, as SVG. Raises FileError."""
    for output in study["outputs"] if study["parameters"] else []:
        name = output["id"]
        if any(p.get(name) is not None for q in study["points"] for p in q["pairs"].values()):
            save(plot.curves(study, name), folder / f"{name}.svg")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.plot", description=__doc__)
    parser.add_argument("file", type=Path, help="result file (JSON)")
    parser.add_argument("figure", type=Path, help="file, or of a study a folder")
    options = parser.parse_args()
    try:
        if options.file.suffix == ".toml":
            from .._core import CaseFile

            save(plot.setup(CaseFile(str(options.file))), options.figure)
            return 0
        data = read(options.file)
        if isinstance(data, Document) and data.kind == "study":
            save_study(data, options.figure)
            return 0
        figure = main_figure(data)
        if figure is None:
            print("warning: there is no difference to draw: no figure is made", file=sys.stderr)
            return 4
        save(figure, options.figure)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
