# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers for people: mm, mN, µT. Everything else of the package is in SI units."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from .files import declared


class Unit(NamedTuple):
    """A unit that is shown: value / size is the number before `name`."""

    name: str
    size: float


_SHOWN = {
    "T": Unit("µT", 1e-6),
    "N": Unit("mN", 1e-3),
    "m": Unit("mm", 1e-3),
    "rad": Unit("°", math.pi / 180),
    "T/N": Unit("µT/mN", 1e-3),
    "T/(N/m)": Unit("µT/(N/m)", 1e-6),
    "T/m": Unit("µT/mm", 1e-3),
    "Pa": Unit("MPa", 1e6),
    "A/m": Unit("kA/m", 1e3),
    "N/m": Unit("N/m", 1.0),
    "N m": Unit("µN m", 1e-6),
    "J": Unit("µJ", 1e-6),
}

NOT_KNOWN = "–"


def shown(si: str | None) -> Unit:
    """The unit in which a quantity of this SI unit is shown."""
    return _SHOWN.get(si or "", Unit(si or "", 1.0))


def number(value: Any, unit: float = 1.0, digits: int = 4) -> str:
    """value / unit with so many significant digits; a dash for None and what is not finite."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return NOT_KNOWN
    text = f"{value / unit + 0.0:.{digits}g}"
    if "e" in text and 1e-4 < abs(value / unit) < 1e7:  # 1.2e+03
        text = f"{float(text):.0f}"
    return text.replace("-", "−", 1) if text.startswith("-") else text


def quantity(value: Any, si: str, digits: int = 4) -> str:
    """ "83.2 µT" for 83.2e-6, "T"."""
    unit = shown(si)
    space = "" if unit.name == "°" else " "
    return f"{number(value, unit.size, digits)}{space}{unit.name}".rstrip()


def percent(fraction: Any, digits: int = 3) -> str:
    """ "10.3 %" for 0.103."""
    return f"{number(fraction, 0.01, digits)} %"


def in_words(names: Iterable[str]) -> str:
    """ "a, b and c"."""
    *first, last = list(names) or [""]
    return f"{', '.join(first)} and {last}" if first else last


def describe_touch(touch: dict[str, Any]) -> str:
    """ "friction 0.3 on the mantle, pin of radius 1 mm"."""
    law = "horizontal force" if touch["law"] == "horizontal" else f"friction {number(touch['friction'])}"
    return f"{law} on the {touch['at']}, pin of radius {quantity(touch['radius'], 'm')}"


def describe_load(load: dict[str, Any], environment: dict[str, Any] | None = None) -> str:
    """ "contact: force 4 mN, height 16 mm, azimuth 30°": a step's load in summary.json, and what is
    around it."""
    parameters = declared()["loads"].get(load["type"], {})
    parts = []
    for name, value in load.items():
        if value is None or isinstance(value, str):  # its type, a setting
            continue
        if name == "touch":
            parts.append(describe_touch(value))
            continue
        if name == "scale":  # of the environment, which is said below
            parts += [f"{number(value)} times"] if value != 1 else []
            continue
        si = parameters[name].rsplit(", ", 1)[-1] if name in parameters else ""
        if name == "velocity":
            si = "m/s"
        parts.append(f"{name.replace('_', ' ')} {quantity(value, si)}")
    for name, unit, size in (("gravity", "m/s²", 1.0), ("uniform_field", "mT", 1e-3)):
        vector = (environment or {}).get(name, [])
        if any(vector):
            components = ", ".join(number(value, size) for value in vector)
            parts.append(f"{name.replace('_', ' ')} ({components}) {unit}")
    return f"{load['type']}: {', '.join(parts)}"
