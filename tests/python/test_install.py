# SPDX-License-Identifier: LGPL-2.1-or-later
"""The package where users put it: a virtual environment, an installation of CMake's component."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = os.environ.get("CILIAVAL_BUILD")

USE = """
import ciliaval as cv
rod = cv.Cilium(1e-3, [cv.Segment(20e-3, 1e6, magnetization=1e4)])
shape = cv.bend(rod, cv.Load("contact", force=1e-5, height=10e-3))
assert shape.status == "converged", shape.message
print(cv.__file__)
"""


@unittest.skipUnless(BUILD, "CILIAVAL_BUILD does not name a build tree")
class Install(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # Only what is installed may be found.
        kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "CILIAVAL_PROGRAM")}
        self.environment = kept

    def call(self, *command, **more):
        done = subprocess.run(
            [*map(str, command)], capture_output=True, text=True, check=False, cwd=self.folder, **more
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_by_pip_in_a_virtual_environment(self):
        for name in ("pyproject.toml", "setup.py", "README.md"):
            shutil.copy(SOURCE / name, self.folder)
        shutil.copytree(SOURCE / "python", self.folder / "python")
        self.call(sys.executable, "-m", "venv", "--system-site-packages", "venv")
        python = self.folder / "venv/bin/python"
        environment = {**self.environment, "CILIAVAL_BUILD": BUILD}
        install = [python, "-m", "pip", "install", "--no-build-isolation", "--no-index", "--no-deps", "."]
        self.call(*install, env=environment)
        shutil.rmtree(self.folder / "python")
        self.assertIn("venv", self.call(python, "-c", USE, env=self.environment))
        program = "import ciliaval.program as p; print(p.program()); p.call('--version')"
        self.assertIn("venv", self.call(python, "-c", program, env=self.environment))

    def test_in_the_build_tree_has_its_program(self):
        environment = {**self.environment, "PYTHONPATH": f"{BUILD}/python"}
        program = "import ciliaval.program as p; print(p.program()); p.call('--version')"
        found = self.call(sys.executable, "-c", program, env=environment).strip()
        self.assertTrue(Path(found).samefile(Path(BUILD, "ciliaval")), found)

    def test_by_the_component_of_cmake(self):
        self.call("cmake", "--install", BUILD, "--component", "python", "--prefix", self.folder)
        package = next(self.folder.glob("**/dist-packages"))
        environment = {**self.environment, "PYTHONPATH": str(package)}
        self.assertIn(str(package), self.call(sys.executable, "-c", USE, env=environment))


if __name__ == "__main__":
    unittest.main()
