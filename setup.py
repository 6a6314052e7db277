# SPDX-License-Identifier: LGPL-2.1-or-later
"""Builds the compiled module and the program with CMake; all else is in pyproject.toml.

CILIAVAL_BUILD names a build tree to take them from, such as build/release; without it they are
built anew, which takes a quarter of an hour.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def run(self):
        build = Path(os.environ.get("CILIAVAL_BUILD") or self.build_temp).resolve()
        if not os.environ.get("CILIAVAL_BUILD"):
            options = ["-DCMAKE_BUILD_TYPE=Release", "-DCILIAVAL_TESTS=OFF", "-DCILIAVAL_PYTHON=ON"]
            options.append(f"-DPython3_EXECUTABLE={sys.executable}")
            subprocess.check_call(["cmake", "-S", SOURCE, "-B", build, *options])
        targets = ["ciliaval_python", "ciliaval"]
        subprocess.check_call(["cmake", "--build", build, "--parallel", "--target", *targets])
        package = Path(self.build_lib) / "ciliaval"
        if self.inplace:
            package = SOURCE / "python" / "ciliaval"
        (package / "bin").mkdir(parents=True, exist_ok=True)
        built = build / "python" / "ciliaval"
        for file in [*built.glob("_core*.so"), built / "declared.json"]:
            shutil.copy2(file, package)
        shutil.copy2(build / "ciliaval", package / "bin")


setup(ext_modules=[Extension("ciliaval._core", [])], cmdclass={"build_ext": CMakeBuild})
