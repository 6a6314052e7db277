# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/gallery: every script runs, prints finite numbers and makes one picture with something in it."""

import ast
import importlib.util
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from matplotlib.image import imread

GALLERY = Path(__file__).resolve().parents[2] / "docs" / "gallery"
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|nan|inf)\b", re.IGNORECASE)


def numbers(text):
    return [float(n) for n in NUMBER.findall(text)]


class Gallery(unittest.TestCase):
    def test_numbers_are_found_in_a_text_whether_finite_or_not(self):
        found = numbers("tip x = 2.116 mm, dB -3e-5 T, d3, nan uT, best: inf")
        np.testing.assert_array_equal(found, [2.116, -3e-5, math.nan, math.inf])

    def test_has_ten_scripts_with_a_title_and_what_you_see(self):
        scripts = sorted(GALLERY.glob("*.py"))
        self.assertGreaterEqual(len(scripts), 10)
        for script in scripts:
            with self.subTest(script.name):
                words = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8")))
                title, rule, empty, *text = words.split("\n")
                self.assertEqual((len(rule), set(rule), empty), (len(title), {"="}, ""))
                self.assertTrue(text[0].startswith("You see "))
                self.assertGreaterEqual(len(text), 2)


def add(script):
    def test(self):
        if script.stem == "export" and not importlib.util.find_spec("meshio"):
            self.skipTest("meshio is not installed")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, script], cwd=folder, capture_output=True, text=True, check=False,
                env={**os.environ, "MPLBACKEND": "agg"},
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            printed = numbers(done.stdout)
            self.assertTrue(printed, done.stdout)
            self.assertTrue(all(map(math.isfinite, printed)), done.stdout)
            self.assertEqual([p.name for p in Path(folder).iterdir()], [f"{script.stem}.png"])
            pixels = imread(Path(folder, f"{script.stem}.png"))[..., :3]
        # Axes and their texts are grey: what has a colour was drawn from data.
        drawn = np.mean(np.ptp(np.abs(pixels - pixels[0, 0]), axis=2) > 0.05)
        self.assertGreater(drawn, 0.005, "the picture has no colours")

    setattr(Gallery, f"test_{script.stem}", test)


for path in sorted(GALLERY.glob("*.py")):
    add(path)

if __name__ == "__main__":
    unittest.main()
