# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures: drawn without a warning, nothing outside the sheet, what they show is what was computed."""

import io
import re
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle, Rectangle
from PIL import Image

import ciliaval as cv
from ciliaval import plot, program
from ciliaval.plain_cilium import PlainCilium
from test_results import SOURCE, quick


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        (folder / "a.toml").write_text(quick("fig3b"))
        cls.result = program.run(folder / "a.toml", folder)
        text = re.sub("samples = .*", "samples = 41", quick("fig6-surface"))
        (folder / "b.toml").write_text(re.sub('travel = "52 mm".*', 'travel = "17 mm"', text))
        cls.sweep = program.run(folder / "b.toml", folder)

    def draw(self, figure):
        """As PNG, PDF and SVG; all of it must lie on the sheet."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for kind in ("png", "pdf", "svg"):
                figure.savefig(io.BytesIO(), format=kind)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        drawn = figure.get_tightbbox(canvas.get_renderer())  # in inches
        width, height = figure.get_size_inches()
        self.assertGreaterEqual(min(drawn.x0, drawn.y0), 0)
        self.assertLessEqual(drawn.x1, width)
        self.assertLessEqual(drawn.y1, height)

    def test_signals_begin_at_no_load_and_are_those_of_the_result(self):
        figure = plot.signal(self.result)
        self.draw(figure)
        lines = {line.get_label(): line for line in figure.axes[0].lines}
        self.assertEqual(set(lines), set(self.result.pairs))
        x, y = lines["beam/volume"].get_data()
        self.assertEqual((x[0], y[0]), (0, 0))
        np.testing.assert_allclose(y[1:], 1e6 * self.result.dB("beam/volume")[:, 0, 0])
        names = [text.get_text() for text in figure.legends[0].get_texts()]
        self.assertEqual(names[0], "beam/volume")  # what leaves out least

    def test_a_path_of_fields_is_drawn_over_the_field(self):
        field = '[["-1 mT", "0 mT", "0 mT"], ["0 mT", "0 mT", "0 mT"], ["2 mT", "0 mT", "0 mT"]]'
        environment = f"[environment]\nuniform_field = {field}\n"
        text = re.sub(r"(?m)^\[load\].*\n(?:.*\n)*?(?=^\[)", environment, quick("fig3b"))
        (self.folder / "f.toml").write_text(re.sub("name = .fig3b.", 'name = "f"', text, count=1))
        result = program.run(self.folder / "f.toml", self.folder)
        figure = plot.signal(result)
        self.draw(figure)
        self.draw(plot.shapes(result))
        self.draw(plot.setup(result))
        x, y = figure.axes[0].lines[0].get_data()
        np.testing.assert_allclose(x, [-1, 0, 2])
        self.assertLess(y[0] * y[2], 0)  # the other way
        self.assertEqual(figure.axes[2].get_xlabel(), "uniform field in mT")

    def test_shapes_end_at_the_tips_of_their_steps(self):
        for step in (None, 1):
            figure = plot.shapes(self.result, step)
            self.draw(figure)
            ends = [
                line.get_xdata()[-1]
                for line in figure.axes[0].lines
                if line.get_color() == plot.look("elastica")["color"]
            ]
            tips = 1e3 * np.hypot(*self.result.tip("elastica")[:, :2].T)
            np.testing.assert_allclose(ends, tips if step is None else tips[[step]])

    def test_sweeps_shade_their_jumps(self):
        figure = plot.sweep(self.sweep)
        self.draw(figure)
        jumps = sum(
            "jump" in step["mechanics"][model]
            for step in self.sweep.steps
            for model in self.sweep.models
        )
        self.assertGreater(jumps, 0)
        self.assertEqual(len(figure.axes[0].patches), jumps)
        self.draw(plot.signal(self.sweep))

    def test_a_setup_is_drawn_for_every_type_of_load(self):
        self.draw(plot.setup(self.result))
        loads = {
            "contact": 'force = "1 mN"\nheight = "16 mm"',
            "flow": 'velocity = "0.2 m/s"',
            "section": 'force = "1 mN"\narclength = "16 mm"',
            "dead": 'force_per_length = "0.1 N/m"',
            "probe": 'displacement = "1 mm"\nheight = "16 mm"',
            "environment": "",
            "moment": 'moment = "10 uN m"',
        }
        self.draw(plot.setup(cv.Case(self.folder / "b.toml")))  # a sweep
        for name in set(cv.load_types()) - {"sweep"}:
            load = f'[load]\ntype = "{name}"\n{loads[name]}\nazimuth = "-100 deg"\n'
            if name == "environment":
                load += '[environment]\nuniform_field = ["0 mT", "-5 mT", "3 mT"]\n'
            text = re.sub(r"(?m)^\[load\]\n(?:.*\n)*?(?=^\[)", load, quick("fig3b"))
            (self.folder / "c.toml").write_text(text)
            self.draw(plot.setup(cv.Case(self.folder / "c.toml")))

    def test_no_text_of_a_setup_is_printed_on_another_or_on_the_cilium(self):
        """Random sensors, 2 to 8; boxes of the texts against each other, against rectangles and the circle."""
        for seed in range(14):
            generator = np.random.default_rng(seed)
            at = 1e-3 * generator.uniform([-5, -5, -4], [5, 5, -0.5], (2 + seed % 7, 3))
            azimuth = generator.uniform(-np.pi, np.pi)
            contact = cv.Load("contact", force=2e-3, height=16e-3, azimuth=azimuth)
            load = contact if seed % 2 else cv.Load("flow", force_per_height=0.2, azimuth=azimuth)
            base, magnet = cv.Segment(3e-3, 1e5, name="base"), cv.Segment(17e-3, 3e6, magnetization=75e3, name="magnet")
            case = cv.Case.from_objects(cv.Cilium(3e-3, [base, magnet]), load, at)
            figure = plot.setup(case)
            figure.set_dpi(200)  # not the one that the texts were placed at
            figure.canvas.draw()
            side, above = figure.axes
            boxes = [(t.get_text(), t.get_window_extent()) for axes in figure.axes for t in [*axes.texts, axes.title] if t.get_text()]
            self.assertEqual(sum(text.startswith(("sensor ", *"01234567")) for text, _ in boxes), 2 * len(at))
            for i, (text, box) in enumerate(boxes):
                with self.subTest(f"seed {seed}: {text}"):
                    self.assertFalse([other for other, of in boxes[:i] if box.overlaps(of)])
                    self.assertFalse([p for p in side.patches if type(p) is Rectangle and box.overlaps(p.get_window_extent())])
                    circle = next(p for p in above.patches if isinstance(p, Circle))
                    middle, radius = above.transData.transform([[0, 0], [circle.radius, 0]])
                    nearest = np.clip(middle, box.min, box.max)
                    self.assertGreater(np.linalg.norm(nearest - middle), (radius - middle)[0])

    def test_a_setup_has_the_surface_that_the_models_touch(self):
        """The touching points of the models lie on it; of every kind of profile, tilted too."""
        kinds = {
            "flat": "",
            "sine": 'amplitude = "0.4 mm"\nwavelength = "5 mm"\ntilt = "3 deg"\n',
            "random": 'rms = "0.3 mm"\nhurst = 0.8\nlongest = "20 mm"\nshortest = "1 mm"\nseed = 7\n',
            "trapezoid": 'height = "1 mm"\ntop = "5 mm"\nbottom = "4 mm"\nflank = "1 mm"\nradius = "0.9 mm"\ntilt = "-2 deg"\n',
        }
        for kind, numbers in kinds.items():
            surface = f'[surface]\nprofile = "{kind}"\n{numbers}'
            text = re.sub(r"(?m)^\[surface\].*\n(?:.*\n)*?(?=^\[)", surface, quick("fig6-surface"))
            text = re.sub("samples = .*", "samples = 2", re.sub("fields = .*", 'fields = ["line"]', text))
            for travel in ("0.5 mm", "7.3 mm"):
                result = cv.Case.from_text(re.sub('travel = "52 mm".*', f'travel = "{travel}"', text)).run()
                figure = plot.setup(result)
                line = next(a for a in figure.axes[0].lines if a.get_label() == "surface")
                for model in result.models:
                    x, _, z = result.steps[-1]["mechanics"][model]["contact"]["point"]
                    # h² / 8R = 1.4 µm between two points of the line, h = 0.1 mm, on an edge of R = 0.9 mm
                    self.assertAlmostEqual(np.interp(1e3 * x, *line.get_data()), 1e3 * z, delta=2e-3, msg=kind)
            self.draw(figure)

    def test_the_cilium_of_a_case_file_is_that_of_the_models(self):
        files = [f for f in (SOURCE / "cases").rglob("*.toml") if ".study" not in f.name and ".sense" not in f.name]
        self.assertGreater(len(files), 10)
        for file in files:
            with self.subTest(file.name):
                case = cv.Case(file)
                plain, whole = PlainCilium.of(case._core.toml()), case.cilium
                self.assertEqual(plain.length, whole.length)
                self.assertEqual(plain.sides, whole.sides and tuple(whole.sides))
                side = plain.orientation
                for azimuth in (side, side + np.pi / 2, side - np.pi):
                    self.assertEqual(plain.extent(azimuth), whole.extent(azimuth))
                for a, b in zip(plain.segments, whole.segments, strict=True):
                    self.assertEqual((a.name, a.length, a.young_modulus), (b.name, b.length, b.young_modulus))
                    self.assertEqual(a.poisson_ratio, b.poisson_ratio)
                    M = b.magnetization
                    self.assertEqual(a.magnetization, M if isinstance(M, tuple) else (0, 0, M))
        for damage in ("", "[cilium]", "[[cilium.segment]]", "[cilium]\ndiameter = []\nsegment = [1]", "=", "cilium = 1"):
            with self.assertRaises(cv.FileError):
                PlainCilium.of(damage)

    def test_a_matrix_of_pairs_has_the_differences(self):
        figure = plot.pairs(self.result)
        self.draw(figure)
        c = self.result.compare(quantity="centreline", step=3, statistic="maximum")[0]
        self.assertIn(f"{100 * c.relative:.3g}", figure.axes[0].texts[0].get_text())
        figure = plot.pairs(self.result, "dB")
        self.draw(figure)
        ticks = [label.get_text().replace("\n", "") for label in figure.axes[0].get_xticklabels()]
        self.assertEqual(ticks[0], "beam/volume")  # the best reference first

    def test_studies_budgets_and_benches_are_drawn(self):
        """From the shipped files with fewer points; what is drawn is in the file."""

        def study_of(name):
            text = (SOURCE / f"cases/paper/{name}.study.toml").read_text()
            text = re.sub("count = .*", "count = 9", text)
            (self.folder / "s.study.toml").write_text(text.replace("fig3b.toml", "a.toml"))
            return program.study(self.folder / "s.study.toml")

        study = study_of("fig4c")
        for output in study["outputs"]:
            self.draw(plot.curves(study, output["id"]))
        figure = plot.curves(study, "dB_norm")
        line = next(line for line in figure.axes[0].lines if line.get_label() == "elastica/line")
        values = [1e6 * p["pairs"]["elastica/line"]["dB_norm"] for p in study["points"]]
        np.testing.assert_allclose(sorted(line.get_ydata()), sorted(values))
        study = study_of("tolerances")
        figure = plot.tornado(study, "elastica/line", "dB_norm")
        self.draw(figure)
        widths = [bar.get_width() for bar in figure.axes[0].patches][1:]
        self.assertEqual(widths, sorted(widths))  # the largest on top
        entry = study["tolerances"]["pairs"]["elastica/line"]["dB_norm"]
        largest = max(
            abs(slope) * n["deviation"]
            for slope, n in zip(entry["slopes"], study["tolerances"]["numbers"])
        )
        self.assertAlmostEqual(widths[-1], 2e6 * largest)
        bench = {"unit": "N", "models": "elastica/volume"}
        points = [{"truth": [1e-3, 0], "found": [1.1e-3, 1e-4]}]
        self.draw(plot.bench({**bench, "first_draw": points}))
        keys = ["magnitude", "magnitude_interval", "azimuth", "azimuth_interval"]
        known = dict(zip(keys, [1e-3, 1e-4, 0.5, 0.1])) | {"time": 0.0}
        lost = dict.fromkeys(keys) | {"time": 1.0}
        self.draw(plot.readings({**bench, "samples": [known, lost]}))

    def test_a_waterfall_ends_at_the_best_model(self):
        link = {"verdict": "resolved", "uncertainty": 1e-6, "physics": ""}
        links = [
            {**link, "to": "beam", "value": 1e-3},
            {**link, "to": "solid", "value": -3e-3, "verdict": "below_uncertainty"},
        ]
        row = {"step": 0, "sensor": None, "quantity": "tip", "component": "x", "unit": "m"}
        row |= {"paper": 8e-3, "best": 6e-3, "links": links, "total": {**link, "value": -2e-3}}
        chain = [{"name": name} for name in ("elastica/line", "beam/line", "solid/line")]
        figure = plot.budget({"case": "a", "chain": chain, "rows": [row]})
        self.draw(figure)
        ends = [bar.get_x() + bar.get_width() for bar in figure.axes[0].patches]
        np.testing.assert_allclose(ends, [1, -2, -2])

    def test_an_order_is_drawn_through_the_errors(self):
        levels = [{"size": h, "value": 1 + h**2} for h in (0.1, 0.2, 0.4)]
        q = {"step": 0, "mechanics": "beam", "field": None, "sensor": None, "quantity": "tip/deflection"}
        q |= {"component": None, "unit": "m", "levels": levels}
        q |= {"conclusive": True, "reason": "", "order": 2.0, "limit": 1.0, "uncertainty": 0.01}
        study = {"model": "beam", "option": "refinement", "size_name": "size", "quantities": [q]}
        figure = plot.convergence({"studies": [study]}, "beam")
        self.draw(figure)
        x, y = figure.axes[0].lines[1].get_data()
        np.testing.assert_allclose(y * levels[0]["value"], x**2)

    def test_an_animation_has_a_frame_for_each_step(self):
        for result in (self.result, self.sweep):
            file = self.folder / "a.gif"
            plot.animate(result, file)
            with Image.open(file) as film:
                self.assertEqual(film.n_frames, len(result.steps))
        plot.animate(self.result, self.folder / "a.html")
        frames = re.findall(r"data:image/png;base64,", (self.folder / "a.html").read_text())
        self.assertEqual(len(frames), len(self.result.steps))
        self.assertEqual(sorted(self.folder.glob("a.*")), [self.folder / f"a.{kind}" for kind in ("gif", "html", "toml")])
        with self.assertRaises(cv.FileError):
            plot.animate(self.result, self.folder / "a.mp4")
        with self.assertRaises(cv.InputError):
            plot.animate(self.result, file, sensor="left")

    def test_a_model_looks_the_same_everywhere_and_unlike_the_others(self):
        looks = [tuple(plot.look(model).values()) for model in cv.models()["mechanics"]]
        self.assertEqual(len(set(looks)), len(looks))


if __name__ == "__main__":
    unittest.main()
