# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages of results: numbers as in the files, what is damaged is named, and how a browser shows them."""

import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from html import escape as plain_escape
from pathlib import Path

import numpy as np

import ciliaval as cv
from ciliaval import program, report
from ciliaval.report import page, view3d
from ciliaval.report.sentences import findings, remarks
from ciliaval.units import describe_load
from test_results import quick

os.environ.pop("CILIAVAL_PYTHON", None)  # which leaves out the page of a run


def escape(text: str) -> str:
    """As Jinja writes it."""
    return plain_escape(text, quote=True).replace("&#x27;", "&#39;").replace("&quot;", "&#34;")


MARKUP = """<script>console.error('ran')</script><b id="main">&amp; 'q'"""


def make_results(folder: Path, title: str = "") -> None:
    """A case with two sensors, a study, a budget, a damaged file and a picture."""
    text = quick("fig3b")
    if title:
        text = re.sub("^title = .*$", lambda _: f"title = {json.dumps(title)}", text, flags=re.M)
    position = re.search(r"(?m)^position = .*$", text).group(0)
    sensors = f'[[sensor]]\nname = "left"\n{position}\n[[sensor]]\nname = "right"\nposition = ["1 mm", "0 mm", "-2 mm"]\n'
    text = re.sub(r"(?m)^\[sensor\].*\n(?:.*\n)*?(?=^\[|\Z)", sensors, text)
    case = folder / "one.toml"
    case.write_text(re.sub("^name = .*$", 'name = "one"', text, count=1, flags=re.M))
    program.run(case, folder)
    study = '[study]\nname = "two"\ncase = "one.toml"\nsensor = "left"\npairs = ["elastica/line"]\noutputs = ["dB_norm"]\n'
    study += '[fixed]\nload.force = "1 mN"\n[[parameter]]\npath = "cilium.diameter"\nvalues = ["2 mm", "3 mm", "4 mm"]\n'
    (folder / "two.study.toml").write_text(study)
    program.study(folder / "two.study.toml", folder)
    (folder / "cut.json").write_text('{"schema": 1, "comp')
    (folder / "pictures").mkdir()
    picture = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
    (folder / "pictures" / "dot.png").write_bytes(base64.b64decode(picture))


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        make_results(cls.folder)
        cls.damaged = report.write(cls.folder)
        cls.html = (cls.folder / "report.html").read_text()
        cls.result = cv.load(cls.folder / "one")


