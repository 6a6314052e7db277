# SPDX-License-Identifier: LGPL-2.1-or-later
"""The source for magpylib, against a stand-in that checks and calls it as magpylib does.

magpylib itself is not among Debian's packages; with it the last tests ask the real one.
"""

import importlib.util
import inspect
import sys
import types
import unittest
from unittest import mock

import numpy as np

import ciliaval as cv
from test_core import contact, paper_cilium

MU_0 = 4e-7 * np.pi


def check(field_func):
    """magpylib's conditions on the function (validate_field_func in its input_checks.py, the same
    from 4.0 to 5.2): the names of its arguments, and its results for an array of whole numbers."""
    names = inspect.getfullargspec(field_func).args[:2]
    if names != ["field", "observers"]:
        raise TypeError(f"the arguments are called {names}")
    for field in ("B", "H"):
        values = field_func(field, np.array([[1, 2, 3], [4, 5, 6]]))
        if values is not None and not (isinstance(values, np.ndarray) and values.shape == (2, 3)):
            raise TypeError(f"{field} is {values!r}")


def stand_in(version):
    class CustomSource:
        def __init__(self, field_func):
            check(field_func)
            self.field_func = field_func

        def get(self, field, observers):
            return self.field_func(field=field, observers=np.atleast_2d(observers))

    module = types.ModuleType("magpylib")
    module.__version__ = version
    module.misc = types.SimpleNamespace(CustomSource=CustomSource)
    return module


def sources(shape, model="volume", **options):
    """The sources of both kinds of versions, with the sizes of their units in SI."""
    from ciliaval import magpylib

    for version, length, flux, strength in [("5.1.0", 1, 1, 1), ("4.5.1", 1e-3, 1e-3, 1e3)]:
        with mock.patch.dict(sys.modules, magpylib=stand_in(version)):
            yield magpylib.source(shape, model, **options), length, flux, strength


class Magpylib(unittest.TestCase):
    def test_gives_the_field_in_the_units_of_the_version(self):
        shape = cv.bend(paper_cilium(), contact(1e-3))
        points = np.array([[0, 0, -2e-3], [1e-3, 2e-3, -4e-3], shape.centreline[-20]])
        B, M = shape.B(points), shape.M(points)
        self.assertEqual([*np.linalg.norm(M[:2], axis=1)], [0, 0])
        self.assertAlmostEqual(np.linalg.norm(M[2]) / 75e3, 1, 6)
        for source, length, flux, strength in sources(shape):
            at = points / length
            for field, expected in [("B", B / flux), ("H", (B / MU_0 - M) / strength)]:
                np.testing.assert_allclose(source.get(field, at), expected, 1e-12, 1e-12 * abs(expected).max())
            np.testing.assert_allclose(source.get("M", at), M / strength, 1e-12)
            np.testing.assert_allclose(source.get("J", at), MU_0 * M / flux, 1e-12)

    def test_has_the_h_of_a_cylinder_inside(self):
        """Oracle: on the axis of a straight magnet H = -M (2 - cos a - cos b)/2, with the angles a and
        b from the axis to the rims."""
        straight = cv.bend(paper_cilium(), contact(0.0))
        z = np.array([4e-3, 8e-3, 15e-3])
        cosines = sum(d / np.hypot(d, 1.5e-3) for d in (z - 3e-3, 20e-3 - z))
        for source, length, _, strength in sources(straight):
            H = source.get("H", np.stack([0 * z, 0 * z, z], 1) / length)
            np.testing.assert_allclose(H[:, 2] * strength, -75e3 * (2 - cosines) / 2, 1e-9)

    def test_takes_every_field_model(self):
        rod = cv.bend(paper_cilium(), contact(1e-3), "beam")
        solid = cv.bend(paper_cilium(), contact(1e-3), "solid", refinement=0)
        at = [0, 0, -2e-3]
        for shape, model, options in [
            (rod, "dipole", {}),
            (rod, "line", {}),
            (rod, "volume", {"slices": "stacked"}),
            (rod, "potential", {"tolerance": 0.05}),
            (solid, "mesh", {}),
        ]:
            with self.subTest(model):
                source, *_ = next(sources(shape, model, **options))
                B = source.get("B", at)
                np.testing.assert_array_equal(B, shape.B(at, model, **options))
                np.testing.assert_allclose(source.get("H", at), B / MU_0, 1e-12)

    @unittest.skipUnless(importlib.util.find_spec("magpylib"), "magpylib is not installed")
    def test_is_a_source_of_magpylib_itself(self):
        from ciliaval import magpylib

        shape = cv.bend(paper_cilium(), contact(1e-3))
        source = magpylib.source(shape)
        np.testing.assert_allclose(source.getB([0, 0, -2e-3]), shape.B([0, 0, -2e-3])[0])


if __name__ == "__main__":
    unittest.main()
