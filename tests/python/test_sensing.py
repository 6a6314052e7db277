# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads from readings. Oracles: the models themselves, SciPy, the binomial and the noncentral chi squared
distribution, the C++ of before (frozen)."""

import json
import math
import os
import tempfile
import unittest
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy import optimize, stats

import ciliaval as cv
import interval_coverage
from ciliaval import sensing
from ciliaval.sensing.inversion import Chips, LinearFit, wrapped
from ciliaval.sensing.loads import sense_readings
from ciliaval.sensing.response import shapes_up_to
from sensing_cases import CASE, NOISE, PAIR, SENSOR, noise_interval, paper_response, polar

SOURCE = Path(__file__).resolve().parents[2]


class Response(unittest.TestCase):
    def test_is_that_of_the_models(self):
        """Loads that are no nodes, with their own azimuths; a sensor near, one far off, one on the axis."""
        case = cv.Case.from_text(CASE)
        sensors = [SENSOR, [4e-3, -3e-3, 1e-3], [0, 0, -3e-3]]
        for mechanics, field in (("elastica", "volume"), ("beam", "line")):
            response = paper_response(4e-3, sensors, mechanics, field)
            self.assertLess(response.interpolation_error, 1e-7 * response.largest_change)
            for size, azimuth in ((3.3e-3, 0.4), (0.7e-3, -2.5), (4e-3, 1.9), (1e-5, 3.1)):
                load = cv.Load("contact", force=size, height=16e-3, azimuth=azimuth)
                direct = cv.bend(case.cilium, load, mechanics, joints="corrected").dB(sensors, field)
                found = response.change(polar(size, azimuth))[0]
                self.assertLess(np.abs(found - direct).max(), 1e-8 * response.largest_change)
            self.assertEqual(np.abs(response.change([0, 0])).max(), 0)

    def test_its_derivative_is_that_of_the_change(self):
        """Central differences; at zero load too, and beyond the range along the load."""
        response = paper_response(3e-3, [SENSOR, [3e-3, 1e-3, -2e-3]], "elastica", "line")
        h = 1e-7
        for p in (polar(2e-3, 0.4), polar(0.1e-3, -2.5), polar(0, 0), polar(1.5e-3, 0.2), polar(2.9e-3, 1.6)):
            derivative = response.derivative(p)[0]
            for axis in (0, 1):
                step = h * np.eye(2)[axis]
                difference = (response.change(p + step) - response.change(p - step))[0] / (2 * h)
                self.assertLess(
                    np.linalg.norm(difference - derivative[..., axis]), 1e-6 * np.linalg.norm(derivative)
                )
        e = polar(1, 0.7)
        beyond = (response.change(3.6e-3 * e) - response.change(3.4e-3 * e))[0] / 2e-4
        along = response.derivative(3e-3 * e)[0] @ e
        self.assertLess(np.linalg.norm(beyond - along), 1e-9 * np.linalg.norm(beyond))

    def test_ranges_end_at_the_slip_off(self):
        """The slip-off that the elastica itself states for one load."""
        case = cv.Case.from_text(CASE)
        shape = cv.bend(case.cilium, cv.Load("contact", force=1.0, height=16e-3), joints="corrected")
        limit = shape.slip_off
        for asked in (1.01 * limit, 7e-3, 1e3):
            shapes = sensing.shapes_within(case, "elastica", asked)
            self.assertLess(shapes.largest, limit)
            self.assertGreater(shapes.largest, 0.9999 * (limit - shape.slip_off_uncertainty))
            self.assertIn("slips off", shapes.limit)
            self.assertLess(sensing.Response(case, "volume", shapes, [SENSOR]).interpolation_error, 1e-9)
        self.assertEqual(sensing.shapes_within(case, "elastica", 0.9 * limit).limit, "")

    def test_refuses_what_it_cannot_serve(self):
        case = cv.Case.from_text(CASE)
        with self.assertRaisesRegex(cv.SolverError, r"within the range of loads up to 0.007 N"):
            shapes_up_to(case, "elastica", 7e-3)
        for largest in (0, math.nan, math.inf):
            with self.assertRaisesRegex(cv.InputError, "finite and positive"):
                shapes_up_to(case, "elastica", largest)
        sideways = '[environment]\nuniform_field = ["1 mT", "0 T", "0 T"]\n'
        for text, what in (
            (CASE + sideways, "points along z"),
            (CASE.replace('magnetization = "75 kA/m"', 'magnetization = ["1 kA/m", "0 A/m", "75 kA/m"]'), "round"),
            (CASE.replace('diameter = "3 mm"', 'section = { shape = "rectangle", width = "3 mm", height = "2 mm" }').replace("30 deg", "0 deg").replace('"corrected"', '"none"'), "round"),
        ):
            odd = cv.Case.from_text(text)
            with self.assertRaisesRegex(cv.InputError, what):
                shapes_up_to(odd, "elastica", 1e-4)
        self.assertEqual(str(sensing.Pair.of("beam/volume")), "beam/volume")
        for text, what in (
            ("elastica", "written mechanics/field"), ("elastic/volume", "elastic"), ("elastica/mesh", "needs the body"),
        ):  # fmt: skip
            with self.assertRaisesRegex(cv.InputError, what):
                sensing.Pair.of(text)


class Inversion(unittest.TestCase):
    def test_gives_the_load_back_from_exact_readings(self):
        response = paper_response()
        p = np.concatenate([polar(size, np.arange(-3, 3.2, 0.5)) for size in (1e-6, 0.3e-3, 1.9e-3, 3.99e-3)])
        sensed = sensing.invert(response, response.change(p), NOISE)
        self.assertLess(np.abs(sensed.load - p).max(), 1e-10 * 4e-3)
        self.assertLess(sensed.chi_squared.max(), 1e-6)
        self.assertTrue(sensed.converged.all())
        self.assertFalse(sensed.is_beyond.any())

    def test_is_the_least_squares_of_scipy(self):
        response = paper_response(4e-3, [SENSOR, [2e-3, -1e-3, -2e-3]])
        rng = np.random.default_rng(20260)
        p = polar(rng.uniform(1e-4, 3.8e-3, 30), rng.uniform(-3, 3, 30))
        read = response.change(p) + NOISE * rng.standard_normal((30, 2, 3)) * 3
        common = np.array([[0.7, 0.4], [0.4, 0.9]])
        sensed = sensing.invert(response, read, NOISE, 1.3, np.tile(common, (30, 1, 1)))
        L = np.linalg.inv(np.linalg.cholesky(common + 1.3 * np.eye(2)))
        for i in range(30):
            def residual(x, i=i):
                return (L @ ((response.change(4e-3 * x)[0] - read[i]) / NOISE)).ravel()

            best = optimize.least_squares(residual, p[i] / 4e-3, method="lm", xtol=1e-14, ftol=1e-14, gtol=1e-14)
            self.assertLess(np.abs(sensed.load[i] - 4e-3 * best.x).max(), 1e-8 * 4e-3)
            self.assertAlmostEqual(sensed.chi_squared[i], 2 * best.cost, delta=1e-6 * (1 + best.cost))
            covariance = 4e-3**2 * np.linalg.inv(best.jac.T @ best.jac)
            self.assertLess(np.abs(sensed.covariance[i] / covariance - 1).max(), 1e-4)

    def test_finds_what_the_program_of_before_found(self):
        """Readings of the shipped benches, inverted by the C++ of commit 31dd646: to 1e-6 of the load."""
        for name, frozen in json.loads((Path(__file__).parent / "sensing_frozen.json").read_text()).items():
            case = cv.Case(SOURCE / "cases" / "paper" / frozen["case"])
            pair = sensing.Pair.of(frozen["models"])
            shapes = sensing.shapes_within(case, pair.mechanics, frozen["largest"])
            response = sensing.Response(case, pair.field, shapes, case.sensors)
            sensed = sensing.invert(response, np.array(frozen["change"])[:, None], frozen["noise"])
            loads = np.array(frozen["load"])
            self.assertGreaterEqual(len(loads), 48, name)
            self.assertLess((np.abs(sensed.load - loads).max(axis=1) / np.hypot(*loads.T)).max(), 1e-6)
            self.assertLess(np.abs(sensed.covariance / np.array(frozen["covariance"]) - 1).max(), 1e-6)
            self.assertEqual(sensed.status.tolist(), frozen["status"])

    def test_its_intervals_hold_the_truth_as_often_as_they_say(self):
        """1,000 readings a row (binomial, 4 standard deviations: 2.8 %; of a weak load the direction may be not
        known, which holds it), as tests/python/interval_coverage.py has them for 5,000."""
        for row in interval_coverage.ROWS:
            with self.subTest(row):
                part = interval_coverage.coverage(row, 1000, seed=2)
                self.assertAlmostEqual(part["magnitude"], 0.955, delta=0.033)
                if "no load" in row:
                    self.assertAlmostEqual(part["found"], 0.05, delta=0.028)
                else:
                    most = 1.0 if "weak" in row else 0.978
                    self.assertTrue(0.922 <= part["azimuth"] <= most, part)

    def test_chi_squared_is_distributed_as_it_should_be(self):
        response, rng = paper_response(), np.random.default_rng(20261)
        p = polar(rng.uniform(0.2e-3, 3.8e-3, 4000), rng.uniform(-3, 3, 4000))
        sensed = sensing.invert(response, response.change(p) + NOISE * rng.standard_normal((4000, 1, 3)), NOISE)
        self.assertGreater(stats.kstest(sensed.misfit_probability, "uniform").pvalue, 1e-3)

    def test_finds_loads_of_five_standard_deviations(self):
        """The noncentral chi squared of two degrees of freedom: 0.35 % lie below 5.99."""
        response, rng = paper_response(), np.random.default_rng(20263)
        inverse = np.linalg.inv(sensing.invert(response, np.zeros((1, 1, 3)), NOISE).covariance[0])
        e = polar(1, rng.uniform(-3, 3, 4000))
        p = 5 * e / np.sqrt(np.einsum("ni,ij,nj->n", e, inverse, e))[:, None]
        read = response.change(p) + NOISE * rng.standard_normal((4000, 1, 3))
        found = (sensing.invert(response, read, NOISE).status == "found").mean()
        missed = stats.ncx2.cdf(stats.chi2.ppf(0.95, 2), 2, 25)
        self.assertAlmostEqual(missed, 0.0035, delta=1e-4)
        self.assertAlmostEqual(found, 1 - missed - 0.001, delta=0.0045)

    def test_says_what_a_reading_does_not_tell(self):
        response = paper_response()
        read = np.array([[[1e-7, -1e-7, 0]], response.change(polar(4.4e-3, 1))[0], [[0, 0, 5e-4]]])
        sensed = sensing.invert(response, read, NOISE)
        self.assertEqual(sensed.azimuth_interval[0], np.pi)
        self.assertGreaterEqual(sensed.magnitude_interval[0], sensed.magnitude[0])
        self.assertTrue(sensed.is_beyond[1])
        self.assertLess(sensed.misfit_probability[2], 1e-12)
        for bad, noise in (([[[0, np.nan, 0]]], NOISE), ([[[0] * 3] * 2], NOISE), ([[[0] * 3]], [1e-6, 0, 1e-6])):
            with self.assertRaises(cv.InputError):
                sensing.invert(response, bad, noise)
        self.assertEqual(len(sensing.invert(response, np.zeros((0, 1, 3)), NOISE).load), 0)

    def test_angles_are_wrapped(self):
        np.testing.assert_allclose(wrapped(np.array([np.pi, -np.pi, 3 * np.pi, 0.1])), [np.pi, np.pi, np.pi, 0.1])

    def test_the_linear_fit_inverts_small_loads(self):
        small = paper_response(1e-6)
        fit = LinearFit(small, NOISE)
        p = polar(0.6e-6, 2)
        self.assertLess(np.abs(fit(small.change(p))[0] - p).max(), 1e-4 * 0.6e-6)
        self.assertLess(fit.misfit, 1e-3)
        self.assertGreater(LinearFit(paper_response(), NOISE).misfit, 10 * fit.misfit)
        self.assertGreater(fit.r_squared[:2].min(), 1 - 1e-6)


class AChip(unittest.TestCase):
    """Turned, mirrored, with fewer components. Oracle: the same readings of a chip along the case's axes."""

    def found(self, keys, change, **more):
        case = cv.Case.from_text(CASE.replace('"-1.55 mm"]', '"-1.55 mm"]\n' + keys))
        return cv.sense(case, change, noise=0.5e-6, **more)

    def test_is_read_in_its_own_directions(self):
        p = polar(np.array([1e-3, 2e-3, 3e-3]), np.array([0.3, 2, -2.8]))
        change = paper_response().change(p)[:, 0]
        straight = self.found("", change)
        x, y, z = change.T
        np.testing.assert_allclose(straight[["load_x", "load_y"]], p, atol=1e-11)
        for keys, own in (
            ('axes = ["+y", "-x", "+z"]', [y, -x, z]),
            ('axes = ["+x", "-y", "-z"]', [x, -y, -z]),
            ('axes = ["-x", "+y", "+z"]', [-x, y, z]),
            ('rotation = "90 deg"', [y, -x, z]),
            ('axes = ["+y", "-x", "+z"]\nrotation = "-90 deg"', [x, y, z]),
        ):
            with self.subTest(keys):
                frame = self.found(keys, np.stack(own, axis=-1))
                np.testing.assert_allclose(frame[["load_x", "load_y"]], p, atol=1e-11)
                np.testing.assert_allclose(frame["magnitude_interval"], straight["magnitude_interval"], rtol=1e-6)

    def test_may_read_two_components(self):
        p = polar(np.array([1e-3, 2e-3]), np.array([0.3, 2]))
        change = paper_response().change(p)[:, 0]
        full = self.found("", change)
        change[:, 2] = np.nan  # what it does not read does not matter
        frame = self.found('components = ["x", "y"]', change)
        np.testing.assert_allclose(frame[["load_x", "load_y"]], p, atol=1e-11)
        self.assertTrue((noise_interval(frame) > noise_interval(full)).all())
        self.assertTrue((frame["misfit_probability"] == 1).all())
        with self.assertRaisesRegex(cv.InputError, "two components"):
            self.found('components = ["x"]', change)

    def test_keys_with_faults_are_refused(self):
        for keys, what in (
            ('axes = ["+x", "+x", "+z"]', "axes"), ('axes = ["x", "y", "z"]', "axes"), ('axes = "+x"', "list"),
            ('axes = ["+x", "-x", "+z"]', "each of x, y, z once"), ("components = []", "empty"),
            ('components = ["w"]', "components"), ('rotation = "3 mm"', "angle"), ('rotation = "900 deg"', "rotation"),
        ):  # fmt: skip
            with self.subTest(keys), self.assertRaisesRegex(cv.InputError, what):
                self.found(keys, np.zeros((1, 3)))

    def test_goes_through_the_written_case(self):
        case = cv.Case.from_text(CASE.replace('"-1.55 mm"]', '"-1.55 mm"]\naxes = ["+y", "-x", "+z"]\nrotation = "30 deg"'))
        again = cv.Case.from_text(case.toml())
        np.testing.assert_allclose(Chips.of(again).axes, Chips.of(case).axes, atol=1e-15)

    def test_axes_that_do_not_fit_are_doubted(self):
        """Readings of a chip upside down (06 of the users' trials)."""
        B = np.concatenate([np.zeros((5, 3)), paper_response().change(polar(2e-3, 1.0))[:, 0]])
        B = B + paper_response().undeformed[0]
        sense = {"unloaded": slice(0, 5), "noise": 0.5e-6}
        case = cv.Case.from_text(CASE)
        self.assertFalse(any("axes" in r or "turned" in r for r in cv.sense(case, B, **sense).attrs["remarks"]))
        x, y, z = B.T
        for own, axes, said in (
            ([x, y, -z], '["+x", "+y", "-z"]', "own z seems to point along the case's -z"),
            ([z, x, y], '["+z", "+x", "+y"]', "own x seems to point along the case's +z"),
        ):
            read = np.stack(own, axis=-1)
            with self.subTest(axes):
                remark = cv.sense(case, read, **sense).attrs["remarks"][-1]
                self.assertIn(said, remark)
                right = cv.Case.from_text(CASE.replace('"-1.55 mm"]', f'"-1.55 mm"]\naxes = {axes}'))
                frame = cv.sense(right, read, **sense)
                np.testing.assert_allclose(frame[["load_x", "load_y"]].to_numpy()[0], polar(2e-3, 1.0), atol=1e-9)

    def test_a_gain_scales_the_field_and_not_the_noise(self):
        p, rng = polar(np.full(2000, 1e-3), np.linspace(-3, 3, 2000)), np.random.default_rng(11)
        for gain in (0.1, 1.0, 10.0):
            case = cv.Case.from_text(CASE.replace('"-1.55 mm"]', f'"-1.55 mm"]\ngain = {gain}'))
            read = gain * paper_response().change(p)[:, 0] + 0.5e-6 * rng.standard_normal((2000, 3))
            frame = cv.sense(case, read, noise=0.5e-6)
            held = np.abs(frame["magnitude"] - 1e-3) <= noise_interval(frame)
            self.assertAlmostEqual(held.mean(), 0.95, delta=0.02)
            self.assertAlmostEqual(frame["chi_squared"].mean(), 1, delta=0.15)

    def test_two_components_without_a_side_are_ambiguous(self):
        """A chip with x and z in the plane y = 0 cannot tell +y from -y."""
        keys = 'components = ["x", "z"]'
        text = CASE.replace('["-0.1 mm", "0.2 mm", "-1.55 mm"]', f'["-0.5 mm", "0 mm", "-1.55 mm"]\n{keys}')
        change = paper_response(4e-3, [[-0.5e-3, 0, -1.55e-3]]).change(polar(np.array([2e-3, 3e-3]), np.array([0.6, -2.0])))
        frame = cv.sense(cv.Case.from_text(text), change[:, 0], noise=0.5e-6)
        self.assertEqual(frame["status"].tolist(), ["ambiguous"] * 2)
        np.testing.assert_allclose(np.abs(frame["azimuth"]), [0.6, 2.0], atol=1e-5)
        on_axis = CASE.replace('["-0.1 mm", "0.2 mm", "-1.55 mm"]', f'["0 mm", "0 mm", "-1.55 mm"]\n{keys}')
        noise = 0.5e-6 * np.random.default_rng(1).standard_normal((200, 3))
        unloaded = cv.sense(cv.Case.from_text(on_axis), noise, noise=0.5e-6)
        self.assertEqual((unloaded["status"] == "failed").sum(), 0)


