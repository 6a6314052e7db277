# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files as loggers, spreadsheets and serial monitors write them: each is read with the right numbers, or refused for
a stated reason."""

import tempfile
import unittest
from datetime import datetime, timedelta, timezone
from pathlib import Path

import numpy as np

from ciliaval.errors import InputError
from ciliaval.sensing.columns import Faults, Option
from ciliaval.sensing.loggers import read_table
from ciliaval.sensing.readings import ReadingOptions, read_readings

LOGGERS = Path(__file__).parent / "loggers"
# The oracle of all files: the readings (67.6, -97.5, 2204.9) uT unloaded and (83.3, -98.7, 2203.6) uT loaded; of a
# second sensor (10, 20, 30) uT and (11, 22, 33) uT.
CHANGES = np.array([[15.7e-6, -1.2e-6, -1.3e-6], [1e-6, 2e-6, 3e-6]])
# 30 times the largest error of numbers of 2e-3 T.
ROUNDING = 1e-17
HEADER = "time [s],Bx [uT],By [uT],Bz [uT]\n"
THREE = "Bx [uT];By [uT];Bz [uT]\n"
COMMAS = "Bx [uT],By [uT],Bz [uT]\n"
FIRST_SECOND = "0 s..1 s"


def options(skip=False, **given):
    """As the command line gives them."""
    return ReadingOptions(**{key: Option(text, f"--{key}") for key, text in given.items()}, skip=skip)


def table_of(text, sensors=("0",), skip=False, **given):
    """The table of a text and its faults."""
    faults = Faults()
    data = text if isinstance(text, bytes) else text.encode()
    stated = {key: Option(text, f"--{key}") for key, text in given.items()}
    return read_table(data, sensors, faults, **stated, skip=skip), faults


def message(text, sensors=("0",), **given):
    return table_of(text, sensors, **given)[1].report("log.csv")


class Files(unittest.TestCase):
    """With files in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def read(self, text, sensors=("0",), background=None, skip=False, **given):
        file = self.folder / "log.csv"
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        if background is not None:
            (self.folder / "background.csv").write_text(background)
            background = self.folder / "background.csv"
        return read_readings(file, sensors, options(skip, **given), background)

    def refused(self, what, text, *arguments, **given):
        with self.assertRaises(InputError) as caught:
            self.read(text, *arguments, **given)
        self.assertIn(what, str(caught.exception))
        return str(caught.exception)

    def table(self, text, sensors=("0",), **given):
        """Table of a text without faults."""
        table, faults = table_of(text, sensors, **given)
        self.assertFalse(len(faults), faults.report(text))
        return table

    def assertClose(self, found, expected, within):
        np.testing.assert_allclose(found, expected, rtol=0, atol=within)


