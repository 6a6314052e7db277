# SPDX-License-Identifier: LGPL-2.1-or-later
"""`ciliaval sense` as a user calls it, test benches and surfaces. Oracles: `ciliaval run`, first-order propagation,
the surface that was swept."""

import dataclasses
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import ciliaval as cv
from ciliaval import program, sensing
from ciliaval.sensing.bench import Bench, Simulation, bench_json
from ciliaval.sensing.levels import LEVEL, OFF_CURVE, BEYOND
from ciliaval.sensing.loads import FlowLaw
from sensing_cases import CASE, FLOW, PAIR, SWEEP, paper_response, polar


class Command(unittest.TestCase):
    """`ciliaval sense` as a user calls it."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.write("one.toml", CASE)
        cls.ciliaval("run", "one.toml")
        cls.result = cv.load(cls.folder / "results" / "one")
        cls.B = cls.result.B("beam/line")[:, 0]
        cls.dB = cls.result.dB("beam/line")[:, 0]
        summary = json.loads((cls.folder / "results" / "one" / "summary.json").read_text())
        cls.straight = np.array(summary["undeformed"]["fields"]["beam/line"]["B"])[0]

    @classmethod
    def write(cls, name, text):
        (cls.folder / name).write_text(text)

    @classmethod
    def ciliaval(cls, *arguments, code=0):
        done = subprocess.run(
            [program.program(), *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True, check=False
        )
        cls.out, cls.err = done.stdout, done.stderr
        assert done.returncode == code, f"{arguments}: {done.returncode}\n{done.stdout}\n{done.stderr}"

    def row(self, name, B, *more):
        return ",".join([name, *map(str, more), *map(repr, np.asarray(B).tolist())]) + "\n"

    def changes(self):
        return "sample,dBx [T],dBy [T],dBz [T]\n" + "".join(self.row(str(i), dB) for i, dB in enumerate(self.dB))

    def found(self, file="found.json"):
        return json.loads((self.folder / file).read_text())

    def expect_the_forces(self, file="found.json"):
        samples = self.found(file)["samples"]
        self.assertEqual([s["status"] for s in samples], ["found"] * 3)
        for sample, force in zip(samples, (1e-3, 2.5e-3, 4e-3)):
            self.assertAlmostEqual(sample["magnitude"], force, delta=1e-8 * force)
            self.assertAlmostEqual(sample["azimuth"], math.radians(30), delta=1e-7)
            self.assertLess(sample["magnitude_interval"], 0.15 * force)

    def test_finds_the_forces_behind_readings_with_the_offset_of_the_earth_and_the_magnet(self):
        earth = np.array([20e-6, -3e-6, -43e-6])
        text = "sample,Bx [T],By [T],Bz [T]\n"
        for sign in (1, -1):
            text += self.row("unloaded", self.straight + earth + sign * np.array([1e-6, 0, 0]))
        self.write("readings.csv", text + "".join(self.row(str(i), B + earth) for i, B in enumerate(self.B)))
        self.ciliaval(
            "sense", "one.toml", "readings.csv", "--models", "beam/line", "--json", "found.json", "--csv", "found.csv",
            "--plot", "found.svg",
        )  # fmt: skip
        self.expect_the_forces()
        self.assertIn("2.5 ", self.out)
        self.write("change.csv", self.changes())
        self.ciliaval("sense", "one.toml", "change.csv", "--models", "beam/line", "--json", "change.json")
        # The mean of two unloaded readings adds its noise: sqrt(1 + 1/2).
        width = [self.found(file)["samples"][1]["noise_interval"] for file in ("found.json", "change.json")]
        self.assertAlmostEqual(width[0] / width[1], math.sqrt(1.5), delta=1e-6)
        self.assertIn("\n1,found,", (self.folder / "found.csv").read_text())
        self.assertIn("<svg", (self.folder / "found.svg").read_text())
        self.assertEqual(self.found()["provenance"]["command"].split()[:3], ["ciliaval", "sense", "one.toml"])

    def test_refuses_options_without_effect(self):
        self.write("change.csv", self.changes())
        self.ciliaval("sense", "one.toml", "change.csv", "--plot", "one.txt", code=2)
        self.assertIn("ends in .svg, .pdf or .png", self.err)
        self.assertEqual(self.out, "")
        self.write("b.sense.toml", '[bench]\ncase = "one.toml"\nmodels = "elastica/line"\n[errors]\n')
        for option, value in (("--noise", "2 uT"), ("--unit", "uT"), ("--csv", "a.csv")):
            self.ciliaval("sense", "b.sense.toml", option, value, code=2)
            self.assertIn(option, self.err)
        self.ciliaval("sense", "b.sense.toml", "change.csv", code=2)
        self.assertIn("makes its own readings", self.err)
        self.ciliaval("sense", "one.toml", code=2)
        self.assertIn("no file of readings", self.err)

    def test_finds_the_forces_in_a_loggers_file(self):
        """Semicolons, decimal commas, mG, times, a column more; options and [readings] say the same."""
        earth = np.array([20e-6, -3e-6, -43e-6])
        lines = ["Sensor 7;started", "Time (ms);Mag X;Mag Y;Mag Z;Temp"]
        for time, B in zip((0, 500, 2000, 3000, 4000), [self.straight, self.straight, *self.B]):
            lines.append(";".join([str(time), *(repr(v).replace(".", ",") for v in (1e7 * (B + earth)).tolist()), "21,5"]))
        self.write("log.csv", "\n".join(lines))
        sense = ("sense", "one.toml", "log.csv", "--models", "beam/line", "--json", "found.json")
        self.ciliaval(*sense, "--unit", "mG", "--unloaded", "0 s..1 s", "--csv", "found.csv")
        self.expect_the_forces()
        self.assertIn(
            "log.csv: 5 rows, B from 'Mag X' in mG, 'Mag Y' in mG, 'Mag Z' in mG; columns not read: 'Temp'; 1 lines above "
            "the header not read; 2 unloaded.",
            self.out,
        )
        self.assertEqual(self.found()["samples"][1]["time"], 3.0)
        self.assertIn("time [s]\n", (self.folder / "found.csv").read_text())
        self.write("other.toml", CASE + '[readings]\nunit = "mG"\nunloaded = "0 s..1 s"\n')
        self.ciliaval("sense", "other.toml", *sense[2:])
        self.expect_the_forces()
        self.ciliaval("sense", "other.toml", "log.csv", "--unloaded", "rows 7..9", code=2)
        self.assertIn('no row lies in "rows 7..9" of --unloaded: the file has the rows 1..5', self.err)
        self.write("other.toml", CASE + '[readings]\nunit = "mm"\n')
        self.ciliaval("sense", "other.toml", "log.csv", code=2)
        self.assertIn("[readings] unit: 'mm' is not a unit of a flux density", self.err)

    def test_leaves_the_readings_alone_that_it_would_overwrite(self):
        self.write("mine.csv", self.changes())
        self.ciliaval("sense", "one.toml", "mine.csv", "--models", "beam/line", "--csv", "mine.csv", code=2)
        self.assertIn("mine.csv", self.err)
        self.assertEqual((self.folder / "mine.csv").read_text(), self.changes())

    def test_takes_the_background_off_at_each_azimuth(self):
        """The stage turns, and with it the ambient field that the sensor sees."""
        def seen(degrees):
            c, s = math.cos(-math.radians(degrees)), math.sin(-math.radians(degrees))
            return np.array([20e-6 * c + 3e-6 * s, 20e-6 * s - 3e-6 * c, -43e-6])

        rows = [f"{a}," + ",".join(map(repr, seen(a).tolist())) for a in range(0, 360, 30)]
        self.write("background.csv", "\n".join(["azimuth [deg],Bx [T],By [T],Bz [T]", *rows]) + "\n")
        text = "sample,azimuth [deg],Bx [T],By [T],Bz [T]\n" + self.row("unloaded", self.straight + seen(60), 60)
        text += "".join(self.row(str(i), B + seen(90 * i), 90 * i) for i, B in enumerate(self.B))
        self.write("readings.csv", text)
        self.ciliaval(
            "sense", "one.toml", "readings.csv", "--background", "background.csv", "--models", "beam/line", "--json",
            "found.json",
        )  # fmt: skip
        self.expect_the_forces()

    def test_takes_the_models_offset_only_where_it_is_asked_for(self):
        text = "sample,Bx [T],By [T],Bz [T]\n" + "".join(self.row(str(i), B) for i, B in enumerate(self.B))
        self.write("readings.csv", text)
        self.ciliaval("sense", "one.toml", "readings.csv", "--models", "beam/line", code=2)
        self.assertIn("there is no reading of the unloaded cilium", self.err)
        self.assertIn('--unloaded "0 s..1 s"', self.err)
        self.ciliaval(
            "sense", "one.toml", "readings.csv", "--unloaded", "model", "--models", "beam/line", "--json", "found.json"
        )
        self.expect_the_forces()
        self.assertIn("no reading of the unloaded cilium", self.out)

    def test_says_what_is_no_load(self):
        self.write("odd.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\nnone,0.1,0,0\nodd,0,0,500\nhuge,900,0,0\n")
        self.ciliaval("sense", "one.toml", "odd.csv", "--models", "beam/line", "--json", "odd.json")
        samples = self.found("odd.json")["samples"]
        self.assertEqual([s["status"] for s in samples], ["nothing", "misfit", "beyond range"])
        self.write("odd.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\nodd,0,0,500\n")
        self.ciliaval("sense", "one.toml", "odd.csv", "--models", "beam/line", code=5)

    def test_finds_the_speed_of_a_flow(self):
        """The case's velocities; the interval does not fall below zero."""
        self.write("flow.toml", FLOW)
        case = cv.Case(self.folder / "flow.toml")
        dB = case.run().dB("elastica/volume")[:, 0]
        self.write("readings.csv", "dBx [T],dBy [T],dBz [T]\n" + "".join(",".join(map(repr, b.tolist())) + "\n" for b in dB))
        self.ciliaval("sense", "flow.toml", "readings.csv", "--noise", "0.5 uT", "--json", "found.json")
        slow, fast = self.found()["samples"]
        self.assertAlmostEqual(slow["velocity"], 0.01, delta=1e-5)
        self.assertAlmostEqual(fast["velocity"], 0.3, delta=1e-7)
        self.assertAlmostEqual(fast["azimuth"], math.radians(-160), delta=1e-6)
        self.assertEqual(slow["velocity_interval"][0], 0)
        self.assertGreater(slow["velocity_interval"][1], 0.01)
        self.assertIn("v (m/s)", self.out)
        self.assertAlmostEqual(float(FlowLaw.of(case).velocity(0.5 * 1000 * 0.3**2 * 3e-3)), 0.3, places=12)

    def test_bad_readings_and_options_are_refused_with_their_place(self):
        header = "sample,Bx [uT],By [uT],Bz [uT]\n"
        good = header + "a,1,2,3\n"
        self.write("alone.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n0,1,2,3\n")
        for text, what, *more in (
            ("sample,Bx [uT],By [uT]\na,1,2\n", "either Bx, By, Bz, or dBx, dBy, dBz"),
            (header + "a,1,2\n", "bad.csv:2"), (header + "a,1,2,nan\n", "bad.csv:2"),
            ("sample,Bx [mm],By [uT],Bz [uT]\na,1,2,3\n", "bad.csv:1"),
            (header + "unloaded,1,2,3\n", "no reading but of the unloaded cilium"),
            ("sample,dBx [uT],dBy [uT],dBz [uT]\nunloaded,1,2,3\na,1,2,3\n", "leave its rows out"),
            (good, "flux density", "--noise", "1 mm"), (good, "--noise: the noise of a reading", "--noise", "0 uT"),
            (good, "elastica/volume", "--models", "volume"), (good, "force", "--largest", "4 mm"),
            (good, "need a column 'azimuth'", "--background", "alone.csv"),
            ("azimuth [deg],Bx [uT],By [uT],Bz [uT]\n10,1,2,3\n", "a single azimuth", "--background", "alone.csv",
             "--unloaded", "model"),
        ):  # fmt: skip
            self.write("bad.csv", text)
            with self.subTest(what):
                self.ciliaval("sense", "one.toml", "bad.csv", *more, code=2)
                self.assertIn(what, self.err)

    def test_the_spread_between_pairs_is_that_of_the_loads_that_each_finds(self):
        """Oracle: each pair alone; the true forces by the pair that made the readings."""
        pairs = ["elastica/volume", "beam/line", "elastica/dipole"]
        self.write("change.csv", self.changes())
        self.ciliaval(
            "sense", "one.toml", "change.csv", "--models", ",".join(pairs), "--json", "found.json", "--csv", "found.csv"
        )
        alone = []
        for pair in pairs:
            alone.append(cv.sense(self.folder / "one.toml", self.dB, models=pair)[["load_x", "load_y"]].to_numpy())
        for i, (sample, force) in enumerate(zip(self.found()["samples"], (1e-3, 2.5e-3, 4e-3))):
            np.testing.assert_allclose([sample["loads"][pair] for pair in pairs], [found[i] for found in alone], rtol=1e-12)
            self.assertAlmostEqual(np.hypot(*sample["loads"]["beam/line"]), force, delta=1e-8 * force)
            sizes = [np.hypot(*found[i]) for found in alone]
            self.assertAlmostEqual(sample["spread"], max(sizes) - min(sizes), delta=1e-12 * force)
            self.assertGreater(sample["spread"], 0.01 * force)  # a dipole is no rod
        self.assertIn("Spread of the load found by elastica/volume, beam/line and elastica/dipole, mN:\n", self.out)
        table = self.out[self.out.index("Spread") :].splitlines()[1:]
        least, most = sorted(np.hypot(*found[1]) for found in alone)[::2]
        self.assertRegex(table[2], f"^ *1 .* {1e3 * least:.5g} +elastica/volume +{1e3 * most:.5g} +elastica/dipole$")
        self.assertLessEqual(max(map(len, table)), 80)
        self.assertIn("magnitude beam/line [N],magnitude elastica/dipole [N],spread [N]", (self.folder / "found.csv").read_text())

    def test_pairs_that_there_are_not_are_refused_with_those_that_there_are(self):
        self.write("change.csv", self.changes())
        for models, what in (
            ("elastica/volume,beem/line", "no model `beem` among the mechanics: elastica, beam, calculix, solid"),
            ("elastica/volum", "no model `volum` among the fields: dipole, line, volume, mesh, potential"),
            ("elastica/volume,", "a pair of models is written mechanics/field"),
        ):
            self.ciliaval("sense", "one.toml", "change.csv", "--models", models, code=2)
            self.assertIn(what, self.err)

    def test_ranges_end_at_the_slip_off(self):
        self.write("change.csv", self.changes())
        for largest, said in (("9 mN", "not 9 mN"), ("1 kN", "not 1e+06 mN")):
            self.ciliaval(
                "sense", "one.toml", "change.csv", "--models", "beam/line", "--largest", largest, "--json", "found.json"
            )
            self.expect_the_forces()
            self.assertIn("Loads are looked for up to 6.3", self.out)
            self.assertIn(said, self.out)
            self.assertTrue(6.3e-3 < self.found()["largest"] < 6.4e-3)

    def test_refuses_noise_and_readings_that_no_sensor_has(self):
        self.write("change.csv", self.changes())
        for noise in ("1e300 uT", "1e-300 uT", "2 T"):
            self.ciliaval("sense", "one.toml", "change.csv", "--noise", noise, code=2)
            self.assertIn(f"not `{noise}`", self.err)
        self.write("huge.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\na,1,2,3\nb,1,1e160,3\n")
        self.ciliaval("sense", "one.toml", "huge.csv", code=2)
        self.assertIn("huge.csv:3:", self.err)
        self.write("far.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n0,1,2,3\n90,1e200,2,3\n")
        self.write("turned.csv", "sample,azimuth [deg],Bx [uT],By [uT],Bz [uT]\na,0,1,2,3\n")
        self.ciliaval("sense", "one.toml", "turned.csv", "--background", "far.csv", code=2)
        self.assertIn("far.csv:3:", self.err)

    def test_takes_the_readings_of_several_sensors_together(self):
        """A row for each in a sample, and the same side by side, by name."""
        places = '[["1 mm", "0 mm", "-1.5 mm"], ["0 mm", "-2 mm", "-1.5 mm"]]'
        two = CASE.replace('["-0.1 mm", "0.2 mm", "-1.55 mm"]', places)
        named = CASE.replace(
            '[sensor]\nposition = ["-0.1 mm", "0.2 mm", "-1.55 mm"]',
            '[[sensor]]\nname = "left"\nposition = ["1 mm", "0 mm", "-1.5 mm"]\n'
            '[[sensor]]\nname = "right"\nposition = ["0 mm", "-2 mm", "-1.5 mm"]',
        )
        self.write("two.toml", two)
        self.write("named.toml", named)
        case = cv.Case.from_text(two)
        dB = cv.bend(case.cilium, case.loads[1], "elastica", joints="corrected").dB(case.sensors)
        text = "sample,sensor,dBx [T],dBy [T],dBz [T]\n" + "".join(self.row("a", dB[s], s) for s in (1, 0))
        self.write("readings.csv", text)
        self.ciliaval("sense", "two.toml", "readings.csv", "--json", "found.json")
        self.assertAlmostEqual(self.found()["samples"][0]["magnitude"], 2.5e-3, delta=1e-9)
        head = ",".join(f"{name}_dB{axis} [T]" for name in ("right", "left") for axis in "xyz")
        self.write("wide.csv", head + "\n" + ",".join(map(repr, dB[::-1].ravel().tolist())) + "\n")
        self.ciliaval("sense", "named.toml", "wide.csv", "--json", "found.json")
        self.assertAlmostEqual(self.found()["samples"][0]["magnitude"], 2.5e-3, delta=1e-9)
        self.write("readings.csv", text[: text.rindex("a,")])
        self.ciliaval("sense", "two.toml", "readings.csv", code=2)
        self.assertIn("no row of sample 'a', sensor 0", self.err)

    def test_a_long_log_has_a_short_table(self):
        rng = np.random.default_rng(3)
        dB = self.dB[rng.integers(0, 3, 500)] + 1e-6 * rng.standard_normal((500, 3))
        rows = "".join(f"{0.01 * i:.2f}," + ",".join(f"{v:.9g}" for v in b) + "\n" for i, b in enumerate(dB))
        self.write("long.csv", "time [s],dBx [T],dBy [T],dBz [T]\n" + rows)
        self.ciliaval("sense", "one.toml", "long.csv", "--models", "beam/line", "--json", "found.json")
        self.assertLess(len(self.out.splitlines()), 30)
        self.assertIn("500 samples: ", self.out)
        self.assertEqual(len(self.found()["samples"]), 500)

    def test_names_and_terminals_of_other_encodings(self):
        self.write("change.csv", self.changes())
        name = os.fsdecode(b"k\xff.json")
        self.ciliaval("sense", "one.toml", "change.csv", "--models", "beam/line", "--json", name)
        self.expect_the_forces(name)
        (self.folder / os.fsdecode(b"log\xff.csv")).write_text(self.changes())
        self.ciliaval("sense", "one.toml", os.fsdecode(b"log\xff.csv"), "--models", "beam/line")
        self.assertIn("log\\xFF.csv: 3 rows", self.out)

    def test_benches_are_read_and_their_faults_said(self):
        good = (
            '[bench]\ncase = "one.toml"\nmodels = "beam/line"\nazimuths = 4\ndraws = 2\n[errors]\nnoise = "0.5 uT"\n'
            'ambient = ["20 uT", "0 uT", "-43 uT"]\n'
        )
        self.write("good.sense.toml", good)
        bench = sensing.read_bench(self.folder / "good.sense.toml")
        self.assertEqual((str(bench.truth), bench.azimuths, bench.noise), ("beam/line", 4, 0.5e-6))
        self.assertEqual(bench.ambient[2], -43e-6)
        for part, to, what in (
            ("one.toml", "none.toml", "does not exist"), ("beam/line", "beam/lime", "lime"),
            ("azimuths", "azimuth", "did you mean `azimuths`"), ("0.5 uT", "0.5 mm", "flux density"),
            ("0.5 uT", "-1 uT", "noise"), ("draws = 2", "draws = 0", "draws"), ("draws = 2", 'draws = "2"', "draws"),
            ('"20 uT", ', "", "three components"), ("[errors]", "[mistakes]", "mistakes"), ("[bench]", "[bench", "bad.sense"),
        ):  # fmt: skip
            self.write("bad.sense.toml", good.replace(part, to))
            with self.subTest(part):
                self.ciliaval("sense", "bad.sense.toml", code=2)
                self.assertIn(what, self.err)
                self.assertIn("bad.sense.toml:", self.err)
        self.ciliaval("sense", "good.sense.toml", "--json", "one.json", "--plot", "one.svg")
        self.assertIn("ambient field", self.out)
        self.assertIn("Roundness", self.out)
        self.assertEqual(self.found("one.json")["sources"][-1]["source"], "all")
        self.assertIn("true load", (self.folder / "one.svg").read_text())
        self.ciliaval("validate", "one.toml", "good.sense.toml")
        self.assertIn("good.sense.toml: the test bench is valid: 3 loads at 4 azimuths, 2 draws", self.out)
        self.assertIn('case "one" is valid', self.out)


