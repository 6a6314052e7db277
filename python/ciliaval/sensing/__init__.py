# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a sensor and its logger make of a field, and what can be read from it."""

from .signal import Record, record

__all__ = ["Record", "record"]
