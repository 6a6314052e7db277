# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are never half written, and the one door by which result files are read."""

import csv
import json
import os
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from .errors import FileError

# Exceptions that reading and using a damaged file may raise.
DAMAGE = (
    ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError, RecursionError,
    StopIteration, TypeError, ValueError, OSError, zlib.error, ElementTree.ParseError, csv.Error,
)  # fmt: skip
_LARGEST = 256 << 20


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """The name of a file to write, which replaces `file` at the end of the block.

    After an exception `file` is as it was. The name is of the form of the program's own temporary
    files (`compare/output/output_file.cc`): a study takes them away if it was killed.
    An OSError becomes a FileError.
    """
    scratch = file.with_name(f".{file.stem}.{os.getpid()}.0.tmp{file.suffix}")
    try:
        yield scratch
        scratch.replace(file)
    except OSError as error:
        raise FileError(f"{file}: {error.strerror}") from error
    finally:
        scratch.unlink(missing_ok=True)


@cache
def declared() -> dict[str, Any]:
    """Declarations of the compiled models, without loading them: `models` and `loads` as ciliaval.models() and
    ciliaval.load_types() return them. The build writes the file."""
    found: dict[str, Any] = json.loads((Path(__file__).parent / "declared.json").read_text(encoding="utf-8"))
    return found


def content(file: Path, largest: int = _LARGEST) -> bytes:
    """The bytes of a regular file. Raises FileError for what is none (a pipe would wait, a device
    has no end), is larger, or cannot be read."""
    try:
        with open(file, "rb", opener=_without_waiting) as stream:
            of = os.fstat(stream.fileno())
            if not stat.S_ISREG(of.st_mode):
                raise FileError(f"{file}: is no regular file")
            if of.st_size > largest:
                raise FileError(f"{file}: is larger than {largest >> 20} MiB, which no result is")
            return stream.read(largest + 1)
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{file}: {error.strerror}") from error
    except ValueError as error:  # a null byte in the name
        raise FileError(f"{file!r}: {error}") from error


def _without_waiting(name: str, flags: int) -> int:
    return os.open(name, flags | os.O_NONBLOCK)


def within(folder: Path, name: str) -> Path:
    """A file of a folder by its name. Raises FileError if the name leads elsewhere."""
    if not isinstance(name, str) or name in ("", ".", "..") or "/" in name or "\0" in name:
        raise FileError(f"{folder}: {name!r} is no name of a file in it")
    return folder / name


def text_of(error: BaseException) -> str:
    """Text of an exception, for people."""
    known = isinstance(error, (FileError, RuntimeError)) and str(error)
    return str(error) if known else f"{type(error).__name__}: {error}"[:300]
