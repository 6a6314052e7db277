# SPDX-License-Identifier: LGPL-2.1-or-later
"""A fresh notebook shows figures and views without magic lines. Skipped without python3-nbclient and python3-ipykernel."""

import base64
import importlib.util
import unittest

from ciliaval.report import view3d

MISSING = [name for name in ("nbclient", "ipykernel") if importlib.util.find_spec(name) is None]

CELLS = [
    """\
import sys
import ciliaval as cv
rod = cv.Cilium(3e-3, [cv.Segment(20e-3, 1e6, magnetization=75e3, name="rod")])
load = cv.Load("contact", force=1e-3, height=16e-3)
result = cv.Case.from_objects(rod, [load, load.changed(force=2e-3)], [0, 0, -2e-3]).run()""",
    "cv.plot.setup(result)",
    "cv.plot.signal(result)",
    "'matplotlib.pyplot' in sys.modules",
    "result.show()" if view3d.scripts() else "",
]


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class Notebook(unittest.TestCase):
    def test_shows_what_its_cells_return(self):
        import nbformat
        from nbclient import NotebookClient

        v4 = nbformat.v4
        notebook = v4.new_notebook(cells=[v4.new_code_cell(text) for text in CELLS])
        NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
        _, setup, signal, pyplot, view = (cell.outputs for cell in notebook.cells)
        for outputs in (setup, signal):
            self.assertEqual(len(outputs), 1)
            png = base64.b64decode(outputs[0]["data"]["image/png"])
            self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
            width = int.from_bytes(png[16:20], "big")
            self.assertAlmostEqual(width, 2 * outputs[0]["metadata"]["image/png"]["width"], delta=2)
        self.assertEqual(pyplot[0]["data"]["text/plain"], "False")  # its state stays the user's
        if view3d.scripts():
            self.assertIn("<iframe srcdoc=", view[0]["data"]["text/html"])


if __name__ == "__main__":
    unittest.main()
