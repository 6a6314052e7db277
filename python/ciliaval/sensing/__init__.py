# SPDX-License-Identifier: LGPL-2.1-or-later
"""From what sensors read to loads and surfaces, and what a logger makes of a field.

docs/guide/sensing.md, docs/theory/signal.md.
"""

import importlib
from typing import Any

# Name -> the module that has it, imported when it is first asked for: a command waits for what it needs alone.
_HOMES = {
    **dict.fromkeys(["Calibration", "calibrate"], "calibration"),
    **dict.fromkeys(["Bench", "read_bench", "run_bench"], "bench"),
    **dict.fromkeys(["Chips", "LinearFit", "SensedLoads", "invert"], "inversion"),
    **dict.fromkeys(["LevelCurve", "sense_surface"], "levels"),
    **dict.fromkeys(["ReadingOptions", "Readings", "read_readings"], "readings"),
    **dict.fromkeys(["Pair", "Response", "Shapes", "shapes_within"], "response"),
    **dict.fromkeys(["Sensing", "readings_of_arrays", "sense", "sense_readings"], "loads"),
    **dict.fromkeys(["Record", "record"], "signal"),
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ciliaval.sensing' has no attribute {name!r}")
    value = getattr(importlib.import_module("." + _HOMES[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
