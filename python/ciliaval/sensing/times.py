# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times as loggers write them, to the nanosecond."""

from __future__ import annotations

import contextlib
import re
import warnings
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Array
from .columns import NUMBER, number_in

if TYPE_CHECKING:
    from pandas import Series

_CALENDAR = re.compile(
    r"\A(?:(?P<day>[0-9]{4}[-/][0-9]{2}[-/][0-9]{2})(?:[Tt ]+|\Z))?"
    r"(?:(?P<h>[0-9]{2}):(?P<m>[0-9]{2})(?::(?P<s>[0-9]{1,2})(?:[.,](?P<f>[0-9]*))?)?"
    r"(?P<zone> ?(?:[Zz]|(?P<sign>[+-])(?P<zh>[0-9]{2}):?(?P<zm>[0-9]{2})?))?)?\Z"
)
# Dates that NumPy reads as _CALENDAR does, ten times as fast: UTC, of this century and the last.
_PLAIN = r"(?:19|20)[0-9]{2}-[0-9]{2}-[0-9]{2}[T ][0-9]{2}:[0-9]{2}:[0-9]{2}(?:\.[0-9]{1,9})?Z?"


def time_form(text: str) -> str | None:
    """number, day ("2026-11-25"), date ("2026-11-25T10:18:38.5+01:00") or clock ("10:18:38.5"); None: no time."""
    value = number_in(text)
    if value is not None:
        return "number" if np.isfinite(value) else None
    if not _CALENDAR.match(text):
        return None
    from pandas import Series

    form = calendar_in_ns(Series([text]))[0][0]
    return (None, "date" if ":" in text else "day", "clock")[form]


def numbers_in_ns(texts: Series, unit: float) -> tuple[Array, Array]:
    """Numbers (n texts) of a unit (ns) in whole ns, and which are none. Long doubles hold ns since 1970 exactly."""
    if not (all(map(str.isdigit, texts)) and "".join(texts).isascii()):  # whole numbers need no second look
        texts = texts.where(texts.str.fullmatch(NUMBER), "nan").str.replace(",", ".", regex=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of exponents beyond a long double
        values = texts.to_numpy(dtype="S").astype(np.longdouble)
        ns = np.round(values * np.longdouble(round(unit) if unit >= 1 else unit))
    wrong = ~(np.abs(ns) < 9e18)
    return np.where(wrong, 0, ns).astype(np.int64), wrong


def calendar_in_ns(texts: Series) -> tuple[Array, Array]:
    """ISO 8601 and hh:mm:ss (n texts): 1 of a date, 2 of a time of day, 0 of neither; and whole ns since 1970 or
    midnight."""
    import pandas as pd

    if texts.str.fullmatch(_PLAIN).all():
        with contextlib.suppress(ValueError):  # of a day or a second that there is not
            ns = texts.str.rstrip("Z").to_numpy(dtype="U").astype("datetime64[ns]").astype(np.int64)
            return np.ones(len(texts), dtype=int), ns
    parts = texts.str.extract(_CALENDAR)
    h, m, s, zh, zm = parts[["h", "m", "s", "zh", "zm"]].fillna(0).to_numpy(dtype=np.int64).T
    has_day, has_clock = parts["day"].notna(), parts["h"].notna()
    days = pd.to_datetime(parts["day"].str.replace("/", "-", regex=False), format="%Y-%m-%d", errors="coerce")
    valid = (has_day | has_clock) & (h <= 24) & (m < 60) & (s < 61)
    valid &= (days.notna() | ~has_day) & (parts["zone"].isna() | has_day)
    fraction = ("0." + parts["f"].fillna("")).to_numpy(dtype="U").astype(float)
    zone = np.where(parts["sign"] == "-", -1, 1) * (zh * 60 + zm) * 60
    ns = ((h * 60 + m) * 60 + s - zone) * 10**9 + np.round(1e9 * fraction).astype(np.int64)
    ns += np.where(days.notna(), days.fillna(pd.Timestamp(0)).to_numpy(dtype="datetime64[ns]").astype(np.int64), 0)
    return np.where(valid, np.where(has_day, 1, 2), 0), ns
