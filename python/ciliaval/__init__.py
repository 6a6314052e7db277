# SPDX-License-Identifier: LGPL-2.1-or-later
"""CiliaVal: models of magnetic-cilium tactile sensors, and their cross-validation.

SI units throughout: m, N, Pa, A/m, T, rad. docs/guide/python.md.
"""

import importlib
from typing import Any

from .errors import Error, FileError, InputError, SolverError

# Name -> the module that has it. They are imported when they are first asked for: the compiled
# models load deal.II, which what only reads results need not wait for.
_HOMES = {
    **dict.fromkeys(
        ["Cilium", "Environment", "Load", "Magnet", "Segment", "Shape", "bend_batch", "load_types", "models", "__version__"],
        "._core",
    ),
    **dict.fromkeys(["Case", "bend"], ".model"),
    **dict.fromkeys(["budget", "converge", "run", "study"], ".program"),
    "sense": ".sensing",
    **dict.fromkeys(["load", "load_study"], ".results"),
}

__all__ = ["Error", "FileError", "InputError", "SolverError", *sorted(_HOMES)]


_MODULES = ["magpylib", "paper", "plot", "program", "report", "results", "sensing"]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module("." + name, __name__)
    if name not in _HOMES:
        raise AttributeError(f"module 'ciliaval' has no attribute '{name}'")
    value = getattr(importlib.import_module(_HOMES[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES, *_MODULES])
