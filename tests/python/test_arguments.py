# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments that the compiled functions take, and objects that can be pickled and copied."""

import copy
import pickle
import re
import tempfile
import unittest
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np

import ciliaval as cv
from ciliaval import _core
from test_core import SENSOR, contact, paper_cilium
from test_results import quick

WRONG = [None, True, np.bool_(True), 1j, "one", b"1", [1.0], np.array([1.0]), np.array("1"), object(), int]


def segment(**more):
    return cv.Segment(**{"length": 17e-3, "young_modulus": 3e6, **more})


def magnet(shape, **more):
    sizes = {"ball": {"diameter": 1e-3}, "cylinder": {"diameter": 1e-3, "length": 1e-3}}
    given = {"position": [0, 0, 1], "magnetization": 1e6}
    given |= sizes.get(shape, {"edges": [1e-3, 1e-3, 1e-3]})
    return getattr(cv.Magnet, shape)(**(given | more))


class Numbers(unittest.TestCase):
    def test_of_any_kind_are_taken(self):
        expected = repr(segment(magnetization=3.0, density=3.0, length=3.0))
        for three in (3, Fraction(3), Decimal(3), np.array(3), np.array(3.0), np.array(Fraction(3), object)):
            self.assertEqual(repr(segment(magnetization=three, density=three, length=three)), expected)
        for kind in (np.int64, np.int8, np.uint16, np.float16, np.float32, np.float64, np.longdouble):
            self.assertEqual(repr(segment(magnetization=kind(3), density=kind(3), length=kind(3))), expected)
            self.assertEqual(magnet("ball", magnetization=kind(3)).moment[2], magnet("ball", magnetization=3).moment[2])
            load = cv.Load("contact", force=kind(3), height=kind(3))
            self.assertEqual(load.parameters, {"force": 3.0, "height": 3.0, "azimuth": 0.0})
        shape = cv.bend(paper_cilium(), contact(1e-3), "beam", refinement=np.int64(1), tolerance=np.float32(1e-9))
        self.assertEqual(shape.status, "converged")

    def test_of_any_kind_are_components(self):
        M = cv.Segment(1, 1e6, magnetization=[np.int64(1), Fraction(1, 2), Decimal(3)]).magnetization
        self.assertEqual(M, (1, 0.5, 3))
        shape = cv.bend(paper_cilium(), contact(1e-3))
        B = shape.B(SENSOR)
        for points in (tuple(SENSOR), [SENSOR], np.array([SENSOR], object), [[Fraction(x) for x in SENSOR]]):
            np.testing.assert_array_equal(shape.B(points), B)
        np.testing.assert_allclose(shape.B(SENSOR.astype("f4")), B, rtol=1e-5)
        np.testing.assert_array_equal(shape.B(np.array([0, 0, -1])), shape.B([0.0, 0.0, -1.0]))

    def test_with_units_are_read_as_in_case_files(self):
        load = cv.Load("contact", force="1 mN", height="16 mm", azimuth="180 deg")
        self.assertEqual(load.parameters, {"force": 1e-3, "height": 16e-3, "azimuth": np.pi})
        self.assertEqual(repr(segment(length="17 mm", magnetization="75 kA/m")), repr(segment(magnetization=75e3)))

    def test_of_words_are_those_of_case_files(self):
        load = cv.Load("probe", displacement=1e-3, height=16e-3, slip_off="rim")
        self.assertEqual(load.parameters["slip_off"], "rim")
        self.assertEqual(cv.Load(load.type, **load.parameters).parameters, load.parameters)
        self.assertNotIn("slip_off", load.changed(slip_off="axis").parameters)
        with self.assertRaisesRegex(cv.InputError, "slip_off.*rin"):
            cv.Load("contact", force=1e-3, height=16e-3, slip_off="rin")
        with self.assertRaisesRegex(cv.InputError, "has no `slip_off`"):
            cv.Load("flow", force_per_height=1e-3, slip_off="rim")
        around = cv.Environment(gravity=["0 m/s2", 0, "-9.81 m/s2"], uniform_field=["5 mT", 0, 0])
        self.assertEqual(around, cv.Environment(gravity=[0, 0, -9.81], uniform_field=[5e-3, 0, 0]))
        shape = cv.bend(paper_cilium(), contact(1e-3))
        np.testing.assert_array_equal(shape.B(["0 mm", "0 m", "-2 mm"]), shape.B([0, 0, -2e-3]))
        for wrong, text in [("1 mm", "`force`.*force"), ("1", "`force`.*unit"), ("much", "`force`.*number")]:
            with self.assertRaisesRegex(cv.InputError, text):
                cv.Load("contact", force=wrong, height=1)
        with self.assertRaisesRegex(cv.InputError, "`poisson_ratio` is a plain number"):
            segment(poisson_ratio="0.49")


