# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.paper FOLDER: what `ciliaval claims` runs."""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from ..command import PASS, Progress, declare_common, json_text, provenance, run_command, write_file, write_out
from ..errors import FileError
from . import claims, ledger_text


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.paper", description=__doc__)
    parser.add_argument("folder", type=Path, help="of the shipped cases, cases/paper")
    parser.add_argument("--quick", action="store_true", help="without the 3D solid")
    parser.add_argument("--json", type=Path, help="file to write")
    declare_common(parser)
    options = parser.parse_args()
    if options.json and not options.json.absolute().parent.is_dir():  # a minute before it would be met
        raise FileError(f"{options.json}: there is no folder {options.json.parent}")
    source = provenance(options)
    progress = Progress(options.quiet)
    ledger = claims(options.folder, not options.quick, progress)
    progress.clear()
    if options.json:
        entries = [claim.json() for claim in ledger]
        write_file(options.json, json_text({"schema": 1, "provenance": source, "claims": entries}))
    write_out(ledger_text(ledger, shutil.get_terminal_size((100, 24)).columns))
    return PASS


if __name__ == "__main__":
    sys.exit(run_command(main))
