# SPDX-License-Identifier: LGPL-2.1-or-later
"""Touches whose force, height or friction are not known. Oracles: the program's own results, SciPy, the binomial
distribution, and figures of a shooting calculation apart from this project."""

import os
import tomllib
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy import optimize, stats

import ciliaval as cv
import unknowns_coverage
from ciliaval.sensing.inversion import Chips
from ciliaval.sensing.response import Pair
from ciliaval.sensing.touch_fit import Touch
from unknowns_coverage import FILE, MODELS, NOISE, case_of

PAIR = Pair.of(MODELS)
TOUCH = {"magnitude": 2e-3, "azimuth": 0.5, "height": 16e-3, "friction": 0.3}
WITH_HEIGHT = ("force", "azimuth", "height")


def read(case, noise=0.0, seed=0, **values):
    """What the sensors read of a touch, (1, s, 3), T."""
    given = {name: value for name, value in (TOUCH | values).items() if value is not None}
    B = Touch(case, PAIR, "force", with_offset=False).at(given).values
    return B[None] + noise * np.random.default_rng(seed).standard_normal((1, *B.shape))


def sense(case, dB, **options):
    return cv.sense(case, dB, **{"noise": NOISE, "models": MODELS, "joints": "case"} | options)


def half(row, name):
    return (row[f"{name}_high"] - row[f"{name}_low"]) / 2


class TouchOfACase(unittest.TestCase):
    def test_has_the_moment_and_displacement_of_a_run(self):
        for touch in ({"at": "axis"}, {"at": "mantle", "radius": "1 mm"}):
            case = case_of(1, **touch)
            step = case.run().summary["steps"][0]["mechanics"]["elastica"]
            model = Touch(case, PAIR, "force", with_offset=False)
            found = dict(zip(model.names, model.at({"magnitude": 4e-3}).quantities))
            for name, key in (("base_moment",) * 2, ("displacement", "touch_displacement"), ("force", "applied_force")):
                self.assertAlmostEqual(found[name] / step[key], 1, delta=1e-12)

    def test_with_corrected_joints_has_the_moment_of_a_horizontal_force(self):
        case = cv.Case(FILE)
        case = cv.Case._of(case._core.corrected("beam")[0])
        model = Touch(case, Pair("beam", "line"), "force", with_offset=False)
        found = dict(zip(model.names, model.at({"magnitude": 3e-3}).quantities))
        self.assertAlmostEqual(found["base_moment"] / (3e-3 * 16e-3), 1, delta=1e-4)

    def test_goes_on_beyond_the_slip_off(self):
        model = Touch(case_of(1), PAIR, "force", with_offset=False)
        at = [model.at(TOUCH | {"magnitude": size}) for size in (4.38e-3, 4.39e-3, 4.40e-3)]
        self.assertEqual(at[0].beyond, 0)
        self.assertGreater(at[2].beyond, at[1].beyond)
        steps = [np.linalg.norm(b.values - a.values) for a, b in zip(at, at[1:])]
        self.assertAlmostEqual(steps[1] / steps[0], 1, delta=0.02)