class LoggerFiles(Files):
    def test_are_read_with_the_right_numbers(self):
        channels = "bx=Ch 1,by=Ch 2,bz=Ch 3"
        # File, options, sensors, rows of the loaded sample, part of what is said.
        for name, given, sensors, rows, remark in (
            ("house_format.csv", {}, 1, 1, "1 unloaded"),
            ("spreadsheet_decimal_comma.csv", {"unloaded": FIRST_SECOND}, 1, 1, "2 unloaded"),
            ("tabs.tsv", {"unloaded": FIRST_SECOND}, 1, 1, "'Bx_uT', 'By_uT', 'Bz_uT'"),
            ("milligauss.csv", {"unloaded": FIRST_SECOND}, 1, 1, "'X (mG)'"),
            ("lower_case_no_unit.csv", {"unloaded": "rows 1..1", "unit": "uT"}, 1, 1, "'bx' in uT"),
            ("gauss.csv", {"unloaded": "rows 1..1"}, 1, 1, "'B_x [G]'"),
            ("row_of_units.csv", {"unloaded": FIRST_SECOND}, 1, 1, "'Bx' in mT"),
            ("serial_monitor.csv", {"unloaded": "0 s..1 s"}, 1, 1, "2 lines above the header"),
            ("lsb.csv", {"unloaded": "rows 1..1", "scale": "0.1 uT"}, 1, 1, "not read: 'Index'"),
            ("wide_numbers.csv", {"unloaded": FIRST_SECOND, "unit": "uT"}, 2, 1, "'Bz1' in uT"),
            ("wide_prefix.csv", {"unloaded": FIRST_SECOND}, 2, 1, "'s2_Bz [uT]'"),
            ("iso_time.csv", {"unloaded": FIRST_SECOND}, 1, 1, "2 unloaded"),
            (
                "phone_app.csv", {"unloaded": "0..1 s"}, 1, 1,
                "columns not read: 'Absolute field (µT)', 'Temperature (°C)'",
            ),
            ("repeated_rows.csv", {}, 1, 3, "5 rows"),
            ("other_names.csv", {"unloaded": FIRST_SECOND, "unit": "µT", "map": channels}, 1, 1, "'Ch 3' in µT"),
        ):  # fmt: skip
            with self.subTest(name):
                read = read_readings(LOGGERS / name, ["0", "1"][:sensors], options(**given))
                self.assertEqual(read.rows.tolist(), [rows])
                self.assertTrue(read.measured_offset)
                self.assertClose(read.change, CHANGES[None, :sensors], ROUNDING)
                self.assertIn(remark, read.remarks[0])
                self.assertTrue(read.remarks[0].startswith(f"{name}: "))
                self.assertEqual(len(read.remarks), 1)

    def test_are_refused_for_a_stated_reason(self):
        for name, given, sensors, what in (
            ("no_header.csv", {}, 1, "there is no header above the numbers"),
            ("lower_case_no_unit.csv", {}, 1, ":1:1: no unit of 'bx', 'by', 'bz'"),
            ("lower_case_no_unit.csv", {}, 1, "--unit uT"),
            ("gauss.csv", {}, 1, "there is no reading of the unloaded cilium"),
            ("gauss.csv", {"unloaded": FIRST_SECOND}, 1, "there is no column 'time'"),
            (
                "lower_case_no_unit.csv", {"unloaded": FIRST_SECOND, "unit": "uT"}, 1,
                "the column 't' has no unit: write \"t [s]\"",
            ),
            ("lsb.csv", {"unloaded": "rows 1..1"}, 1, '--scale "0.15 uT"'),
            ("other_names.csv", {}, 1, ":1:1: no columns Bx, By, Bz; say which"),
            ("wide_numbers.csv", {"unloaded": FIRST_SECOND, "unit": "uT"}, 1, "does not have"),
            ("house_format.csv", {}, 2, "the case has 2 sensors"),
            ("iso_time.csv", {"unloaded": "5 s..9 s"}, 1, "the times 0 s..2.5 s"),
            ("iso_time.csv", {"unloaded": "0 s..9 s"}, 1, "no reading but of the unloaded"),
            ("gauss.csv", {"unloaded": "rows 1..1", "unit": "mT"}, 1, "'B_x [G]' has two units"),
            ("house_format.csv", {"unloaded": "rows 1..1"}, 1, "leave --unloaded out"),
            ("none.csv", {}, 1, ":1:1: there is no such file"),
        ):  # fmt: skip
            with self.subTest(name), self.assertRaises(InputError) as caught:
                read_readings(LOGGERS / name, ["0", "1"][:sensors], options(**given))
            self.assertIn(what, str(caught.exception))
            self.assertIn(f"{name}:", str(caught.exception))


