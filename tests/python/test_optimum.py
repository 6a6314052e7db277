# SPDX-License-Identifier: LGPL-2.1-or-later
"""The search in the unit box and the optima of studies. Oracles: functions whose optima and multipliers
follow by hand, scans and grids of the same studies."""

import itertools
import json
import math
import sqlite3
import tempfile
import unittest
from pathlib import Path

import numpy as np

from ciliaval import InputError
from ciliaval._core import StudyFile, StudyStore
from ciliaval.design import optimum_report
from ciliaval.design.optimum import constraints_of, optimise
from ciliaval.design.search import FEASIBILITY, Trial, maximise
from test_design import DIAMETER, LINE, MODULI, ONE_SEARCH, RANGE, parameter, study_of, swept, write_study

VOLUME = 'pairs = ["elastica/volume"]\noutputs = ["dB_norm", "range"]\n'
PROPORTION = parameter("cilium.segment.magnet.proportion", 0.05, 0.95)


def optimum_of(header, rest):
    study = study_of(header, rest)
    return study, optimise(study, StudyStore(study, None))


def best_value(optimum, output):
    """An output of the first pair at the best design."""
    return next(iter(optimum.designs[1].results.values())).values[output]


def each(trial):
    """The function of several points from that of one."""
    return lambda points: [trial(*u) for u in points]


