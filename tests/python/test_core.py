# SPDX-License-Identifier: LGPL-2.1-or-later
"""The compiled part of the Python package."""

import ast
import json
import os
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import tomllib
import textwrap
import time
import unittest
from pathlib import Path

import numpy as np

import ciliaval as cv
import ciliaval.program

SOURCE = Path(__file__).resolve().parents[2]
SENSOR = np.array([-0.1e-3, 0.2e-3, -1.55e-3])


def paper_cilium(base_length=3e-3):
    """The paper's cilium, section 3.4.1."""
    base = cv.Segment(length=base_length, young_modulus=0.1e6, poisson_ratio=0.49)
    magnet = cv.Segment(17e-3, 3e6, 0.49, magnetization=75e3, name="magnet")
    return cv.Cilium(diameter=3e-3, segments=[base, magnet])


def contact(force):
    return cv.Load("contact", force=force, height=13e-3)


class Cases(unittest.TestCase):
    TABLES = {
        "case": {"name": "soft", "title": 'a "quoted" \U0001f600 title'},
        "cilium": {
            "diameter": "3 mm",
            "segment": [
                {"name": "base", "length": "3 mm", "young_modulus": "0.1 MPa", "poisson_ratio": 0.49},
                {"name": "magnet", "length": "17 mm", "young_modulus": "3 MPa", "poisson_ratio": 0.49,
                 "magnetization": "75 kA/m"},
            ],
        },
        "load": {"type": "contact", "force": ["1 mN", "2 mN"], "height": "16 mm"},
        "sensor": {"position": ["0 mm", "0 mm", "-1.55 mm"]},
        "models": {"mechanics": ["elastica"], "fields": ["line"]},
    }  # fmt: skip

    def test_a_dictionary_is_the_file_that_it_was_read_from(self):
        for file in sorted((SOURCE / "cases").rglob("*.toml")):
            if len(file.suffixes) > 1:  # a study or bench
                continue
            with self.subTest(file.name):
                tables = tomllib.loads(file.read_text())
                self.assertEqual(cv.Case.from_dict(tables, str(file)).toml(), cv.Case(file).toml())

    def test_a_text_or_dictionary_is_a_case(self):
        case = cv.Case.from_dict(self.TABLES)
        self.assertEqual((case.name, case.title), ("soft", self.TABLES["case"]["title"]))
        self.assertEqual(cv.Case.from_text(case.toml()).toml(), case.toml())
        self.assertIsNone(case.file)
        for tables, text in (
            ({"case": {"name": None}}, "`name` is a NoneType"),
            ({**self.TABLES, "case": {"nam": "soft"}}, "the dictionary:.*did you mean 'name'"),
            ({**self.TABLES, "cilium": {"diameter": 3e-3}}, "diameter.*has no unit"),
        ):
            with self.assertRaisesRegex(cv.InputError, text):
                cv.Case.from_dict(tables)

    def test_other_numbers_by_the_paths_of_studies(self):
        case = cv.Case.from_dict(self.TABLES)
        changed = case.changed({"cilium.segment.base.young_modulus": "0.2 MPa", "sensor.position.z": -2e-3})
        self.assertEqual(changed.cilium.segments[0].young_modulus, 0.2e6)
        self.assertEqual(changed.sensors[0, 2], -2e-3)
        self.assertEqual(case.cilium.segments[0].young_modulus, 0.1e6)
        for values, text in (
            ({"load.hight": 1}, "no number `load.hight`; did you mean 'load.height'.*Its numbers: cilium.diameter"),
            ({"load.height": "1 N"}, "height"),
            ({"cilium.diameter": -1.0}, "diameter"),
            ({"load.height": "high"}, "height"),
            ({3: 1.0}, "path"),
            ({"load.height": "25 mm"}, "the changed case:.*height"),  # above the tip
        ):
            with self.subTest(values), self.assertRaisesRegex(cv.InputError, text):
                case.changed(values)

    def test_objects_are_a_case(self):
        case = cv.Case.from_dict(self.TABLES)
        made = cv.Case.from_objects(case.cilium, case.loads, case.sensors, ["elastica"], ["line"])
        np.testing.assert_array_equal(made.run().dB("elastica/line"), case.run().dB("elastica/line"))
        named = cv.Case.from_objects(case.cilium, case.loads[0], name="mine", title="t")
        self.assertEqual((named.name, named.title, named.fields), ("mine", "t", []))
        for arguments, text in (
            ((case.cilium, []), "one load or more"),
            ((case.cilium, case.loads, [[0, 0, np.nan]]), "finite"),
            ((case.cilium, case.loads, (), ["elastika"]), "elastica"),
            ((3, case.loads), "`cilium` is a Cilium"),
        ):
            with self.subTest(text), self.assertRaisesRegex(cv.InputError, text):
                cv.Case.from_objects(*arguments)

    def test_a_run_in_memory_has_what_a_folder_has(self):
        case = cv.Case.from_dict(self.TABLES)
        result = case.run()
        self.assertEqual(result.case_text, case.toml())
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "case.toml"
            file.write_text(case.toml())
            written = cv.run(file, folder)
            for step in range(2):
                a, b = (r.centreline("elastica", step) for r in (result, written))
                for name in a:
                    np.testing.assert_array_equal(a[name], b[name])
        for figure in (cv.plot.setup, cv.plot.shapes, cv.plot.signal):
            self.assertTrue(figure(result).axes)
        copy = pickle.loads(pickle.dumps(result))
        np.testing.assert_array_equal(copy.centreline("elastica", 1)["x"], result.centreline("elastica", 1)["x"])
        self.assertEqual(copy.case_text, result.case_text)
        for of in (result, copy):
            with self.assertRaisesRegex(cv.FileError, "no beam_0000.csv"):
                of._text("beam_0000.csv")