class Faulty(Files):
    def test_planted_faults_are_refused_with_their_place(self):
        for text, what in (
            (HEADER + "0,1,2,3\n1,1,NaN,3\n", "log.csv:3:5: 'NaN' is not a finite number"),
            (HEADER + "0,1,2,inf\n", "log.csv:2:7: 'inf' is not a finite"),
            (HEADER + "0,1,,3\n", "log.csv:2:5: the cell is empty"),
            (
                HEADER + "0,1,2,3\n1,1,2",
                "log.csv:3:5: the row has 3 cells and the header 4: the last row is cut off; delete it",
            ),
            (HEADER + "0,1,2,3\n1;1;2;3\n", "separated by commas, this row by semicolons?"),
            (HEADER + "0,1,5,2,5,3,5\n", "are there commas in the numbers?"),
            (THREE + "1,5;2;3\n1.5;2;3\n", "log.csv:3:1: '1.5' has a decimal point, line 2 the other"),
            (THREE + "1.5;2;3\n1,5;2;3\n", "log.csv:3:1: '1,5' has a decimal comma, line 2 the other"),
            (THREE + "1.234,5;2;3\n", "log.csv:2:1: '1.234,5'"),
            (COMMAS + '"1,234",2,3\n', "nothing between thousands"),
            ("Bx [uT],By [uT],Bz [uT],Bx [mT]\n1,2,3,4\n", "log.csv:1:25: there is a second column 'Bx'"),
            (HEADER + "0,1,2,3\n" + HEADER + "0,1,2,3\n", "log.csv:3:1: the header is repeated"),
            (
                "Bx [mT],By [mT],Bz [mT]\nuT,uT,uT\n1,2,3\n",
                "log.csv:2:1: the column 'Bx [mT]' has two units: 'mT' by the header, 'uT' by the row of units",
            ),
            (
                "Bx [V],By [V],Bz [V]\n1,2,3\n",
                "log.csv:1:1: the column 'Bx': 'V' is not a unit of a flux density",
            ),
            (HEADER + "0,1,2,3\n2,1,2,3\n1,1,2,3\n", "log.csv:4:1: the time goes back at '1'"),
            (HEADER + "0,1,2,3\nlater,1,2,3\n", "log.csv:3:1: 'later' is no time as in the rows above"),
            (HEADER, "there are no rows below the header"),
            ("", "the file is empty"),
            (b"\xff\xfeB", "UTF-16"),
            ("Bx [T],By [T],Bz [T]\n1,2,300\n", "log.csv:2:1: a field of 300 T"),
            ("Bx By\n1 2\n", "columns are separated by commas, semicolons, tabs, | or blanks"),
            ("Bx [uT],By [uT],dBz [uT]\n1,2,3\n", "must be either Bx, By, Bz"),
            ("Bx [uT],By [uT],U [V]\n1,2,3\n", "there is no column Bz"),
            ("1,2,3\n4,5,6\n" + COMMAS + "1,2,3\n", "log.csv:1:1: there is no header above the numbers '1,2,3'"),
            ("azimuth," + COMMAS + "1,1,2,3\n", "log.csv:1:1: the column 'azimuth' needs the unit of an angle"),
            ("azimuth [mm]," + COMMAS + "1,1,2,3\n", "the column 'azimuth': 'mm' is not a unit of an angle"),
            ("Bx:1.2,By:3.4,Bz:5.6\n" * 2, "log.csv:1:1: each number of 'Bx:1.2,By:3.4,Bz:5.6' has its name"),
            ("Bx [uT],By [uT],Bz [uT]\n1,2,\x00\n", "log.csv:2:5: '\\x00' is not a number"),
        ):  # fmt: skip
            with self.subTest(text):
                self.assertIn(what, message(text))

    def test_of_very_many_faults_the_first_are_listed(self):
        lines = message(HEADER + "0,1,,3\n" * 500).split("\n")
        self.assertEqual(len(lines), 51)
        self.assertEqual(lines[49], "log.csv:51:5: the cell is empty")
        self.assertRegex(lines[50], "^log.csv: [0-9]+ more faults$")

    def test_all_kinds_of_faults_are_reported_at_once(self):
        text = message(HEADER + "0,1,2,3\n1,2\n2,1,x,3\n1,1,2,3\n")
        self.assertEqual([line.split(":")[1] for line in text.split("\n")], ["3", "4", "5"])

    def test_options_with_faults_are_refused_by_name(self):
        good = "Bx,By,Bz\n1,2,3\n"
        for given, what in (
            ({"unit": "mm"}, "--unit: 'mm' is not a unit of a flux density"),
            ({"unit": "LSB", "scale": "5 mm"}, "--scale: "),
            ({"unit": "LSB", "scale": "1 uT, 2 uT"}, "--scale: '1 uT, 2 uT' has 2 parts"),
            ({"unit": "uT", "scale": "5 uT"}, "no column is in LSB: leave --scale out"),
            ({"unit": "uT", "map": "bx"}, "--map: 'bx' is no entry NAME=COLUMN"),
            ({"unit": "uT", "map": "bq=Bx"}, "--map: 'bq=Bx' is no entry"),
            ({"unit": "uT", "map": "bx=Bx,by=By,bz=Bzz"}, "no column 'Bzz', which --map names; did you mean 'Bz'?"),
            ({"unit": "uT", "map": "bx=Bx,by=Bx,bz=Bz"}, "--map names the column 'Bx' twice"),
        ):
            with self.subTest(given):
                try:
                    found = message(good, **given)
                except InputError as fault:
                    found = str(fault)
                self.assertIn(what, found)

    def test_unloaded_parts_with_faults_are_refused_by_name(self):
        for option in ("first", "rows 0..1", "rows 2..1", "1 s..0 s", "0 mm..1 mm", "0..1", "rows 1..x", "nan s..1 s"):
            text = self.refused("--unloaded: ", HEADER + "0,1,2,3\n1,2,3,4\n", unloaded=option)
            self.assertIn("rows 1..20", text)

    def test_faults_of_the_unloaded_rows(self):
        change = "sample,dBx [uT],dBy [uT],dBz [uT]\n"
        B = "sample,Bx [uT],By [uT],Bz [uT]\n"
        self.refused("log.csv:2:1: the change dB of the unloaded cilium is zero", change + "unloaded,1,2,3\na,1,2,3\n")
        self.refused("no unloaded reading: leave --unloaded out", change + "a,1,2,3\n", unloaded="model")
        what = 'no row lies in "rows 7..9" of --unloaded: the file has the rows 1..1'
        self.refused(what, B + "a,1,2,3\n", unloaded="rows 7..9")
        self.refused("no reading but of the unloaded cilium", B + "unloaded,1,2,3\n")
        self.refused("log.csv:1:1: there is no reading of the unloaded cilium", B + "a,1,2,3\n")
        model = self.read(B + "a,1,2,3\n", unloaded="model")
        self.assertFalse(model.measured_offset)
        self.assertIsNone(model.unloaded)
        self.assertClose(model.change, [[[1e-6, 2e-6, 3e-6]]], ROUNDING)


