# SPDX-License-Identifier: LGPL-2.1-or-later
"""The JSON schema of case files against the shipped cases. Oracle: jsonschema, and what the program says."""

import json
import tempfile
import tomllib
import unittest
from pathlib import Path

try:
    import jsonschema
except ImportError:
    jsonschema = None

from ciliaval import program

SOURCE = Path(__file__).resolve().parents[2]
CASES = sorted(
    file
    for file in (SOURCE / "cases").rglob("*.toml")
    if not file.name.endswith((".study.toml", ".sense.toml"))
)


@unittest.skipUnless(jsonschema, "needs python3-jsonschema")
class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        schema = json.loads(program.call("schema"))
        jsonschema.Draft7Validator.check_schema(schema)
        cls.validator = jsonschema.Draft7Validator(schema)

    def faults(self, text):
        """Faults by the schema, and True if the program finds one."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "case.toml"
            file.write_text(text)
            try:
                program.call("validate", file)
                refused = False
            except Exception:
                refused = True
        return [error.message for error in self.validator.iter_errors(tomllib.loads(text))], refused

    def test_knows_the_shipped_cases(self):
        self.assertGreater(len(CASES), 8)
        for file in CASES:
            with self.subTest(file.name):
                self.validator.validate(tomllib.loads(file.read_text()))

    def test_knows_new_cases_and_cases_with_every_default(self):
        with tempfile.TemporaryDirectory() as folder:
            for load in ("contact", "flow", "section", "dead", "probe", "environment", "sweep"):
                name = Path(folder) / load
                program.call("new", name, "--load", load)
                text = name.with_suffix(".toml").read_text()
                self.assertEqual(self.faults(text), ([], False))
            program.call("run", name.with_suffix(".toml"), "-o", folder)
            written = (Path(folder) / "sweep" / "case.toml").read_text()
            self.validator.validate(tomllib.loads(written))

    def test_finds_what_the_program_refuses(self):
        good = (SOURCE / "cases/paper/fig3b.toml").read_text()
        self.assertEqual(self.faults(good), ([], False))
        for old, new in {
            'length = "3 mm"': 'lenght = "3 mm"',
            'height = "16 mm"': 'arclength = "16 mm"',  # of another type of load
            'diameter = "3 mm"': "diameter = 3",
            'azimuth = "30 deg"': 'azimuth = "deg"',
            "poisson_ratio = 0.49": "poisson_ratio = 0.5",
            'type = "contact"': 'type = "contakt"',
            '"elastica", "beam"': '"elastica", "bean"',
            "[sensor]": "[senser]",
            'position = ["-0.1 mm", ': "position = [",
            "[models]": "[models.beam]\ndegree = 0\n[models]",
        }.items():
            with self.subTest(new):
                self.assertIn(old, good)
                messages, refused = self.faults(good.replace(old, new, 1))
                self.assertTrue(refused)
                self.assertTrue(messages)


if __name__ == "__main__":
    unittest.main()