class OfAFile(unittest.TestCase):
    """Needs of a log of a real chip."""

    def sense(self, rows, head, keys="", **more):
        case = cv.Case.from_text(CASE.replace('"-1.55 mm"]', '"-1.55 mm"]\n' + keys))
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "log.csv"
            log.write_text("\n".join([head, *(",".join(map(repr, row)) for row in np.asarray(rows).tolist())]))
            return cv.sense(case, log, noise="0.5 uT", unloaded="rows 1..4", **more)

    def setUp(self):
        self.p = polar(np.array([1e-3, 2e-3, 3e-3]), np.array([0.3, 2, -2.8]))
        change = np.concatenate([np.zeros((4, 3)), paper_response().change(self.p)[:, 0]])
        self.B = paper_response().undeformed[0] + change

    def test_the_temperature_is_taken_off(self):
        """Magnet and chip lose 0.1 % of B a kelvin."""
        T = np.array([[21.0], [22], [21], [22], [25], [30], [18]])
        read = np.hstack([T, self.B * (1 - 1e-3 * (T - 21.5))])
        head = "Temp [°C],Bx [T],By [T],Bz [T]"
        frame = self.sense(read, head, temperature="-0.1 %/K")
        np.testing.assert_allclose(frame[["load_x", "load_y"]], self.p, atol=1e-9)
        raw = self.sense(read, head)
        self.assertGreater(np.abs(raw[["load_x", "load_y"]].to_numpy() - self.p).max(), 1e-5)
        for more, what in (
            ({"temperature": "0.1 %"}, "no coefficient"), ({"temperature": "50 %/K"}, "10 %/K"), ({"temperature": "1.2.3 %/K"}, "no coefficient"),
            ({"temperature": "1 mm/K"}, "no coefficient"),
        ):  # fmt: skip
            with self.subTest(what), self.assertRaisesRegex(cv.InputError, what):
                self.sense(read, head, **more)
        with self.assertRaisesRegex(cv.InputError, "write it in K or degC"):
            self.sense(read, head.replace("°C", "°F"), temperature="-0.1 %/K")
        with self.assertRaisesRegex(cv.InputError, "there is no column 'temperature'"):
            self.sense(self.B, "Bx [T],By [T],Bz [T]", temperature="-0.1 %/K")
        read[5, 0] = np.nan
        with self.assertRaisesRegex(cv.InputError, "log.csv:7:1"):
            self.sense(read, head, temperature="-0.1 %/K")

    def test_a_chip_with_two_axes_has_two_columns(self):
        frame = self.sense(self.B[:, [0, 2]], "Bx [T],Bz [T]", 'components = ["x", "z"]')
        np.testing.assert_allclose(frame[["load_x", "load_y"]], self.p, atol=1e-9)
        with self.assertRaisesRegex(cv.InputError, "no column By"):
            self.sense(self.B[:, [0, 2]], "Bx [T],Bz [T]", 'components = ["x", "y"]')


