# SPDX-License-Identifier: LGPL-2.1-or-later
"""A sweep's field as a logger records and filters it."""

import math
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np
from scipy import special

import ciliaval as cv
from ciliaval.files import content
from ciliaval.results import read_table
from ciliaval.sensing import record
from ciliaval.sensing.signal import highpass, signal_csv
from test_results import quick

REST = np.zeros((2, 3))


class Sampling(unittest.TestCase):
    """Oracle: the straight lines themselves, drawn through uneven times; numbers that are exact."""

    def test_samples_the_straight_line_between_two_times(self):
        B = [[0, 8, -1], [4, 8, -1], [4, 1, -1]]
        made = record([1, 1.25, 3], B, 8)
        t = 1 + np.arange(17) / 8
        np.testing.assert_array_equal(made.time, t)
        expected = np.stack([np.minimum(4, 16 * (t - 1)), np.minimum(8, 8 - 4 * (t - 1.25)), -np.ones(17)], axis=1)
        np.testing.assert_allclose(made.raw, expected, atol=1e-14)
        np.testing.assert_array_equal(made.filtered, made.raw)

    def test_does_not_overshoot_at_a_jump(self):
        times = [0, 0.3, 0.5, 0.5 + 1e-9, 0.8, 1]
        B = np.array([1, 1, 1, -1, -1, -1])[:, None] * np.array([1, 2, 3])
        made = record(times, B, 100)
        expected = np.where(np.arange(101) <= 50, 1, -1)[:, None] * np.array([1, 2, 3])
        np.testing.assert_allclose(made.raw, expected, atol=1e-15)

    def test_ends_with_the_last_time(self):
        # Neither 0.1 nor 0.3 - 0.1 is exact: the last sample must not be lost to rounding.
        for last in (0.3, 0.7, 1.1, 5.9):
            made = record([0.1, last], [[0, 0, 0], [1, 1, 1]], 10)
            self.assertEqual(len(made.time), round(10 * (last - 0.1)) + 1)
            self.assertAlmostEqual(made.raw[-1, 0], 1, 14)
            self.assertLessEqual(made.time[-1], last)


class Noise(unittest.TestCase):
    def test_is_gaussian_of_the_given_standard_deviation(self):
        # 4.5 standard errors are exceeded once in 150,000 seeds; Kolmogorov's sqrt(n) D > 1.95 once in 1,000.
        sigma = 0.4e-6
        for values in record([0, 100], REST, 1000, sigma, seed=7).raw.T:
            n = len(values)
            self.assertLess(abs(values.mean()), 4.5 * sigma / math.sqrt(n))
            self.assertLess(abs(values.var() / sigma**2 - 1), 4.5 * math.sqrt(2 / n))
            below = special.ndtr(np.sort(values) / sigma)
            steps = np.arange(n + 1) / n
            distance = max(np.max(below - steps[:-1]), np.max(steps[1:] - below))
            self.assertLess(distance * math.sqrt(n), 1.95)

    def test_is_independent_in_time_and_of_other_components_sensors_and_seeds(self):
        records = [record([0, 100], REST, 1000, 2, seed=s, sensor=i).raw for s, i in ((7, 0), (7, 1), (8, 0))]
        series = np.concatenate(records, axis=1).T / 2
        n = series.shape[1]
        for i, a in enumerate(series):
            for j, b in enumerate(series[i:], i):
                for lag in range(1 if i == j else 0, 4):
                    found = a[: n - lag] @ b[lag:] / n
                    self.assertLess(abs(found), 4.5 / math.sqrt(n), (i, j, lag))

    def test_is_the_same_for_a_seed_whatever_the_field_and_the_length(self):
        made = record([0, 10], REST, 50, 1, seed=5).raw
        np.testing.assert_array_equal(record([0, 10], REST, 50, 1, seed=5).raw, made)
        np.testing.assert_array_equal(record([0, 20], REST, 50, 1, seed=5).raw[: len(made)], made)
        with_field = record([0, 10], REST + [8, 16, 32], 50, 2, seed=5).raw
        np.testing.assert_allclose(with_field - [8, 16, 32], 2 * made, atol=1e-13)


