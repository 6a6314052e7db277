# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading result files, and the program's commands as functions."""

import json
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

import ciliaval as cv
from ciliaval import program, results

SOURCE = Path(__file__).resolve().parents[2]


def quick(name):
    """A shipped case by the quick models."""
    text = (SOURCE / f"cases/paper/{name}.toml").read_text()
    text = re.sub(r"mechanics = .*", 'mechanics = ["elastica", "beam"]', text)
    return re.sub(r"fields = .*", 'fields = ["dipole", "volume"]', text)


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.case = cls.folder / "case.toml"
        cls.case.write_text(quick("fig3b"))
        cls.result = program.run(cls.case, cls.folder)

    def test_are_arrays_by_step(self):
        result = cv.load(self.folder / "fig3b")
        self.assertEqual(result.models, ["elastica", "beam"])
        self.assertEqual(result.tip("beam").shape, (4, 3))
        self.assertEqual(result.dB("beam/volume").shape, (4, 1, 3))
        self.assertEqual(result.dB_uncertainty("beam/dipole").shape, (4, 1, 3))
        np.testing.assert_array_equal(result.load("force"), [1e-3, 2e-3, 3e-3, 4e-3])
        self.assertEqual(result.status("elastica"), ["converged"] * 4)
        line = result.centreline("beam", 3)
        tip = [line[axis][-1] for axis in "xyz"]
        np.testing.assert_array_equal(tip, result.tip("beam")[3])

    def test_are_those_of_a_run_in_this_process(self):
        here = cv.Case(self.case).run()
        np.testing.assert_array_equal(here.tip("beam"), self.result.tip("beam"))
        np.testing.assert_array_equal(here.dB("elastica/volume"), self.result.dB("elastica/volume"))
        self.assertEqual(here.comparisons, self.result.comparisons)

    def test_have_a_band_with_its_parts(self):
        """The tip of the plain beam against the corrected one by hand; inputs by hand; their covariance."""
        name = "cilium.segment.base.young_modulus"
        text = quick("fig3b") + f'[[input_uncertainty]]\nnumber = "{name}"\nuncertainty = "3 %"\n'
        case = cv.Case.from_text(text)
        result = case.run()
        better = cv.bend(case.cilium, case.loads, "beam", joints="corrected")
        apart = np.linalg.norm(result.tip("beam") - [shape.tip for shape in better], axis=1)
        # The solid's kernel of w = 0.5 mm has this standard deviation.
        height, sigma = case.loads[0].parameters["height"], 0.5e-3 * np.sqrt(1 / 3 - 2 / np.pi**2)
        moved = [
            np.array([shape.tip for shape in cv.bend(
                case.cilium, [load.changed(height=height + rise) for load in case.loads], joints="corrected")])
            for rise in (-sigma, 0, sigma)
        ]  # fmt: skip
        width = np.linalg.norm(moved[0] - 2 * moved[1] + moved[2], axis=1) / 2
        by_hand = apart + width + [shape.tip_uncertainty for shape in better]
        np.testing.assert_allclose(result.model_uncertainty("beam"), by_hand, rtol=1e-9)
        low, high = (case.changed({name: 0.1e6 * (1 + sign * 0.003)}) for sign in (-1, 1))
        tips = [np.array([shape.tip for shape in cv.bend(c.cilium, c.loads, "beam")]) for c in (low, high)]
        by_inputs = np.linalg.norm(tips[1] - tips[0], axis=1) / 0.2
        np.testing.assert_allclose(result.input_uncertainty("beam"), by_inputs, rtol=1e-6)
        whole = result.model_uncertainty("beam") + result.tip_uncertainty("beam") + 1.96 * result.input_uncertainty("beam")
        np.testing.assert_allclose(result.band("beam"), whole, rtol=1e-4)
        pair = "elastica/volume"
        self.assertTrue((result.dB_band(pair) > result.dB_model_uncertainty(pair)).all())
        covariance = result.dB_covariance(pair)
        np.testing.assert_allclose(np.sqrt(np.diag(covariance)), result.dB_input_uncertainty(pair).ravel(), rtol=1e-9)
        self.assertEqual(np.linalg.matrix_rank(covariance), 1)  # one input
        self.assertTrue(np.isnan(self.result.input_uncertainty("beam")).all())
        with self.assertRaisesRegex(cv.InputError, "slip_off"):
            result.band("beam", "tip.x")

    def test_are_a_table(self):
        result = self.result
        table = result.table()
        pair = result.pairs[-1]
        dB = table.query("quantity == 'dB' and model == @pair")
        shape = (len(result.steps), len(result.sensors), 3)
        np.testing.assert_array_equal(dB["value"].to_numpy().reshape(shape), result.dB(pair))
        np.testing.assert_array_equal(dB["band"].to_numpy().reshape(shape), result.dB_band(pair))
        np.testing.assert_array_equal(dB["uncertainty"].to_numpy().reshape(shape), result.dB_uncertainty(pair))
        model = result.models[0]
        tip = table.query("quantity == 'tip' and model == @model")
        np.testing.assert_array_equal(tip["value"].to_numpy().reshape(-1, 3), result.tip(model))
        self.assertEqual(list(tip["component"][:3]), ["x", "y", "z"])
        self.assertEqual(set(table["unit"]), {"m", "rad", "N", "T"})

    def test_have_verdicts_and_intervals(self):
        (tip,) = self.result.compare(quantity="tip", statistic="value", step=3, model="elastica")
        deflection = np.linalg.norm(self.result.tip("elastica")[3] - self.result.tip("beam")[3])
        self.assertAlmostEqual(tip.difference, deflection, 15)
        self.assertEqual(tip.verdict, "resolved")
        low, high = tip.interval
        self.assertTrue(0 < low < tip.difference < high)

    def test_name_what_there_is(self):
        for wrong, text in [
            (lambda: self.result.tip("solid"), "elastica, beam"),
            (lambda: self.result.B("beam/mesh"), "beam/volume"),
            (lambda: self.result.load("forze"), "force, height, azimuth"),
            (lambda: self.result.contact("beam", "normal"), "but none"),
            (lambda: self.result.sensor("east"), "has no sensor 'east', but 0"),
            (lambda: cv.plot.signal(self.result, "east"), "has no sensor 'east'"),
        ]:
            with self.assertRaisesRegex(cv.InputError, text):
                wrong()
        with self.assertRaisesRegex(TypeError, "colour"):
            self.result.compare(colour=1)

    def test_are_filtered_by_the_words_of_the_documentation(self):
        text = (SOURCE / "docs/guide/results.md").read_text()
        words = re.findall(r"^- `([a-z ]+)`: ", text.split("**Verdict.**")[1].split("\n\n")[1], re.M)
        self.assertEqual(len(words), 3)
        summary = json.loads((self.folder / "fig3b" / "summary.json").read_text())
        summary["comparisons"][0]["verdict"] = words[1]
        result = results.Result(summary)
        found = {word: result.compare(verdict=word) for word in words}
        self.assertEqual(sum(map(len, found.values())), len(result.comparisons))
        self.assertEqual(found["below uncertainty"], [result.comparisons[0]])
        self.assertEqual(result.compare(verdict="below_uncertainty"), found["below uncertainty"])
        for wrong, valid in [
            ({"verdict": "unresolved"}, "'below uncertainty', 'inconclusive'"),
            ({"model": "solid"}, "'elastica', 'beam', 'elastica/dipole'"),
            ({"quantity": "tips"}, "'tip', 'tip_angle'"),
            ({"statistic": "max"}, "'maximum'"),
            ({"step": 4}, "2, 3"),
            ({"sensor": -1}, "None, 0"),
        ]:
            with self.subTest(wrong), self.assertRaisesRegex(cv.InputError, valid):
                self.result.compare(**wrong)
        self.assertEqual(self.result.compare(verdict="inconclusive", step=np.int64(0), sensor=0), [])

    def test_of_exactly_zero_are_zero(self):
        """A straight cilium's angle and force are known."""
        summary = json.loads((self.folder / "fig3b" / "summary.json").read_text())
        beam = summary["steps"][0]["mechanics"]["beam"]
        beam.update(tip=[0, 0, 0.02], tip_angle=0, applied_force=0.0, tip_uncertainty=0)
        del summary["steps"][1]["mechanics"]["beam"]["tip_angle"]
        summary["steps"][0]["fields"]["beam/volume"]["dB"] = [[0, 0, 0]]
        zero = results.Result(summary)
        for array in (zero.tip_angle, zero.applied_force, zero.tip_uncertainty):
            self.assertEqual(array("beam")[0], 0)
        self.assertTrue(np.isnan(zero.tip_angle("beam")[1]))
        np.testing.assert_array_equal(zero.dB("beam/volume")[0], [[0, 0, 0]])

    def test_of_a_load_that_slips_off_are_nan(self):
        text = re.sub(r'force = .*', 'force = ["1 mN", "9 mN"]', quick("fig3b"))
        file = self.folder / "off.toml"
        file.write_text(text.replace('name = "fig3b"', 'name = "off"'))
        result = cv.Case(file).run()
        self.assertEqual(result.status("elastica"), ["converged", "slipped_off"])
        self.assertTrue(np.isnan(result.tip("elastica")[1]).all())
        self.assertTrue(np.isnan(result.dB("elastica/volume")[1]).all())

    def test_of_a_sweep_have_its_contact(self):
        text = re.sub("samples = .*", "samples = 11", quick("fig6-surface"))
        file = self.folder / "sweep.toml"
        file.write_text(re.sub('travel = "52 mm".*', 'travel = "5 mm"', text))
        result = program.run(file, self.folder)
        self.assertEqual(result.contact("beam").shape, (11,))
        table = results.read_table(self.folder / "fig6-surface" / "sweep.csv")
        self.assertEqual(len(table["travel"]), 11)
        self.assertEqual(table["beam.state"].dtype.kind, "U")

    def test_that_are_damaged_are_named(self):
        good = (self.folder / "fig3b" / "summary.json").read_text()
        file = self.folder / "bad.json"
        for text, fault in [
            (good[: len(good) // 2], "is damaged"),
            ("[]", "no result"),
            (json.dumps({"schema": 1}), "no result"),
            (json.dumps({"schema": 1, "comparisons": []}), "is damaged"),
        ]:
            file.write_text(text)
            with self.assertRaisesRegex(cv.FileError, f"bad.json.*{fault}"):
                results.read(file)
        with self.assertRaisesRegex(cv.FileError, "No such file"):
            cv.load(self.folder / "nowhere")


class Commands(unittest.TestCase):
    def test_give_the_program_s_documents(self):
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.toml"
            case.write_text(quick("fig3b"))
            budget = cv.budget(case, without=["solid", "potential"])
            self.assertEqual(budget.kind, "budget")
            self.assertTrue(budget["rows"])
            self.assertEqual(cv.converge(case).kind, "converge")
            with self.assertRaisesRegex(cv.InputError, "3 levels of refinement or more, not 2"):
                cv.converge(case, levels=2)

    def test_run_a_study(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "case.toml").write_text(quick("fig3b"))
            study = Path(folder) / "mine.study.toml"
            study.write_text(
                '[study]\nname = "mine"\ncase = "case.toml"\npairs = ["elastica/volume"]\n'
                'outputs = ["dB_norm"]\n[fixed]\nload.force = "1 mN"\n[[parameter]]\n'
                'path = "cilium.segment.base.young_modulus"\nvalues = ["0.1 MPa", "0.2 MPa"]\n'
            )
            document = cv.study(study)
            self.assertEqual(document.kind, "study")
            kept = cv.study(study, folder, fresh=True)
            self.assertEqual(cv.load_study(Path(folder) / "mine")["points"], kept["points"])
            with self.assertRaisesRegex(cv.FileError, "No such file"):
                cv.load_study(folder)
            self.assertEqual(len(document["points"]), 2)

    def test_raise_the_program_s_errors(self):
        with self.assertRaisesRegex(cv.InputError, "no file `no such case`"):
            cv.budget("no such case")


if __name__ == "__main__":
    unittest.main()
