# SPDX-License-Identifier: LGPL-2.1-or-later
"""Models against measurements in Python: what the file says, the figure, the page."""

import json
import re
import tempfile
import tomllib
import unittest
import warnings
from pathlib import Path

import numpy as np

try:
    import jsonschema
except ImportError:
    jsonschema = None
from matplotlib.backends.backend_agg import FigureCanvasAgg

import ciliaval as cv
from ciliaval import plot, program, report
from ciliaval.report import case
from test_results import quick

MEASURED = """
[[measurement]]
quantity = "tip.deflection"
point = ["1.5 mm", "0 mm"]
file = "tip.csv"
source = "camera <1>"

[[measurement]]
quantity = "dB.0.x"
step = 2
value = "1 mT"
uncertainty = "5 %"
source = "Hall sensor"
fitted = true

[[input_uncertainty]]
number = "cilium.segment.base.young_modulus"
uncertainty = "5 %"

[[input_uncertainty]]
number = "load.height"
uncertainty = "0.2 mm"
"""


class Validation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        (folder / "a.toml").write_text(quick("fig3b") + MEASURED)
        (folder / "tip.csv").write_text("value [mm],uncertainty [mm]\n4,0.2\n8,0.2\n11,0.1\n13,0.1\n")
        cls.result = program.run(folder / "a.toml", folder)

    def test_is_that_of_the_file_and_holds_together(self):
        validation = self.result.validation
        self.assertEqual([s.model for s in validation.of(quantity="tip.deflection")], ["elastica", "beam"])
        self.assertEqual(len(validation.of(quantity="dB.0.x")), 4)
        (beam,) = validation.of(model="beam")
        self.assertEqual(beam.point, (1.5e-3, 0.0))
        points = beam.points
        np.testing.assert_allclose([p.measured for p in points], [4e-3, 8e-3, 11e-3, 13e-3])
        errors, variances, rows = [], [], []
        for p in points:
            self.assertAlmostEqual(p.error, p.simulated - p.measured, 15)
            self.assertAlmostEqual(p.u_input, np.linalg.norm(p.contributions), 15)
            self.assertAlmostEqual(p.u_val, np.linalg.norm([p.u_num, p.u_input, p.u_D]), 15)
            self.assertEqual(p.verdict == "bounded", abs(p.error) > 2 * p.u_val)
            self.assertAlmostEqual(p.bound, abs(p.error) + 2 * p.u_val, 15)
            self.assertAlmostEqual(p.least, max(0, abs(p.error) - 2 * p.u_val), 15)
            errors.append(p.error)
            variances.append(p.u_num**2 + p.u_D**2)
            rows.append(p.contributions)
        covariance = np.diag(variances) + np.array(rows) @ np.array(rows).T
        chi = np.array(errors) @ np.linalg.solve(covariance, errors)
        self.assertAlmostEqual(beam.chi_squared / chi, 1, 9)
        self.assertEqual(validation.domain["slenderness"]["from"], 20 / 3)
        with self.assertRaises(TypeError):
            validation.of(modell="beam")

    @unittest.skipUnless(jsonschema, "needs python3-jsonschema")
    def test_is_known_to_the_schema_of_case_files(self):
        validator = jsonschema.Draft7Validator(json.loads(program.call("schema")))
        for text in ((self.folder / "a.toml").read_text(), (self.folder / "fig3b" / "case.toml").read_text()):
            validator.validate(tomllib.loads(text))
        wrong = MEASURED.replace("quantity =", "quantiti =", 1)
        self.assertTrue(list(validator.iter_errors(tomllib.loads(quick("fig3b") + wrong))))

    def test_is_that_of_a_run_in_this_process(self):
        self.assertEqual(cv.Case(self.folder / "a.toml").run().validation.series, self.result.validation.series)

    def test_is_none_without_measurements_and_damage_is_named(self):
        (self.folder / "b.toml").write_text(re.sub("name = .fig3b.", 'name = "b"', quick("fig3b"), count=1))
        self.assertIsNone(program.run(self.folder / "b.toml", self.folder).validation)
        for bad in ({**self.result.summary, "validation": damage} for damage in ([], {"series": [{}]}, "x")):
            (self.folder / "bad.json").write_text(json.dumps(bad))
            with self.assertRaises(cv.FileError):
                cv.load(self.folder / "bad.json")

    def test_a_figure_has_the_measured_points_and_the_models_curves(self):
        for which, quantity in enumerate(["tip.deflection", "dB.0.x"]):
            figure = plot.validation(self.result, which)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                FigureCanvasAgg(figure).draw()
            drawn = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())
            self.assertGreaterEqual(min(drawn.x0, drawn.y0), 0)
            self.assertLessEqual(drawn.x1, figure.get_size_inches()[0])
            series = self.result.validation.of(quantity=quantity)
            names = [text.get_text() for text in figure.legends[0].get_texts()]
            self.assertEqual(set(names), {"measured", *(s.model for s in series)})
        figure = plot.validation(self.result)
        line = next(l for l in figure.axes[0].lines if l.get_label() == "beam")
        (beam,) = self.result.validation.of(model="beam")
        np.testing.assert_allclose(line.get_ydata(), [1e3 * p.simulated for p in beam.points])
        np.testing.assert_allclose(line.get_xdata(), [1, 2, 3, 4])  # mN

    def test_a_page_says_it_and_never_validated(self):
        blocks = case.validation_blocks(self.result)
        text = repr(blocks)
        self.assertIn("Against measurements (ASME V&V 20)", text)
        self.assertIn("tip.deflection, point (1.5, 0) mm of the end", text)
        self.assertIn("fitted to 1 of the 1 values", text)
        self.assertNotIn("validated", text)
        report.write(self.folder / "fig3b")
        html = (self.folder / "fig3b" / "report.html").read_text()
        self.assertIn("Against measurements (ASME V&amp;V 20)", html)
        self.assertNotIn("camera <1>", html)


if __name__ == "__main__":
    unittest.main()
