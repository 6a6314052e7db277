#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""A key of what is described (problem/description/) and a model's id stand in one product file.

Prints each other file that has one as a string, and returns 1. Not looked at are the names of
Python's arguments, which are its interface, and
other models among the choices of an entry's option.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Words that are also the name of something else: of a quantity, a column, a command, a study's key.
WORDS = {"name", "shape", "path", "length", "height", "width", "samples", "seed", "mesh", "radius", "rms", "density", "magnetization", "rotation", "position", "axis"}


def main() -> int:
    listed = subprocess.run(["git", "ls-files", "compare", "problem"], cwd=ROOT, capture_output=True, text=True, check=True)
    files = [f for f in listed.stdout.split() if f.endswith((".cc", ".h")) and (ROOT / f).exists()]
    texts = {f: re.sub(r"//.*", "", (ROOT / f).read_text()) for f in files}
    homes = {}
    for file, text in texts.items():
        if file.startswith("problem/description/"):
            for name in re.findall(r'(?:&\w+::\w+, ?\s*|\w+_key = |\.name = |sized\(\S+ )"(\w+)"', text):
                homes.setdefault(name, set()).add(file)
        if file.startswith("compare/models/entries/"):
            for name in re.findall(r'\.id = "(\w+)"', text):
                homes.setdefault(name, set()).add(file)
    faults = [
        f'{file}: "{name}" is stated in {min(homes[name])}'
        for file, text in sorted(texts.items())
        for name in sorted(homes.keys() - WORDS)
        if f'"{name}"' in text and file not in homes[name] and not file.startswith("compare/models/entries/")
    ]
    print("\n".join(faults) or f"{len(homes)} names, each in one file")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
