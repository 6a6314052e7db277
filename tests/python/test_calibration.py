# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers of a case from readings at known loads."""

import json
import os
import tempfile
import unittest
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy import stats

import ciliaval as cv
from ciliaval import program, sensing
from ciliaval.report.page import results_page
from ciliaval.sensing.inversion import Chips
from sensing_cases import CASE


class Calibration(unittest.TestCase):
    """Numbers of a case from readings at its loads. Oracle: the numbers with which the readings were made."""

    @classmethod
    def setUpClass(cls):
        text = CASE.replace('azimuth = "30 deg"', 'azimuth = ["0 deg", "120 deg", "240 deg"]')
        cls.case = cv.Case.from_text(text)
        cls.base = "cilium.segment.base.young_modulus"
        cls.magnet = "cilium.segment.magnet.magnetization"

    def made(self, changes=None):
        case = self.case.changed(changes or {})
        return case.run().dB("beam/line")

    def fit(self, dB, names, case=None, **more):
        return sensing.calibrate(case or self.case, dB, names, models="beam/line", noise=0.5e-6, **more)

    def test_gives_the_numbers_back(self):
        found = self.fit(self.made({self.base: 0.085e6, self.magnet: 80e3}), ["base.young_modulus", "magnet.magnetization"])
        np.testing.assert_allclose(found.values, [0.085e6, 80e3], rtol=1e-7)
        self.assertEqual([p.unit for p in found.parameters], ["Pa", "A/m"])
        self.assertLess(found.chi_squared, 1e-6)
        self.assertEqual(found.freedom, 7)
        segments = found.case.cilium.segments
        self.assertAlmostEqual(segments[0].young_modulus, 0.085e6, delta=0.01)

    def test_a_sensor_that_sits_elsewhere_is_found(self):
        """Place, turn and gain, each beside the modulus; and through the written case."""
        chip = 'position = ["-0.03 mm", "0.15 mm", "-1.6 mm"]\nrotation = ["1 deg", "-2 deg", "3 deg"]\ngain = 1.02'
        other = cv.Case.from_text(self.case.toml().replace('position = ["-0.0001 m", "0.0002 m", "-0.00155 m"]', chip))
        chips = Chips.of(other)
        shapes = cv.bend(other.cilium, other.loads, "beam", joints="corrected")
        dB = np.stack([shape.dB(other.sensors, "line") for shape in shapes])
        read = chips.own(dB)[:, 0]
        names = ["sensor.position", "sensor.orientation"]
        true = [-0.03e-3, 0.15e-3, -1.6e-3, *np.radians([1, -2, 3])]
        found = self.fit(read / 1.02, names)
        np.testing.assert_allclose(found.values, true, atol=1e-8)
        gain = self.fit(read, ["sensor.gain"], case=cv.Case.from_text(other.toml().replace("gain = 1.02", "gain = 1")))
        np.testing.assert_allclose(gain.values, [1.02], rtol=1e-8)
        again = cv.Case.from_text(found.case.toml())
        np.testing.assert_allclose(again.sensors[0], true[:3], atol=1e-8)
        np.testing.assert_allclose(Chips.of(again).axes, chips.axes, atol=1e-7)

    def test_names_what_the_readings_do_not_tell_apart(self):
        found = self.fit(self.made(), ["base.young_modulus", "magnet.magnetization", "scale"])
        self.assertEqual([sorted(group) for group in found.together], [["magnet.magnetization", "sensor.gain"]])
        self.assertEqual(found.freedom, 9 - 2)  # their combination is one number
        self.assertTrue(np.isfinite(found.deviations[0]) and np.isinf(found.deviations[1:]).all())
        self.assertIn("cannot tell apart: magnet.magnetization, sensor.gain", found.text(80))
        nothing = self.fit(self.made(), ["base.young_modulus", "elastica.tolerance"])
        self.assertEqual(nothing.together, [["models.elastica.tolerance"]])

    def test_its_intervals_hold_the_truth_as_often_as_they_say(self):
        """60 draws of noise and offset: 95 % of 120 intervals, binomial, 4 standard deviations: 8 %."""
        rng = np.random.default_rng(7)
        true = np.array([0.11e6, -1.5e-3])
        case = self.case.changed({"sensor.position.z": -1.5e-3})
        case = case.changed({self.base: 0.11e6})
        dB = np.stack([s.dB(case.sensors) for s in cv.bend(case.cilium, case.loads, joints="corrected")])[:, 0]
        straight = np.zeros((2, 3))
        held, chi = 0, []
        for _ in range(60):
            B = np.concatenate([straight, dB]) + 0.5e-6 * rng.standard_normal((5, 3))
            found = sensing.calibrate(
                self.case, B, ["base.young_modulus", "sensor.position.z"], noise=0.5e-6, unloaded=slice(0, 2)
            )
            held += (np.abs(found.values - true) <= 1.96 * found.deviations).sum()
            chi.append(found.misfit_probability)
        self.assertAlmostEqual(held / 120, 0.95, delta=0.08)
        self.assertGreater(stats.kstest(chi, "uniform").pvalue, 1e-3)

    def test_faults_are_refused(self):
        dB = self.made()[:, 0]
        for read, names, what in (
            (dB[:2], ["base.young_modulus"], "2 readings and 3 load steps"), (dB, [], "no number"),
            (dB, ["base.young_modulos"], "did you mean `base.young_modulus`"), (dB, ["young_modulus"], "say which"),
            (dB, ["base.young_modulus"] * 2, "twice"), (dB, ["load.force"], "not the same in all load steps"), (dB, ["sensor.colour"], "no number"),
            (dB, [f"sensor.{n}" for n in ("position", "orientation", "gain")] + ["base.length", "magnet.length", "diameter"],
             "10 numbers cannot be found from 9"),
        ):  # fmt: skip
            with self.subTest(what), self.assertRaisesRegex(cv.InputError, what):
                self.fit(read, names)
        with self.assertRaisesRegex(cv.InputError, "unloaded rows"):
            self.fit(dB, ["base.young_modulus"], unloaded="model")

    def test_command(self):
        dB = self.made({self.base: 0.085e6})[:, 0]
        with tempfile.TemporaryDirectory() as folder:
            case, log = Path(folder, "one.toml"), Path(folder, "known.csv")
            case.write_text(self.case.toml())
            log.write_text("\n".join(["dBx [T],dBy [T],dBz [T]", *(",".join(map(repr, b)) for b in dB.tolist())]))
            words = ["calibrate", case, log, "--fit", "base.young_modulus", "--models", "beam/line"]
            made, found = Path(folder, "calibrated.toml"), Path(folder, "found.json")
            out = program.call(*words, "-o", made, "--json", found)
            self.assertIn("0.085", out)
            self.assertAlmostEqual(json.loads(found.read_text())["parameters"][0]["value"], 0.085e6, delta=0.1)
            self.assertAlmostEqual(cv.Case(made).cilium.segments[0].young_modulus, 0.085e6, delta=0.1)
            page = results_page(Path(folder), "a test").html
            self.assertIn("Calibration of one", page)
            self.assertIn("0.085", page)
            with self.assertRaisesRegex(cv.InputError, "fit"):
                program.call("calibrate", case, log, "--fit", "")
            with self.assertRaisesRegex(cv.InputError, "one.toml"):  # it would be overwritten
                program.call(*words, "-o", case)


if __name__ == "__main__":
    unittest.main()
