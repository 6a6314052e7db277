# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables, files and tolerances of studies, and the command. Oracles: derivatives by hand, random cilia,
numbers that are made up. Optima: test_optimum.py."""

import csv
import io
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

from ciliaval import InputError
from ciliaval._core import StudyFile, StudyStore
from ciliaval.design import summary, tolerances
from ciliaval.design.summary import Result, results_of

CASE = """[case]
name = "one"
title = "A test"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[load]
type = "contact"
force = "1 mN"
height = "16 mm"
azimuth = "30 deg"
[sensor]
position = ["-0.1 mm", "-0.1 mm", "-1.6 mm"]
[models]
mechanics = ["elastica"]
"""

LINE = 'pairs = ["elastica/line"]\n'
RANGE = '[optimise]\nmaximise = "dB_norm"\nat_least.range = "2 mN"\n'
ONE_SEARCH = "global_evaluations = 0\nstarts = 1\n"


def parameter(path, start, end, more=""):
    return f'[[parameter]]\npath = "{path}"\nfrom = {start}\nto = {end}\n{more}'


DIAMETER = parameter("cilium.diameter", '"1 mm"', '"5 mm"')
MODULI = parameter(
    "cilium.segment.base.young_modulus", '"0.1 MPa"', '"1 MPa"', 'name = "E1"\ncount = 5\nspacing = "logarithmic"\n'
)


def write_study(folder, header, rest, case=CASE):
    Path(folder, "one.toml").write_text(case)
    file = Path(folder, "varied.study.toml")
    file.write_text(f'[study]\nname = "varied"\ncase = "one.toml"\n{header}\n{rest}')
    return file


def study_of(header, rest):
    with tempfile.TemporaryDirectory() as folder:
        return StudyFile(str(write_study(folder, header, rest)))


def swept(study):
    return results_of(StudyStore(study, None).run())


LENGTHS = parameter("cilium.segment.magnet.proportion", 0.1, 0.9, 'name = "L2/L0"\ncount = 17\n')


def made_up(rest, f, header='pairs = ["elastica/line"]\noutputs = ["dB_norm"]\ntitle = "A title"\n'):
    """A study of |dB| with values from a function of the first parameter; it slips off where that is None."""
    study = study_of(header, rest)
    points = []
    for i in range(study.point_count):
        value = f(study.values_at(i)[0])
        result = Result("converged", "", [value])
        if value is None:
            result = Result("slipped_off", 'the contact slips off: "far", too', [None])
        points.append([result] * len(study.pairs))
    return study, points


class Summary(unittest.TestCase):
    def test_csv_has_a_line_for_each_point_and_pair_with_units_and_quotes(self):
        study, points = made_up(
            '[[parameter]]\npath = "cilium.diameter"\nvalues = ["3 mm", "1 mm"]\n',
            lambda d: 0.1 if d > 0.002 else None,
            'pairs = ["elastica/line", "beam/line"]\noutputs = ["dB_norm"]\n',
        )
        self.assertEqual(
            summary.study_csv(study, points),
            "point,cilium.diameter,pair,status,dB_norm,message\n"
            "# units: cilium.diameter m, dB_norm T\n"
            "0,0.003,elastica/line,converged,0.1,\n"
            "0,0.003,beam/line,converged,0.1,\n"
            '1,0.001,elastica/line,slipped_off,,"the contact slips off: ""far"", too"\n'
            '1,0.001,beam/line,slipped_off,,"the contact slips off: ""far"", too"\n',
        )

    def test_csv_gives_numbers_back_and_spreadsheets_no_formula(self):
        row = [1e-5, -0.0, 3.0, 1e22, 0.1 + 0.2, None, "=1+1", "-1e-3", "+x", "a\x1b\nb", "π,\x9b"]
        text = summary.csv_text([["name"] * len(row), row], "x\x07")
        head, comment, rest = text.split("\n", 2)
        self.assertEqual(comment, "# x\\x07")
        (cells,) = csv.reader(io.StringIO(rest))
        self.assertEqual(cells[:6], ["1e-05", "0", "3", "1e+22", "0.30000000000000004", ""])
        self.assertEqual(cells[6:], ["'=1+1", "-1e-3", "'+x", "a\\x1B\nb", "π,\\xC2\\x9B"])

    def test_json_gives_back_every_number(self):
        study, points = made_up(LENGTHS, lambda x: None if x > 0.85 else math.exp(-x) / 3)
        made = {"version": "1", "git": "abc", "libraries": {}, "command": "the command", "date": "the date"}
        text = json.dumps(summary.study_json(study, points, made))
        document = json.loads(text)
        self.assertEqual(document["outputs"], [{"id": "dB_norm", "unit": "T"}])
        self.assertEqual(len(document["points"]), 17)
        for i, point in enumerate(document["points"]):
            x = point["parameters"]["cilium.segment.magnet.proportion"]
            self.assertEqual([x], study.values_at(i))
            pair = point["pairs"]["elastica/line"]
            expected = (None, "slipped_off") if x > 0.85 else (math.exp(-x) / 3, "converged")
            self.assertEqual((pair["dB_norm"], pair["status"]), expected)
        self.assertNotRegex(text, "the command|the date")  # nothing that differs from call to call

    def test_the_table_is_thinned_and_tells_what_slipped_off(self):
        many = parameter("cilium.diameter", '"1 mm"', '"5 mm"', "count = 401\n")
        text = summary.text(*made_up(many, lambda d: None if d < 0.00105 else d))
        self.assertLess(text.count("\n"), 40)
        for words in (
            "401 points, 25 of them below, 376 left out",
            "      1  slipped_off\n",
            "      5         5000\n",
            "slipped_off at 5 of 401 points, first at diameter = 1 mm",
        ):
            self.assertIn(words, text)

    def test_the_table_of_zipped_parameters_is_thinned_too(self):
        many = parameter("cilium.diameter", '"1 mm"', '"5 mm"', "count = 51\n")
        many += parameter("load.azimuth", '"0 deg"', '"50 deg"', "count = 51\n")
        study, points = made_up(many, lambda d: d, LINE + 'outputs = ["dB_norm"]\ncombine = "zip"\n')
        text = summary.text(study, points)
        self.assertIn("51 points, 25 of them below, 26 left out", text)
        self.assertIn("\n             1             0      1000\n", text)
        self.assertIn("\n             5            50      5000\n", text)

    # The table of 41 x 7 points leaves out points between whole values of the parameters: the rows form a grid.
    def test_the_table_of_two_parameters_has_whole_values(self):
        two = parameter("cilium.diameter", '"1 mm"', '"5 mm"', "count = 41\n")
        two += parameter("load.azimuth", '"0 deg"', '"60 deg"', "count = 7\n")
        text = summary.text(*made_up(two, lambda d: d))
        self.assertIn("287 points, 25 of them below, 262 left out", text)
        rows = {}  # azimuths of each diameter
        for diameter, azimuth, _ in re.findall(r"^ +(\S+) +(\S+) +(\S+)$", text.partition("|dB|")[2], re.M):
            rows.setdefault(diameter, []).append(azimuth)
        self.assertEqual(list(rows.values()), [["0", "10", "30", "40", "60"]] * 5)


TOLERANCES = """[tolerances]
load.force = "0.1 mN"
sensor.position.x = "10 mm"
cilium.diameter = "2 %"
"""


def of_formulas(header, rest, largest=1.0):
    """B = 2.5e5 T/N² F² (1 + x/m)³ e_x of a model that fails above a force."""
    study = study_of(header, rest)

    def result(force, x):
        if force > largest:
            return Result("failed", "too much", [None] * len(study.outputs))
        B = 2.5e5 * force**2 * (1 + x) ** 3
        values = {"B_x": B, "dB_x": B, "dB_norm": B}
        return Result("converged", "", [values.get(o.id, 0.0) for o in study.outputs])

    points = [[result(study.values_at(i)[0], -1e-4)] for i in range(study.point_count)]
    force, x = 1e-3, -1e-4
    points.append([result(force, x)])
    for t in study.tolerances:
        for steps in (-2, -1, 1, 2):
            moved = {"load.force": force, "sensor.position.x": x, "cilium.diameter": 0.0}
            moved[t.path] += steps * t.deviation / 4
            points.append([result(moved["load.force"], moved["sensor.position.x"])])
    return study, points


class Tolerances(unittest.TestCase):
    # Oracle: the derivatives by hand. The differences are exact for cubics.
    def test_are_first_order_slopes_and_their_root_sum_of_squares(self):
        study, points = of_formulas(LINE + 'outputs = ["B_x", "dB_norm", "dB_y"]\n', TOLERANCES)
        self.assertEqual(study.point_count, 0)
        self.assertEqual(len(points), study.all_points)
        self.assertEqual([t.path for t in study.tolerances], ["cilium.diameter", "load.force", "sensor.position.x"])
        x = 1 - 1e-4
        for i, output in enumerate(study.outputs):
            found = tolerances.propagate(study, points, 0, i)
            if output.id == "dB_y":
                self.assertEqual(found.deviation, 0)
                continue
            self.assertAlmostEqual(found.nominal, 0.25 * x**3, 12)
            slopes = [share.slope for share in found.shares]
            np.testing.assert_allclose(slopes, [0, 500 * x**3, 0.75 * x**2], atol=1e-7)
            self.assertAlmostEqual(found.shares[1].spread, 500 * x**3 * 1e-4, 10)
            # D(h) − f' = f''' h²/6 of the cubic, h = σ/4.
            self.assertAlmostEqual(found.shares[2].error, 1.5 * 0.0025**2 / 6, 9)
            self.assertAlmostEqual(found.deviation, math.hypot(0.05 * x**3, 0.0075 * x**2), 9)

    # The compiled module's points are those that propagate() takes them for.
    def test_move_each_number_by_half_of_its_deviation_to_both_sides(self):
        study = study_of(LINE, '[fixed]\ncilium.diameter = "2 mm"\n' + TOLERANCES)
        self.assertAlmostEqual(study.tolerances[0].nominal, 0.002)
        self.assertAlmostEqual(study.tolerances[0].deviation, 4e-5)
        self.assertEqual(study.all_points, 1 + 4 * 3)
        names = [study.describe(i) for i in range(study.all_points)]
        self.assertEqual(names[0], "nominal")
        self.assertEqual(names[1:5], [f"cilium.diameter = {d} m" for d in (0.00198, 0.00199, 0.00201, 0.00202)])
        self.assertAlmostEqual(float(names[6].removeprefix("load.force = ").removesuffix(" N")), 0.975e-3, 15)
        with self.assertRaises(InputError):
            study.describe(13)

    def test_stand_behind_the_sweep(self):
        study, points = of_formulas(
            LINE, TOLERANCES + '[[parameter]]\npath = "load.force"\nvalues = ["2 mN", "3 mN"]\n'
        )
        self.assertEqual((study.point_count, len(points)), (2, 2 + 13))
        entry = tolerances.tolerance_json(study, points)["pairs"]["elastica/line"]["dB_x"]
        self.assertAlmostEqual(entry["nominal"], 0.25, 3)
        self.assertEqual(len(entry["slopes"]), 3)
        self.assertIn("force(", summary.text(study, points))

    def test_what_fails_leaves_a_gap_and_no_sum(self):
        study, points = of_formulas(LINE, TOLERANCES, 1.01e-3)
        found = tolerances.propagate(study, points, 0, 0)
        self.assertIsNotNone(found.nominal)
        self.assertIsNotNone(found.shares[0].slope)
        self.assertIsNone(found.shares[1].slope)
        self.assertIsNone(found.deviation)
        self.assertRegex(tolerances.tolerance_text(study, points), r"all together .* -")
        self.assertIn("load.force,N,0.001,0.0001,,,\n", tolerances.tolerance_csv(study, points))
        self.assertIn("failed: too much", tolerances.tolerance_text(*of_formulas(LINE, TOLERANCES, 1e-5)))

    # Oracle: the standard deviation of 4,000 random cilia, all numbers normally distributed. Its own
    # relative error is 1/√8000 = 1.1 %; second-order terms of the tolerances are below 1 %.
    def test_agree_with_random_cilia(self):
        deviations = """[tolerances]