class Bend(unittest.TestCase):
    def test_gives_the_program_s_own_numbers(self):
        """Oracle: the program on the same case, through its file of results."""
        text = (SOURCE / "cases/paper/fig3b.toml").read_text()
        text = re.sub(r"mechanics = .*", 'mechanics = ["elastica", "beam"]', text)
        text = re.sub(r"fields = .*", 'fields = ["volume"]', text)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "case.toml"
            file.write_text(text)
            case = cv.Case(file)
            cv.program.call("run", file, "-o", folder)
            summary = json.loads((Path(folder) / "fig3b" / "summary.json").read_text())
        for model in ("elastica", "beam"):
            shapes = cv.bend(case.cilium, case.loads, model)
            self.assertEqual(len(shapes), len(summary["steps"]))
            for shape, step in zip(shapes, summary["steps"]):
                self.assertEqual(shape.tip.tolist(), step["mechanics"][model]["tip"])
                self.assertEqual(
                    shape.B(case.sensors).tolist(), step["fields"][f"{model}/volume"]["B"]
                )

    def test_a_long_path_takes_memory_in_proportion(self):
        """docs/measurements.md: 13 kB a load."""
        code = (
            "import sys, ciliaval as cv, test_core as t\n"
            "size = lambda: int(open('/proc/self/statm').read().split()[1]) * 4096\n"
            "cv.bend(t.paper_cilium(), [t.contact(1e-3)] * 200)\n"
            "before = size()\n"
            "kept = cv.bend(t.paper_cilium(), [t.contact(1e-3)] * 3000)\n"
            "print((size() - before) / 3000)"
        )
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, cwd=Path(__file__).parent
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(float(done.stdout), 20e3)

    def test_refines_the_solid_to_a_tolerance(self):
        """Oracle: the model's own estimate, by which the coarsest mesh misses 0.3 % and the next does not."""
        coarse = cv.bend(paper_cilium(), contact(1e-3), "solid", refinement=0)
        moved = np.linalg.norm(coarse.tip - [0, 0, 20e-3])
        self.assertGreater(coarse.tip_uncertainty, 0.003 * moved)
        shape = cv.bend(paper_cilium(), contact(1e-3), "solid", tolerance=0.3)
        self.assertLess(shape.tip_uncertainty, 0.003 * moved)
        self.assertIn("refinement 1, error of at most", shape.message)

    def test_says_what_a_model_does_not_take(self):
        away = cv.Environment(uniform_field=[0, 1e-3, 0])
        for model, options, said in (
            ("elastica", {}, "elastica: the elastica bends in the plane of the load"),
            ("calculix", {}, "calculix takes no environment"),
        ):
            with self.assertRaisesRegex(cv.InputError, said):
                cv.bend(paper_cilium(), contact(1e-3), model, environment=away, **options)

    def test_weight_and_a_field_bend_a_slender_rod_as_linear_theory(self):
        """Oracle: (rho - rho_f) g A L^4 / (8 E I) and M A B L^3 / (3 E I), for a small deflection."""
        rod = cv.Cilium(0.2e-3, [cv.Segment(20e-3, 10e6, magnetization=1e3, density=1200.0)])
        area, bending = np.pi * 1e-8, 10e6 * np.pi * 1e-16 / 4
        weight = cv.Environment(gravity=[0, 2e-3, 0], fluid_density=1000.0)
        field = cv.Environment(uniform_field=[0, 1e-6, 0], magnetic_energy="R")
        shape = cv.bend(rod, environment=weight)
        tip = 200 * 2e-3 * area * 20e-3**4 / 8 / bending
        np.testing.assert_allclose(shape.tip[1], tip, rtol=1e-3)
        self.assertEqual(shape.load.type, "environment")
        self.assertEqual(shape.load.environment, weight)
        tip = 1e3 * area * 1e-6 * 20e-3**3 / 3 / bending
        shapes = cv.bend(rod, environment=[field, field], model="beam")
        np.testing.assert_allclose(shapes[1].tip[1], tip, rtol=1e-3)
        # Beside a load, of which small ones add up.
        push = cv.Load("section", force=1e-9, arclength=20e-3, azimuth=np.pi / 2)
        tip += 1e-9 * 20e-3**3 / 3 / bending
        np.testing.assert_allclose(cv.bend(rod, push, environment=field).tip[1], tip, rtol=1e-3)

    def test_an_environment_that_does_not_fit_is_an_error(self):
        rod = cv.Cilium(1e-3, [cv.Segment(20e-3, 1e6, magnetization=1e4)])
        field = cv.Environment(uniform_field=[1e-3, 0, 0])
        with self.assertRaisesRegex(cv.InputError, "3 environments and 2 loads"):
            cv.bend(rod, 2 * [cv.Load("dead", force_per_length=1e-3)], environment=3 * [field])
        with self.assertRaisesRegex(cv.InputError, "`magnetic_energy`: \"G\" is none of F, R"):
            cv.Environment(magnetic_energy="G")
        with self.assertRaisesRegex(cv.InputError, "calculix takes no environment"):
            cv.bend(rod, environment=field, model="calculix")
        with self.assertRaisesRegex(cv.InputError, "density"):
            cv.bend(rod, environment=cv.Environment(gravity=[0, 0, -9.81]))
        with self.assertRaisesRegex(cv.InputError, "neither a load nor an environment"):
            cv.bend(rod)

    def test_a_segment_is_magnetised_across_its_axis(self):
        """Oracles: c L^3 / (3 E I) of a couple c = M A B per length, and mu_0 M / 2 in the middle."""
        segment = cv.Segment(0.1, 1e6, magnetization=[1e3, -2e3, 0.0])
        self.assertEqual(segment.magnetization, (1e3, -2e3, 0.0))
        self.assertIn("magnetization=[1000, -2000, 0]", repr(segment))
        rod = cv.Cilium(1e-3, [segment])
        area, bending = np.pi * 0.25e-6, 1e6 * np.pi * 1e-12 / 64
        field = cv.Environment(uniform_field=[0, 0, 1e-8])
        tip = cv.bend(rod, environment=field, model="beam").tip
        expected = -np.array([1e3, -2e3]) * area * 1e-8 * 0.1**3 / (3 * bending)
        np.testing.assert_allclose(tip[:2], expected, rtol=1e-5)
        B = cv.bend(rod, cv.Load("dead", force_per_length=0.0)).B([0, 0, 0.05])
        middle = 4e-7 * np.pi / 2 * np.array([1e3, -2e3, 0])
        np.testing.assert_allclose(B[0], middle, rtol=1e-4, atol=1e-12)
        segment.magnetization = 5e3
        self.assertEqual(segment.magnetization, 5e3)
        with self.assertRaisesRegex(cv.InputError, "magnetization"):
            cv.Segment(0.1, 1e6, magnetization=[1e3, 2e3])

    def test_a_section_of_another_shape_bends_by_its_second_moment(self):
        """Oracle: F L^3/(3 E I) with I = b h^3/12, and pi (d^4 - d_i^4)/64."""
        rod = [cv.Segment(length=0.1, young_modulus=1e6, magnetization=1e3)]
        plate = cv.Cilium.rectangle(2e-3, 1e-3, rod, orientation=0.4)
        tube = cv.Cilium.tube(2e-3, 1e-3, rod)
        self.assertEqual(list(plate.sides), [2e-3, 1e-3])
        self.assertIsNone(tube.sides)
        self.assertEqual(plate.extent(0.4 + np.pi / 2), 1e-3)
        for cilium, azimuth, moment in (
            (plate, 0.4, 1e-3 * 2e-3**3 / 12),
            (plate, 0.4 + np.pi / 2, 2e-3 * 1e-3**3 / 12),
            (tube, 0, np.pi * (2e-3**4 - 1e-3**4) / 64),
        ):
            load = cv.Load("section", force=1e-9, arclength=0.1, azimuth=azimuth)
            tip = cv.bend(cilium, load).tip
            expected = 1e-9 * 0.1**3 / (3 * 1e6 * moment)
            self.assertAlmostEqual(np.hypot(*tip[:2]) / expected, 1, delta=1e-5)
        with self.assertRaisesRegex(cv.InputError, "along the azimuth"):
            cv.bend(plate, cv.Load("section", force=1e-9, arclength=0.1))
        with self.assertRaisesRegex(cv.InputError, "inner diameter"):
            cv.Cilium.tube(1e-3, 1e-3, rod)

    def test_a_magnet_far_away_pulls_as_a_dipole(self):
        """Oracle: the coaxial dipoles' 3 mu_0 m m'/(2 pi a^4)."""
        cilium = paper_cilium()
        far = cv.Magnet.cylinder([0, 0, 0.3], 4e-3, 5e-3, 1e6, name="far")
        bent = cv.bend(cilium, model="beam", environment=cv.Environment(magnets=[far]))
        own = 75e3 * np.pi * 1.5e-3**2 * 17e-3
        a = 0.3 - 11.5e-3
        pull = 3 * 4e-7 * np.pi * own * far.moment[2] / (2 * np.pi * a**4)
        force = bent.magnet_forces["far"]["force"]
        np.testing.assert_allclose(force, [0, 0, -pull], rtol=1e-2, atol=1e-3 * pull)
        np.testing.assert_allclose(far.B([0, 0, 0.9]), [[0, 0, 2e-7 * far.moment[2] / 0.6**3]], rtol=1e-3)
        with self.assertRaisesRegex(cv.InputError, "axis"):
            cv.Magnet.ball([0, 0, 1], 1e-3, 1e6, axis=[0, 0, 0])

    def test_a_flow_bends_a_slender_rod_as_linear_theory(self):
        """Oracle: q L^4 / (8 E I), for a load that hardly bends it."""
        rod = cv.Cilium(1e-3, [cv.Segment(20e-3, 1e6, magnetization=1e4)])
        q = 1e-6
        shape = cv.bend(rod, cv.Load("flow", force_per_height=q))
        second_moment = np.pi * 1e-3**4 / 64
        self.assertAlmostEqual(shape.tip[0] / (q * 20e-3**4 / (8 * 1e6 * second_moment)), 1, 6)

    def test_gives_arrays_of_the_shapes_it_promises(self):
        shape = cv.bend(paper_cilium(), contact(1e-3))
        n = len(shape.S)
        self.assertEqual(shape.centreline.shape, (n, 3))
        self.assertEqual(shape.theta.shape, (n,))
        self.assertEqual(shape.curvature.shape, (n,))
        np.testing.assert_array_equal(shape.centreline[-1], shape.tip)
        self.assertEqual(shape.B(SENSOR).shape, (1, 3))
        self.assertEqual(shape.dB([SENSOR, 2 * SENSOR]).shape, (2, 3))
        self.assertEqual(shape.B([list(SENSOR)] * 5, model="line").shape, (5, 3))

    def test_states_the_beam_s_uncertainty_and_that_of_its_field(self):
        shape = cv.bend(paper_cilium(), contact(1e-3), "beam")
        finer = cv.bend(paper_cilium(), contact(1e-3), "beam", refinement=2)
        self.assertGreater(shape.tip_uncertainty, 0)
        self.assertLess(np.linalg.norm(shape.tip - finer.tip), shape.tip_uncertainty)
        field = shape.field(SENSOR)
        self.assertTrue((field["B_uncertainty"] >= 0).all())

    def test_bends_the_solid(self):
        shape = cv.bend(paper_cilium(), contact(1e-3), "solid", refinement=0)
        self.assertLess(abs(shape.tip[0] / 1.502e-3 - 1), 0.01)
        self.assertEqual(shape.B(SENSOR, model="mesh").shape, (1, 3))

    def test_a_load_that_slips_off_is_a_result(self):
        shape = cv.bend(paper_cilium(), contact(1.0))
        self.assertEqual(shape.status, "slipped_off")
        self.assertTrue(0 < shape.slip_off < 1)
        with self.assertRaisesRegex(cv.SolverError, "slipped_off"):
            shape.tip  # noqa: B018


    def test_a_magnet_that_pulls_the_cilium_in_is_a_result(self):
        brick = cv.Magnet.cuboid(
            [12e-3, 0, 20e-3], [6e-3, 4e-3, 5e-3], 1.2 / (4e-7 * np.pi), axis=[1, 0, 0], name="brick"
        )
        shape = cv.bend(
            paper_cilium(), model="beam", environment=cv.Environment(magnets=[brick])
        )
        self.assertEqual(shape.status, "pulled_in")
        self.assertTrue(0 < shape.pull_in["fraction"] < 1)
        self.assertEqual(shape.pull_in["magnet"], "brick")
        self.assertEqual(shape.pull_in["tip"].shape, (3,))
        fractions, eigenvalues = shape.pull_in["approach"].T
        self.assertTrue((np.diff(fractions) > 0).all())
        self.assertLess(abs(eigenvalues[-1]), 1e-2)
        with self.assertRaisesRegex(cv.SolverError, "pulled_in"):
            shape.tip  # noqa: B018
        self.assertIsNone(cv.bend(paper_cilium(), contact(1e-3)).pull_in)