class Arrays(unittest.TestCase):
    def test_are_read_as_files_are(self):
        case, rng = cv.Case.from_text(CASE), np.random.default_rng(5)
        change = paper_response().change(polar(np.array([1e-3, 2e-3]), np.array([0.3, 2])))[:, 0]
        B = paper_response().undeformed[0] + np.concatenate([np.zeros((4, 3)), change]) + 20e-6
        B += 0.4e-6 * rng.standard_normal(B.shape)
        frame = cv.sense(case, B, noise=0.4e-6, unloaded=slice(0, 4), largest="4 mN")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "log.csv"
            rows = [",".join([name, *map(repr, b.tolist())]) for name, b in zip(["unloaded"] * 4 + ["a", "b"], B)]
            file.write_text("\n".join(["sample,Bx [T],By [T],Bz [T]", *rows]))
            of_file = cv.sense(case, file, noise="0.4 uT", largest=4e-3)
        self.assertEqual(of_file["sample"].tolist(), ["a", "b"])
        for column in ("load_x", "load_y", "magnitude_interval", "azimuth_interval", "chi_squared"):
            np.testing.assert_allclose(frame[column], of_file[column], rtol=1e-9)
        self.assertEqual(frame.attrs["unit"], "N")
        indices = cv.sense(case, B, noise=0.4e-6, unloaded=[0, 1, 2, 3], largest=4e-3)
        np.testing.assert_array_equal(indices["magnitude"], frame["magnitude"])

    def test_backgrounds(self):
        """A field for all drops out; one with each reading is taken off, with its noise."""
        case, rng = cv.Case.from_text(CASE), np.random.default_rng(6)
        change = paper_response().change(polar(np.array([1e-3, 2e-3]), np.array([0.3, 2])))[:, 0]
        B = paper_response().undeformed[0] + np.concatenate([np.zeros((4, 3)), change])
        ambient = 30e-6 * rng.standard_normal(B.shape)
        kept = {"noise": 0.4e-6, "unloaded": slice(0, 4)}
        one = cv.sense(case, B, background=[2e-5, 0, -4e-5], **kept)
        each = cv.sense(case, B + ambient, background=ambient, **kept)
        np.testing.assert_allclose(one["magnitude"], [1e-3, 2e-3], rtol=1e-9)
        np.testing.assert_allclose(each["magnitude"], [1e-3, 2e-3], rtol=1e-9)
        np.testing.assert_allclose(noise_interval(each) / noise_interval(one), np.sqrt(2), rtol=1e-9)

    def test_with_faults_are_refused(self):
        case = cv.Case.from_text(CASE)
        good = np.zeros((5, 3))
        for B, more, what in (
            (np.zeros((5, 2)), {}, r"shape \(n, 3\)"), (np.zeros((5, 2, 3)), {}, "shape"), ("abc.csv", {}, "abc.csv"),
            ([["a", 1, 2]], {}, "numbers in T"), (np.full((5, 3), np.nan), {}, "not finite"),
            (good, {"unloaded": slice(0, 5)}, "no reading but"), (good, {"unloaded": slice(9, 12)}, "names no"),
            (good, {"unloaded": "first"}, "slice"), (good, {"background": good}, "no background"),
            (good, {"unloaded": [0], "background": good[:2]}, "5 readings and 2"), (good, {"noise": "1 mm"}, "flux"),
            (good, {"noise": 0}, "1 fT and 1 T"), (good, {"largest": "3 mm"}, "force"), (good, {"models": "elastic/volume"}, "elastic"),
            (good, {"unit": "uT"}, "arrays are in T"), (good + 200, {}, "are they in T"),
        ):  # fmt: skip
            with self.subTest(what), self.assertRaisesRegex((cv.InputError, cv.FileError), what):
                cv.sense(case, B, **more)


