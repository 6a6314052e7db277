# SPDX-License-Identifier: LGPL-2.1-or-later
"""The annotation of an array of NumPy's."""

from typing import Any

import numpy.typing as npt

Array = npt.NDArray[Any]