class BadInput(unittest.TestCase):
    def test_is_refused_with_what_there_is(self):
        cilium = paper_cilium()
        for wrong, text in [
            (lambda: cv.bend(cilium, contact(1e-3), "bem"), "no model `bem`"),
            (lambda: cv.bend(cilium, contact(1e-3), "beam", refinment=1), "has no option `refinment`"),
            (lambda: cv.bend(cilium, contact(1e-3), "beam", refinement="two"), "not what it takes"),
            (lambda: cv.bend(cilium, contact(1e-3), "beam", tip="round"), "none of"),
            (lambda: cv.bend(cilium, contact(float("nan"))), "finite"),
            (lambda: cv.Load("contct", force=1), "no load type"),
            (lambda: cv.Load("contact", force=1), "needs `height`"),
            (lambda: cv.Load("contact", force=1, hight=1), "has no `hight`"),
            (lambda: cv.Cilium(-3e-3, cilium.segments), "diameter"),
            (lambda: cv.Cilium(3e-3, [cv.Segment(1e-3, 1e6, 0.5)]), "poisson_ratio"),
            (lambda: cv.Case("no such file.toml"), "does not exist"),
            (lambda: cv.bend(cilium, contact(1e-3)).B([0, 0]), "shape"),
            (lambda: cv.bend(cilium, contact(1e-3)).B(SENSOR, model="mesh"), "body"),
            (lambda: cv.bend_batch([cilium], []), "one load for each"),
        ]:
            with self.subTest(text), self.assertRaisesRegex(cv.Error, text) as caught:
                wrong()
            self.assertIsInstance(caught.exception, (cv.InputError, cv.SolverError))

    def test_an_unknown_name_is_an_attribute_error(self):
        with self.assertRaises(AttributeError):
            cv.bent  # noqa: B018