cilium.diameter = "1 %"
cilium.segment.base.young_modulus = "3 %"
cilium.segment.magnet.magnetization = "2 %"
load.azimuth = "1 deg"
sensor.position.x = "0.05 mm"
sensor.position.z = "0.05 mm"
"""
        header = LINE + 'outputs = ["dB_x", "dB_norm"]\n'
        study = study_of(header, deviations)
        points = swept(study)
        normal = random.Random(20261122)
        cilia = ""
        for t in study.tolerances:
            values = [f"{t.nominal + t.deviation * normal.gauss(0, 1)!r} {t.unit}" for _ in range(4000)]
            cilia += f'[[parameter]]\npath = "{t.path}"\nvalues = {json.dumps(values)}\n'
        samples = np.array([pairs[0].values for pairs in swept(study_of(header + 'combine = "zip"\n', cilia))])
        for i in range(2):
            found = tolerances.propagate(study, points, 0, i)
            sigma = samples[:, i].std(ddof=1)
            self.assertAlmostEqual(found.deviation, sigma, delta=0.04 * sigma)
            for share in found.shares:
                self.assertLess(share.error, 1e-2 * abs(share.slope) + 1e-12)


    def test_faults_are_said_with_their_place(self):
        def fault(lines):
            try:
                study_of(LINE, "[tolerances]\n" + lines)
            except InputError as error:
                return str(error).partition("varied")[2]
            return ""

        for lines, words in (
            ('cilium.diametr = "1 %"\n', "did you mean 'cilium.diameter'?"),
            ('cilium.diameter = "1 MPa"\n', "length"),
            ('cilium.diameter = "0 mm"\n', "is positive"),
            ('cilium.diameter = "0 %"\n', "a percentage is positive"),
            ('cilium.diameter = "-1 %"\n', "a percentage is positive"),
            ("cilium.diameter = 3\n", "has no unit"),
            ('cilium.segment.base.magnetization = "5 %"\n', "not zero"),
            ('cilium.segment.base.poisson_ratio = "10 %"\n', "moved by half of its tolerance is 0.51"),
            ('models.beam.degree = "10 %"\n', "is a whole number"),
        ):
            said = fault(lines)
            self.assertTrue(said.startswith(".study.toml:7:"), said)
            self.assertIn(words, said)
        self.assertEqual(fault('cilium.segment.base.poisson_ratio = "1 %"\ncilium.diameter = "5%"\n'), "")
        # Right by itself, not with the height of the contact.
        self.assertIn("the contact height", fault('cilium.length = "10 mm"\n'))


class Command(unittest.TestCase):
    """python3 -m ciliaval.design, which `ciliaval study` runs."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.out = self.folder / "results" / "varied"

    def call(self, *arguments, **environment):
        words = [sys.executable, "-m", "ciliaval.design", "varied.study.toml", *arguments]
        variables = {**os.environ, **environment}
        return subprocess.run(words, cwd=self.folder, capture_output=True, text=True, env=variables)

    def document(self):
        return json.loads((self.out / "study.json").read_text())

    def test_a_second_call_solves_nothing_and_says_the_same(self):
        write_study(self.folder, LINE, MODULI)
        first = self.call("--quiet", "--json", "again.json")
        self.assertEqual((first.returncode, first.stderr), (0, ""))
        self.assertIn("E1(MPa)", first.stdout)
        self.assertTrue(first.stdout.endswith("\n\nResults: results/varied\n"), first.stdout)
        names = ["dB_norm.svg", "dB_x.svg", "dB_y.svg", "dB_z.svg", "points.sqlite", "study.csv", "study.json"]
        self.assertEqual(sorted(file.name for file in self.out.iterdir()), names)
        before = {name: (self.out / name).read_bytes() for name in names}
        self.assertEqual((self.folder / "again.json").read_bytes(), before["study.json"])
        (self.out / ".dB_x.4711.0.tmp.svg").write_text("half a figure")
        second = self.call()
        self.assertEqual((second.returncode, second.stdout), (0, first.stdout))
        self.assertEqual(
            second.stderr, 'ciliaval: study "varied": 5 of 5 solutions are there already; --fresh starts anew\n'
        )
        self.assertEqual({file.name: file.read_bytes() for file in self.out.iterdir()}, before)
        fresh = self.call("--fresh", "--quiet")
        self.assertEqual((fresh.returncode, fresh.stderr), (0, ""))
        self.assertEqual((self.out / "study.json").read_bytes(), before["study.json"])

    def test_tolerances_alone_are_a_study(self):
        write_study(self.folder, LINE, '[tolerances]\nload.force = "1 %"\n')
        study = self.call()
        self.assertEqual((study.returncode, study.stderr), (0, ""))
        self.assertIn("all together", study.stdout)
        self.assertFalse((self.out / "study.csv").exists())
        self.assertIn(
            "\nelastica/line,dB_x,T,load.force,N,0.001,1e-05,", (self.out / "tolerances.csv").read_text()
        )
        self.assertGreater(self.document()["tolerances"]["pairs"]["elastica/line"]["dB_x"]["deviation"], 0)

    # Oracle: the sweep of one point, the design that was found.
    def test_an_optimum_is_the_sweeps_point_of_its_design(self):
        header = 'pairs = ["elastica/volume", "beam/line"]\noutputs = ["dB_norm", "range"]\n'

        def search(limit):
            write_study(self.folder, header, RANGE.replace("2 mN", limit) + ONE_SEARCH + DIAMETER)
            return self.call("--fresh", "--quiet")

        study = search("2 mN")
        self.assertEqual((study.returncode, study.stderr), (0, ""))
        self.assertTrue((self.out / "optimum.csv").exists())
        self.assertFalse((self.out / "study.csv").exists())
        again = self.call()
        self.assertEqual(again.stdout, study.stdout)
        self.assertIn("evaluations are there already", again.stderr)
        design = self.document()["optimum"]["designs"][1]
        for pair in design["pairs"].values():
            del pair["limits"]
        diameter = design["parameters"]["cilium.diameter"]
        point = f'[[parameter]]\npath = "cilium.diameter"\nvalues = ["{diameter!r} m"]\n'
        write_study(self.folder, header + "model_uncertainty = true\n", point)
        self.assertEqual(self.call().returncode, 4)  # the folder is another study's
        self.assertEqual(self.call("--fresh").returncode, 0)
        self.assertEqual(self.document()["points"][0]["pairs"], design["pairs"])
        none = search("1 N")
        self.assertEqual(none.returncode, 5, none.stderr)
        self.assertIn("No design was found", none.stdout)

    def test_every_point_failed_is_exit_code_3(self):
        models = 'mechanics = ["beam"]\n[models.beam]\nmax_iterations = 2\nmax_cutbacks = 0\n'
        case = CASE.replace('"1 mN"', '"2 mN"').replace('mechanics = ["elastica"]\n', models)
        write_study(self.folder, 'pairs = ["beam/line"]\n', MODULI, case)
        study = self.call()
        self.assertEqual(study.returncode, 3, study.stderr)
        self.assertIn("beam/line: failed at 5 of 5 points", study.stdout)
        self.assertTrue((self.out / "study.csv").exists())
        write_study(self.folder, 'pairs = ["beam/line"]\n', RANGE + ONE_SEARCH + DIAMETER, case)
        self.assertEqual(self.call("--fresh").returncode, 3)

    def test_what_cannot_be_done_has_its_exit_code_and_message(self):
        def fails(code, words, *arguments, **environment):
            called = self.call(*arguments, **environment)
            self.assertEqual(called.returncode, code, called.stderr)
            self.assertIn(words, called.stderr)
            return called

        write_study(self.folder, LINE, MODULI)
        fails(4, "one.toml", "-o", "one.toml")
        fails(4, "none/x.json", "--json", "none/x.json")
        fails(2, "would be overwritten", "--json", "one.toml")
        self.assertEqual(self.call().returncode, 0)
        fails(2, "would be overwritten", "--json", "results/varied/points.sqlite")
        full = fails(4, "/dev/full", "--json", "/dev/full")
        self.assertIn("Results: results/varied", full.stdout)
        self.assertTrue(Path("/dev/full").is_char_device())
        words = [sys.executable, "-m", "ciliaval.design", "varied.study.toml"]
        with open("/dev/full", "w") as out:
            called = subprocess.run(words, cwd=self.folder, stdout=out, stderr=subprocess.PIPE)
        self.assertEqual((called.returncode, b"standard output" in called.stderr), (4, True))
        self.assertIn('"points"', self.call("--json", "/dev/stdout").stdout)
        write_study(self.folder, LINE + "x = 1\n", MODULI)
        fails(2, "varied.study.toml:5:1: unknown key 'x'", "-o", "elsewhere")
        self.assertFalse((self.folder / "elsewhere").exists())

    def test_without_matplotlib_the_rest_is_written(self):
        write_study(self.folder, LINE, MODULI)
        (self.folder / "matplotlib.py").write_text("raise ImportError('no figures here')")
        path = f"{self.folder}:{os.environ.get('PYTHONPATH', '')}"
        study = self.call(PYTHONPATH=path)
        self.assertEqual(study.returncode, 0, study.stderr)
        self.assertIn("ciliaval: the study is without its figures: ImportError: no figures here", study.stderr)
        self.assertTrue((self.out / "study.csv").exists())

    def test_a_name_does_not_command_the_terminal(self):
        write_study(self.folder, LINE, MODULI)
        for name, shown in (("a\x1bb", "a\\x1Bb"), (os.fsdecode(b"a\xffb"), "a\\xFFb")):
            called = self.call("-o", name)
            self.assertEqual(called.returncode, 0, called.stderr)
            self.assertTrue(called.stdout.endswith(f"Results: {shown}/varied\n"), called.stdout)
            self.assertTrue(Path(self.folder, name, "varied", "dB_x.svg").exists())

    def test_a_table_is_as_wide_as_the_terminal(self):
        study, points = made_up(LENGTHS, lambda x: x, LINE + 'outputs = ["dB_norm", "dB_x"]\n')
        points = [[Result(r.status, r.message, r.values * 2) for r in pairs] for pairs in points]
        self.assertRegex(summary.text(study, points), r"\n  L2/L0  .*\|dB\|\(uT\)\n")
        self.assertEqual(summary.text(study, points, 20).count("\n  L2/L0  "), 2)


if __name__ == "__main__":
    unittest.main()