class Report(Results):
    def test_a_damaged_file_is_named_and_all_others_are_shown(self):
        self.assertEqual(len(self.damaged), 1)
        self.assertIn("cut.json: is damaged", self.damaged[0])
        for text in ("cut.json: is damaged", ">Case one", ">Study two", "dot.png"):
            self.assertIn(text, self.html)

    def test_every_kind_of_damage_inside_a_file_is_named(self):
        whole = json.loads((self.folder / "one" / "summary.json").read_text())
        study = json.loads((self.folder / "two" / "study.json").read_text())
        faults = [(whole, key) for key in ("steps", "sensors", "comparisons")]
        faults += [(study, key) for key in ("points", "outputs")]
        for data, key in faults:
            for bad in ([1], "x", None):
                with tempfile.TemporaryDirectory() as scratch:
                    folder = Path(scratch) / "one"
                    shutil.copytree(self.folder / "one", folder)
                    (folder / "summary.json").unlink()
                    (folder / "a.json").write_text(json.dumps({**data, key: bad}))
                    damaged = report.write(scratch)
                    self.assertEqual(len(damaged), 1, (key, bad))
                    self.assertRegex(damaged[0], r"a\.json: (is damaged|.*cannot be (shown|drawn))")

    def test_nothing_costs_a_sound_result_its_place(self):
        """Faults in one result each beside a sound one: each is named, nothing else is lost."""
        line = self.result.steps[0]["mechanics"]["elastica"]["centreline"]

        def changed(change):
            def plant(folder: Path):
                data = json.loads((folder / "summary.json").read_text())
                change(data)
                (folder / "summary.json").write_text(json.dumps(data))

            return plant

        def named(name):
            return changed(lambda d: d["steps"][0]["mechanics"]["elastica"].update(centreline=name))

        def replaced(name, make):
            def plant(folder: Path):
                (folder / name).unlink(missing_ok=True)
                make(folder / name)

            return plant

        grids = [f.name for f in (self.folder / "one" / "vtk").glob("*.vti")]
        faults = {
            "provenance": changed(lambda d: d.update(provenance=5)),
            "case": changed(lambda d: d.update(case=["x"])),
            "title": changed(lambda d: d.update(title=10**400)),
            "tip": changed(lambda d: d["steps"][0]["mechanics"]["beam"].update(tip=[10**400, 0, 0])),
            "force": changed(lambda d: d["steps"][0]["load"].update(force=10**400)),
            "above": named("../one/elastica_0000.csv"),
            "absolute": named("/etc/passwd"),
            "pipe": replaced(line, os.mkfifo),
            "device": replaced(line, lambda file: file.symlink_to("/dev/zero")),
            "text": replaced(line, lambda file: file.write_bytes(b"S,x\n1,2,3\n\xff")),
            "grid": lambda folder: [(folder / "vtk" / name).write_text("<VTKFile>") for name in grids],
            "deep": replaced("deep.json", lambda file: file.write_text("[" * 100_000)),
            "waits": replaced("waits.json", os.mkfifo),
        }
        with tempfile.TemporaryDirectory() as scratch:
            shutil.copytree(self.folder / "one", Path(scratch) / "sound")
            for name, plant in faults.items():
                shutil.copytree(self.folder / "one", Path(scratch) / name)
                plant(Path(scratch) / name)
            (Path(scratch) / "folder.png").mkdir()
            (Path(scratch) / "dead.png").symlink_to("/nowhere")
            damaged = report.write(scratch)
            html = (Path(scratch) / "report.html").read_text()
            for name in [*faults, "folder.png", "dead.png"]:
                lines = [line for line in damaged if line.startswith(f"{scratch}/{name}")]
                self.assertEqual(len(lines), 1, name)
                self.assertIn(escape(lines[0]), html)
            self.assertEqual(len(damaged), len(faults) + 2)
            self.assertGreater(html.count(">Case one"), len(faults) - 4)
            for name in ("pipe", "above"):
                with self.assertRaises(cv.FileError):
                    cv.load(Path(scratch) / name).centreline("elastica", 0)

    def test_every_case_that_is_solved_has_a_page(self):
        """Nothing bends, all slips off, one step, no sensor, models that fail."""
        contact = '[load]\ntype = "contact"\nforce = {}\nheight = "16 mm"\n'
        sensor = '[sensor]\nposition = ["0 mm", "0 mm", "-2 mm"]\n'
        rods = '[models]\nmechanics = ["elastica", "beam"]\n'
        fields = 'fields = ["line", "volume"]\n'
        solid = '[models]\nmechanics = ["beam", "solid"]\n'
        cases = {
            "rest": contact.format('["0 mN", "0 mN"]') + sensor + rods + fields,
            "still": '[load]\ntype = "flow"\nvelocity = ["0 m/s"]\n' + sensor + rods + fields,
            "upright": '[load]\ntype = "environment"\n[environment]\ngravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]\n'
            + sensor + rods + fields,
            "off": contact.format('["90 mN"]') + sensor + rods + fields,
            "one": contact.format('["1 mN"]') + sensor + rods + fields,
            "blind": contact.format('["1 mN", "2 mN"]') + rods,
            "failed": contact.format('["4 mN"]') + sensor + solid + fields
            + "[models.solid]\nrefinement = 0\nmax_iterations = 1\nmax_cutbacks = 0\n",
        }  # fmt: skip
        segment = '[[cilium.segment]]\nname = "{}"\nlength = "{} mm"\nyoung_modulus = "{} MPa"\npoisson_ratio = 0.49\ndensity = "1100 kg/m^3"\n'
        cilium = '[cilium]\ndiameter = "3 mm"\n' + segment.format("base", 3, 0.1)
        cilium += segment.format("magnet", 17, 3) + 'magnetization = "75 kA/m"\n'
        with tempfile.TemporaryDirectory() as scratch:
            for name, text in cases.items():
                file = Path(scratch) / f"{name}.toml"
                file.write_text(f'[case]\nname = "{name}"\n{cilium}{text}')
                written = Path(scratch) / "out" / name / "summary.json"
                program.call("run", file, "-o", Path(scratch) / "out", "--fresh", result=written)
                self.assertTrue((Path(scratch) / "out" / name / "report.html").is_file(), name)
            self.assertEqual(report.write(Path(scratch) / "out"), [])
            page = (Path(scratch) / "out" / "report.html").read_text()
            for name in cases:
                self.assertIn(f">Case {name}", page)

    def test_a_folder_s_name_need_be_no_utf_8(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(os.fsdecode(os.fsencode(scratch) + b"/out\xff"))
            shutil.copytree(self.folder / "one", folder / "one")
            self.assertEqual(report.write(folder), [])
            self.assertIn("The set-up of one", (folder / "report.html").read_text())

    def test_people_s_dollars_are_text(self):
        """Half of a formula, which matplotlib would refuse to draw."""
        data = json.loads((self.folder / "one" / "summary.json").read_text())
        data.update(title="cost $a_{$ b")
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) / "one"
            shutil.copytree(self.folder / "one", folder)
            (folder / "summary.json").write_text(json.dumps(data))
            case = (folder / "case.toml").read_text()
            (folder / "case.toml").write_text(case.replace("'magnet'", "'mag$x^{$'"))
            self.assertEqual(report.write(scratch), [])
            page = (Path(scratch) / "report.html").read_text()
            svg = [base64.b64decode(s).decode() for s in re.findall(r"svg\+xml;base64,([^\"]+)", page)]
            self.assertTrue(any("mag$x^{$" in picture for picture in svg))

    def test_a_missing_file_of_a_shape_is_named(self):
        with tempfile.TemporaryDirectory() as scratch:
            shutil.copytree(self.folder / "one", Path(scratch) / "one")
            (Path(scratch) / "one" / "beam_0003.csv").unlink()
            self.assertIn("beam_0003.csv: No such file", report.write(scratch)[0])

    def test_there_is_no_empty_figure_where_no_step_has_a_shape(self):
        data = json.loads((self.folder / "one" / "summary.json").read_text())
        for step in data["steps"]:
            for of_model in step["mechanics"].values():
                of_model.update(status="pulled_in", message="the magnet 'm' pulls the cilium in", tip=None)
                of_model.update(tip_angle=None, applied_force=None, centreline=None)
            step["fields"] = {}
        data["comparisons"] = []
        with tempfile.TemporaryDirectory() as scratch:
            (Path(scratch) / "one").mkdir()
            (Path(scratch) / "one" / "summary.json").write_text(json.dumps(data))
            self.assertEqual(report.write(scratch), [])
            page = (Path(scratch) / "report.html").read_text()
            self.assertNotIn("Shapes", page)
            self.assertIn("pulls the cilium in", page)

    def test_tables_have_the_numbers_of_the_files(self):
        tip = self.result.tip("elastica")[0]
        row = re.search(r">1, elastica</th>(.*?)</tr>", self.html).group(1)
        cells = [float(c.replace("−", "-")) for c in re.findall(r"<td>([−\d.e]+)</td>", row)]
        np.testing.assert_allclose(cells[:3], 1e3 * tip, rtol=1e-4)
        study = json.loads((self.folder / "two" / "study.json").read_text())
        value = study["points"][1]["pairs"]["elastica/line"]["dB_norm"]
        self.assertIn(f"<td>{1e6 * value:.4g}</td>", self.html)

    def test_a_load_and_what_is_around_it_in_words(self):
        around = {"gravity": [0, 0, -9.81], "uniform_field": [47e-3, 0, 0]}
        load = {"type": "environment", "scale": 1.0, "azimuth": 0.0}
        self.assertEqual(
            describe_load(load, around),
            "environment: azimuth 0°, gravity (0, 0, −9.81) m/s², uniform field (47, 0, 0) mT",
        )
        touch = {"law": "coulomb", "friction": 0.3, "at": "mantle", "radius": 1e-3}
        self.assertEqual(
            describe_load({"type": "probe", "displacement": 6e-3, "touch": touch}),
            "probe: displacement 6 mm, friction 0.3 on the mantle, pin of radius 1 mm",
        )
        self.assertEqual(describe_load({**load, "scale": 0.5}), "environment: 0.5 times, azimuth 0°")

    def test_the_sentences_are_made_from_the_numbers(self):
        run, bending, fields, trust, look = findings(self.result)
        tips = {m: np.hypot(*self.result.tip(m)[-1, :2]) for m in self.result.models}
        self.assertIn(f"moves aside by {1e3 * tips['beam']:.4g} mm (beam)", run)
        norms = {p: np.linalg.norm(self.result.dB(p)[-1], axis=1) for p in self.result.pairs}
        for name, norm in zip(("left", "right"), norms["beam/volume"]):
            self.assertIn(f"{1e6 * norm:.4g} µT at sensor {name}", run)
        by = tips["elastica"] / tips["beam"] - 1
        self.assertIn(f"bending models agree within {abs(100 * by):.3g} %", bending)
        self.assertIn(f"elastica moves {'more' if by > 0 else 'less'} than that of the beam", bending)
        by, paper = (norms[p][0] / norms["beam/volume"][0] - 1 for p in ("beam/dipole", "elastica/dipole"))
        self.assertIn(f"field models differ by up to {abs(100 * by):.3g} %: beam/dipole reads less", fields)
        self.assertIn(f"elastica/dipole reads {abs(100 * paper):.3g} % less |ΔB|", fields)
        self.assertIn(f"± {100 * self.result.band('beam')[-1] / tips['beam']:.2g} % of its deflection", trust)
        resolved = self.result.compare(verdict="resolved")
        self.assertIn(f"{len(resolved)} of {len(self.result.comparisons)}", look)
        self.assertFalse([s for s in (run, bending, fields, trust, look) if re.search(r"[.!?]\s", s) or s[-1] != "."])
        limit = self.result.steps[-1]["mechanics"]["elastica"]["slip_off_force"]
        self.assertIn(f"{1e3 * limit:.4g} mN", next(remarks(self.result)))

    def test_the_page_of_a_case_is_small_its_captions_are_sentences_and_no_figure_is_there_twice(self):
        html = (self.folder / "one" / "report.html").read_text()
        self.assertLess(len(html.encode()), 3e6)
        figures = re.findall(r'src="(data:image/[^"]*)"', html)
        self.assertGreater(len(figures), 6)
        self.assertEqual(len(figures), len(set(figures)))
        captions = [re.sub("<strong>.*</strong>", "", text).strip() for text in re.findall(r"<figcaption[^>]*>(.*?)</figcaption>", html)]
        for text in captions:
            self.assertRegex(text, r"^[A-Z].* (is|are|shows|tells) .*\.$")

    def test_nothing_of_the_paper_is_missed_beside_results_of_other_cases(self):
        self.assertNotIn("fig4", self.html.split('id="missing"')[1].split("</section>")[0])

    def test_a_folder_without_results_is_an_error_and_the_old_page_stays(self):
        with tempfile.TemporaryDirectory() as scratch:
            with self.assertRaisesRegex(cv.FileError, "no results"):
                report.write(scratch)
        page_file = self.folder / "report.html"
        with self.assertRaises(cv.FileError):
            page.write(self.folder / "nowhere" / "report.html", page.Page("", []))
        self.assertEqual(page_file.read_text(), self.html)
        self.assertEqual([f.name for f in self.folder.glob(".report*")], [])

    def test_from_the_shell_the_exit_code_says_that_a_file_is_damaged(self):
        command = [sys.executable, "-m", "ciliaval.report", str(self.folder), "-o"]
        done = subprocess.run([*command, str(self.folder / "b.html")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 4)
        self.assertIn("cut.json", done.stderr)

    def test_pages_and_figures_of_results_do_not_load_the_models(self):
        program = (
            "import sys, ciliaval as cv\nfrom ciliaval import plot, report\nfrom ciliaval.plot.__main__ import main_figure\n"
            "report.write(sys.argv[1])\nresult = cv.load(sys.argv[1] + '/one')\n"
            "plot.setup(result), main_figure(result), plot.curves(cv.load_study(sys.argv[1] + '/two'), 'dB_norm')\n"
            "loaded = [name for name in sys.modules if name.startswith('ciliaval')]\nassert 'ciliaval._core' not in loaded, loaded\n"
        )
        done = subprocess.run([sys.executable, "-c", program, str(self.folder)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_grid_of_a_field_is_that_of_the_file(self):
        file = sorted((self.folder / "one" / "vtk").glob("field_*_0000.vti"))[0]
        grid = view3d.read_grid(file)
        case = cv.Case(self.folder / "one" / "case.toml")
        model, field = re.fullmatch(r"field_(\w+?)_(\w+)_0000", file.stem).groups()
        shape = cv.bend(case.cilium, case.loads[0], model)
        z, y, x = 3, 5, 7
        at = grid["origin"] + grid["spacing"] * [x, y, z]
        np.testing.assert_allclose(grid["B"][z, y, x], shape.B(at, model=field)[0], rtol=1e-6)


@unittest.skipUnless(shutil.which("chromedriver"), "chromedriver is not installed")
class InABrowser(Results):
    """Two widths; everything closed, then everything opened."""

    FAULTS = """
      const faults = [], width = document.documentElement.clientWidth;
      const drawings = document.querySelectorAll('figure img, figure canvas');
      for (const d of drawings) {
        const r = d.getBoundingClientRect();
        if (!d.checkVisibility({checkOpacity: true, checkVisibilityCSS: true})) {
          if (!d.closest('details:not([open])')) faults.push('hidden: ' + d.alt);
          continue;
        }
        if (r.width < 100 || r.height < 30) if (d.alt !== 'dot') faults.push('small: ' + d.alt);
        if ((r.left < 0 || r.right > width + 0.5) && !d.closest('.scroll')) faults.push('out of the page: ' + d.alt);
        if (d.tagName === 'IMG' && d.naturalWidth === 0) faults.push('no picture: ' + d.alt);
        if (d.tagName === 'IMG' && !d.alt) faults.push('no title');
      }
      if (drawings.length === 0) faults.push('no figure');
      const wide = document.documentElement.scrollWidth;
      if (wide > width) faults.push('the page is ' + wide + ' wide on ' + width);
      const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
      for (const id of ids) if (ids.indexOf(id) !== ids.lastIndexOf(id)) faults.push('id twice: ' + id);
      for (const a of document.querySelectorAll('a[href^="#"]'))
        if (!document.getElementById(a.getAttribute('href').slice(1))) faults.push('leads nowhere');
      for (const s of document.querySelectorAll('.scroll, pre'))
        if (s.scrollWidth > s.clientWidth && s.tabIndex !== 0) faults.push('not by keyboard');
      return faults;"""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        for word in ("headless=new", "no-sandbox", "enable-unsafe-swiftshader", "use-angle=swiftshader"):
            options.add_argument(f"--{word}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        cls.browser = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
        cls.browser.set_window_size(1280, 900)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        super().tearDownClass()

    def open(self, file: Path, width: int = 1280) -> None:
        # A headless window has a least width; the screen itself is emulated.
        screen = {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": False}
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)
        self.browser.get(file.as_uri())

    def messages(self) -> list[str]:
        return [entry["message"] for entry in self.browser.get_log("browser")]

    def requests(self) -> list[str]:
        events = (json.loads(e["message"])["message"] for e in self.browser.get_log("performance"))
        sent = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
        return [url for url in sent if not url.startswith(("data:", "file:", "blob:"))]

    def faults(self) -> list[str]:
        return self.browser.execute_script(self.FAULTS)

    def planted(self, what: str, policy: bool = True) -> Path:
        html = self.html.replace("</main>", what + "</main>")
        if not policy:
            html = re.sub('<meta http-equiv="Content-Security-Policy".*?>', "", html)
        file = self.folder / "planted.html"
        file.write_text(html)
        return file

    def test_every_figure_is_seen_nothing_is_loaded_and_the_page_fits(self):
        for file in (self.folder / "report.html", self.folder / "one" / "report.html"):
            for width in (360, 1280):
                self.open(file, width)
                self.assertEqual(self.faults(), [])
                self.browser.execute_script(
                    "document.querySelectorAll('details').forEach(d => d.open = true)"
                )
                self.assertEqual(self.faults(), [])
                self.assertEqual(self.requests(), [])
                self.assertEqual(self.messages(), [])

    @unittest.skipUnless(view3d.scripts(), "libjs-three is not installed")
    def test_the_view_shows_another_picture_at_another_load(self):
        from selenium.webdriver.common.by import By
        from selenium.webdriver.common.keys import Keys

        self.open(self.folder / "one" / "report.html")
        box = self.browser.find_element(By.CSS_SELECTOR, ".view")
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", box)
        canvas = box.find_element(By.TAG_NAME, "canvas")
        slider = box.find_element(By.TAG_NAME, "input")
        self.browser.implicitly_wait(5)
        self.browser.find_element(By.CSS_SELECTOR, ".view[data-ready]")
        words = box.find_element(By.TAG_NAME, "output")
        shown, text = canvas.screenshot_as_png, words.text
        self.assertIn("force 1 mN", text) if slider.get_attribute("max") == "0" else None
        slider.send_keys(Keys.ARROW_LEFT)
        self.assertNotEqual(words.text, text)
        self.assertNotEqual(canvas.screenshot_as_png, shown)
        before = canvas.screenshot_as_png
        canvas.send_keys(Keys.ARROW_LEFT)
        self.assertNotEqual(canvas.screenshot_as_png, before)
        self.assertEqual(self.messages(), [])

    def test_the_checks_see_what_they_look_for(self):
        image = "<img alt='' src='http://127.0.0.1:9/x.png'>"
        script = "<script>console.error('planted')</script>"
        self.open(self.planted(image + script, policy=False))
        self.assertIn("http://127.0.0.1:9/x.png", self.requests())
        self.assertTrue(any("planted" in m for m in self.messages()))
        # The page's own policy stops both, and says so.
        self.open(self.planted(image + script))
        said = self.messages()
        self.assertTrue(any("Content Security Policy" in m for m in said))
        self.assertFalse(any(m.endswith('"planted"') for m in said))
        dot = re.search(r'src="(data:image/png[^"]*)"', self.html).group(1)
        for what, fault in [
            (f"<figure><img alt='p' src='{dot}' width='9' height='9'></figure>", "small: p"),
            (f"<figure><img alt='p' src='{dot}' width='2000' height='99'></figure>", "out of the page: p"),
            ("<figure><img alt='p' src='data:image/png;base64,AA' width='200' height='99'></figure>", "no picture: p"),
            (f"<figure style='visibility:hidden'><img alt='p' src='{dot}' width='200' height='99'></figure>", "hidden: p"),
            ("<div style='width:500px'>wide</div>", "the page is 516 wide on 345"),
            ("<div class='scroll'><div style='width:700px'>wide</div></div>", "not by keyboard"),
            ("<p id='main'>again</p>", "id twice: main"),
            ("<a href='#nowhere'>x</a>", "leads nowhere"),
        ]:  # fmt: skip
            self.open(self.planted(what), 360)
            self.assertIn(fault, self.faults())

    def test_the_keyboard_reaches_contents_tables_and_details(self):
        from selenium.webdriver import ActionChains
        from selenium.webdriver.common.keys import Keys

        self.open(self.folder / "report.html", 360)

        def press(key):
            ActionChains(self.browser).send_keys(key).perform()

        def focused(what):
            return self.browser.execute_script(f"return document.activeElement.{what}")

        press(Keys.TAB)
        self.assertEqual(focused("textContent"), "Skip the contents")
        self.assertGreaterEqual(focused("getBoundingClientRect().left"), 0)
        press(Keys.ENTER)
        self.assertEqual(focused("id"), "main")
        press(Keys.TAB)
        self.assertEqual(focused("className"), "scroll")
        press(Keys.ARROW_RIGHT)
        moved = "return new Promise(r => setTimeout(() => r(document.activeElement.scrollLeft), 500))"
        self.assertGreater(self.browser.execute_script(moved), 0)
        for _ in range(30):
            if focused("tagName") == "SUMMARY":
                break
            press(Keys.TAB)
        press(Keys.ENTER)
        self.assertTrue(focused("parentElement.open"))

    def test_what_stands_in_a_users_file_is_text_and_no_markup(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            make_results(folder, MARKUP)
            report.write(folder)
            self.open(folder / "report.html")
            self.assertEqual(self.messages(), [])
            self.assertIn(MARKUP, self.browser.execute_script("return document.body.innerText"))


if __name__ == "__main__":
    unittest.main()