class Batch(unittest.TestCase):
    def test_is_each_design_by_itself(self):
        generator = np.random.default_rng(1)
        cilia = [paper_cilium(length) for length in generator.uniform(1e-3, 6e-3, 40)]
        loads = [contact(force) for force in generator.uniform(0.1e-3, 20e-3, 40)]
        batch = cv.bend_batch(cilia, loads, [SENSOR])
        self.assertTrue(0 < batch["converged"].sum() < 40)
        for i, (cilium, load) in enumerate(zip(cilia, loads)):
            shape = cv.bend(cilium, load)
            self.assertEqual(batch["converged"][i], shape.status == "converged")
            if batch["converged"][i]:
                np.testing.assert_array_equal(batch["tip"][i], shape.tip)
                np.testing.assert_array_equal(batch["B"][i], shape.B(SENSOR))
                np.testing.assert_array_equal(batch["dB"][i], shape.dB(SENSOR))
            else:
                self.assertTrue(np.isnan(batch["tip"][i]).all())
                self.assertEqual(batch["slip_off"][i], shape.slip_off)

    def test_leaves_the_slip_off_out(self):
        """Every other number is the same, also of designs that slip off."""
        generator = np.random.default_rng(2)
        cilia = [paper_cilium(length) for length in generator.uniform(1e-3, 6e-3, 60)]
        loads = [contact(force) for force in generator.uniform(0.1e-3, 20e-3, 60)]
        points = generator.uniform(-3e-3, -1e-3, (60, 2, 3))
        whole, quick = (cv.bend_batch(cilia, loads, points, slip_off=of) for of in (True, False))
        self.assertTrue(np.isfinite(whole["slip_off"]).all() and np.isnan(quick["slip_off"]).all())
        self.assertTrue(0 < quick["converged"].sum() < 60)
        for key in ("converged", "tip", "tip_angle", "applied_force", "B", "dB"):
            np.testing.assert_array_equal(whole[key], quick[key])
        one = cv.bend_batch(cilia[7:8], loads[7:8], points[7])
        np.testing.assert_array_equal(one["dB"][0], whole["dB"][7])
        with self.assertRaisesRegex(cv.InputError, "those of 2 designs, and there are 60"):
            cv.bend_batch(cilia, loads, points[:2])

    def test_takes_options_of_the_model(self):
        cilium, load = paper_cilium(3e-3), contact(2e-3)
        batch = cv.bend_batch([cilium], [load], joints="corrected")
        shape = cv.bend(cilium, load, joints="corrected")
        np.testing.assert_array_equal(batch["tip"][0], shape.tip)
        self.assertGreater(shape.tip_uncertainty, 1e-7)
        self.assertLess(shape.tip[0] / cv.bend(cilium, load).tip[0], 0.92)
        with self.assertRaisesRegex(cv.InputError, "joints"):
            cv.bend_batch([cilium], [load], joints="glued")

    def test_of_none_is_empty(self):
        self.assertEqual(cv.bend_batch([], [])["tip"].shape, (0, 3))


