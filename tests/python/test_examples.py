# SPDX-License-Identifier: LGPL-2.1-or-later
"""The examples in the docstrings, run from the folder of the sources."""

import doctest
import importlib
import inspect
import os
import pkgutil
import unittest
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import ciliaval

SOURCE = Path(__file__).resolve().parents[2]
# Functions that people call: each has an example. (Commands of the program take minutes.)
PUBLIC = ["bend", "bend_batch", "sense", "Case.from_dict", "Case.from_objects", "sensing.invert", "sensing.record",
          "sensing.calibrate", "paper.claims", "plot.setup", "plot.animate"]  # fmt: skip


def modules():
    for found in pkgutil.walk_packages(ciliaval.__path__, "ciliaval."):
        if not found.name.endswith("__main__"):
            yield importlib.import_module(found.name)


class Examples(unittest.TestCase):
    def setUp(self):
        self.addCleanup(os.chdir, Path.cwd())
        os.chdir(SOURCE)

    def test_give_what_they_say(self):
        count = 0
        for module in modules():
            result = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
            self.assertEqual(result.failed, 0, module.__name__)
            count += result.attempted
        # A compiled function, which doctest does not look for.
        example = doctest.DocTestParser().get_doctest(ciliaval.bend_batch.__doc__, {}, "bend_batch", None, 0)
        result = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example)
        self.assertEqual((result.failed, result.attempted), (0, 4))
        self.assertGreater(count, 30)

    def test_are_there_for_what_people_call(self):
        for name in PUBLIC:
            value = ciliaval
            for part in name.split("."):
                value = getattr(value, part)
            self.assertIn(">>> ", inspect.getdoc(value) or "", name)


if __name__ == "__main__":
    unittest.main()