class Kinds(Files):
    """Oracle: the numbers in the text."""

    def test_encodings_and_line_ends_do_not_matter(self):
        for text in (
            b"\xef\xbb\xbfBx [\xc2\xb5T],By [\xce\xbcT],Bz [uT]\r\n1,-2,3e0\r\n",
            b"Bx [\xb5T],By [\xb5T],Bz [\xb5T]\n1,-2,3\n",
            b"Bx (\xb5T);By (\xb5T);Bz (\xb5T);\n+1;-2,0;3;\n",
            b"Bx, uT\tBy, uT\tBz, uT\n1\t-2\t3",
        ):
            self.assertClose(self.table(text).B, [[[1e-6, -2e-6, 3e-6]]], 1e-20)

    def test_headers_of_many_kinds_are_known(self):
        for names in (
            "X,Y,Z", "x,y,z", "Bx,By,Bz", "bx,by,bz", "B_x,B_y,B_z", "Mag X,Mag Y,Mag Z", "magX,magY,magZ",
            "X axis,Y axis,Z axis", "mx,my,mz", "Magnetic Field X,Magnetic Field Y,Magnetic Field Z",
            "BX_uT,BY_uT,BZ_uT", "Bx / uT,By / uT,Bz / uT", "x uT,y uT,z uT", "ax,Bx,By,Bz,x,y,z",
            "mag_uT_x,mag_uT_y,mag_uT_z", "mag[0],mag[1],mag[2]", "B(1),B(2),B(3)",
            "mag[0] [uT],mag[1] [uT],mag[2] [uT]", "mag.00,mag.01,mag.02", "BX_UT,BY_UT,BZ_UT",
            "/imu/magnetic_field/x,/imu/magnetic_field/y,/imu/magnetic_field/z",
        ):  # fmt: skip
            cells = "9,1,2,3,7,8,9" if names.startswith("ax") else "1,2,3"
            with self.subTest(names):
                self.assertClose(self.table(f"{names}\n{cells}\n", unit="uT").B, [[[1e-6, 2e-6, 3e-6]]], 1e-20)
        # As numpy.savetxt() and the program's own files have them.
        self.assertEqual(len(self.table("# log of today\n# t,Bx,By,Bz\n0,1,2,3\n", unit="uT").B), 1)
        units = "# units: Bx mT, By mT, Bz mT\n"
        for text in (f"{units}Bx,By,Bz\n1,2,3\n", f"Bx,By,Bz\n{units}1,2,3\n"):
            self.assertClose(self.table(text).B[0, 0, 2], 3e-3, 1e-18)

    def test_units_of_many_spellings_are_known(self):
        def z(unit, scale=""):
            return self.table("Bx,By,Bz\n1,2,3\n", unit=unit, scale=scale).B[0, 0, 2]

        for unit, factor in (
            ("T", 1), ("mT", 1e-3), ("uT", 1e-6), ("µT", 1e-6), ("nT", 1e-9), ("G", 1e-4), ("mG", 1e-7),
            ("Gauss", 1e-4), ("Tesla", 1), ("ut", 1e-6), ("ga", 1e-4),
        ):  # fmt: skip
            self.assertClose(z(unit), 3 * factor, 1e-15 * factor)
        self.assertClose(z("LSB", "0.15 uT"), 0.45e-6, 1e-21)
        self.assertClose(z("counts", "0.15 uT/LSB"), 0.45e-6, 1e-21)
        self.assertClose(z("LSB", "6842 LSB/G"), 3e-4 / 6842, 1e-21)
        self.assertClose(z("raw", "0.15 uT, 0.15 uT, 0.25 uT"), 0.75e-6, 1e-21)

    def test_times_of_many_forms_are_seconds(self):
        for name, first, second, seconds, within in (
            ("Time (s)", "3", "4,5", 4.5, 1e-12), ("t_ms", "3", "1500", 1.5, 1e-12),
            ("micros", "3", "1500000", 1.5, 1e-12), ("Timestamp [s]", "1764065918", "1764065919.5", 1.5, 0),
            ("Timestamp [s]", "1764065918", "1764065920,2", 2.2, 0), ("t [day]", "45979.5", "45979.75", 21600, 0),
            ("time", "2026-11-25T10:18:38+01:00", "2026-11-25T09:18:39.25Z", 1.25, 0),
            ("time", "2024-02-28 23:59:59", "2024-02-29 00:00:00,5", 1.5, 1e-6),
            ("Time", "10:18:38.5", "10:19:00", 21.5, 1e-9), ("date", "2024-02-28", "2024-03-01", 2 * 86400, 1e-6),
            ("time", "2026-11-25 12:00:00+00:00", "2026-11-25 12:00:00.050000+00:00", 0.05, 0),
            ("time", "2026/11/25 12:00:00.123456789", "2026/11/25 12:00:00.1234567896", 1e-9, 0),
            ("t_unix_ns", "1763483234000000000", "1763483234000000001", 1e-9, 0), ("TimeUS", "5", "1500000", 1.5, 0),
            ("Time since start in ms", "5", "1500", 1.5, 0), ("unix_time", "1763483234000", "1763483234050", 0.05, 0),
            ("seconds_elapsed", "0.1", "0.25", 0.25, 0),
            ("time", "1763483234000000000", "1763483234050000000", 0.05, 0),
        ):  # fmt: skip
            with self.subTest(name, second=second):
                table = self.table(f"{name};Bx [uT];By [uT];Bz [uT]\n{first};1;2;3\n{second};1;2;3\n")
                self.assertClose(table.time[1], seconds, within)
        # One that is not known is not read, and is said.
        odd = self.table("time,Bx [uT],By [uT],Bz [uT]\n3 pm,1,2,3\n4 pm,1,2,3\n")
        self.assertIsNone(odd.time)
        self.assertIn("'3 pm' in the column 'time' is no time", odd.timeless)
        self.assertIn("columns not read: 'time'", odd.remark)
        self.assertIsNone(self.table("time,Bx [uT],By [uT],Bz [uT]\n2026-02-30,1,2,3\n").time)

    def test_several_sensors_stand_side_by_side_or_below_each_other(self):
        named = ["left", "right"]
        for names in (
            "left_Bx,left_By,left_Bz,right_Bx,right_By,right_Bz",
            "Bx left,By left,Bz left,Bx right,By right,Bz right",
            "Bx0,By0,Bz0,Bx1,By1,Bz1",
            "B1x,B1y,B1z,B2x,B2y,B2z",
            "Sensor 1: X,Sensor 1: Y,Sensor 1: Z,Sensor 2: X,Sensor 2: Y,Sensor 2: Z",
            "Bx[0],By[0],Bz[0],Bx[1],By[1],Bz[1]",
            "left[0],left[1],left[2],right[0],right[1],right[2]",
            "Bx (left),By (left),Bz (left),Bx (right),By (right),Bz (right)",
        ):
            with self.subTest(names):
                table = self.table(f"{names}\n1,2,3,4,5,6\n", named, unit="uT")
                self.assertClose(table.B, [[[1e-6, 2e-6, 3e-6], [4e-6, 5e-6, 6e-6]]], 1e-20)
        below = self.table("time [s],sensor,x,y,z\n0,right,1,2,3\n0,0,4,5,6\n", named, unit="uT")
        self.assertEqual(below.sensor.tolist(), [1, 0])
        self.assertIn(
            "log.csv:2:1: the sensor 'middle' is none of the case's, left, right",
            message("sensor,x,y,z\nmiddle,1,2,3\n", named, unit="uT"),
        )
        self.assertIn(
            "there is no column Bz of the sensor right", message("Bx0,By0,Bz0,Bx1,By1\n1,2,3,4,5\n", named, unit="uT")
        )

    def test_maps_choose_among_columns(self):
        two = "t,X,Y,Z,Hall 1 [mT],Hall 2,Hall 3 [mT]\n0,7,8,9,1,2,3\n"
        table = self.table(two, map="bx=hall 1, by=Hall 2 [mT], bz=Hall 3 [mT], time=t [ms]")
        self.assertClose(table.B, [[[1e-3, 2e-3, 3e-3]]], 1e-17)
        self.assertEqual(table.time.tolist(), [0])
        turned = self.table("X,Y,Z\n1,2,3\n", unit="uT", map="bx=Y,by=Z,bz=X")
        self.assertClose(turned.B, [[[2e-6, 3e-6, 1e-6]]], 1e-20)


