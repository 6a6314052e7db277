# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program's CSV files as NumPy reads them: the names of the columns from the first line."""

import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

from ciliaval import program
from ciliaval.results import read_table

SOURCE = Path(__file__).resolve().parents[2]
QUICK = {"mechanics": '["elastica", "beam"]', "fields": '["line", "volume"]'}


def genfromtxt(file, **options):
    return np.genfromtxt(file, names=True, delimiter=",", **options)


class Csv(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))

    def run_case(self, name, **replaced):
        """The folder of a shipped case, run by quick models."""
        text = (SOURCE / f"cases/paper/{name}.toml").read_text()
        for key, value in (QUICK | replaced).items():
            text = re.sub(rf"^{key} = .*", f"{key} = {value}", text, flags=re.MULTILINE)
        file = self.folder / f"{name}.toml"
        file.write_text(text)
        result = program.run(file, self.folder)
        return result, self.folder / name

    def test_fields_are_those_of_the_summary(self):
        result, folder = self.run_case("fig3b")
        table = genfromtxt(folder / "fields.csv", dtype=None, encoding="utf-8")
        self.assertEqual(
            table.dtype.names,
            ("step", "force", "height", "azimuth", "sensor", "pair", "B_x", "B_y", "B_z", "dB_x")
            + ("dB_y", "dB_z", "uncertainty_x", "uncertainty_y", "uncertainty_z", "band_x", "band_y", "band_z"),
        )
        self.assertEqual(len(table), 4 * 4)
        for pair in result.pairs:
            rows = table[table["pair"] == pair]
            np.testing.assert_array_equal(rows["force"], result.load("force"))
            for i, axis in enumerate("xyz"):
                np.testing.assert_array_equal(rows[f"B_{axis}"], result.B(pair)[:, 0, i])
                np.testing.assert_array_equal(rows[f"dB_{axis}"], result.dB(pair)[:, 0, i])
                both = result.dB_uncertainty(pair)[:, 0, i]
                np.testing.assert_array_equal(rows[f"uncertainty_{axis}"], both)
                np.testing.assert_array_equal(rows[f"band_{axis}"], result.dB_band(pair)[:, 0, i])

    def test_an_unknown_value_is_nan(self):
        _, folder = self.run_case("fig3b", force='["1 mN", "9 mN"]')  # the second slips off
        table = genfromtxt(folder / "fields.csv")
        self.assertEqual(len(table), 2 * 4)
        self.assertTrue(np.all(np.isfinite(table["dB_x"][:4])))
        self.assertTrue(np.all(np.isnan(table["dB_x"][4:])))

    def test_every_file_of_a_run_has_its_names_in_the_first_line(self):
        self.run_case("fig3b")
        _, folder = self.run_case("fig6-surface", samples="14")
        for file in [*folder.glob("*.csv"), *(self.folder / "fig3b").glob("*.csv")]:
            with self.subTest(file.name):
                names = file.read_text().splitlines()[0].split(",")
                self.assertEqual(list(read_table(file)), names)
                table = genfromtxt(file, deletechars="", replace_space=" ")
                self.assertEqual(list(table.dtype.names), names)
                for name, column in read_table(file).items():
                    if column.dtype == float:
                        np.testing.assert_array_equal(table[name], column)


if __name__ == "__main__":
    unittest.main()