class Filter(unittest.TestCase):
    def test_has_the_analytic_magnitude(self):
        """Oracle: the closed form; a sine far behind the filter's transient, by its Fourier sum."""
        rate = 1000.0
        t = np.arange(20000) / rate
        for order in (1, 2, 3, 4, 7, 12):
            for cutoff in (20.0, 100.0, 300.0):
                for f in (30.0, 110.0, 250.0):
                    x = math.tan(math.pi * cutoff / rate) / math.tan(math.pi * f / rate)
                    expected = 1 / math.sqrt(1 + x ** (2 * order))
                    for phase, power in (("causal", 1), ("zero_phase", 2)):
                        y = highpass(np.sin(2 * math.pi * f * t), rate, cutoff, order, phase)[8000:12000]
                        found = 2 * abs(np.mean(y * np.exp(-2j * math.pi * f * t[8000:12000])))
                        self.assertAlmostEqual(found, expected**power, delta=1e-9, msg=(order, cutoff, f, phase))

    def test_passes_its_share_of_the_noise(self):
        # White noise leaves the filter with the variance sigma^2 times the mean of |H|^2, |H|^4 both ways.
        intervals = (np.arange(2000) + 0.5) / 2000
        x = math.tan(math.pi * 0.2) / np.tan(math.pi / 2 * intervals)
        for phase, power in (("causal", 1), ("zero_phase", 2)):
            share = np.mean((1 / (1 + x**8)) ** power)
            y = record([0, 1000], REST, 100, 3, 20, 4, phase, seed=11).filtered[:, 1]
            # Filtered noise is correlated: fewer independent samples, but no less than a half.
            self.assertAlmostEqual(y @ y / len(y) / 9, share, delta=4.5 * share * math.sqrt(4 / len(y)))

    def test_takes_the_resting_field_away_from_the_first_sample_on(self):
        # 5 mT at rest that a sine of 1 uT disturbs from the middle on: the offset is not seen.
        t = np.arange(4001) / 400
        sine = np.where(t < 5, 0, 1e-6 * np.sin(2 * math.pi * 20 * t))
        B = np.stack([np.full(4001, 5e-3), -2e-3 + sine, np.full(4001, 1e-3)], axis=1)
        for phase in ("causal", "zero_phase"):
            y = record(t, B, 400, 0, 1, 4, phase).filtered
            self.assertLess(np.abs(y[:, [0, 2]]).max(), 1e-14)
            # The filter that runs backwards sees the sine 2.5 s ahead.
            self.assertLess(np.abs(y[:1000, 1]).max(), 1e-14 if phase == "causal" else 1e-10)
            self.assertAlmostEqual(np.abs(y[2800:3200, 1]).max(), 1e-6, delta=0.02e-6)

    def test_bad_input_is_an_input_error(self):
        good = {"times": [0, 1, 2], "B": np.full((3, 3), 1e-3), "sampling_rate": 50, "noise": 1e-6, "cutoff": 4}
        record(**good)
        for change, text in (
            ({"times": [], "B": np.zeros((0, 3))}, "two times or more"),
            ({"times": [0, 1]}, "two times or more"),
            ({"times": [0, 1, 1]}, r"after 1 s comes 1 s \(number 3\)"),
            ({"times": [0, math.nan, 2]}, "not finite"),
            ({"B": np.full((3, 3), math.inf)}, "not finite"),
            *(({"sampling_rate": x}, "sampling rate") for x in (0, -1, math.nan, math.inf)),
            *(({"noise": x}, "standard deviation") for x in (-1e-9, math.nan, math.inf)),
            *(({"order": x}, "1 to 20") for x in (0, 21, 2.5)),
            *(({"cutoff": x}, "cut-off") for x in (-1, 1e-9, 25, math.nan)),
            ({"phase": "zero"}, "causal or zero_phase"),
            ({"sampling_rate": 0.4, "cutoff": None}, "shorter than one interval"),
            ({"sampling_rate": 6e6}, r"more than 1e\+07 samples"),
            ({"sampling_rate": 5, "cutoff": 1, "phase": "zero_phase"}, "more than 15 samples; there are 11"),
        ):
            with self.subTest(change), self.assertRaisesRegex(cv.InputError, text):
                record(**{**good, **change})


class OfASweep(unittest.TestCase):
    def test_run_writes_it_beside_the_sweep(self):
        text = re.sub("samples = .*", "samples = 41", quick("fig6-surface"))
        text = re.sub('travel = "52 mm".*', 'travel = "17 mm"', text)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "a.toml"
            file.write_text(text)
            result = cv.run(file, folder)
            made = read_table(result.folder / "signal.csv")
            # 17 mm at 1 mm/s, 20 a second, both ends.
            self.assertEqual(len(made["time"]), 341)
            (pair, *_) = result.pairs
            self.assertEqual(list(made)[:5], ["time", *(f"{pair}.dB0_{a}" for a in "xyz"), f"{pair}.filtered0_x"])
            self.assertEqual(made[f"{pair}.filtered0_x"][0], 0)
            self.assertGreater(np.abs(made[f"{pair}.filtered0_x"]).max(), 20e-6)  # the jump
            sweep = read_table(result.folder / "sweep.csv")
            noise = made[f"{pair}.dB0_x"] - np.interp(made["time"], sweep["time"], sweep[f"{pair}.dB0_x"])
            self.assertAlmostEqual(noise.std(), 0.5e-6, delta=0.1e-6)
            self.assertEqual(signal_csv(result.folder).encode(), content(result.folder / "signal.csv"))
            self.assertIn(f"{pair}.filtered0_z T", (result.folder / "signal.csv").read_text().splitlines()[1])
            (result.folder / "case.toml").write_text("[case]\n")
            with self.assertRaisesRegex(cv.FileError, "has no .signal."):
                signal_csv(result.folder)
