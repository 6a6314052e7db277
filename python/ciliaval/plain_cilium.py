# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cilium of a case.toml that a run has written, for pictures: without the compiled models."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Any

import numpy as np

from .errors import FileError


@dataclass(frozen=True)
class PlainSegment:
    """SI units, as ciliaval.Segment; magnetization (3,), A/m."""

    name: str
    length: float
    young_modulus: float
    poisson_ratio: float
    magnetization: tuple[float, ...]


@dataclass(frozen=True)
class PlainCilium:
    """diameter, m, of a circle or a tube, else 0; sides, (2,), m, and orientation, rad, of a rectangle."""

    segments: list[PlainSegment]
    diameter: float
    sides: tuple[float, float] | None
    orientation: float

    @property
    def length(self) -> float:
        return sum(segment.length for segment in self.segments)

    def extent(self, azimuth: float) -> float:
        """Along the direction, which of a rectangle is that of a side, m."""
        if self.sides is None:
            return self.diameter
        return self.sides[0 if abs(np.cos(azimuth - self.orientation)) > 0.5**0.5 else 1]

    @staticmethod
    def of(text: str) -> PlainCilium:
        """From a case with every value it used, as a run writes it: quantities in SI units. Raises
        FileError."""
        try:
            table = tomllib.loads(text)["cilium"]
            section = table.get("section", {})
            is_rectangle = section.get("shape") == "rectangle"
            return PlainCilium(
                [_segment(segment) for segment in table["segment"]],
                0.0 if is_rectangle else as_number(table["diameter"]),
                (as_number(section["width"]), as_number(section["height"])) if is_rectangle else None,
                as_number(section.get("orientation", 0.0)),
            )
        except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise FileError(f"case.toml is not as a run has written it: {error!r}") from None


def _segment(table: dict[str, Any]) -> PlainSegment:
    M = table.get("magnetization", 0.0)
    length, modulus, ratio = (as_number(table[key]) for key in ("length", "young_modulus", "poisson_ratio"))
    along = tuple(as_number(m) for m in M) if isinstance(M, list) else (0.0, 0.0, as_number(M))
    return PlainSegment(str(table.get("name", "")), length, modulus, ratio, along)


def as_number(value: Any) -> float:
    """The number of a quantity as a run writes it: "0.003 m" or 0.49."""
    return float(value.split()[0] if isinstance(value, str) else value)