class TestBench(unittest.TestCase):
    def bench(self, **changes):
        case = cv.Case.from_text(CASE.replace("2.5 mN", "2 mN"))
        return dataclasses.replace(Bench("title", case, PAIR, PAIR), **changes)

    def row(self, result, source):
        return next(inversion for name, inversion, _ in result.rows if name == source)

    def test_without_errors_finds_the_loads(self):
        result = sensing.run_bench(self.bench())
        self.assertEqual([name for name, _, _ in result.rows], ["none", "all"])
        for _, inversion, _ in result.rows:
            self.assertLess(inversion.magnitude_rms, 1e-9)
            self.assertLess(inversion.azimuth_largest, 1e-9)
            self.assertEqual(inversion.below_ten_degrees, 1)
        self.assertEqual(self.row(result, "none").readings, 36)
        self.assertGreater(result.rows[0][2].magnitude_rms, 1e-3)  # the response is not linear
        np.testing.assert_allclose(result.roundness, 1, atol=1e-9)

    def test_noise_spreads_as_its_propagation_says(self):
        """First order; the noise of reading and offset add up to sqrt(2) sigma."""
        bench = self.bench(noise=0.2e-6, draws=100)
        errors = self.row(sensing.run_bench(bench), "noise")
        response = paper_response(5e-3)
        p = np.concatenate([polar(size, np.radians(30 * np.arange(12))) for size in (1e-3, 2e-3, 4e-3)])
        J = response.derivative(p)[:, 0] / bench.noise
        covariance = 2 * np.linalg.inv(np.einsum("nci,ncj->nij", J, J))
        size = np.hypot(*p.T)[:, None]
        e = p / size
        n = np.stack([-e[:, 1], e[:, 0]], axis=-1)
        for found, axis in ((errors.magnitude_rms, e), (errors.azimuth_rms, n)):
            spread = np.sqrt((np.einsum("ni,nij,nj->n", axis, covariance, axis) / size[:, 0] ** 2).mean())
            self.assertAlmostEqual(found, spread, delta=0.1 * spread)

    def test_the_stages_angle_is_the_directions_error(self):
        bench = self.bench(stage_azimuth=math.radians(2), draws=400, azimuths=3)
        errors = self.row(sensing.run_bench(bench), "stage azimuth")
        self.assertLess(errors.magnitude_rms, 1e-9)
        self.assertAlmostEqual(errors.azimuth_rms, math.radians(2), delta=math.radians(0.3))
        # The rms of n normal numbers has the deviation sigma/sqrt(2n). 1.97: Student's t at 97.5 %.
        interval = 1.97 * math.radians(2) / math.sqrt(800)
        self.assertAlmostEqual(errors.azimuth_rms_interval, interval, delta=0.2 * interval)
        one = self.row(sensing.run_bench(dataclasses.replace(bench, draws=1)), "stage azimuth")
        self.assertEqual(one.azimuth_rms_interval, 0)

    def test_of_the_ambient_field_the_noise_of_its_measurement_is_left(self):
        ambient = np.array([20e-6, 0, -43e-6])
        rms = [
            self.row(sensing.run_bench(self.bench(noise=0.2e-6, ambient=k * ambient)), "ambient field").magnitude_rms
            for k in (1, 10)
        ]
        self.assertGreater(rms[0], 0)
        self.assertAlmostEqual(rms[1], rms[0], delta=1e-6 * rms[0])

    def test_each_source_shows_and_the_seed_decides(self):
        truth = sensing.Pair("beam", "line")
        bench = self.bench(truth=truth, noise=0.5e-6, quantum=0.5e-6, sensor_position=1e-4, draws=5)
        result = sensing.run_bench(bench)
        everything = self.row(result, "all")
        for source in ("noise", "digits", "sensor position", "models"):
            self.assertGreater(self.row(result, source).magnitude_rms, 1e-5)
            self.assertGreater(everything.azimuth_largest, self.row(result, source).azimuth_rms)
        again = sensing.run_bench(bench)
        self.assertEqual(bench_json(bench, result, {}), bench_json(bench, again, {}))
        self.assertEqual((len(result.found), len(result.by_magnitude)), (36, 3))
        self.assertGreater(result.by_magnitude[0].azimuth_rms, result.by_magnitude[-1].azimuth_rms)
        other = sensing.run_bench(dataclasses.replace(bench, seed=2))
        self.assertNotEqual(self.row(other, "noise").magnitude_rms, self.row(result, "noise").magnitude_rms)

    def test_several_sensors(self):
        text = CASE.replace('["-0.1 mm", "0.2 mm", "-1.55 mm"]', '[["1 mm", "0 mm", "-1.5 mm"], ["0 mm", "2 mm", "-1.5 mm"]]')
        bench = dataclasses.replace(self.bench(noise=1e-6, draws=3), case=cv.Case.from_text(text))
        read = Simulation(bench).readings("all")
        self.assertEqual(read.change.shape, (3 * 12 * 3, 2, 3))
        self.assertLess(self.row(sensing.run_bench(bench), "all").azimuth_largest, 0.1)