class Search(unittest.TestCase):
    def test_finds_a_peak_between_the_bounds(self):
        result = maximise(each(lambda u, v: Trial(-((u - 0.3) ** 2) - 2 * (v - 0.6) ** 2)), [0.9, 0.1])
        (best,) = result.optima
        self.assertEqual((result.local_searches, best.starts), (12, 12))
        np.testing.assert_allclose(best.u, [0.3, 0.6], atol=1e-6)
        self.assertEqual(best.at_bound, [0, 0])
        self.assertLess(best.residual, 1e-6)

    # u + v on the circle u² + v² = 1/2: (1/2, 1/2), λ = 1/(2u) = 1. A point beside it by t loses t² of the
    # gain, and the constraint may be missed by 1e-8: t may be 1e-4.
    def test_finds_a_point_on_a_constraint_and_its_multiplier(self):
        (best,) = maximise(each(lambda u, v: Trial(u + v, (u * u + v * v - 0.5, u - 0.9))), [0.1, 0.2]).optima
        np.testing.assert_allclose(best.u, [0.5, 0.5], atol=1e-5)
        self.assertLessEqual(best.trial.violation, FEASIBILITY)
        np.testing.assert_allclose(best.multipliers, [1, 0], atol=1e-5)
        self.assertLess(best.residual, 1e-5)

    # 2u − v + w(1 − w): the corner (1, 0) and w = 1/2, multipliers 2 and 1.
    def test_finds_bounds_and_their_multipliers(self):
        (best,) = maximise(each(lambda u, v, w: Trial(2 * u - v + w * (1 - w))), [0.5, 0.5, 0.9]).optima
        self.assertEqual(best.u[:2], (1, 0))
        self.assertAlmostEqual(best.u[2], 0.5, 6)
        self.assertEqual(best.at_bound, [1, -1, 0])
        np.testing.assert_allclose(best.bound_multipliers, [2, 1, 0], atol=1e-8)
        self.assertLess(best.residual, 1e-6)

    # Where a bound, the other and a constraint meet, two of the three are enough: what matters is that some
    # non-negative combination is found.
    def test_a_corner_that_a_constraint_touches_is_stationary(self):
        (best,) = maximise(each(lambda u, v: Trial(u + 3 * v, (u + v - 2,))), [0.5, 0.5]).optima
        self.assertEqual(best.u, (1, 1))
        self.assertLess(best.residual, 1e-8)

    # Two peaks, the lower one with the wider basin.
    def test_lists_the_distinct_optima_the_best_first(self):
        def bump(u, centre, width):
            return math.exp(-(((u - centre) / width) ** 2))

        function = each(lambda u: Trial(1.2 * bump(u, 0.15, 0.1) + bump(u, 0.7, 0.25)))
        first, second = maximise(function, [0.8]).optima
        self.assertAlmostEqual(first.u[0], 0.15, delta=0.01)
        self.assertAlmostEqual(second.u[0], 0.7, delta=0.01)
        self.assertGreater(first.trial.gain, second.trial.gain)
        self.assertEqual(first.starts + second.starts, 12)
        local = maximise(function, [0.8], 0, 0)  # from the start alone there is the nearer one
        self.assertEqual((len(local.optima), local.local_searches), (1, 1))
        self.assertAlmostEqual(local.optima[0].u[0], 0.7, delta=0.01)

    # As a cilium that slips off: beyond u + v = 1 there is no gain, but how far beyond is known. The gain
    # rises up to there: v = 1 − u, u(1 − u) + 1, the peak at (1/2, 1/2).
    def test_bears_points_without_a_gain(self):
        def trial(u, v):
            g = u + v - 1
            return Trial(-10, (g,), False) if g > 1e-6 else Trial(u * v + u + v, (g,))

        result = maximise(each(trial), [0.95, 0.9])
        self.assertEqual(result.infeasible, 0)
        np.testing.assert_allclose(result.optima[0].u, [0.5, 0.5], atol=0.01)
        self.assertAlmostEqual(result.optima[0].trial.gain, 1.25, 4)

    # Nothing is known beyond u = 0.7 but that it is no good; the gain rises up to there.
    def test_comes_near_to_where_the_function_ends(self):
        for evaluations in (0, 500):
            result = maximise(
                each(lambda u: Trial(u, (-1.0,)) if u <= 0.7 else Trial(-10, (10.0,), False)), [0.2], evaluations
            )
            self.assertAlmostEqual(result.optima[0].u[0], 0.7, delta=0.002)
            self.assertLessEqual(result.optima[0].u[0], 0.7)

    def test_without_a_feasible_point_says_so(self):
        result = maximise(each(lambda u: Trial(u, (0.5 + (u - 0.4) ** 2,))), [0.9])
        self.assertEqual((result.optima, result.infeasible), ([], result.local_searches))

    # A kink is an optimum, but no differences show it: it is the result and said not to be stationary.
    def test_an_optimum_that_is_not_stationary_is_said_to_be_none(self):
        result = maximise(each(lambda u: Trial(min(u, 1.6 - 3 * u))), [0.9])
        self.assertAlmostEqual(result.optima[0].u[0], 0.4, 3)
        self.assertGreater(result.not_stationary, 0)

    def test_asks_for_the_same_points_again_and_each_once(self):
        asked = [[], []]
        for points in asked:

            def function(batch, points=points):
                points += batch
                return [Trial(math.sin(9 * u) + math.cos(7 * v) * u, (u + v - 1.2,)) for u, v in batch]

            maximise(function, [0.2, 0.2])
        self.assertEqual(asked[0], asked[1])
        self.assertEqual(len(asked[0]), len(set(asked[0])))
        self.assertTrue(all(0 <= x <= 1 for u in asked[0] for x in u))
        self.assertTrue(200 < len(asked[0]) < 6000, len(asked[0]))

    def test_what_the_function_raises_comes_through(self):
        for last in (0, 1, 20, 60):
            count = itertools.count()

            def function(points):
                if next(count) == last:
                    raise KeyboardInterrupt
                return [Trial(-((u - 0.3) ** 4) - v * v, (u + v - 1,)) for u, v in points]

            with self.assertRaises(KeyboardInterrupt):
                maximise(function, [0.9, 0.1])


