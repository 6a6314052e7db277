# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common parts of the program's commands that are written in Python: progress, errors, exit codes.

main() is what the program starts for them, with the module and its arguments (compare/app/python.cc).
"""

from __future__ import annotations

import argparse
import importlib
import json
import math
import os
import re
import shutil
import signal
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .errors import FileError, InputError

PASS, TOLERANCE, USAGE, SOLVER, INPUT_OUTPUT, UNDECIDED = range(6)  # docs/guide/README.md

_QUIET_FOR = 2.0  # s, before anything is said
_INTERVAL = 1.0  # s, between two lines


class Progress:
    """Called with a text, says it on stderr: on a terminal as one line that is written over, elsewhere
    as a line for each other text; at most one a second and none in the first two seconds."""

    def __init__(self, is_silent: bool = False):
        self._is_silent = is_silent
        self._start = time.monotonic()
        self._last = self._start
        self._shown = False
        self._said = ""

    def __call__(self, text: str) -> None:
        now = time.monotonic()
        if self._is_silent or now - self._start < _QUIET_FOR or now - self._last < _INTERVAL:
            return
        self._last = now
        line = f"{text} ({now - self._start:.0f} s)"
        if sys.stderr.isatty():
            width = shutil.get_terminal_size().columns - 1
            sys.stderr.write("\r\033[K" + line[:width])
            self._shown = True
        elif text != self._said:
            sys.stderr.write(line + "\n")
        self._said = text
        sys.stderr.flush()

    def clear(self) -> None:
        """Takes the line off the terminal."""
        if self._shown:
            sys.stderr.write("\r\033[K")
            self._shown = False


def terminal_width() -> int:
    """Columns of the terminal that stdout is; 0: it is none."""
    return shutil.get_terminal_size().columns if sys.stdout and sys.stdout.isatty() else 0


def json_text(value: Any) -> str:
    """JSON text as the program writes it: null for a number that is not finite."""
    if not isinstance(value, dict):
        return _dumped(value, 1) + "\n"
    # Each object of a list has its own line; in a very long list 500 share one, since indenting a hundred thousand
    # samples takes seconds.
    parts = []
    for key, entry in value.items():
        is_rows = isinstance(entry, list) and bool(entry) and isinstance(entry[0], dict)
        step = 1 if not is_rows or len(entry) < 1000 else 500
        lines = ",\n  ".join(_dumped(entry[i : i + step])[1:-1] for i in range(0, len(entry), step)) if is_rows else ""
        text = f"[\n  {lines}\n ]" if is_rows else _dumped(entry, 1).replace("\n", "\n ")
        parts.append(f" {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _dumped(value: Any, indent: int | None = None) -> str:
    try:
        return json.dumps(value, indent=indent, ensure_ascii=False, allow_nan=False)
    except ValueError:
        return json.dumps(_finite(value), indent=indent, ensure_ascii=False)


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(v) for v in value]
    return value


def printable(text: str, allowed: str = "") -> str:
    """A text for a terminal, a table or a file: control characters, which a terminal would obey, and
    bytes of a file's name that are no UTF-8 as \\x1B."""

    def shown(found: re.Match[str]) -> str:
        return "".join(f"\\x{byte:02X}" for byte in found[0].encode("utf-8", "surrogateescape"))

    return re.sub(rf"[^\x20-\x7e\xa0-\ud7ff\ue000-\U0010ffff{allowed}]", shown, text)


def declare_common(parser: argparse.ArgumentParser) -> None:
    """The options that the program passes on to each command."""
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")
    parser.add_argument("--command", default=parser.prog, help="for the provenance")


def provenance(options: argparse.Namespace) -> dict[str, Any]:
    """What made a result file: program, date, the command of --command."""
    from . import _core

    made: dict[str, Any] = json.loads(_core.provenance(printable(options.command)))
    return made


class Outputs:
    """Files that a command writes beside its tables, if it names them: --json, --csv, --plot.

    Raises InputError before anything runs if one of them is one of the inputs or another output,
    FileError if it cannot be written.
    """

    def __init__(self, options: argparse.Namespace, inputs: Sequence[Path | str | None]):
        from . import _core

        self.json, self.csv, self.plot = options.json, options.csv, options.plot
        named = [None if file is None else os.fsencode(file) for file in (self.json, self.csv, self.plot)]
        _core.check_outputs(named, [os.fsencode(file) for file in inputs if file is not None])

    @staticmethod
    def declare(parser: argparse.ArgumentParser) -> None:
        for name in ("json", "csv", "plot"):
            parser.add_argument(f"--{name}", help="file to write")

    def write(self, to_json: Callable[[], dict[str, Any]], to_csv: Callable[[], str] | None = None) -> None:
        """Writes those that are named, after the table: a full disk must not cost that."""
        if self.json:
            write_file(self.json, json_text(to_json()))
        if self.csv and to_csv:
            write_file(self.csv, to_csv())
        if self.plot:
            from .plot.__main__ import main_figure, save
            from .results import Document

            figure = main_figure(Document("sense", _finite(to_json())))
            if figure is not None:
                save(figure, Path(self.plot))


def write_file(file: str | Path, text: str) -> None:
    """Replaces a file at once or not at all. Raises FileError."""
    from . import _core

    _core.write_file(os.fsencode(file), text)


def write_out(text: str) -> None:
    """To stdout, which is the result. Raises FileError if it cannot be written."""
    if sys.stdout is None:
        raise FileError("standard output is closed")
    try:
        if hasattr(sys.stdout, "reconfigure"):  # a terminal that has not all characters
            sys.stdout.reconfigure(errors="backslashreplace")
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except OSError as error:
        raise FileError(f"standard output: {error.strerror}") from error


def run_command(execute: Callable[[], int]) -> int:
    """The exit code of a command; an error is said on stderr, Ctrl-C ends the process by its signal."""
    try:
        return execute()
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
        raise
    except (InputError, FileError, RuntimeError, OSError) as error:
        print(f"ciliaval: {error}", file=sys.stderr)
        if isinstance(error, InputError):
            return USAGE
        return INPUT_OUTPUT if isinstance(error, OSError) else SOLVER


def main() -> int:
    # While the module is imported Ctrl-C ends the process: an import that is interrupted may raise anything.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    module = importlib.import_module(f"{sys.argv[1]}.__main__")  # an ImportError is the program's to word
    signal.signal(signal.SIGINT, signal.default_int_handler)
    del sys.argv[1]
    return run_command(module.main)
