# SPDX-License-Identifier: LGPL-2.1-or-later
"""A bent cilium as a source of magpylib (version 4 or 5), beside its own magnets and sensors."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import Shape
from .arrays import Array

VACUUM_PERMEABILITY = 4e-7 * np.pi  # H/m, as in the paper


def source(shape: Shape, model: str = "volume", **options: Any) -> Any:
    """A magpylib.misc.CustomSource of the bent magnet, in the frame of the cilium.

    B is that of the field model, M the magnetisation that the model has (Shape.M), J = mu_0 M and
    H = B/mu_0 - M. Units are magpylib's: SI from version 5 on; mm, mT and kA/m before. Raises
    ImportError without magpylib.
    """
    import magpylib

    is_si = int(magpylib.__version__.split(".")[0]) >= 5
    length, flux, strength = (1.0, 1.0, 1.0) if is_si else (1e-3, 1e3, 1e-3)

    # magpylib asks for these names of the arguments.
    def field_func(field: str, observers: npt.ArrayLike) -> Array:
        points = np.asarray(observers, dtype=float) * length
        if field == "B":
            return shape.B(points, model, **options) * flux
        M = shape.M(points, model, **options)
        if field == "H":
            return (shape.B(points, model, **options) / VACUUM_PERMEABILITY - M) * strength
        return M * strength if field == "M" else VACUUM_PERMEABILITY * M * flux

    return magpylib.misc.CustomSource(field_func=field_func)
