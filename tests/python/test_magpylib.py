# SPDX-License-Identifier: LGPL-2.1-or-later
"""The source for magpylib, against a stand-in that calls it as magpylib documents.

magpylib itself is not among Debian's packages; with it the last test asks the real one.
"""

import importlib.util
import sys
import types
import unittest
from unittest import mock

import numpy as np

import ciliaval as cv
from test_core import contact, paper_cilium


def stand_in(version):
    class CustomSource:
        def __init__(self, field_func):
            for quantity in ("B", "H", "M", "J"):
                values = field_func(quantity, np.array([[1.0, 2, 3], [4, 5, 6]]))
                assert values is None or values.shape == (2, 3)
            self.field_func = field_func

    module = types.ModuleType("magpylib")
    module.__version__ = version
    module.misc = types.SimpleNamespace(CustomSource=CustomSource)
    return module


class Magpylib(unittest.TestCase):
    def test_gives_the_field_in_the_units_of_the_version(self):
        from ciliaval import magpylib

        shape = cv.bend(paper_cilium(), contact(1e-3))
        points = np.array([[0, 0, -2e-3], [1e-3, 2e-3, -4e-3]])
        B = shape.B(points)
        for version, length, flux, strength in [("5.1.0", 1, 1, 1), ("4.5.1", 1e3, 1e3, 1e-3)]:
            with mock.patch.dict(sys.modules, magpylib=stand_in(version)):
                source = magpylib.source(shape)
            np.testing.assert_allclose(source.field_func("B", points * length), B * flux, 1e-12)
            H = source.field_func("H", points * length)
            np.testing.assert_allclose(H * 4e-7 * np.pi / strength, B, 1e-12)

    @unittest.skipUnless(importlib.util.find_spec("magpylib"), "magpylib is not installed")
    def test_is_a_source_of_magpylib_itself(self):
        from ciliaval import magpylib

        shape = cv.bend(paper_cilium(), contact(1e-3))
        source = magpylib.source(shape)
        np.testing.assert_allclose(source.getB([0, 0, -2e-3]), shape.B([0, 0, -2e-3])[0])


if __name__ == "__main__":
    unittest.main()
