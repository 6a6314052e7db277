# SPDX-License-Identifier: LGPL-2.1-or-later
"""A bent cilium as a source of magpylib (version 4 or 5), beside its own magnets and sensors."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import Shape

VACUUM_PERMEABILITY = 4e-7 * np.pi  # H/m, as in the paper


def source(shape: Shape, model: str = "volume", **options: Any):
    """A magpylib.misc.CustomSource of the bent magnet, in the frame of the cilium.

    B is that of the field model. H is B/mu_0: outside the magnet alone. Units are magpylib's: SI
    from version 5 on; mm, mT and kA/m before. Raises ImportError without magpylib.
    """
    import magpylib

    is_si = int(magpylib.__version__.split(".")[0]) >= 5
    length, flux, strength = (1.0, 1.0, 1.0) if is_si else (1e-3, 1e3, 1e-3)

    def field(quantity: str, observers):
        if quantity not in ("B", "H"):
            return None  # magpylib asks which quantities there are
        B = shape.B(np.asarray(observers, dtype=float) * length, model, **options)
        return B * flux if quantity == "B" else B / VACUUM_PERMEABILITY * strength

    return magpylib.misc.CustomSource(field_func=field)