class LeftOut(unittest.TestCase):
    """The part of the interval that is the models'."""

    def test_of_a_plain_rod_it_holds_what_corrected_joints_make(self):
        """Readings of the corrected rod without noise, by the case's plain one: off by what the interval says."""
        case = cv.Case.from_text(CASE.replace('"corrected"', '"none"'))
        p = polar(np.linspace(0.5e-3, 3.5e-3, 7), np.linspace(-3, 3, 7))
        B = paper_response().change(p)[:, 0]
        corrected = cv.sense(case, B, noise=1e-9)
        np.testing.assert_allclose(corrected["magnitude"], np.hypot(*p.T), rtol=1e-6)
        plain = cv.sense(case, B, noise=4e-7, joints="case")
        error = np.abs(plain["magnitude"] - np.hypot(*p.T))
        self.assertTrue((error > 0.04 * np.hypot(*p.T)).all())
        self.assertTrue((error < plain["magnitude_interval"]).all())
        self.assertTrue((plain["magnitude_interval"] < 1.3 * error).all())
        self.assertEqual(set(plain["status"]), {"found"})  # what is left out is no misfit

    def test_is_said_to_be_unknown_where_the_corrections_do_not_reach(self):
        """A foot of a tenth of a diameter."""
        text = CASE.replace('length = "3 mm"', 'length = "0.3 mm"').replace('"corrected"', '"none"')
        case = cv.Case.from_text(text)
        result = sense_readings(case, sensing.readings_of_arrays(np.zeros((2, 3)), 1, None, None), PAIR, 1e-6, 1e-3)
        self.assertIn("leaves out is not known: elastica", result.text(80))
        self.assertIn("elastica", result.json({})["model_uncertainty_unknown"])
        self.assertEqual(result.loads.model_interval.tolist(), [0, 0])
        self.assertEqual(result.json({})["joints"], "none")

    def test_inputs_widen_the_interval_by_what_they_make(self):
        """A modulus of the base that is known to 4 % shifts the load of a reading by the same as another cilium does."""
        name, uncertainty = "cilium.segment.base.young_modulus", 0.04
        text = CASE + f'[[input_uncertainty]]\nnumber = "{name}"\nuncertainty = "4 %"\n'
        B = paper_response().change(polar(np.array([1e-3, 3e-3]), np.array([0.5, -2])))[:, 0]
        frame = cv.sense(cv.Case.from_text(text), B, noise=1e-7)
        found = [
            cv.sense(cv.Case.from_text(CASE).changed({name: 0.1e6 * (1 + sign * 0.1 * uncertainty)}), B, noise=1e-7)
            for sign in (-1, 1)
        ]
        by_hand = 1.96 * (found[1]["magnitude"] - found[0]["magnitude"]) / 0.2
        np.testing.assert_allclose(frame["input_interval"], by_hand, rtol=1e-3)
        squares = sum(frame[k] ** 2 for k in ("input_interval", "model_interval"))
        self.assertTrue((frame["magnitude_interval"] ** 2 > squares).all())

    def test_joints_are_corrected_or_the_cases(self):
        with self.assertRaisesRegex(cv.InputError, "joints: `corrected`"):
            cv.sense(cv.Case.from_text(CASE), np.zeros((1, 3)), joints="none")


class SenseReadings(unittest.TestCase):
    def test_a_scatter_beyond_the_noise_is_said(self):
        case = cv.Case.from_text(CASE)
        rng = np.random.default_rng(9)
        for noise, doubts in ((2e-6, True), (0.5e-6, False)):
            B = noise * rng.standard_normal((30, 1, 3))
            readings = sensing.readings_of_arrays(B[:, 0], 1, slice(0, 20), None)
            remarks = sense_readings(case, readings, PAIR, 0.5e-6, 4e-3).remarks
            self.assertEqual(any("Rows that are averaged differ" in remark for remark in remarks), doubts)


if __name__ == "__main__":
    unittest.main()
