# SPDX-License-Identifier: LGPL-2.1-or-later
"""A sweep's field as a logger records and filters it: docs/theory/signal.md.

python3 -m ciliaval.sensing.signal FOLDER: signal.csv beside the sweep.csv of a case with [signal].
"""

from __future__ import annotations

import csv
import io
import math
import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy import signal

from ..arrays import Array
from ..errors import Error, FileError, InputError
from ..files import content, replacing
from ..plain_cilium import as_number
from ..results import read_table

_HIGHEST_ORDER = 20
_MOST_SAMPLES = 10_000_000
_PHASES = ("causal", "zero_phase")


@dataclass(frozen=True)
class Record:
    """A sensor's record at equal intervals.

    time: (n,), s. raw: with the noise, (n, 3), T. filtered: (n, 3), T; raw without a filter.
    """

    time: Array
    raw: Array
    filtered: Array


def record(
    times: npt.ArrayLike,
    B: npt.ArrayLike,
    sampling_rate: float,
    noise: float = 0.0,
    cutoff: float | None = None,
    order: int = 4,
    phase: str = "causal",
    seed: int = 1,
    sensor: int = 0,
) -> Record:
    """The record of a sensor that sees the field B, (m, 3), T, at increasing times, (m,), s.

    1. Samples at t_k = t_0 + k/f_s, up to the last time. B between two times lies on the straight
       line: a sweep's field jumps, and a polynomial of higher degree overshoots at a jump.
    2. Gaussian noise of the standard deviation `noise`, T, independent from sample to sample and
       from component to component; `seed` and `sensor` (its number) give the numbers, and a longer
       record begins with the same noise.
    3. highpass() with the cut-off in Hz; None: no filter.

    Raises InputError if the times do not increase, a number is not finite or out of its range, or the
    record has fewer samples than two or than the filter needs, or more than ten million.

    >>> from ciliaval.sensing import record
    >>> record([0, 1], [[0, 0, 0], [1e-6, 0, 0]], sampling_rate=4).raw[:, 0].tolist()
    [0.0, 2.5e-07, 5e-07, 7.5e-07, 1e-06]
    """
    times, B = np.asarray(times, dtype=float), np.asarray(B, dtype=float)
    _require_valid(times, B, sampling_rate, noise)
    intervals = (times[-1] - times[0]) * sampling_rate * (1 + 1e-12)  # rounding must not cost the last one
    if not intervals >= 1:
        raise InputError(
            f"the record of {times[-1] - times[0]:g} s is shorter than one interval of the sampling rate of "
            f"{sampling_rate:g} Hz: a higher rate, or a slower sweep"
        )
    if not intervals < _MOST_SAMPLES:
        raise InputError(
            f"the record of {times[-1] - times[0]:g} s at {sampling_rate:g} Hz has more than {_MOST_SAMPLES:g} samples: "
            "a lower sampling rate, or a faster sweep"
        )
    at = np.minimum(times[0] + np.arange(1 + int(intervals)) / sampling_rate, times[-1])
    raw = np.stack([np.interp(at, times, component) for component in B.T], axis=1)
    if noise > 0:
        raw += np.random.default_rng([seed, sensor]).normal(0, noise, raw.shape)
    filtered = raw if cutoff is None else highpass(raw, sampling_rate, cutoff, order, phase)
    return Record(at, raw, filtered)


