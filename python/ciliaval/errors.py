# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exceptions of the package: the kinds of error that the program has, with the same texts."""


class Error(RuntimeError):
    """Anything that went wrong in CiliaVal."""


class InputError(Error, ValueError):
    """The input cannot be used."""


class SolverError(Error):
    """A solver did not converge or met a state that it cannot go on from."""


class FileError(Error, OSError):
    """A file could not be read or written."""
