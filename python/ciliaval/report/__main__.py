# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.report DIR [-o FILE.html]: one page of everything in a folder of results."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ..errors import Error
from . import page


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.report", description=__doc__)
    parser.add_argument("folder", type=Path, help="folder of results")
    parser.add_argument("-o", "--output", type=Path, help="file to write (DIR/report.html)")
    parser.add_argument("--case", action="store_true", help="the folder is of one case")
    parser.add_argument("--made-by", default="python3 -m ciliaval.report", help="for the footer")
    options = parser.parse_args()
    try:
        if options.case:
            made = page.case_page(options.folder)
        else:
            made = page.results_page(options.folder, options.made_by)
        page.write(options.output or options.folder / "report.html", made)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    for line in made.damaged:
        print(f"warning: {line}", file=sys.stderr)
    return 4 if made.damaged else 0


if __name__ == "__main__":
    sys.exit(main())
