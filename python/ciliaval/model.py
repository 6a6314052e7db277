# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending a cilium in this process: the program's own models, compiled."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np

from . import _core
from ._core import Cilium, Environment, Load, Shape
from .arrays import Array
from .errors import InputError
from .results import Result, from_run

Progress = Callable[[str], None]


@overload
def bend(
    cilium: Cilium,
    load: Load | None = None,
    model: str = "elastica",
    progress: Progress | None = None,
    environment: Environment | None = None,
    **options: Any,
) -> Shape: ...
@overload
def bend(
    cilium: Cilium,
    load: Sequence[Load],
    model: str = "elastica",
    progress: Progress | None = None,
    environment: Environment | Sequence[Environment] | None = None,
    **options: Any,
) -> list[Shape]: ...
@overload
def bend(
    cilium: Cilium,
    load: Load | None = None,
    model: str = "elastica",
    progress: Progress | None = None,
    *,
    environment: Sequence[Environment],
    **options: Any,
) -> list[Shape]: ...
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
    path: Sequence[Load] = [] if load is None else [load] if isinstance(load, Load) else load
    if environment is not None or load is None:
        around = [] if environment is None else [environment] if isinstance(environment, Environment) else environment
        is_one = is_one and around is not environment
        path = _core.surrounded(path, around)
    shapes = _core.bend_path(cilium, path, model, progress, **options)
    return shapes[0] if is_one else shapes


class Case:
    """A case file (TOML): cilium, loads, sensors, models. from_text() and from_dict() make one
    without a file.

    Raises InputError with every fault of the file, a line each.
    """

    def __init__(self, file: str | Path):
        self._core = _core.CaseFile(file)
        self.file: Path | None = Path(file)

    @classmethod
    def _of(cls, core: Any, file: Path | None = None) -> Case:
        case = cls.__new__(cls)
        case._core, case.file = core, file
        return case

    @classmethod
    def from_text(cls, toml: str, name: str = "the text") -> Case:
        """The case that a file with this text would be; messages call it `name`; files that it
        names lie beside that, or else in the working folder. Raises InputError."""
        return cls._of(_core.CaseFile.from_text(toml, name))

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], name: str = "the dictionary") -> Case:
        """The case that a file with these tables would be, as `tomllib.load` gives them: quantities
        with their units. Raises InputError.

        >>> import ciliaval as cv
        >>> case = cv.Case.from_dict({
        ...     "case": {"name": "soft"},
        ...     "cilium": {"diameter": "3 mm", "segment": [
        ...         {"name": "base", "length": "3 mm", "young_modulus": "0.1 MPa", "poisson_ratio": 0.49},
        ...         {"name": "magnet", "length": "17 mm", "young_modulus": "3 MPa", "poisson_ratio": 0.49,
        ...          "magnetization": "75 kA/m"}]},
        ...     "load": {"type": "contact", "force": "1 mN", "height": "16 mm"},
        ...     "models": {"mechanics": ["elastica"]}})
        >>> case.name
        'soft'
        """
        return cls.from_text(toml_of(tables), name)

    @classmethod
    def from_objects(
        cls,
        cilium: Cilium,
        loads: Load | Sequence[Load],
        sensors: Any = (),
        mechanics: Sequence[str] = ("elastica", "beam"),
        fields: Sequence[str] = (),
        name: str = "objects",
        title: str = "A case of objects",
    ) -> Case:
        """The case of a cilium, a load or a load path, and sensors, (n, 3) m, with the models to run;
        without a list of `fields` volume where there is a sensor. Raises InputError with every fault.

        >>> import ciliaval as cv
        >>> rod = cv.Cilium(3e-3, [cv.Segment(20e-3, 1e6, magnetization=75e3, name="rod")])
        >>> case = cv.Case.from_objects(rod, cv.Load("contact", force=1e-3, height=16e-3), [0, 0, -2e-3])
        >>> case.run().pairs
        ['elastica/volume', 'beam/volume']
        """
        path = [loads] if isinstance(loads, Load) else list(loads)
        used = list(fields) or (["volume"] if np.size(sensors) else [])
        return cls._of(_core.CaseFile.of_objects(cilium, path, sensors, list(mechanics), used, name, title))

    def changed(self, values: Mapping[str, Any]) -> Case:
        """This case with other numbers, by the paths that studies have for them
        (docs/guide/studies.md), in SI units or with a unit: changed({"load.height": "15 mm"}).

        Raises InputError for a path that the case does not have, or a number out of its range.
        """
        return self._of(self._core.changed(dict(values)), self.file)

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
    def sensors(self) -> Array:
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
    def mechanics(self, models: list[str]) -> None:
        self._core.mechanics = models

    @property
    def fields(self) -> list[str]:
        """The field models; a list may be assigned."""
        return self._core.fields

    @fields.setter
    def fields(self, models: list[str]) -> None:
        self._core.fields = models

    def toml(self) -> str:
        """The case with every value it uses, defaults included, in SI units."""
        return self._core.toml()

    def run(self, progress: Progress | None = None) -> Result:
        """Runs all models and compares them: the object that load() makes of a result folder.

        Nothing is written: `ciliaval run` makes the folder with VTK files and pages. What one model
        cannot solve is a failed step of that model.
        """
        return from_run(self._core.run(progress))

    def __repr__(self) -> str:
        return f"Case('{self.file or self.name}')"


def toml_of(tables: Mapping[str, Any]) -> str:
    """The text of a TOML file with these tables: what tomllib.loads reads as them. Raises InputError for
    a value that such a file cannot state."""
    return "".join(f"{_quoted(key)} = {_toml(value, key)}\n" for key, value in tables.items())


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _toml(value: Any, key: str) -> str:
    """A value on one line of TOML, tables inline."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_quoted(k)} = {_toml(v, k)}" for k, v in value.items()) + "}"
    if isinstance(value, (str, Path)):
        return _quoted(str(value))
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Sequence):
        return "[" + ", ".join(_toml(v, key) for v in value) + "]"
    if hasattr(value, "tolist"):  # of NumPy
        return _toml(value.tolist(), key)
    try:
        return repr(float(value))
    except (TypeError, ValueError) as error:
        raise InputError(f"`{key}` is a {type(value).__name__}, which no case file can state") from error
