# SPDX-License-Identifier: LGPL-2.1-or-later
"""Readings made of the rows of a file: samples, their scatter, what is subtracted, doubts."""

import math
import time
import unittest

import numpy as np
import pandas as pd

from ciliaval.errors import InputError
from ciliaval.sensing.readings import Background
from ciliaval.sensing.times import calendar_in_ns
from test_loggers import COMMAS, HEADER, Files, message


class Samples(Files):
    def test_rows_of_one_time_are_one_sample(self):
        text = "time [s],sensor," + COMMAS + "0,0,0,0,0\n0,1,1,1,1\n2,0,5,0,0\n2,1,1,1,6\n4,1,0,0,1\n4,0,0,0,0\n"
        read = self.read(text, ["0", "1"], unloaded="0 s..1 s")
        self.assertEqual(read.change.shape, (2, 2, 3))
        self.assertClose(read.change[0], [[5e-6, 0, 0], [0, 0, 5e-6]], 1e-20)
        self.assertClose(read.change[1, 1], [-1e-6, -1e-6, 0], 1e-20)
        self.assertEqual(read.time.tolist(), [2, 4])
        self.assertEqual(read.names, ["2 s", "4 s"])
        what = "log.csv:6:1: there is no row of sample '4 s', sensor 0"
        self.refused(what, text[: text.rindex("4,0")], ["0", "1"], unloaded="0 s..1 s")

    def test_repeated_rows_are_averaged_with_their_scatter(self):
        # By hand. Rows 1, 2, 3 of x differ from their mean by -1, 0, 1 uT.
        text = "sample,Bx [uT],By [uT],Bz [uT]\nunloaded,0,0,0\nunloaded,0,0,0\na,1,0,0\na,2,0,0\nb,7,0,0\na,3,0,0\n"
        read = self.read(text)
        self.assertEqual(read.names, ["a", "b"])
        self.assertClose(read.change[:, 0, 0], [2e-6, 7e-6], 1e-20)
        self.assertClose(read.variance(), [1 / 3 + 1 / 2, 1 + 1 / 2], 1e-15)
        self.assertEqual(read.common_variance().tolist(), [1 / 2, 1 / 2])
        self.assertEqual(read.freedom, 9)
        self.assertClose(math.sqrt(read.squares / read.freedom), math.sqrt(2 / 9) * 1e-6, 1e-20)
        self.assertClose(read.unloaded, [[0, 0, 0]], 0)

    def test_windows_of_a_sample_do_not_reach_into_the_one_before(self):
        """Sensor 1 begins before sensor 0, whose row is the sample's first."""
        text = "sample,time [s],sensor," + COMMAS
        text += "unloaded,0,0,0,0,0\nunloaded,0,1,0,0,0\na,10,0,1,0,0\na,9.9,1,1,0,0\nb,20,0,5,0,0\nb,19.995,1,5,0,0\n"
        read = self.read(text, ["0", "1"], average="1 s")
        self.assertEqual(read.names, ["a", "b"])
        self.assertClose(read.change[:, :, 0], [[1e-6, 1e-6], [5e-6, 5e-6]], 1e-20)

    def test_a_column_sensor_without_a_time(self):
        text = "sensor," + COMMAS + "0,0,0,0\n0,1,2,3\n0,4,5,6\n"
        self.assertEqual(self.read(text, unloaded="rows 1..1").names, ["2", "3"])

    def test_marks_between_thousands_are_refused(self):
        for text, given in (
            ("X\tY\tZ\n122\t-22\t7,640\n110\t-20\t7,641\n", {"unit": "LSB", "scale": "0.15 uT"}),
            ("X;Y;Z\n12.345;0;3\n11.000;1;5\n", {"unit": "nT"}),
        ):
            self.refused("mark between thousands", text, unloaded="rows 1..1", **given)
        self.assertClose(
            self.read("X;Y;Z\n0;0;0\n1,234;2,5;3\n", unit="uT", unloaded="rows 1..1").change[0, 0], [1.234e-6, 2.5e-6, 3e-6], 1e-20
        )

    def test_are_named_by_their_time_or_their_row(self):
        self.assertEqual(self.read(HEADER + "0,0,0,0\n0.05,1,2,3\n", unloaded="rows 1..1").names, ["0.05 s"])
        self.assertEqual(self.read("x,y,z\n0,0,0\n1,2,3\n", unit="uT", unloaded="rows 1..1").names, ["2"])
        # Rows of one time are samples of their own where one sensor reads.
        self.assertEqual(self.read(HEADER.replace("B", "dB") + "0,0,0,0\n0,1,2,3\n").names, ["0 s", "0 s"])

    def test_a_million_rows_take_seconds(self):
        text = HEADER + "".join(f"{i},67.{i % 10},-97.5,2204.9\n" for i in range(1_000_000))
        start = time.perf_counter()
        read = self.read(text, unloaded="0 s..99999 s", average="10 s")
        self.assertLess(time.perf_counter() - start, 20)  # 2.5 s measured
        self.assertEqual(read.rows.tolist(), [10] * 90_000)
        self.assertIn("more than 1000000 rows", message(text + "1000001,1,2,3\n"))

    def test_dates_read_fast_are_those_read_part_by_part(self):
        days = [year + day for year in ("1900", "1969", "2026", "2100")
                for day in ("-02-29", "-02-28", "-12-31", "-13-01", "-01-00")]
        for text in (day + clock for day in days for clock in (
                "T00:00:00", "T24:00:00", " 23:59:60", "T23:59:61", "T12:60:00", "T10:18:38.5Z", "T10:18:38.123456789")):
            # A column with a time of day is read part by part.
            (form, ns), (forms, all_ns) = calendar_in_ns(pd.Series([text])), calendar_in_ns(pd.Series([text, "10:00"]))
            self.assertEqual((form[0], ns[0] * (form[0] > 0)), (forms[0], all_ns[0] * (forms[0] > 0)), text)


