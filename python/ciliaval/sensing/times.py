# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times as loggers write them, to the nanosecond."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from .columns import number_in

if TYPE_CHECKING:
    from pandas import Series

_ISO = re.compile(
    rb"(?:(?P<Y>0000)[-/](?P<M>00)[-/](?P<D>00))?(?:(?:(?<=0)[Tt ]+|(?<!0))"
    rb"(?P<h>00):(?P<m>00)(?::(?P<s>0{1,2})(?:[.,](?P<f>0*))?)?)?"
    rb" ?(?P<zone>[Zz]|(?P<sign>[+-])(?P<zh>00):?(?P<zm>00)?)?"
)
_SHAPE = np.arange(256, dtype=np.uint8)  # digits as 0: what texts of one form have in common
_SHAPE[ord("0") : ord("9") + 1] = ord("0")
_IN_NUMBER = np.isin(np.arange(256), list(b"\0+-.0123456789eE"))


def bytes_of(column: Series) -> npt.NDArray[np.bytes_]:
    try:
        return np.asarray(column.to_numpy().astype("S"))
    except UnicodeEncodeError:
        return np.array([text.encode("ascii", "replace") for text in column])


def time_form(text: str) -> str | None:
    """number, day ("2026-11-25"), date ("2026-11-25T10:18:38.5+01:00") or clock ("10:18:38.5"); None: no time."""
    value = number_in(text)
    if value is not None:
        return "number" if np.isfinite(value) else None
    cells = np.array([text.encode("ascii", "replace")])
    form = calendar_in_ns(cells)[0][0]
    return (None, "day" if b":" not in cells[0] else "date", "clock")[form]


def numbers_in_ns(cells: Array, unit: float) -> tuple[Array, Array]:
    """Numbers (n texts) of a unit (ns) in whole ns, and which are none. Long doubles hold ns since 1970 exactly."""
    cells = np.char.strip(cells)
    raw = cells.view(np.uint8).reshape(len(cells), -1).copy()
    raw[raw == ord(",")] = ord(".")
    wrong = ~_IN_NUMBER[raw].all(axis=1)
    raw[wrong] = 0
    texts = raw.view(cells.dtype).ravel()
    texts[texts == b""] = b"nan"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of exponents beyond a long double
        try:
            values = texts.astype(np.longdouble)
        except ValueError:
            values = np.array([np.longdouble(t if number_in(t.decode()) is not None else b"nan") for t in texts])
        ns = np.round(values * np.longdouble(round(unit) if unit >= 1 else unit))
    wrong |= ~(np.abs(ns) < 9e18)
    return np.where(wrong, 0, ns).astype(np.int64), wrong


def calendar_in_ns(cells: Array) -> tuple[Array, Array]:
    """ISO 8601 and hh:mm:ss (n texts): 1 of a date, 2 of a time of day, 0 of neither; and whole ns since 1970 or
    midnight.

    Texts of one form, as "0000-00-00T00:00:00Z" with all digits 0, are read together.
    """
    raw = np.ascontiguousarray(cells).view(np.uint8).reshape(len(cells), -1)
    shapes = _SHAPE[raw].view(cells.dtype).ravel()
    forms, ns = np.zeros(len(cells), dtype=int), np.zeros(len(cells), dtype=np.int64)
    left = np.arange(len(cells))
    for _ in range(100):  # of more forms than any logger has the others are none
        if not len(left):
            break
        form = shapes[left[0]]
        here, left = left[shapes[left] == form], left[shapes[left] != form]
        found = _ISO.fullmatch(form.strip(b" \t"))
        if not found or not (found["Y"] or found["h"]) or (found["zone"] and not (found["Y"] and found["h"])):
            continue
        lead = len(form) - len(form.lstrip(b" \t"))

        def digits(name: str, most: int = 9) -> Array:
            assert found is not None
            begin, end = found.span(name)
            end = min(end, begin + most)
            values = raw[here, lead + begin : lead + end].astype(np.int64) - ord("0")
            return values @ 10 ** np.arange(end - begin)[::-1]

        hour, minute, second = (digits(name) for name in "hms")
        size = max(0, found.end("f") - found.start("f"))
        fraction = digits("f") * 10 ** max(0, 9 - size) + (digits("f", 10) % 10 >= 5 if size > 9 else 0)
        valid = (hour <= 24) & (minute < 60) & (second < 61)
        value = ((hour * 60 + minute) * 60 + second) * 10**9 + fraction
        if found["Y"]:
            year, month, day = (digits(name) for name in "YMD")
            months = ((year - 1970) * 12 + month - 1).astype("datetime64[M]")
            begins, ends = (m.astype("datetime64[D]").astype(np.int64) for m in (months, months + 1))
            valid &= (1 <= month) & (month <= 12) & (1 <= day) & (day <= ends - begins) & (abs(year - 1970) < 290)
            value += np.where(valid, begins + day - 1, 0) * 86_400 * 10**9
            zone = (digits("zh") * 60 + digits("zm")) * 60 * 10**9
            if found["sign"]:
                value -= np.where(raw[here, lead + found.start("sign")] == ord("-"), -zone, zone)
        forms[here] = np.where(valid, 1 if found["Y"] else 2, 0)
        ns[here] = value
    return forms, ns