class Field(Files):
    """Kinds that were met in the field. Oracle: the numbers in the text."""

    B = np.array([[1e-6, 2e-6, 3e-6], [4e-6, 5e-6, 6e-6]])

    def check(self, text, step=None, remark="", **given):
        table = self.table(text, **given)
        self.assertClose(table.B[:, 0], self.B, 1e-20)
        if step is not None:
            self.assertEqual(table.time[1] - table.time[0], step)
        self.assertIn(remark, table.remark)
        return table

    def test_px4(self):
        text = (
            "timestamp,magnetometer_ga[0],magnetometer_ga[1],magnetometer_ga[2],n\n123456789,0.01,0.02,0.03,1\n"
            "123506789,0.04,0.05,0.06,1\n"
        )
        table = self.check(text, None, "time from 'timestamp' in us, as PX4 has it")
        self.assertClose(table.time, [123.456789, 123.506789], 1e-12)
        unknown = self.table("timestamp,x,y,z\n123456789,1,2,3\n", unit="uT")
        self.assertIn('--map "time=timestamp [us]"', unknown.timeless)

    def test_date_and_time_in_two_columns_go_over_midnight(self):
        for separator in ",;\t| ":
            text = "Date,Time,X [uT],Y [uT],Z [uT]\n2026-11-25,23:59:59.95,1,2,3\n2026-11-26,00:00:00.0,4,5,6\n"
            self.check(text.replace(",", separator), 0.05)

    def test_ros(self):
        remark = "ROS's message sensor_msgs/MagneticField"
        one = (
            "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.magnetic_field.x,"
            "field.magnetic_field.y,field.magnetic_field.z\n"
        )
        self.check(
            one + "1763483234000000000,0,1763483233997000000,mag,1e-6,2e-6,3e-6\n"
            "1763483234050000001,1,1763483234047000000,mag,4e-6,5e-6,6e-6\n",
            0.050000001, remark,
        )  # fmt: skip
        two = "header.stamp.sec,header.stamp.nanosec,header.frame_id,"
        two += "magnetic_field.x,magnetic_field.y,magnetic_field.z\n"
        rows = "1763483234,950000000,mag,1e-6,2e-6,3e-6\n1763483235,1,mag,4e-6,5e-6,6e-6\n"
        self.check(two + rows, 0.050000001, remark)
        # As bags are written by pandas, with quotes and a time that has no unit.
        bag = two.replace("sec", "secs").replace("nanosecs", "nsecs")
        quoted = "\n".join('"' + line.replace(",", '","') + '"' for line in (bag + rows).splitlines())
        self.check('"Time",' + quoted.replace("\n", '\n"1763483234.95",'), 0.050000001, remark)
        # The user's statement goes before the file's.
        table = self.table(two + rows, unit="uT")
        self.assertClose(table.B[0, 0], [1e-12, 2e-12, 3e-12], 1e-25)

    def test_a_column_states_the_unit(self):
        text = (
            "t_unix_ns,t_utc_iso,t_rel_s,bx,by,bz,units,note\n"
            "1763483234000000000,2025-11-18T16:27:14.000+00:00,0.0,1,2,3,uT,\n"
            "1763483234050000000,2025-11-18T16:27:14.050+00:00,0.05,4,5,6,uT,\n"
        )
        self.check(text, 0.05, "'bx' in uT")
        self.assertIn("has two units: 'uT' by the column 'units', 'mT' by --unit", message(text, unit="mT"))
        self.assertIn("the column 'units' has several units: uT, mT", message(text[: text.rindex("uT")] + "mT,\n"))

    def test_tables_between_blanks_and_bars(self):
        plain = "   time [s]    Bx [uT]   By [uT]   Bz [uT]\n"
        self.check(plain + "      0.0       1.0       2.0       3.0\n     0.05       4.0       5.0       6.0\n", 0.05)
        self.check("t_s Bx By Bz\n0,0 1 2,0 3\n0,05  4 5,0 6\n", 0.05, unit="uT")
        self.check("Time Bx By Bz\n2026-11-25 23:59:59.95 1 2 3\n2026-11-26 00:00:00 4 5 6\n", 0.05, unit="uT")
        bars = "| time [s] | Bx [uT] | By [uT] | Bz [uT] |\n|---|---|---|---|\n"
        self.check(bars + "| 0 | 1 | 2 | 3 |\n| 0.5 | 4 | 5 | 6 |\n", 0.5)
        self.check("# t [s]  Bx [uT]  By [uT]  Bz [uT]\n0.00e+00 1e0 2e0 3e0\n5.00e-01 4e0 5e0 6e0\n", 0.5)
        self.check("% t_s Bx_uT By_uT Bz_uT\n0 1 2 3\n0.5 4 5 6\n", 0.5)
        # A sentence is no header.
        self.check("x and y and z of the magnet\nBx,By,Bz\n1,2,3\n4,5,6\n", unit="uT")

    def test_columns_by_their_numbers(self):
        text = "2024-05-14 11:55:31.950     1.0     2.0   3.0\n2024-05-14 11:55:32.000     4.0   5.0   6.0\n"
        self.assertIn('--map "time=1, bx=3, by=4, bz=5" --unit uT', message(text))
        self.check(text, 0.05, map="time=1, bx=3, by=4, bz=5", unit="uT")
        self.assertIn("no unit of '3', '4', '5'", message(text, map="time=1, bx=3, by=4, bz=5"))
        self.assertIn("there is no column '6', which --map names", message(text, map="bx=3, by=4, bz=6", unit="uT"))
        self.check("0;1;2;3\n50;4;5;6\n", 0.05, map="time=1 [ms], bx=2 [uT], by=3 [uT], bz=4 [uT]")

    def test_labview_and_spreadsheets(self):
        labview = (
            "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\nChannels\t3\nSamples\t2\t2\t2\n"
            "***End_of_Header***\t\nX_Value\tBx [uT]\tBy [uT]\tBz [uT]\tComment\n0\t1\t2\t3\t\n0.05\t4\t5\t6\t\n"
        )
        self.check(labview, 0.05, map="time=X_Value [s]")
        self.check(labview.replace("3\t\n", "3\n").replace("6\t\n", "6\n"), 0.05, map="time=X_Value [s]")
        self.check("sep=;\nZeit;Time;Bx;By;Bz\n;ms;uT;uT;uT\n1;0,0;1,0;2,0;3,0\n2;50,0;4,0;5;6,0\n", 0.05)

    def test_rows_without_B_can_be_left_out(self):
        text = HEADER + "0,1,2,3\n0.1,1.5\nRead error, retrying\n0.2,nan,nan,nan\n0.3,overflow,1,1\n0.4,,,\n"
        text += HEADER + "0.5,4,5,6\n"
        faults = message(text).split("\n")
        self.assertEqual(sorted({int(line.split(":")[1]) for line in faults}), [3, 4, 5, 6, 7, 8])
        self.assertEqual(sum("--skip" in line for line in faults), 1)
        remark = "2 rows, B from 'Bx [uT]', 'By [uT]', 'Bz [uT]'; 6 rows without B left out: lines 3, 4, 5, 6, 7, 8"
        table = self.check(text, 0.5, remark, skip=True)
        self.assertEqual(table.number.tolist(), [1, 8])
        self.assertEqual(table.line.tolist(), [2, 9])
        # Faults other than a lack of B are refused all the same.
        self.assertIn("the time goes back", message(HEADER + "1,1,2,3\n1,,,\n0,1,2,3\n", skip=True))
        self.assertIn("no time as in the rows", message(HEADER + "1,1,2,3\nx,1,2,3\n", skip=True))
        self.assertIn("no rows with B", message(HEADER + "1,,2,3\n", skip=True))

    def test_readings_are_averaged_in_windows_of_time(self):
        text = HEADER + "".join(f"{i / 1000:.3f},{i},0,0\n" for i in range(100))
        read = self.read(text, unloaded="0 s..9 ms", average="10 ms")
        self.assertEqual(read.rows.tolist(), [10] * 9)
        self.assertEqual(read.names[:2], ["0.01 s", "0.02 s"])
        self.assertClose(read.time, np.arange(1, 10) / 100, 1e-15)
        self.assertClose(read.change[:, 0, 0], np.arange(10, 100, 10) * 1e-6, 1e-20)
        self.assertEqual(read.freedom, 10 * 9 * 3)
        self.assertClose(read.squares, 10 * 82.5e-12, 1e-22)
        named = "sample," + HEADER + "unloaded,0,0,0,0\na,0,1,0,0\na,0.4,2,0,0\na,1,3,0,0\nb,1.7,5,0,0\n"
        read = self.read(named, average="0.5 s")
        self.assertEqual(read.names, ["a, 0 s", "a, 1 s", "b, 1.7 s"])
        self.assertEqual(read.rows.tolist(), [2, 1, 1])
        what = "--average is a length of time, but there is no column 'time'"
        self.refused(what, COMMAS + "1,2,3\n", average="1 s", unloaded="model")
        self.refused("--average: ", text, average="1 mm")
        # Sensors that are read one after the other belong together.
        polled = "time [s],sensor,x,y,z\n" + "".join(f"{i / 100},{i % 2},{i},0,0\n" for i in range(8))
        read = self.read(polled, ["0", "1"], unit="uT", unloaded="0 s..0.01 s", average="0.02 s")
        self.assertClose(read.change[:, :, 0], np.array([[2, 2], [4, 4], [6, 6]]) * 1e-6, 1e-20)