class Backgrounds(Files):
    HEADER = "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n"

    def test_rows_of_one_azimuth_are_averaged(self):
        # By hand. (1 + 3)/2 = 2 at 0 deg, (2 + 5)/2 = 3.5 half-way to 90 deg.
        background = Background((self.HEADER + "0,1,0,0\n90,5,0,0\n360,3,0,0\n").encode(), "b.csv", ["left", "right"])
        self.assertClose(background.at([0], 0)[0, 0], 2e-6, 1e-20)
        self.assertClose(background.at([math.pi / 4], 1)[0, 0], 3.5e-6, 1e-20)
        means, weights = background.parts([0.0], 0)
        self.assertEqual(background.rows.tolist(), [2, 1])  # both sensors have the same
        self.assertEqual((means[0, np.argmax(weights[0])], sorted(weights[0])), (0, [0, 1]))

    def test_is_interpolated_on_the_circle(self):
        rows = "sample,azimuth [deg],Bx [uT],By [uT],Bz [uT]\nunloaded,{0},0,0,0\na,{0},0,0,0\n"
        for csv, azimuths, taken in (
            ("0,9,9,9\n30,1,2,3\n60,9,9,9\n", (30, 390, -330), (1, 2, 3)),  # the row of the azimuth, also a turn away
            ("60,4,0,0\n0,0,0,0\n", (15,), (1, 0, 0)),
            ("0,0,0,0\n90,50,0,0\n330,0,8,0\n", (345, -15), (0, 4, 0)),
        ):
            background = Background((self.HEADER + csv).encode(), "b.csv", ["0"])
            for azimuth in azimuths:
                self.assertClose(1e6 * background.at([math.radians(azimuth)], 0)[0], taken, 1e-12)
                read = self.read(rows.format(azimuth), background=self.HEADER + csv)
                self.assertClose(read.change, [[[0, 0, 0]]], 1e-20)
                self.assertClose(read.background, [[[0]]], 1e-15)  # with the same weights it adds nothing

    def test_faults(self):
        rows = "sample,azimuth [deg],Bx [uT],By [uT],Bz [uT]\nunloaded,10,1,2,3\na,10,1,2,3\n"
        with self.assertRaisesRegex(InputError, "^b.csv:1:1: there is no column 'azimuth'$"):
            Background(b"Bx [uT],By [uT],Bz [uT]\n1,1,1\n", "b.csv", ["0"])
        with self.assertRaisesRegex(InputError, "^b.csv:1:1: there is no row of sensor 1$"):
            Background(b"azimuth [deg],sensor,Bx [uT],By [uT],Bz [uT]\n30,0,1,1,1\n", "b.csv", ["0", "1"])
        self.refused("log.csv:2:1: the background has a single azimuth", rows, background=self.HEADER + "0,1,2,3\n")
        one = self.HEADER + "0,1,2,3\n"
        self.refused("need a column 'azimuth'", HEADER + "0,1,2,3\n", background=one, unloaded="model")
        self.refused(
            "the change dB has no background any more",
            "azimuth [deg],dBx [uT],dBy [uT],dBz [uT]\n10,1,2,3\n", background=self.HEADER + "0,1,2,3\n",
        )  # fmt: skip
        self.refused("background.csv:3:1: a field of 1e+194 T", rows, background=one + "90,1e200,2,3\n")

    def test_the_covariance_is_that_of_the_weights(self):
        # By hand: sensors at 0 and 45 deg of a background with 2 rows at 0 and 1 at 90 deg: the means' variances are
        # 1/2 and 1; less the unloaded rows at 90 deg the weights are (1, -1) and (1/2, -1/2).
        text = f"sample,sensor,azimuth [deg],{COMMAS}unloaded,0,90,5,0,0\nunloaded,1,90,5,0,0\n"
        text += "a,0,0,2,0,0\na,1,45,3.5,0,0\n"
        read = self.read(text, ["0", "1"], self.HEADER + "0,1,0,0\n90,5,0,0\n0,3,0,0\n")
        self.assertClose(read.background, [[[1.5, 0.75], [0.75, 0.375]]], 1e-14)
        self.assertClose(read.common_variance(), [1 + 1.875], 1e-14)
        self.assertClose(read.change, [[[0, 0, 0]] * 2], 1e-20)

    def test_the_scatter_of_rows_knows_its_noise(self):
        # Unloaded rows at several azimuths have the noise of several background rows: that alone makes no doubt.
        # Oracle: chi^2 of (rows - 1) 3 is as large as its mean.
        sigma, squares, freedom, random = 0.5e-6, 0.0, 0, np.random.default_rng(20264)

        def noisy():
            return ",".join(f"{x:.17g}" for x in random.normal(0, sigma, 3))

        for _ in range(200):
            background = "azimuth [deg],Bx [T],By [T],Bz [T]\n" + "".join(f"{a},{noisy()}\n" for a in range(0, 360, 60))
            text = "sample,azimuth [deg],Bx [T],By [T],Bz [T]\na,10,0,0,0\n"
            text += "".join(f"unloaded,{a + b},{noisy()}\n" for a in range(0, 360, 60) for b in (0, 0, 20))
            read = self.read(text, background=background)
            squares += read.squares / sigma**2
            freedom += read.freedom
        self.assertEqual(freedom, 200 * 3 * 17)
        # chi^2 of f degrees of freedom has the standard deviation sqrt(2 f): 4 of them are 5.6 %.
        self.assertAlmostEqual(squares / freedom, 1, delta=0.056)