def highpass(
    series: npt.ArrayLike, sampling_rate: float, cutoff: float, order: int = 4, phase: str = "causal"
) -> Array:
    """The columns of a series, (n, …), after a Butterworth high-pass filter of the order 1 to 20 (4: the paper's).

    phase: "causal" from the first sample's steady state, as a filter in the logger, or "zero_phase", of the whole
    record afterwards, which shifts nothing and has the square of the magnitude,
    |H(f)| = 1/sqrt(1 + (tan(pi f_c/f_s)/tan(pi f/f_s))^(2 order)), by the bilinear transform. Raises InputError.
    """
    series = np.asarray(series, dtype=float)
    if not (isinstance(order, (int, np.integer)) and 1 <= order <= _HIGHEST_ORDER):
        raise InputError(f"the order of a filter is 1 to {_HIGHEST_ORDER}, not {order}")
    if phase not in _PHASES:
        raise InputError(f"the phase of a filter is {' or '.join(_PHASES)}, not {phase!r}")
    if not 1e-6 * sampling_rate <= cutoff < sampling_rate / 2:
        raise InputError(
            f"the cut-off lies between a millionth and half of the sampling rate of {sampling_rate:g} Hz, not at {cutoff:g} Hz"
        )
    sections = signal.butter(order, cutoff, "highpass", fs=sampling_rate, output="sos")
    if phase == "causal":
        # As if the first sample had always been there: taking it off loses no digits to an offset.
        return np.asarray(signal.sosfilt(sections, series - series[0], axis=0))
    least = 3 * (order + 1)  # of the reflection at each end
    if len(series) <= least:
        raise InputError(
            f"a filter of order {order} without a shift of phase needs more than {least} samples; there are {len(series)}"
        )
    return np.asarray(signal.sosfiltfilt(sections, series, axis=0))


def _require_valid(times: Array, B: Array, sampling_rate: float, noise: float) -> None:
    if times.ndim != 1 or B.shape != (len(times), 3) or len(times) < 2:
        raise InputError(
            f"a record needs two times or more, each with its field: the times have the shape {times.shape}, the fields {B.shape}"
        )
    if not (np.isfinite(times).all() and np.isfinite(B).all()):
        raise InputError("a time or a field to be recorded is not finite")
    if not (np.diff(times) > 0).all():
        i = int(np.argmin(np.diff(times) > 0))
        raise InputError(
            f"the times to be recorded must increase, but after {times[i]:g} s comes {times[i + 1]:g} s (number {i + 2})"
        )
    if not (sampling_rate > 0 and math.isfinite(sampling_rate)):
        raise InputError(f"the sampling rate must be finite and positive, not {sampling_rate:g} Hz")
    if not (noise >= 0 and math.isfinite(noise)):
        raise InputError(f"the noise's standard deviation must be finite and not negative, not {noise:g} T")


def signal_csv(folder: Path) -> str:
    """signal.csv of a folder with the case.toml and sweep.csv of a case with [signal]: of each pair of
    models and each sensor dB as the logger records it (`dB`) and filtered. Raises FileError,
    InputError."""
    try:
        options = tomllib.loads(content(folder / "case.toml").decode("utf-8"))["signal"]
        rate = as_number(options["sampling_rate"])
        noise, cutoff = (as_number(options[key]) if key in options else None for key in ("noise", "cutoff"))
    except (ValueError, KeyError) as error:
        raise FileError(f"{folder / 'case.toml'}: has no [signal]: {error}") from error
    sweep = read_table(folder / "sweep.csv")
    columns: dict[str, Array] = {}
    count: dict[str, int] = {}  # sensors of each pair
    for name in sweep:
        found = re.fullmatch(r"(.+/.+)\.dB(.*)_x", name)
        if not found:
            continue
        pair, label = found.groups()
        sensor = count[pair] = count.get(pair, -1) + 1
        B = np.stack([sweep[f"{pair}.dB{label}_{axis}"] for axis in "xyz"], axis=1)
        if np.isnan(B).any():
            continue  # the model has not come to the end
        made = record(
            sweep["time"], B, rate, noise or 0.0, cutoff, options.get("order", 4), options.get("phase", "causal"),
            options.get("seed", 1), sensor,
        )  # fmt: skip
        columns.setdefault("time", made.time)
        for kind, values in (("dB", made.raw), ("filtered", made.filtered)):
            for axis, component in zip("xyz", values.T):
                columns[f"{pair}.{kind}{label}_{axis}"] = component
    columns.setdefault("time", np.zeros(0))
    units = ", ".join(f"{name} {'s' if name == 'time' else 'T'}" for name in columns)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    text.write(f"# units: {units}\n")
    writer.writerows(zip(*(values.tolist() for values in columns.values())))
    return text.getvalue()


def main() -> int:
    folder = Path(sys.argv[-1])
    try:
        text = signal_csv(folder)
        with replacing(folder / "signal.csv") as scratch:
            scratch.write_text(text, encoding="utf-8")
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