class WrongTypes(unittest.TestCase):
    """Each argument of each function refuses what it cannot take by an InputError with its name."""

    def refuses(self, name, call, values):
        for value in values:
            with self.subTest(name, value=value):
                with self.assertRaisesRegex(cv.InputError, f"`{re.escape(name)}") as caught:
                    call(value)
                self.assertNotRegex(str(caught.exception), "::|C\\+\\+|pybind")

    def test_are_refused_as_numbers(self):
        base = [segment()]
        cilium = paper_cilium()
        for name, call in [
            *[(k, lambda v, k=k: segment(**{k: v})) for k in ("length", "young_modulus", "poisson_ratio", "density")],
            *[
                (k, lambda v, k=k: setattr(segment(), k, v))
                for k in ("length", "young_modulus", "poisson_ratio", "density")
            ],
            ("diameter", lambda v: cv.Cilium(v, base)),
            ("width", lambda v: cv.Cilium.rectangle(v, 1e-3, base)),
            ("height", lambda v: cv.Cilium.rectangle(1e-3, v, base)),
            ("orientation", lambda v: cv.Cilium.rectangle(1e-3, 1e-3, base, v)),
            ("diameter", lambda v: cv.Cilium.tube(v, 1e-3, base)),
            ("inner_diameter", lambda v: cv.Cilium.tube(2e-3, v, base)),
            ("azimuth", cilium.extent),
            ("diameter", lambda v: magnet("ball", diameter=v)),
            ("diameter", lambda v: magnet("cylinder", diameter=v)),
            ("length", lambda v: magnet("cylinder", length=v)),
            ("fluid_density", lambda v: cv.Environment(fluid_density=v)),
            *[
                (k, lambda v, k=k: cv.Load("contact", **({"force": 1, "height": 1} | {k: v})))
                for k in ("force", "height", "azimuth")
            ],
        ]:
            self.refuses(name, call, WRONG)

    def test_are_refused_as_vectors_and_points(self):
        shape = cv.bend(paper_cilium(), contact(1e-3))
        vectors = [None, "x", [1, 2], [1, 2, 3, 4], [[1, 2, 3], [1, 2, 3]], [1, 2, None], [True, 1, 2], object()]
        vectors += [np.zeros(3, complex), np.zeros(3, bool), {1, 2, 3}, [[1], [2, 3]]]
        for name, call in [
            ("magnetization", lambda v: segment(magnetization=v)),
            ("magnetization", lambda v: setattr(segment(), "magnetization", v)),
            ("gravity", lambda v: cv.Environment(gravity=v)),
            ("uniform_field", lambda v: cv.Environment(uniform_field=v)),
            ("edges", lambda v: magnet("cuboid", edges=v)),
            *[
                (k, lambda v, k=k, s=s: magnet(s, **{k: v}))
                for s in ("ball", "cylinder", "cuboid")
                for k in ("position", "axis", "magnetization")
            ],
        ]:
            self.refuses(name, call, vectors)
        points = [None, 1.0, "x", [1, 2], [[1, 2]], np.zeros((2, 2, 3)), [1, 2, None], np.zeros(3, complex), object()]
        for call in (shape.B, shape.dB, shape.M, shape.field, magnet("ball").B):
            self.refuses("points", call, points)
        self.refuses("points", lambda v: cv.bend_batch([], [], v), points[1:])

    def test_are_refused_as_texts(self):
        cilium, load = paper_cilium(), contact(1e-3)
        shape = cv.bend(cilium, load)
        for name, call in [
            ("type", cv.Load),
            ("name", lambda v: segment(name=v)),
            ("name", lambda v: setattr(segment(), "name", v)),
            ("name", lambda v: magnet("ball", name=v)),
            ("magnetic_energy", lambda v: cv.Environment(magnetic_energy=v)),
            ("model", lambda v: cv.bend(cilium, load, v)),
            ("model", lambda v: shape.B(SENSOR, v)),
            ("model", lambda v: shape.dB(SENSOR, v)),
            ("model", lambda v: shape.M(SENSOR, v)),
            ("model", lambda v: shape.field(SENSOR, v)),
            ("model", lambda v: cv.bend_batch([cilium], [load], model=v)),
            ("field", lambda v: cv.bend_batch([cilium], [load], field=v)),
        ]:
            self.refuses(name, call, [None, 1, b"x", ["x"]])
        for call in (cv.Case, _core.StudyFile):
            self.refuses("file", call, [None, 1, b"x", ["x"]])

    def test_are_refused_as_objects(self):
        cilium, load = paper_cilium(), contact(1e-3)
        some = [1, "x", [1], [None], {"x": 1}]
        for name, call in [
            ("segments", lambda v: cv.Cilium(1, v)),
            ("segments", lambda v: cv.Cilium.rectangle(1, 1, v)),
            ("segments", lambda v: cv.Cilium.tube(2, 1, v)),
            ("magnets", lambda v: cv.Environment(magnets=v)),
            ("cilium", lambda v: cv.bend(v, load)),
            ("load", lambda v: cv.bend(cilium, v)),
            ("environment", lambda v: cv.bend(cilium, load, environment=v)),
            ("progress", lambda v: cv.bend(cilium, load, progress=v)),
            ("cilia", lambda v: cv.bend_batch(v, [load])),
            ("loads", lambda v: cv.bend_batch([cilium], v)),
        ]:
            self.refuses(name, call, some)
        self.refuses("segments", lambda v: cv.Cilium(1, v), [segment(), None])
        with self.assertRaisesRegex(cv.InputError, "`segments.1.` is a Segment, not None"):
            cv.Cilium(1, [segment(), None])
        with self.assertRaisesRegex(cv.InputError, "`force` of a load is one force.*make a Load of each"):
            cv.Load("contact", force=[1e-3, 2e-3], height=1)

    def test_are_refused_in_a_case(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "case.toml")
            file.write_text(quick("fig3b"))
            case = cv.Case(str(file))
        self.refuses("mechanics", lambda v: setattr(case, "mechanics", v), [1, "beam", [1], None])
        self.refuses("fields", lambda v: setattr(case, "fields", v), [1, "line", [1], None])
        self.refuses("progress", case.run, [1, "x"])

    def test_are_refused_as_options(self):
        cilium, load = paper_cilium(), contact(1e-3)
        for option, model, values in [
            ("refinement", "beam", [True, 1.5, -1, 1j, "1", None, [1]]),
            ("tolerance", "beam", [True, None, [1], 1j]),
            ("shear_rigid", "beam", [1, "yes", None]),
            ("joints", "beam", [1, None, True, b"none"]),
            ("mesh", "solid", [1, ["a.msh"]]),
            ("tolerance", "solid", ["1 mm", "x", True]),
        ]:
            self.refuses(option, lambda v, o=option, m=model: cv.bend(cilium, load, m, **{o: v}), values)