def iso(epoch, between, fraction, minutes):
    """ "2025-11-18T16:27:14" with the fraction and the offset from UTC."""
    at = datetime.fromtimestamp(epoch, timezone(timedelta(minutes=minutes)))
    text = at.isoformat(between)
    return text[:19] + fraction + text[19:]


def of_a_double(epoch, h):
    whole, fraction = f"{epoch + h / 100:.9f}".split(".")
    return iso(int(whole), " ", "." + fraction, 0)


# Name, header, text of `h` hundredths of a second after an epoch in whole seconds since 1970, whether the file has the
# time as it was, not as a double held it.
TIME_FORMS = (
    ("Seconds", "time [s]", lambda e, h: f"{e + h // 100}.{h % 100:02}", True),
    ("Milliseconds", "time [ms]", lambda e, h: f"{1000 * e + 10 * h}", True),
    ("MillisecondsWithFraction", "time [ms]", lambda e, h: f"{1000 * e + 10 * h}.000", True),
    ("Microseconds", "time [us]", lambda e, h: f"{10**6 * e + 10**4 * h}", True),
    ("Nanoseconds", "time [ns]", lambda e, h: f"{10**9 * e + 10**7 * h}", True),
    ("SecondsOfADouble", "time [s]", lambda e, h: f"{e + h / 100:.9f}", False),
    ("SecondsOfNumpy", "time [s]", lambda e, h: f"{e + h / 100:.18e}", False),
    ("NanosecondsOfNumpy", "time [ns]", lambda e, h: f"{float(10**9 * e + 10**7 * h):.18e}", False),
    ("IsoWithZone", "time", lambda e, h: iso(e + h // 100, "T", f".{h % 100:02}0", 0), True),
    # str(datetime) has no fraction where it is zero.
    ("IsoOfPython", "time", lambda e, h: iso(e + h // 100, " ", f".{h % 100:02}0000" if h % 100 else "", 0), True),
    ("IsoOfNanoseconds", "time", lambda e, h: iso(e + h // 100, "T", f".{h % 100:02}0000000", 330), True),
    ("IsoWestOfGreenwich", "time", lambda e, h: iso(e + h // 100, "T", f".{h % 100:02}", -150), True),
    ("IsoOfADouble", "time", of_a_double, False),  # as pandas makes it of seconds since 1970
    ("DateAndTime", "Date,Time", lambda e, h: iso(e + h // 100, ",", f".{h % 100:02}", 0)[:22], True),
    ("SecondsAndNanoseconds", "stamp.sec,stamp.nanosec", lambda e, h: f"{e + h // 100},{h % 100 * 10**7}", True),
)


class TimesSince1970(Files):
    def test_a_row_at_the_boundary_of_a_window_belongs_to_it(self):
        # Twenty rows of the straight cilium, 50 ms apart, and a window whose end is the last of them. Oracle: the
        # rows' numbers. The times of the loaded rows are the doubles nearest to what the file has.
        epochs = (100_000_001, 999_999_999, 1_763_483_234, 2_147_483_647, 3_848_765_234, 4_102_444_799)
        for (name, header, text, is_exact), epoch in ((form, epoch) for form in TIME_FORMS for epoch in epochs):
            with self.subTest(name, epoch=epoch):
                rows = (f"{text(epoch, 5 * i)},{'0,0,0' if i < 20 else '9,0,0'}\n" for i in range(30))
                log = f"{header},Bx [uT],By [uT],Bz [uT]\n" + "".join(rows)
                read = self.read(log, unloaded="0 s..0.95 s")
                self.assertIn("; 20 unloaded", read.remarks[0])
                expected = [(100 + 5 * i) / 100 for i in range(10)]
                self.assertClose(read.time, expected, 0 if is_exact else 0.5e-6)
                if is_exact:
                    self.assertEqual(read.names[:2], ["1 s", "1.05 s"])
                self.assertIn("; 19 unloaded", self.read(log, unloaded="0.05 s..0.95 s").remarks[0])
                self.assertIn("; 18 unloaded", self.read(log, unloaded="50 ms..949 ms").remarks[0])
                self.assertEqual(self.read(log, unloaded="0 s..0.95 s", average="0.1 s").rows.tolist(), [2] * 5)


if __name__ == "__main__":
    unittest.main()