class Optimum(unittest.TestCase):
    # Oracle: the peak of the scan of Fig. 4c, a parabola through its three highest points, 0.001 apart.
    def test_of_one_parameter_is_the_peak_of_its_scan(self):
        fixed = '[fixed]\ncilium.segment.base.young_modulus = "0.5 MPa"\n'
        fixed += 'cilium.segment.magnet.young_modulus = "1 MPa"\n'
        for field in ("line", "volume"):
            header = f'pairs = ["elastica/{field}"]\noutputs = ["dB_norm"]\n'
            scan = study_of(header, fixed + parameter("cilium.segment.magnet.proportion", 0.855, 0.905, "count = 51\n"))
            y = np.array([pairs[0].values[0] for pairs in swept(scan)])
            x = np.array([scan.values_at(i)[0] for i in range(scan.point_count)])
            i = y.argmax()
            near = slice(i - 1, i + 2)
            a, b, c = np.polyfit(x[near] - x[i], y[near] / y[i], 2)
            _, optimum = optimum_of(header, fixed + '[optimise]\nmaximise = "dB_norm"\n' + PROPORTION)
            self.assertAlmostEqual(optimum.designs[1].values[0], x[i] - b / (2 * a), delta=1e-4)
            self.assertAlmostEqual(best_value(optimum, 0) / y[i], c - b * b / (4 * a), delta=1e-6)
            self.assertLess(optimum.best.residual, 1e-6)

    # A smooth problem with a limit: the slice through the best design has it, none that keeps the limit is better, and
    # some break it.
    def test_has_slices_through_the_best_design(self):
        study, optimum = optimum_of(VOLUME, RANGE + DIAMETER + PROPORTION)
        slices = optimum_report.optimum_json(study, optimum)["slices"]
        best = best_value(optimum, 0)
        self.assertEqual([s["path"] for s in slices], [p.path for p in study.searched])
        for s, ends in zip(slices, [(1e-3, 5e-3), (0.05, 0.95)]):
            self.assertEqual((s["at"][0], s["at"][-1]), ends)
            self.assertEqual(s["at"], sorted(s["at"]))
            self.assertAlmostEqual(s["values"][s["at"].index(s["best"])], best, delta=1e-12 * best)
            self.assertFalse(all(s["kept"]))
            for value, kept in zip(s["values"], s["kept"]):
                if value is not None and kept:
                    self.assertLessEqual(value, best * (1 + 1e-6))

    # Oracle: a grid of 81 × 81 designs, of which none that keeps the limit may be better, and of which the
    # best is near.
    def test_of_two_parameters_under_a_limit_is_that_of_a_grid(self):
        _, optimum = optimum_of(VOLUME, RANGE + DIAMETER + PROPORTION)
        self.assertAlmostEqual(best_value(optimum, 1), 2e-3, delta=2e-8 * 2e-3)
        grid = study_of(
            VOLUME,
            parameter("cilium.diameter", '"1 mm"', '"3 mm"', "count = 81\n")
            + parameter("cilium.segment.magnet.proportion", 0.55, 0.95, "count = 81\n"),
        )
        points = swept(grid)
        signal = [r.values[0] if r.values[0] and r.values[1] >= 2e-3 else 0.0 for (r,) in points]
        largest, best = max(signal), best_value(optimum, 0)
        self.assertLessEqual(largest, best * (1 + 1e-6))
        self.assertGreaterEqual(largest, best * 0.98)
        at = grid.values_at(signal.index(largest))
        self.assertAlmostEqual(optimum.designs[1].values[0], at[0], delta=2 * 0.025e-3)
        self.assertAlmostEqual(optimum.designs[1].values[1], at[1], delta=4 * 0.005)

    # Oracle: the optima with the limit, or the bound, 0.5 % to both sides.
    def test_has_multipliers_that_are_the_gain_of_a_relaxed_limit_and_bound(self):
        def solve(limit, modulus):
            low = parameter("cilium.segment.base.young_modulus", f'"{modulus} MPa"', '"3 MPa"')
            low += 'spacing = "logarithmic"\n'
            rest = RANGE.replace('"2 mN"', f'"{limit} mN"').replace("at_least", ONE_SEARCH + "at_least")
            return optimum_of(VOLUME, rest + PROPORTION + DIAMETER + low)[1]

        best = solve(2, 0.1).best
        self.assertEqual(best.at_bound[2], -1)
        self.assertLess(best.residual, 1e-6)
        step = math.log(2.01 / 1.99)
        by_limit = math.log(best_value(solve(1.99, 0.1), 0) / best_value(solve(2.01, 0.1), 0)) / step
        by_bound = math.log(best_value(solve(2, 0.0995), 0) / best_value(solve(2, 0.1005), 0)) / step
        self.assertAlmostEqual(best.multipliers[0], by_limit, delta=1e-3 * by_limit)
        # In u = ln(E/E_from)/ln(E_to/E_from).
        self.assertAlmostEqual(best.bound_multipliers[2] / math.log(30), by_bound, delta=1e-3 * by_bound)

    # Along E2 at E1 = 1 MPa |ΔB| has a trough at 0.17 MPa (docs/evidence/studies.md): both ends are optima,
    # the lower one of a basin that a tenth of the starts hit.
    def test_lists_both_sides_of_a_trough(self):
        moduli = parameter("cilium.segment.magnet.young_modulus", '"0.1 MPa"', '"10 MPa"', 'spacing = "logarithmic"\n')
        _, optimum = optimum_of(
            LINE + 'outputs = ["dB_norm"]\n',
            '[fixed]\ncilium.segment.base.young_modulus = "1 MPa"\n[optimise]\nmaximise = "dB_norm"\nstarts = 40\n'
            + moduli,
        )
        self.assertEqual([d.values[0] for d in optimum.designs[1:]], [1e7, 1e5])
        self.assertGreater(best_value(optimum, 0), optimum.designs[2].results["elastica/line"].values[0])
        self.assertEqual(sum(local.starts for local in optimum.search.optima), 42)

    def test_keeps_an_upper_limit_too(self):
        _, optimum = optimum_of(
            'pairs = ["elastica/volume"]\noutputs = ["B_z", "dB_norm"]\n',
            RANGE + 'at_most.B_z = "1 mT"\n' + DIAMETER + PROPORTION,
        )
        self.assertAlmostEqual(abs(best_value(optimum, 0)), 1e-3, delta=2e-8 * 1e-3)
        self.assertGreaterEqual(best_value(optimum, 2), 2e-3 * (1 - 2e-8))
        self.assertGreater(optimum.best.multipliers[1], 0)
        self.assertLessEqual(optimum.best.trial.violation, FEASIBILITY)

    # Without a limit the thinnest cilium that still bears the load, and loads 2 % around it, wins.
    def test_bears_its_load_where_no_limit_is_stated(self):
        _, optimum = optimum_of(
            'pairs = ["elastica/volume"]\noutputs = ["range", "sensitivity"]\n',
            '[optimise]\nmaximise = "sensitivity"\n' + DIAMETER,
        )
        self.assertAlmostEqual(best_value(optimum, 1), 1.021e-3, delta=1e-9)
        self.assertEqual(optimum.designs[0].values[0], 3e-3)  # the case's own diameter

    def test_is_found_from_a_start_that_slips_off(self):
        _, optimum = optimum_of(
            VOLUME,
            RANGE + "global_evaluations = 0\nstarts = 0\n"
            + parameter("cilium.diameter", '"1 mm"', '"5 mm"', 'start = "1.2 mm"\n'),
        )  # fmt: skip
        self.assertEqual(optimum.designs[0].results["elastica/volume"].status, "slipped_off")
        self.assertEqual(optimum.search.local_searches, 1)
        self.assertAlmostEqual(best_value(optimum, 1), 2e-3, delta=2e-8 * 2e-3)

    # A plain rod's range is off by more than nothing, which is what its optimum keeps the limit by.
    def test_a_limit_kept_by_less_than_the_model_leaves_out_is_shown(self):
        study, optimum = optimum_of(VOLUME, RANGE + ONE_SEARCH + DIAMETER)
        result = optimum.designs[1].results["elastica/volume"]
        self.assertGreater(result.range_model_uncertainty, 0.02 * 2e-3)
        self.assertRegex(optimum_report.optimum_text(study, optimum), r"range kept by [-0-9.e]+ \+-\d")
        (limit,) = optimum_report.limit_states(study, result)
        self.assertAlmostEqual(limit["band"] * 2e-3, result.range_uncertainty + result.range_model_uncertainty)

    def test_without_a_design_that_keeps_the_limits_there_is_none(self):
        study, optimum = optimum_of(VOLUME, RANGE.replace("2 mN", "1 N") + DIAMETER)
        self.assertFalse(optimum.found)
        self.assertEqual(len(optimum.designs), 1)
        self.assertIn("No design was found that keeps the limits", optimum_report.optimum_text(study, optimum))
        document = optimum_report.optimum_json(study, optimum)
        self.assertFalse(document["found"])
        self.assertEqual(document["slices"], [])

    # |ΔB| grows towards the cilium, up to where the model breaks; the other model has a smaller range.
    def test_leaves_out_designs_at_which_the_model_fails_and_other_pairs_confirm(self):
        study = study_of(
            'pairs = ["elastica/line", "beam/line"]\noutputs = ["dB_norm", "range"]\n',
            '[optimise]\nmaximise = "dB_norm"\nat_least.range = "5 mN"\n'
            + parameter("sensor.position.z", '"-3 mm"', '"-1 mm"', 'name = "z"\n'),
        )

        class Store:
            def evaluate(self, designs, mechanics, outputs=None, progress=None):
                names = outputs or [o.id for o in study.outputs]
                return [[self.result(z, mechanics, names)] for (z,) in designs]

            def result(self, z, mechanics, names):
                if z > -1.2e-3:
                    return ("failed", "too near", [None] * len(names), None, None)
                values = {"dB_norm": -1e-9 / z, "range": 5e-3 if mechanics == "elastica" else 4.9e-3}
                return ("converged", "", [values[name] for name in names], None, None)

        optimum = optimise(study, Store())
        self.assertAlmostEqual(optimum.designs[1].values[0], -1.2e-3, delta=0.01e-3)
        self.assertLessEqual(optimum.designs[1].values[0], -1.2e-3)
        text = optimum_report.optimum_text(study, optimum)
        self.assertIn("range missed by 2 %", text)
        self.assertIn("kept", text)
        pairs = optimum_report.optimum_json(study, optimum)["designs"][1]["pairs"]
        (kept,), (missed,) = (pairs[pair]["limits"] for pair in study.pairs)
        self.assertEqual(kept, {"output": "range", "status": "kept", "value": 5e-3, "by": 0.0, "band": None})
        self.assertEqual((missed["output"], missed["status"], missed["value"]), ("range", "missed", 4.9e-3))
        self.assertAlmostEqual(missed["by"], 0.02)

    # The beam has too few iterations.
    def test_a_limit_of_a_pair_that_fails_is_unknown(self):
        study, optimum = optimum_of(
            'pairs = ["elastica/line", "beam/line"]\noutputs = ["dB_norm", "range"]\n',
            "[fixed]\nmodels.beam.max_iterations = 1\nmodels.beam.max_cutbacks = 0\n"
            + RANGE + ONE_SEARCH + DIAMETER,
        )
        self.assertIn("range unknown", optimum_report.optimum_text(study, optimum))
        for design in optimum_report.optimum_json(study, optimum)["designs"]:
            (limit,) = design["pairs"]["beam/line"]["limits"]
            self.assertEqual(limit, {"output": "range", "status": "unknown", "value": None, "by": None, "band": None})

    def test_goes_on_from_the_store_and_evaluates_nothing_twice(self):
        def kept(folder):
            with sqlite3.connect(Path(folder, "varied", "points.sqlite")) as store:
                tables = [name for (name,) in store.execute("select name from sqlite_master where type = 'table'")]
                return {table: sorted(map(repr, store.execute(f"select * from {table}"))) for table in tables}

        def run(folder, last=None):
            """Ends after so many calls; the outcome, and how many solutions there were before."""
            store = StudyStore(study, str(folder))
            before, calls = store.size, itertools.count(1)

            class Ending:
                def evaluate(self, *arguments):
                    if next(calls) == last:
                        raise KeyboardInterrupt
                    return store.evaluate(*arguments)

            try:
                found = optimise(study, Ending())
            finally:
                store.close()
            document = json.dumps(optimum_report.optimum_json(study, found))
            return document + optimum_report.optimum_text(study, found), before, next(calls) - 1

        with tempfile.TemporaryDirectory() as folder:
            header, rest = VOLUME, RANGE + "global_evaluations = 60\nstarts = 2\n" + DIAMETER + PROPORTION
            study = StudyFile(str(write_study(folder, header, rest)))
            whole, _, calls = run(Path(folder, "whole"))
            for last in (1, 2, 10, calls):
                part = Path(folder, str(last))
                with self.assertRaises(KeyboardInterrupt):
                    run(part, last)
                again, before, _ = run(part)
                self.assertEqual(again, whole)
                self.assertEqual(before > 0, last > 1)
                self.assertEqual(kept(part), kept(Path(folder, "whole")))

    def test_reports_each_design_by_each_pair(self):
        study, optimum = optimum_of(
            'pairs = ["elastica/line", "elastica/volume", "beam/volume"]\noutputs = ["dB_norm", "range"]\n',
            RANGE + ONE_SEARCH + DIAMETER,
        )
        lines = optimum_report.optimum_csv(study, optimum)
        self.assertTrue(
            lines.startswith(
                "design,cilium.diameter,pair,status,dB_norm,range,message\n"
                "# units: cilium.diameter m, dB_norm T, range N\nstart,0.003,elastica/line,converged,"
            )
        )
        self.assertIn("\noptimum 1,0.00", lines)
        start, best = optimum_report.optimum_json(study, optimum)["designs"]
        self.assertEqual(list(best["pairs"]), study.pairs)
        self.assertEqual(best["parameters"]["cilium.diameter"], optimum.designs[1].values[0])
        self.assertEqual(best["pairs"]["beam/volume"]["range"], optimum.designs[1].results["beam/volume"].values[1])
        self.assertEqual([c["reached"] for c in best["constraints"]], [True, False])
        self.assertEqual([limit["status"] for limit in start["pairs"]["beam/volume"]["limits"]], ["kept"])
        shown = optimum_report.optimum_text(study, optimum)
        reached = "range >= 2 mN: reached; 1 % less would give"
        for words in (reached, "diameter(mm)", "|dB| of start", "range missed by"):
            self.assertIn(words, shown)

    def test_extra_optima_are_solved_by_the_model_that_searched_and_their_limits_are_judged(self):
        study, optimum = optimum_of(
            'pairs = ["elastica/line", "beam/line"]\noutputs = ["dB_norm", "range"]\n',
            '[fixed]\ncilium.segment.base.young_modulus = "1 MPa"\n[optimise]\nmaximise = "dB_norm"\nstarts = 40\n'
            'at_least.range = "2 mN"\n'
            + parameter("cilium.segment.magnet.young_modulus", '"0.1 MPa"', '"10 MPa"', 'spacing = "logarithmic"\n'),
        )  # fmt: skip
        designs = optimum_report.optimum_json(study, optimum)["designs"]
        self.assertEqual([list(d["pairs"]) for d in designs], [study.pairs, study.pairs, study.pairs[:1]])
        (limit,) = designs[2]["pairs"]["elastica/line"]["limits"]
        self.assertEqual((limit["status"], limit["value"]), ("kept", designs[2]["pairs"]["elastica/line"]["range"]))

    def test_the_own_load_is_the_designs(self):
        study = study_of(VOLUME, '[optimise]\nmaximise = "dB_norm"\n' + parameter("load.force", '"1 mN"', '"9 mN"'))
        self.assertEqual(study.load([2e-3]), 2e-3)
        (limit,) = constraints_of(study)
        self.assertEqual((limit.output.id, limit.value, limit.is_own_load), ("range", 1.001, True))
        best = optimise(study, StudyStore(study, None)).designs[1]
        self.assertAlmostEqual(best.results["elastica/volume"].values[1] / best.values[0], 1.001, 7)

    def test_of_a_wrong_study_is_an_input_error(self):
        study = study_of(LINE, MODULI)
        with self.assertRaisesRegex(InputError, "no \\[optimise\\]"):
            StudyStore(study, None).evaluate([[1e-3]], "elastica")
        study = study_of(VOLUME, RANGE + DIAMETER)
        with self.assertRaisesRegex(InputError, "a value for each parameter"):
            StudyStore(study, None).evaluate([[1e-3, 2e-3]], "elastica")


if __name__ == "__main__":
    unittest.main()
