# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are never half written."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import FileError


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