class Surface(unittest.TestCase):
    """Levels of a surface of steps of 1 mm, read by the models that made the readings."""

    noise = 1e-6

    @classmethod
    def setUpClass(cls):
        cls.case = cv.Case.from_text(SWEEP)
        cls.dB = cls.case.run().dB("elastica/volume")
        cls.curve = sensing.LevelCurve(cls.case, PAIR, 4e-3)

    def readings(self, seed, offset_rows=0):
        rng = np.random.default_rng(seed)
        change = self.dB + self.noise * rng.standard_normal(self.dB.shape)
        if offset_rows:
            change = change - self.noise / np.sqrt(offset_rows) * rng.standard_normal(self.dB.shape[1:])
        return sensing.Readings(
            names=[str(i) for i in range(len(change))], change=change, rows=np.ones(len(change), dtype=int), time=None,
            background=None, measured_offset=True, offset_variance=1 / offset_rows if offset_rows else 0.0,
            squares=0.0, freedom=0, unloaded=None, remarks=[],
        )  # fmt: skip

    def sensed(self, readings):
        return sensing.sense_surface(self.case, readings, PAIR, self.noise, self.curve)

    def test_steps_are_found_within_their_intervals(self):
        errors, inside = [], []
        for seed in range(1, 21):
            levels = self.sensed(self.readings(seed)).levels
            self.assertGreaterEqual(len(levels), 4)
            for level in levels:
                errors.append(abs(level.interference - (2e-3 if level.interference > 1.5e-3 else 1e-3)))
                inside.append(errors[-1] <= level.interval)
        print(f"levels inside: {sum(inside)} of {len(inside)}; largest error {1e6 * max(errors):.1f} um")
        self.assertGreaterEqual(np.mean(inside), 0.85)
        self.assertLess(max(errors), 20e-6)

    def test_intervals_hold_the_noise_of_the_offset(self):
        inside = [
            abs(level.interference - (2e-3 if level.interference > 1.5e-3 else 1e-3)) <= level.interval
            for seed in range(1, 41)
            for level in self.sensed(self.readings(seed, 1)).levels
        ]
        self.assertGreaterEqual(len(inside), 100)
        self.assertGreaterEqual(np.mean(inside), 0.85)

    def test_says_where_no_level_surface_gives_the_reading(self):
        readings = self.readings(1)
        change = readings.change[:3].copy()
        change[0, 0, 1] += 20e-6
        change[1] *= 3
        found = self.sensed(dataclasses.replace(readings, change=change, rows=readings.rows[:3], names=["0", "1", "2"]))
        self.assertEqual(found.status[0], OFF_CURVE)
        self.assertIn(found.status[1], (OFF_CURVE, BEYOND))
        self.assertEqual(found.status[2], LEVEL)
        self.assertEqual(found.levels, [])

    def test_the_text_names_the_steps(self):
        text = self.sensed(self.readings(3)).text(0)
        self.assertIn("levels of the surface by elastica/volume", text)
        self.assertIn("of 209 readings belong to levels", text)

    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            case, log = Path(folder, "steps.toml"), Path(folder, "log.csv")
            case.write_text(SWEEP)
            head = ",".join(f"dB{axis}{s} [T]" for s in (0, 1) for axis in "xyz")
            rows = [",".join(map(repr, row.ravel().tolist())) for row in self.readings(1).change]
            log.write_text("\n".join([head, *rows]))
            made = [Path(folder, name) for name in ("a.json", "a.csv", "a.svg")]
            program.call("sense", case, log, *[f"--{f.suffix[1:].replace('svg', 'plot')}={f}" for f in made])
            document = json.loads(made[0].read_text())
            self.assertGreaterEqual(len(document["levels"]), 4)
            self.assertEqual(document["levels"][0]["height"], 0)
            self.assertEqual(len(made[1].read_text().splitlines()), 210)
            self.assertIn("<svg", made[2].read_text())


if __name__ == "__main__":
    unittest.main()