class Unknowns(unittest.TestCase):
    def test_height_and_force_are_known_together_as_the_shooting_says(self):
        """One sensor: 52 %, 8 mm and F (h - 0.9 mm) to 0.16 % (as a direction of unit length in ln F and ln h); two:
        18 %, 2.7 mm, 0.11 %. The azimuth is not stated: the first pair lies between those of 0 and 30 degrees."""
        one = cv.Case(FILE)
        two = cv.Case.from_objects(one.cilium, one.loads, [one.sensors[0], unknowns_coverage.SECOND], fields=["line"])
        deviations = {}
        for case, azimuth in ((one, 0.0), (one, np.pi / 6), (two, 0.0)):
            row = sense(case, read(case, friction=None, azimuth=azimuth), unknowns=WITH_HEIGHT).iloc[0]
            C = row["covariance"]
            deviations[len(case.sensors), azimuth] = np.sqrt(np.diag(C))
            c = 16e-3 - -2e-3 * C[2, 2] / C[0, 2]  # dF/dh = -F/(h - c)
            arm = 16e-3 - c
            self.assertAlmostEqual(c, 0.9e-3, delta=0.05e-3)
            g = np.array([1 / 2e-3, 0, 1 / arm])
            strong = np.sqrt(g @ C @ g) / np.hypot(1, 16e-3 / arm)
            self.assertAlmostEqual(strong, 0.0016 if case is one else 0.0011, delta=5e-5)
            self.assertEqual(row["status"], "not determined")
            self.assertIn("force and height apart: not determined by th", row["knowledge"])
            self.assertAlmostEqual(row["force"], 2e-3, delta=1e-9)
        self.assertGreater(deviations[1, 0.0][0] / 2e-3, 0.52)
        self.assertLess(deviations[1, np.pi / 6][0] / 2e-3, 0.52)
        self.assertGreater(deviations[1, 0.0][2], 8e-3)
        self.assertLess(deviations[1, np.pi / 6][2], 8e-3)
        self.assertAlmostEqual(deviations[2, 0.0][0] / 2e-3, 0.18, delta=0.005)
        self.assertAlmostEqual(deviations[2, 0.0][2], 2.7e-3, delta=0.05e-3)

    def test_words(self):
        case = cv.Case(FILE)
        row = sense(case, read(case, friction=None), unknowns=WITH_HEIGHT).iloc[0]
        combination, apart = row["knowledge"].split("; ")[-2:]
        self.assertEqual(combination, "force × (height − 0.87 mm) = 30.26 ± 0.14 µN m")
        self.assertEqual(apart, "force and height apart: not determined by this sensor")
        self.assertRegex(row["knowledge"], r"^force < 4.\d mN; azimuth = 28.65 ± 0.27°; height > 8.\d mm; base moment")
        case = case_of(1)
        row = sense(case, read(case), unknowns=("force", "azimuth", "friction")).iloc[0]
        self.assertRegex(row["knowledge"], r"force − 0.406 mN × friction = 1.878\d ± 0.00\d+ mN; force and")

    def test_force_and_azimuth_are_those_of_before(self):
        """With an offset that unloaded readings share, and with a chip that is turned and reads two components."""
        turned = tomllib.loads(cv.Case(FILE).toml())
        turned["sensor"] |= {"axes": ["+y", "-x", "+z"], "rotation": "30 deg", "gain": 1.1, "components": ["x", "y"]}
        for case in (cv.Case(FILE), cv.Case.from_dict(turned)):
            loaded = Chips.of(case).own(read(case, friction=None))
            B = np.concatenate([np.zeros((4, 1, 3)), loaded, 1.5 * loaded])
            B += NOISE * np.random.default_rng(3).standard_normal(B.shape)
            before = sense(case, B, unloaded=slice(0, 4))
            after = sense(case, B, unloaded=slice(0, 4), unknowns=("force", "azimuth"))
            np.testing.assert_allclose(after["force"], before["magnitude"], rtol=1e-6)
            np.testing.assert_allclose(after["azimuth"], before["azimuth"], atol=1e-6)
            np.testing.assert_allclose(after["chi_squared"], before["chi_squared"], atol=1e-4)
            noise = np.sqrt(before["magnitude_interval"] ** 2 - before["model_interval"] ** 2)
            np.testing.assert_allclose((after["force_high"] - after["force_low"]) / 2, noise, rtol=0.02)
            self.assertEqual(after["force_by"].tolist(), ["ellipse"] * 2)

    def test_ends_are_where_chi_squared_rises_by_3_84(self):
        """The least chi squared with the force, or height, held at an end, by scipy.optimize.least_squares."""
        case = case_of(2)
        touch = Touch(case, PAIR, "force", with_offset=False)
        dB = read(case, NOISE, seed=4, magnitude=3e-3)
        row = sense(case, dB, unknowns=WITH_HEIGHT, largest=6e-3).iloc[0]
        for name, end in (("force", "high"), ("height", "low"), ("base_moment", "high"), ("displacement", "low")):
            self.assertEqual(row[f"{name}_by"] in ("profile", "open"), True)
            value = row[f"{name}_{end}"]

            def off(x, name=name, value=value):
                seen = touch.at({"magnitude": x[0] * 1e-3, "azimuth": x[1], "height": x[2] * 1e-2, "friction": 0.3})
                held = 1e5 * (seen.quantities[touch.names.index(name)] / value - 1)
                return np.append(((seen.values - dB[0]) / NOISE).ravel(), held)

            start = [1e3 * row["force"], row["azimuth"], 1e2 * row["height"]]
            if name in ("force", "height"):  # on the valley of F (h - c)
                arm = row["force"] * (row["height"] - 1e-3)
                start = [1e3 * value, start[1], 1e2 * (arm / value + 1e-3)]
                if name == "height":
                    start = [1e3 * arm / (value - 1e-3), start[1], 1e2 * value]
            least = optimize.least_squares(off, start, x_scale=[1, 0.01, 1], method="lm")
            self.assertAlmostEqual(2 * least.cost - row["chi_squared"], 3.84, delta=0.1, msg=name)

    def test_a_deviation_adds_to_the_interval_and_a_range_makes_a_mixture(self):
        case = case_of(1)
        dB = read(case)
        find = lambda **priors: sense(case, dB, unknowns=("force", "azimuth"), priors=priors).iloc[0]  # noqa: E731
        alone, height, friction = find(), find(height="0.1 mm"), find(friction=(0, 0.6))
        by_height = 1.96 * 2e-3 / 15.1e-3 * 0.1e-3  # dF/dh = -F/(h - c)
        self.assertAlmostEqual(half(height, "force") / np.hypot(half(alone, "force"), by_height), 1, delta=0.01)
        # The force at each friction, with the noise, as drawn.
        touch = Touch(case, PAIR, "force", with_offset=False)
        mu = np.linspace(0, 0.6, 13)

        def at(friction):
            def off(x):
                seen = touch.at(TOUCH | {"magnitude": x[0] * 1e-3, "azimuth": x[1], "friction": friction})
                return ((seen.values - dB[0]) / NOISE).ravel()

            found = optimize.least_squares(off, [2.0, 0.5], x_scale=[1, 0.1])
            return found.x[0] * 1e-3, 2 * found.cost

        force, chi_squared = np.array([at(m) for m in mu]).T
        rng = np.random.default_rng(1)
        drawn = rng.uniform(0, 0.6, 200_000)
        weights = np.exp(-np.interp(drawn, mu, chi_squared) / 2)
        values = np.interp(drawn, mu, force) + half(alone, "force") / 1.96 * rng.standard_normal(len(drawn))
        order = np.argsort(values)
        share = np.cumsum(weights[order]) / weights.sum()
        for end, part in (("low", 0.025), ("high", 0.975)):
            expected = values[order][np.searchsorted(share, part)]
            self.assertAlmostEqual(friction[f"force_{end}"], expected, delta=0.02 * half(friction, "force"))

    def test_two_depths_of_one_touch_are_used_together(self):
        case = case_of(1)
        dB = np.concatenate([read(case, magnitude=size) for size in (1e-3, 3e-3)])
        apart = sense(case, dB, unknowns=WITH_HEIGHT)
        both = sense(case, dB, unknowns=WITH_HEIGHT, touches=["a", "a"])
        self.assertEqual(both["height_low"][0], both["height_low"][1])
        self.assertEqual(both["chi_squared"][0], both["chi_squared"][1])
        deviation = lambda frame: [np.sqrt(C[2, 2]) for C in frame["covariance"]]  # noqa: E731
        self.assertLess(max(deviation(both)), min(deviation(apart)))
        self.assertLess(half(both.iloc[0], "displacement"), 0.7 * half(apart.iloc[0], "displacement"))
        self.assertIn("these readings", both["knowledge"][0])
        np.testing.assert_allclose(both["force"], [1e-3, 3e-3], rtol=1e-5)

    def test_says_where_nothing_is_seen_and_where_nothing_fits(self):
        case = case_of(1)
        noise = NOISE * np.random.default_rng(7).standard_normal((1, 1, 3))
        frame = sense(case, np.concatenate([noise, read(case) + [0, 0, 5e-5]]), unknowns=("force", "azimuth"))
        self.assertEqual(frame["status"].tolist(), ["nothing", "misfit"])
        self.assertEqual(frame["force_low"][0], 0)
        self.assertEqual(frame["azimuth_by"][0], "open")

    def test_speed_and_displacement(self):
        flow = cv.Case(FILE.parent / "fig5.toml")
        shape = cv.bend(flow.cilium, flow.loads[2:3])[0]
        row = sense(flow, shape.dB(flow.sensors, "line")[None], unknowns=("speed", "azimuth")).iloc[0]
        self.assertAlmostEqual(row["speed"], 0.3, delta=1e-6)
        self.assertNotIn("base_moment", row)
        loads = [cv.Load("probe", displacement=4e-3, height=16e-3, azimuth=0.5)]
        case = cv.Case.from_objects(cv.Case(FILE).cilium, loads, [cv.Case(FILE).sensors[0]], fields=["line"])
        shape = cv.bend(case.cilium, loads)[0]
        row = sense(case, shape.dB(case.sensors, "line")[None], unknowns="displacement, azimuth").iloc[0]
        self.assertAlmostEqual(row["displacement"], 4e-3, delta=1e-8)
        self.assertAlmostEqual(row["force"], shape.applied_force, delta=1e-8)

    def test_refuses_what_it_cannot_find(self):
        case, plain, flow = case_of(1), cv.Case(FILE), cv.Case(FILE.parent / "fig5.toml")
        dB = np.zeros((2, 3))
        for of, options, what in (
            (case, {"unknowns": ("force", "weight")}, "no `weight`; there are: force, displacement, speed, azimuth"),
            (case, {"unknowns": ()}, "at least one"),
            (case, {"unknowns": ("force", "force")}, "force stands there twice"),
            (case, {"unknowns": ("force", "displacement")}, "force and displacement are one unknown, the size"),
            (case, {"unknowns": ("displacement",)}, "a contact is stated by its force: take that in place of"),
            (flow, {"unknowns": ("speed", "height")}, "a flow has no height"),
            (plain, {"unknowns": ("force", "friction")}, r"no friction: state \[load.touch\] law"),
            (plain, {"unknowns": ("azimuth",)}, "size of the load is no unknown and not the same in all load steps"),
            (case, {"unknowns": ("force",), "priors": {"weight": 1}}, "priors: there is no `weight`"),
            (case, {"unknowns": WITH_HEIGHT, "priors": {"height": 1e-3}}, "height is an unknown: it has no prior"),
            (plain, {"unknowns": ("force",), "priors": {"friction": (0, 1)}}, "priors: the load has no friction"),
            (case, {"unknowns": ("force",), "priors": {"height": -1e-3}}, "positive standard deviation"),
            (case, {"unknowns": ("force",), "priors": {"friction": (0.6, 0)}}, "the ends of a range"),
            (case, {"unknowns": ("force",), "priors": {"friction": (-0.1, 0.6)}}, "cannot have"),
            (case, {"unknowns": ("force",), "touches": [1]}, "1 labels for 2 readings"),
            (case, {"unknowns": ("force",), "models": "solid/mesh"}, "found by a rod"),
            (case, {"touches": [1, 2]}, "belong to `unknowns`"),
        ):  # fmt: skip
            with self.assertRaisesRegex(cv.InputError, what):
                sense(of, dB, **options)

    def test_intervals_hold_the_truth_as_often_as_they_say(self):
        """As tests/python/unknowns_coverage.py has it for 400 touches; at least what the binomial distribution has with
        999 in 1,000."""
        for row, touches in (("friction and height stated", 40), ("height unknown, two sensors", 8)):
            part = unknowns_coverage.coverage(row, touches, seed=2)
            for name in unknowns_coverage.LOOKED_AT:
                self.assertGreaterEqual(part[name], stats.binom.ppf(0.001, touches, 0.95) / touches, (row, name))


if __name__ == "__main__":
    unittest.main()
