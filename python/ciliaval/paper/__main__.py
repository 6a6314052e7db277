# SPDX-License-Identifier: LGPL-2.1-or-later
"""python3 -m ciliaval.paper FOLDER: what `ciliaval claims` runs."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

from .. import _core
from ..command import PASS, Progress, run_command, write_out
from ..errors import FileError
from ..files import replacing
from . import claims, ledger_text


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m ciliaval.paper", description=__doc__)
    parser.add_argument("folder", type=Path, help="of the shipped cases, cases/paper")
    parser.add_argument("--quick", action="store_true", help="without the 3D solid")
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")
    parser.add_argument("--json", type=Path, help="file to write")
    parser.add_argument("--command", default="python3 -m ciliaval.paper", help="for the provenance")
    options = parser.parse_args()
    if options.json and not options.json.absolute().parent.is_dir():  # a minute before it would be met
        raise FileError(f"{options.json}: there is no folder {options.json.parent}")
    command = options.command.encode("utf-8", "backslashreplace").decode("utf-8")
    provenance = json.loads(_core.provenance(command))
    progress = Progress(options.quiet)
    ledger = claims(options.folder, not options.quick, progress)
    progress.clear()
    if options.json:
        entries = [claim.json() for claim in ledger]
        text = json.dumps({"schema": 1, "provenance": provenance, "claims": entries}, indent=2)
        with replacing(options.json) as scratch:
            scratch.write_text(text + "\n", encoding="utf-8")
    write_out(ledger_text(ledger, shutil.get_terminal_size((100, 24)).columns))
    return PASS


if __name__ == "__main__":
    sys.exit(run_command(main))