class Silent(Files):
    """Doubts that a file does not show by itself."""

    @staticmethod
    def counts(n, seed=1, noise=3.0):
        return np.round(np.random.default_rng(seed).normal([120, -25, 7640], noise, (n, 3))).astype(int)

    def remarks(self, counts, **given):
        text = "time [s],X,Y,Z\n" + "".join(f"{i / 100},{x},{y},{z}\n" for i, (x, y, z) in enumerate(counts))
        given = {"unit": "LSB", "scale": "0.15 uT", "unloaded": "rows 1..5"} | given
        return self.read(text, **given).remarks[1:]

    def test_a_frozen_sensor(self):
        counts = self.counts(46)
        self.assertEqual(self.remarks(counts), [])
        counts[35:] = counts[35]
        (remark,) = self.remarks(counts)
        self.assertIn("of the lines 37 to 47 are all (", remark)
        few = self.counts(46)
        few[35:40] = few[35]
        self.assertEqual(self.remarks(few), [])

    def test_coarse_counts_are_not_frozen(self):
        for noise in (0.0, 0.1, 0.2, 0.3, 0.5, 1.0):
            for seed in range(20):
                self.assertEqual(self.remarks(self.counts(300, seed, noise)), [], (noise, seed))
        # A logger that is faster than its sensor writes each reading several times.
        repeated = np.repeat(self.counts(100), 10, axis=0)
        self.assertEqual(self.remarks(repeated), [])
        repeated[400:600] = repeated[400]
        self.assertEqual(len(self.remarks(repeated)), 1)

    def test_negative_counts_without_their_sign(self):
        counts = self.counts(46)
        counts[20:] += [400, 220, 0]
        self.assertEqual(self.remarks(counts), [])
        (remark,) = self.remarks(counts % 65536)
        self.assertIn("By jumps between 0 and 65535", remark)
        self.assertEqual(self.remarks(np.abs(counts) + [60000, 0, 0]), [])


if __name__ == "__main__":
    unittest.main()