class Stubs(unittest.TestCase):
    def test_name_what_the_module_has(self):
        tree = ast.parse((SOURCE / "python/ciliaval/_core.pyi").read_text())
        from ciliaval import _core

        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                self.assertTrue(callable(getattr(_core, node.name)), node.name)
            if isinstance(node, ast.ClassDef) and not node.bases:
                members = {m.name for m in node.body if isinstance(m, ast.FunctionDef)}
                members |= {m.target.id for m in node.body if isinstance(m, ast.AnnAssign)}
                public = {m for m in dir(getattr(_core, node.name)) if not m.startswith("_")}
                self.assertEqual(public, {m for m in members if not m.startswith("_")}, node.name)


class Process(unittest.TestCase):
    def test_what_only_reads_results_does_not_load_the_models(self):
        program = "import sys, ciliaval.errors, ciliaval; assert 'ciliaval._core' not in sys.modules"
        subprocess.run([sys.executable, "-c", program], check=True)

    def test_a_path_of_many_loads_takes_memory_in_proportion(self):
        program = textwrap.dedent(
            """
            import ciliaval as cv
            from test_core import contact, paper_cilium
            def pages():
                return int(open("/proc/self/statm").read().split()[1])
            def pages_per_load(count):
                before = pages()
                shapes = cv.bend(paper_cilium(), [contact(1e-3)] * count)
                return (pages() - before) / count
            print(pages_per_load(500), pages_per_load(3000))
            """
        )
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*sys.path])}
        done = subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, check=True, text=True
        )
        few, many = map(float, done.stdout.split())
        self.assertLess(many, 1.5 * few)

    def test_progress_is_told_and_an_exception_in_it_ends_the_solution(self):
        lines = []
        cv.bend(paper_cilium(), contact(1e-3), "solid", lines.append, refinement=0)
        self.assertTrue(any("iteration" in line for line in lines))

        def stop(_):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            cv.bend(paper_cilium(), contact(1e-3), "solid", stop, refinement=0)

    def test_ctrl_c_ends_a_solution(self):
        program = textwrap.dedent(
            """
            import ciliaval as cv
            from test_core import contact, paper_cilium
            loads = [contact(1e-5 * (i + 1)) for i in range(200)]
            cv.bend(paper_cilium(), loads, "solid", lambda line: print(line, flush=True))
            """
        )
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*sys.path])}
        with subprocess.Popen(
            [sys.executable, "-c", program],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        ) as process:
            process.stdout.readline()
            process.send_signal(signal.SIGINT)
            start = time.monotonic()
            _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertLess(time.monotonic() - start, 30)


if __name__ == "__main__":
    unittest.main()
