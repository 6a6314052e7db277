# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures, as matplotlib's: plot.signal(cv.load("results/fig3b")).savefig("a.pdf").

Of a case (cv.load, Case.run): setup, shapes, signal, sweep, pairs, validation; animate writes a file of
its load path. Of other result files (cv.program.read): curves, tornado, optimum_slices of a study;
budget; convergence; bench, readings, levels of `sense`. A notebook shows a figure by itself.
`python3 -m ciliaval.plot FILE.json OUT.pdf` draws the main figure of a file.

Lengths are shown in mm, forces in mN, flux densities in µT. A model has the same colour and mark in
every figure; the more detailed ones come first in a legend.
"""

from .case import pairs, shapes, signal, sweep
from .evidence import bench, budget, convergence, levels, readings
from .film import animate
from .sketch import setup
from .study import curves, optimum_slices, tornado
from .style import look
from .validation import validation

__all__ = [
    "animate",
    "bench",
    "budget",
    "convergence",
    "curves",
    "levels",
    "look",
    "optimum_slices",
    "pairs",
    "readings",
    "setup",
    "shapes",
    "signal",
    "sweep",
    "tornado",
    "validation",
]