class Equality(unittest.TestCase):
    def test_with_another_thing_is_false(self):
        for value in (cv.Environment(), magnet("ball")):
            self.assertFalse(value == 3)
            self.assertTrue(value != "x")


class NoPoints(unittest.TestCase):
    def test_have_no_field(self):
        shape = cv.bend(paper_cilium(), contact(1e-3), "beam")
        for points in (np.empty((0, 3)), [], np.empty(0)):
            for model in ("dipole", "line", "volume", "potential"):
                self.assertEqual(shape.B(points, model).shape, (0, 3))
            self.assertEqual(shape.field(points)["dB_uncertainty"].shape, (0, 3))
            self.assertEqual(shape.M(points).shape, (0, 3))
            self.assertEqual(magnet("ball").B(points).shape, (0, 3))
            self.assertEqual(cv.bend_batch([paper_cilium()] * 2, [contact(1e-3)] * 2, points)["B"].shape, (2, 0, 3))


class Magnetization(unittest.TestCase):
    def test_is_that_of_the_bent_magnet(self):
        """Oracle: ∇·B = 0 and ∇×H = 0 by central differences, inside; H is continuous along the mantle."""
        shape = cv.bend(paper_cilium(), contact(4e-3), "beam")
        tip = shape.centreline[-40]
        h = 1e-6
        offsets = np.concatenate([h * np.eye(3), -h * np.eye(3)])
        B = shape.B(tip + offsets)
        M = shape.M(tip + offsets)
        self.assertTrue((np.linalg.norm(M, axis=1) > 7e4).all())
        gradient = lambda f: ((f[:3] - f[3:]) / (2 * h)).T  # noqa: E731
        dB, dH = gradient(B), gradient(B / (4e-7 * np.pi) - M)
        self.assertLess(abs(np.trace(dB)), 1e-5 * abs(dB).max())
        self.assertLess(abs(dH - dH.T).max(), 1e-4 * abs(dH).max())
        outside = [tip[0], 1e-2, tip[2]]
        np.testing.assert_array_equal(shape.M([outside]), [[0, 0, 0]])
        for model in ("dipole", "line"):
            np.testing.assert_array_equal(shape.M([tip, outside], model), np.zeros((2, 3)))
        np.testing.assert_array_equal(shape.M(outside, "potential"), [[0, 0, 0]])
        with self.assertRaisesRegex(cv.InputError, "in air alone"):
            shape.M(tip, "potential")
        with self.assertRaisesRegex(cv.InputError, "stacked"):
            shape.M(tip, slices="stacked")

    def test_of_the_solid_is_near_that_of_the_rod(self):
        solid = cv.bend(paper_cilium(), contact(1e-3), "solid", refinement=0)
        middle = solid.centreline[len(solid.S) // 2]
        M = solid.M([middle, [0, 0, -1]], "mesh")
        np.testing.assert_allclose(M[0], solid.M(middle)[0], rtol=0.02, atol=500)
        np.testing.assert_array_equal(M[1], [0, 0, 0])


class Copies(unittest.TestCase):
    """By pickle and by copy.deepcopy."""

    def copies(self, value):
        return [pickle.loads(pickle.dumps(value, protocol)) for protocol in (2, 5)] + [copy.deepcopy(value)]

    def test_of_the_statement_of_a_problem_are_equal(self):
        near = magnet("cuboid", axis=[1, 2, 3], magnetization=[1e5, 2e5, 3e5], name="near")
        around = cv.Environment([0, 0, -9.81], 1000.0, [1e-3, 2e-3, 3e-3], "R", [near, magnet("cylinder")])
        across = cv.Segment(1e-3, 1e6, 0.3, [1e3, 2e3, 3e3], "across", 1100.0)
        cilia = [paper_cilium(), cv.Cilium.rectangle(2e-3, 1e-3, [across], 0.3), cv.Cilium.tube(2e-3, 1e-3, [across])]
        bent = cv.bend(cv.Cilium(1e-3, [segment(density=1e3)]), environment=cv.Environment([0.1, 0, 0]))
        for value in (across, near, around, *cilia, contact(1e-3), bent.load):
            for other in self.copies(value):
                self.assertIs(type(other), type(value))
                self.assertEqual(repr(other), repr(value))
        for other in self.copies(around):
            self.assertEqual(other, around)
        for other in self.copies(bent.load):
            self.assertEqual(other.environment, bent.load.environment)

    def assert_equal_shapes(self, other, shape, models):
        for name in ("status", "message", "model", "tip_uncertainty", "tip_angle_uncertainty", "applied_force",
                     "slip_off", "unstable_modes", "seconds"):  # fmt: skip
            self.assertEqual(getattr(other, name), getattr(shape, name), name)
        for name in ("S", "centreline", "theta", "curvature"):
            np.testing.assert_array_equal(getattr(other, name), getattr(shape, name))
        for model in models:
            here, there = shape.field([SENSOR, 2 * SENSOR], model), other.field([SENSOR, 2 * SENSOR], model)
            for name in ("B", "dB", "B_uncertainty", "dB_uncertainty"):
                np.testing.assert_array_equal(there[name], here[name])

    def test_of_shapes_give_equal_results(self):
        for model, options, fields in [
            ("elastica", {"joints": "corrected"}, ["dipole", "line", "volume"]),
            ("beam", {}, ["volume"]),
            ("solid", {"refinement": 0}, ["volume", "mesh"]),
        ]:
            shape = cv.bend(paper_cilium(), contact(1e-3), model, **options)
            for other in self.copies(shape):
                self.assert_equal_shapes(other, shape, fields)
        lost = cv.bend(paper_cilium(), contact(1.0))
        for other in self.copies(lost):
            self.assertEqual((other.status, other.slip_off), (lost.status, lost.slip_off))

    def test_of_cases_give_equal_results(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "case.toml")
            file.write_text(quick("fig3b"))
            case = cv.Case(file)
            case.fields = ["line"]
        result = case.run()
        for other in self.copies(case):
            self.assertEqual((other.name, other.file, other.toml()), (case.name, file, case.toml()))
            there = other.run()
            np.testing.assert_array_equal(there.tip("beam"), result.tip("beam"))
            np.testing.assert_array_equal(there.dB("beam/line"), result.dB("beam/line"))

    def test_of_another_build_are_refused(self):
        made_by, state = segment().__getstate__()
        with self.assertRaisesRegex(cv.InputError, "pickled by ciliaval 0.0.1"):
            cv.Segment.__new__(cv.Segment).__setstate__(("ciliaval 0.0.1", state))
        with self.assertRaisesRegex(cv.InputError, "damaged"):
            cv.Segment.__new__(cv.Segment).__setstate__((made_by, state[:10]))


if __name__ == "__main__":
    unittest.main()
