# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending a cilium in this process: the program's own models, compiled."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import _core
from ._core import Cilium, Environment, Load, Shape

Progress = Callable[[str], None]


def bend(
    cilium: Cilium,
    load: Load | Sequence[Load] | None = None,
    model: str = "elastica",
    progress: Progress | None = None,
    environment: Environment | Sequence[Environment] | None = None,
    **options: Any,
) -> Shape | list[Shape]:
    """The cilium bent by a load, by its environment, or by both, by one of the mechanics models.

    load: one, or several that it bears one after the other (a load path): then a list of shapes.
    environment: gravity, fluid and uniform field, the same under all loads, or one for each; without
    a load a list of them is a path of its own.
    model: "elastica" (the paper's), "beam", "solid"; models() names all with their options.
    progress: called with a line of text while a long solution goes on. Ctrl-C ends it.
    options: those of the model, as in a case file, in SI units: refinement=2.

    Raises InputError, SolverError. A load that is too large gives a Shape with the status
    "slipped_off", "pulled_in" or "failed", whose numbers raise SolverError when they are asked for.

    >>> import ciliaval as cv
    >>> base = cv.Segment(length=3e-3, young_modulus=0.1e6)
    >>> tip = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
    >>> shape = cv.bend(cv.Cilium(3e-3, [base, tip]), cv.Load("contact", force=1e-3, height=13e-3))
    >>> shape.dB([-1e-4, 2e-4, -1.55e-3])  # at a sensor, T  # doctest: +SKIP
    """
    is_one = load is None or isinstance(load, Load)
    path = [] if load is None else [load] if is_one else load
    if environment is not None or load is None:
        is_same = environment is None or isinstance(environment, Environment)
        around = [] if environment is None else [environment] if is_same else environment
        is_one = is_one and is_same
        path = _core.surrounded(path, around)
    shapes = _core.bend_path(cilium, path, model, progress, **options)
    return shapes[0] if is_one else shapes


class Case:
    """A case file (TOML): cilium, loads, sensors, models.

    Raises InputError with every fault of the file, a line each.
    """

    def __init__(self, file: str | Path):
        self._core = _core.CaseFile(file)
        self.file = Path(file)

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def title(self) -> str:
        return self._core.title

    @property
    def cilium(self) -> Cilium:
        return self._core.cilium

    @property
    def loads(self) -> list[Load]:
        return self._core.loads

    @property
    def sensors(self):
        """Positions of the sensors, (n, 3), m."""
        return self._core.sensors

    @property
    def sensor_names(self) -> list[str]:
        """Their names; numbers from 0 where the case gives none."""
        return self._core.sensor_names

    @property
    def mechanics(self) -> list[str]:
        """The mechanics models that it runs; a list may be assigned."""
        return self._core.mechanics

    @mechanics.setter
    def mechanics(self, models: Sequence[str]) -> None:
        self._core.mechanics = models

    @property
    def fields(self) -> list[str]:
        """The field models; a list may be assigned."""
        return self._core.fields

    @fields.setter
    def fields(self, models: Sequence[str]) -> None:
        self._core.fields = models

    def toml(self) -> str:
        """The case with every value it uses, defaults included, in SI units."""
        return self._core.toml()

    def run(self, progress: Progress | None = None):
        """Runs all models and compares them: the object that load() makes of a result folder.

        Nothing is written: `ciliaval run` makes the folder with VTK files and pages. What one model
        cannot solve is a failed step of that model.
        """
        from .results import from_summary

        return from_summary(self._core.summary(progress))

    def __repr__(self) -> str:
        return f"Case('{self.file}')"
