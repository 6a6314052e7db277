# SPDX-License-Identifier: LGPL-2.1-or-later
"""Readings of loads that are not known, less all offsets: docs/guide/sensing.md, Readings."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path

import numpy as np
from scipy import sparse

from .._core import quantity
from ..arrays import Array
from ..command import printable
from ..errors import FileError, InputError
from ..files import content
from .columns import Faults, Option, in_quotes
from .loggers import MOST_ROWS, Table, read_table

_LARGEST_FILE = 100_000_000  # bytes
_SAME_AZIMUTH = 1e-9  # rad
_TURN = 2 * math.pi
_UNLOADED = "unloaded"
_ONE_BY_CHANCE = 1e-6


@dataclass(frozen=True)
class ReadingOptions:
    """Options for reading a file of readings where it does not say so itself: docs/guide/sensing.md."""

    map: Option = Option()
    unit: Option = Option()
    scale: Option = Option()
    unloaded: Option = Option()
    average: Option = Option()
    temperature: Option = Option()
    skip: bool = False


OPTIONS = [option.name for option in fields(ReadingOptions)]

@dataclass(frozen=True)
class Readings:
    """n samples of what all sensors read, less all offsets.

    change: (n, sensors, 3), dB, T; where measured_offset is False ("model") B, from which the offset is to be taken.
    rows: (n,), averaged, of the sensor with the fewest. time: (n,), s, of the first row. background:
    (n, sensors, sensors), covariance of the sensors by the background's noise over sigma^2. offset_variance:
    1/(unloaded rows), over sigma^2, or 0. squares, freedom: sum of (B - mean)^2, T^2, of the rows that
    are averaged, and its degrees of freedom. unloaded: (sensors, 3), mean B of the unloaded rows as the
    file has it, T. remarks: what was read, what was not, and doubts.
    """

    names: list[str]
    change: Array
    rows: Array
    time: Array | None = None
    background: Array | None = None
    measured_offset: bool = False
    offset_variance: float = 0.0
    squares: float = 0.0
    freedom: int = 0
    unloaded: Array | None = None
    remarks: list[str] = field(default_factory=list)

    def variance(self) -> Array:
        """Variance of dB by the noise of reading, over sigma^2, (n,): 1/m + 1/n with m rows and n unloaded ones."""
        return 1 / self.rows + self.offset_variance

    def require_offset(self, what: str) -> None:
        """Raises InputError where B of the unloaded cilium is not known, so that these are no changes."""
        if not self.measured_offset:
            raise InputError(f"{what} needs dBx, dBy, dBz, or unloaded rows")

    def common_variance(self) -> Array:
        """The variance over sigma^2 that dB of a sample has in common with that of the others, (n,): of the offset and
        the background; of several sensors the largest in any combination of them."""
        common = np.full(len(self.rows), self.offset_variance)
        if self.background is not None:
            common += np.maximum(np.linalg.eigvalsh(self.background)[:, -1], 0)
        return common


class Background:
    """The ambient field that the sensors see at each azimuth, without the cilium.

    Rows of one azimuth (to 1e-9) and sensor are averaged. rows: (means,), of each mean. Sensors that the file
    does not tell apart share the means. Raises InputError.
    """

    def __init__(self, data: bytes, file: object, sensors: Sequence[str], reads: Array | None = None):
        faults = Faults()
        table = read_table(data, sensors, faults, reads=reads)
        if table is not None and table.azimuth is None:
            faults.add("there is no column 'azimuth'")
        if table is not None and table.is_change:
            faults.add("the background is B: name its columns Bx, By, Bz")
        faults.require_none(file)
        assert table is not None and table.azimuth is not None
        is_for_all = not table.is_wide and table.sensor is None
        rows: list[Array] = []
        self._means = []  # of each sensor: azimuths, rising, in [0, 2 pi), B, and the number of its first mean
        for s, sensor in enumerate(sensors[:1] if is_for_all else sensors):
            mine = np.ones(len(table.B), dtype=bool) if table.sensor is None else table.sensor == s
            if not mine.any():
                faults.refuse(file, f"there is no row of sensor {sensor}")
            azimuth = table.azimuth[mine] % _TURN
            azimuth[azimuth >= _TURN - _SAME_AZIMUTH] -= _TURN  # just below a turn is zero
            order = np.argsort(azimuth, kind="stable")
            group = np.zeros(len(order), dtype=int)
            group[order] = np.cumsum(np.diff(azimuth[order], prepend=azimuth[order[0]]) > _SAME_AZIMUTH)
            count = np.bincount(group)
            means = _means(np.column_stack([azimuth, table.B[mine, s if table.is_wide else 0]]), group, count)
            self._means.append((means[:, 0], means[:, 1:], sum(map(len, rows))))
            rows.append(count)
        self._means *= len(sensors) if is_for_all else 1
        self.rows = np.concatenate(rows)

    def parts(self, azimuth: Array, sensor: int) -> tuple[Array, Array]:
        """The two means at azimuths (n,), rad, and their weights, (n, 2): a row's own, else by linear interpolation
        between the neighbours on the circle; NaN if there are but rows of another azimuth."""
        known, _, first = self._means[sensor]
        phi = np.asarray(azimuth, dtype=float) % _TURN
        above = np.searchsorted(known, phi, side="right")
        last, following = (above - 1) % len(known), above % len(known)
        apart = [np.abs((known[i] - phi + math.pi) % _TURN - math.pi) for i in (last, following)]
        step = (known[following] - known[last]) % _TURN
        with np.errstate(invalid="ignore", divide="ignore"):
            t = ((phi - known[last]) % _TURN) / step  # a single azimuth: no number
        t = np.where(apart[1] <= _SAME_AZIMUTH, 1, t if len(known) > 1 else np.nan)
        t = np.where(apart[0] <= _SAME_AZIMUTH, 0, t)
        return np.stack([last, following], axis=1) + first, np.stack([1 - t, t], axis=1)

    def at(self, azimuth: Array, sensor: int) -> Array:
        """The field at azimuths (n,), rad, (n, 3), T."""
        (means, weights), (_, B, first) = self.parts(azimuth, sensor), self._means[sensor]
        return np.asarray(np.einsum("ni,nij->nj", weights, B[means - first]))


def _part_of(option: Option) -> tuple[str, float, float]:
    """Rows of the unloaded cilium, besides those of the sample `unloaded`: "rows" or "time", with the first and the
    last, of "rows 1..20", "0 s..1 s" or "0..1 s"; "model"; or "". Raises InputError."""
    text = option.text.strip(" \t")
    if text in ("", "model"):
        return text, 0, 0

    def refusal(why: str) -> InputError:
        form = '"0 s..1 s" by the time, "rows 1..20" by the rows below the header, or "model"'
        return Option(text, option.where).refusal(f"{why}: write {form}")

    first, dots, last = (part.strip(" \t") for part in text.removeprefix("rows ").partition(".."))
    if not dots:
        raise refusal("is no range")
    if text.startswith("rows "):
        if not (first.isdigit() and last.isdigit() and 1 <= int(first) and max(int(first), int(last)) <= MOST_ROWS):
            raise refusal("is no range of rows from 1 on")
        kind, ends = "rows", (float(first), float(last))
    else:
        number = "0123456789.+-eE "
        bare = not first.strip(number)  # then it has the unit of the other end
        try:
            begin = quantity(f"{first} {last.lstrip(number)}" if bare else first, "s")
            kind, ends = "time", (begin, quantity(last, "s"))
        except InputError as fault:
            raise refusal(f"is no range of time ({fault})") from fault
    if ends[1] < ends[0]:
        raise refusal("ends before it begins")
    return kind, *ends


def read_readings(
    file: Path,
    sensors: Sequence[str],
    options: ReadingOptions = ReadingOptions(),
    background: Path | None = None,
    reads: Array | None = None,
) -> Readings:
    """Reads readings from a file as loggers write it for a case with these sensors, and takes off the earth's field and
    the undeformed magnet's:

        dB = (B - background(azimuth)) - (B_unloaded - background(azimuth of the unloaded)).

    Each row of the background has the noise of a reading; what it adds to both parts of dB adds no noise. With
    options.temperature, a coefficient alpha of the same field's reading, each B is that at the mean temperature T_0 of
    the unloaded rows, B/(1 + alpha (T - T_0)). reads: (sensors, 3), which components the file has; None: all.
    Raises InputError with every fault, a line each: `file:line:column: what is wrong`.
    """
    file = Path(file)
    part = _part_of(options.unloaded)
    window = _window(options.average)
    coefficient = _coefficient(options.temperature)
    ambient = None
    if background is not None:
        ambient = Background(_bytes_of(Path(background)), background, sensors, reads)
    faults = Faults()
    table = read_table(
        _bytes_of(file), sensors, faults, options.map, options.unit, options.scale, options.skip, coefficient != 0, reads
    )
    faults.require_none(file)
    assert table is not None
    if fault := _unsuitable(table, sensors, part, options, ambient is not None):
        faults.refuse(file, fault)
    grouped = _Grouped(table, sensors, part, window, ambient, faults, file, reads)
    if coefficient:
        grouped.to_one_temperature(coefficient, options.temperature.where)
    return grouped.readings(options.unloaded)


def _bytes_of(file: Path) -> bytes:
    if not file.is_file():
        raise InputError(
            f"{file}:1:1: there is no such file: a name without a leading / is looked for beside the case file"
        )
    if file.stat().st_size > _LARGEST_FILE:
        raise InputError(f"{file}:1:1: the file is larger than {_LARGEST_FILE} bytes")
    try:
        return content(file, _LARGEST_FILE)
    except FileError as error:
        raise InputError(f"{file}:1:1: the file cannot be read") from error


def _window(option: Option) -> float:
    """The length of the windows of --average, s; 0 if it is not given. Raises InputError."""
    length = option.by(lambda text: quantity(text, "s"))
    if length is not None and not 1e-9 <= length < 9e9:
        raise option.refusal('is no length of time, such as "10 ms"')
    return length or 0.0


def _coefficient(option: Option) -> float:
    """alpha, 1/K, of "-0.1 %/K"; 0 if it is not given. Raises InputError."""
    found = re.fullmatch(r"\s*([-+]?\d*\.?\d+(?:e[-+]?\d+)?)\s*(%|ppm|1)?\s*/\s*(?:K|degC|°C)\s*", option.text)
    if option.text and not found:
        raise option.refusal('is no coefficient, such as "-0.1 %/K" or "-1000 ppm/K"')
    alpha = float(found[1]) * {"%": 1e-2, "ppm": 1e-6}.get(found[2], 1.0) if found else 0.0
    if abs(alpha) > 0.1:
        raise option.refusal("is more than 10 %/K, which no sensor has")
    return alpha


def _unsuitable(
    table: Table, sensors: Sequence[str], part: tuple[str, float, float], options: ReadingOptions, has_background: bool
) -> str | None:
    """Reason why the file does not suffice for the options given; None if it does."""
    has_key = table.sensor is not None and (table.sample is not None or table.time is not None)
    if len(sensors) > 1 and not table.is_wide and not has_key:
        return (
            f"the case has {len(sensors)} sensors: the file needs the columns 'sample' and 'sensor', and a row for "
            "each; or columns for each, such as s0_Bx, s0_By, s0_Bz, s1_Bx"
        )
    if has_background and table.azimuth is None:
        return "the background depends on the azimuth: the readings need a column 'azimuth'"
    if has_background and table.is_change:
        return "the change dB has no background any more: leave the background out"
    if part[0] == "time" and table.time is None:
        return f'{options.unloaded.where} is a range of time, but {table.timeless}; --unloaded "rows 1..20" needs none'
    if options.average.text and table.time is None:
        return f"{options.average.where} is a length of time, but {table.timeless}"
    return None


class _Grouped:
    """The rows by sample in the order of the file, and those of the unloaded cilium, which are group 0."""

    def __init__(
        self, table: Table, sensors: Sequence[str], part: tuple[str, float, float], window: float,
        ambient: Background | None, faults: Faults, file: Path, reads: Array | None,
    ):  # fmt: skip
        self.reads = np.ones((len(sensors), 3), dtype=bool) if reads is None else reads
        self.table, self.sensors, self.part, self.ambient = table, sensors, part, ambient
        self.faults, self.file, self.window = faults, file, window
        self.named = np.zeros(len(table.B), dtype=bool)
        if table.sample is not None:
            self.named = (np.array(table.names) == _UNLOADED)[table.sample]
        self.unloaded = self.named.copy()
        if part[0] in ("rows", "time"):
            values = table.number if part[0] == "rows" else table.time
            assert values is not None
            slack = table.resolution if part[0] == "time" else 0  # a row at a boundary belongs to the part
            self.unloaded |= (values >= part[1] - slack) & (values <= part[2] + slack)
        self.loaded = np.flatnonzero(~self.unloaded)
        key, window_of = self._keys()
        self.group = np.zeros(len(table.B), dtype=int)
        self.group[self.loaded], first = 1 + key, np.unique(key, return_index=True)[1]
        self.first = self.loaded[first]  # row of each sample
        self.names = self._names(window_of[first] if window else None)

    def to_one_temperature(self, alpha: float, where: str) -> None:
        """B at the mean temperature of the unloaded rows. Raises InputError."""
        temperature = self.table.temperature
        if self.table.is_change or not self.unloaded.any():
            what = f"{where} needs unloaded rows, against whose temperature the others are corrected"
            self.faults.refuse(self.file, what)
        assert temperature is not None
        growth = 1 + alpha * (temperature - temperature[self.unloaded].mean())
        if (growth <= 0.5).any():
            line = int(self.table.line[np.argmin(growth)])
            what = f"the temperature {temperature[np.argmin(growth)]:g} is too far from the unloaded rows'"
            self.faults.refuse(self.file, what, line)
        self.table.B = self.table.B / growth[:, None, None]
        self.table.remark += f"; B at {temperature[self.unloaded].mean():.4g} degrees"

    def _keys(self) -> tuple[Array, Array]:
        """Numbers of each loaded row: of its sample, in the order of the file, and of its window."""
        import pandas as pd  # it takes half a second

        table, loaded = self.table, self.loaded
        window_of = np.zeros(len(loaded), dtype=int)
        if table.sample is not None:
            key = pd.factorize(table.sample[loaded])[0]
        elif self.window:
            key = window_of
        elif table.sensor is not None and table.time is not None:
            key = pd.factorize(table.time[loaded])[0]
        else:
            key = np.arange(len(loaded))
        if self.window and len(loaded):
            assert table.time is not None
            time = table.time[loaded]
            begin = pd.Series(time).groupby(key).transform("min").to_numpy()
            slack = table.resolution + 1e-12 * np.abs(time).max()
            window_of = np.floor((time - begin + slack) / self.window).astype(np.int64)
            key = pd.factorize(key * (window_of.max() + 1) + window_of)[0]
        return key, window_of

    def _names(self, window_of: Array | None) -> list[str]:
        table = self.table
        times = []
        if table.time is not None:
            times = [f"{repr(time).removesuffix('.0')} s" for time in table.time[self.first].tolist()]
        if table.sample is None:
            return times or [str(number) for number in table.number[self.first]]
        names = [table.names[i] for i in table.sample[self.first]]
        if window_of is None or not window_of.any():
            return names
        return [f"{name}, {time}" for name, time in zip(names, times)]

    def readings(self, option: Option) -> Readings:
        """The means less the offset and the background. Raises InputError."""
        table, sensors = self.table, self.sensors
        n, k = 1 + len(self.first), len(sensors)
        # An entry for each row and sensor: the sensor, and B.
        width = table.B.shape[1]
        row = np.repeat(np.arange(len(table.B)), width)
        sensor = np.tile(np.arange(width), len(table.B)) if table.sensor is None else table.sensor
        B = table.B.reshape(-1, 3)
        at = self.group[row] * k + sensor
        count = np.bincount(at, minlength=n * k).reshape(n, k)
        any_unloaded = bool(count[0].any())
        for g, s in np.argwhere((count == 0) & ((np.arange(n) > 0) | any_unloaded)[:, None])[: Faults.most]:
            name = in_quotes(self.names[g - 1] if g else _UNLOADED)
            self.faults.add(f"there is no row of sample {name}, sensor {sensors[s]}", int(table.line[-1]))
        if not len(self.faults):
            self._check_unloaded(option, any_unloaded)
        self.faults.require_none(self.file)
        per = np.maximum(count, 1).reshape(-1)
        as_read = _means(B, at, per)
        if self.ambient is not None:
            B, weights = self._less_background(B, row, sensor)
        mean = _means(B, at, per)
        rest = B - mean[at]
        shift = _means(rest, at, per)  # the rounding of long sums
        mean, rest = mean + shift, rest - shift[at]
        squares = float((rest**2).sum())
        covariance = None
        if self.ambient is not None:
            squares = self._weighted_squares(rest, at, weights)
            covariance = self._covariance(at, weights, per, n, k)
        mean = mean.reshape(n, k, 3)
        rows = count.min(axis=1)
        return Readings(
            names=self.names,
            change=mean[1:] - mean[0] if any_unloaded else mean[1:],
            rows=rows[1:],
            time=None if table.time is None else table.time[self.first],
            background=covariance,
            measured_offset=table.is_change or any_unloaded,
            offset_variance=1 / rows[0] if any_unloaded else 0.0,
            squares=squares,
            freedom=int((np.maximum(count - 1, 0) * self.reads.sum(axis=1)).sum()),
            unloaded=as_read.reshape(n, k, 3)[0] if any_unloaded else None,
            remarks=self._remarks(int(rows[0]) if any_unloaded else 0),
        )

    def _check_unloaded(self, option: Option, any_unloaded: bool) -> None:
        """Adds the faults of rows that are unloaded and of an option that says otherwise."""
        table, part, faults = self.table, self.part, self.faults
        line = int(table.line[np.argmax(self.named)]) if self.named.any() else 0
        if table.is_change and line:
            faults.add("the change dB of the unloaded cilium is zero: leave its rows out", line)
        elif table.is_change and part[0]:
            faults.add(f"the change dB needs no unloaded reading: leave {option.where} out")
        elif line and part[0]:
            faults.add(f"there are rows of the sample `unloaded`: leave {option.where} out", line)
        elif not any_unloaded and part[0] in ("rows", "time"):
            has = f"the rows 1..{table.number[-1]}"
            if part[0] == "time" and table.time is not None:
                has = f"the times {table.time[0]:g} s..{table.time[-1]:g} s"
            faults.add(f'no row lies in "{option.text}" of {option.where}: the file has {has}')
        elif len(self.first) and not any_unloaded and not table.is_change and not part[0]:
            faults.add(
                "there is no reading of the unloaded cilium, without which the earth's field would be read as load: "
                "name its rows `unloaded` in a column 'sample', or say which they are: --unloaded \"0 s..1 s\" by the "
                "time or --unloaded \"rows 1..20\"; --unloaded model takes the model's own B instead"
            )
        elif not len(self.first):
            faults.add("there is no reading but of the unloaded cilium")

    def _less_background(
        self, B: Array, row: Array, sensor: Array
    ) -> tuple[Array, sparse.csr_matrix]:
        """B less the background, and the weights with which its means were taken off, (entries, means)."""
        table, ambient = self.table, self.ambient
        assert ambient is not None and table.azimuth is not None
        means, weights = np.zeros((len(B), 2), dtype=int), np.zeros((len(B), 2))
        B = B.copy()
        for s in range(len(self.sensors)):
            mine = sensor == s
            azimuth = table.azimuth[row[mine]]
            means[mine], weights[mine] = ambient.parts(azimuth, s)
            B[mine] -= ambient.at(azimuth, s)
        for line in table.line[row[np.isnan(weights[:, 0])]][: Faults.most]:
            what = "the background has a single azimuth, which is not this row's: measure it at more"
            self.faults.add(what, int(line))
        self.faults.require_none(self.file)
        entries = np.repeat(np.arange(len(B)), 2)
        return B, sparse.csr_matrix((weights.ravel(), (entries, means.ravel())), (len(B), len(ambient.rows)))

    def _weighted_squares(self, rest: Array, at: Array, weights: sparse.csr_matrix) -> float:
        """The squares of rows about their mean, weighted by V^-1; over sigma^2 it is chi^2 of 3 (rows - 1) degrees of
        freedom.

        Each row has the noise 1 of its own, and by W (rows x means) that of the background: V = I + W D W^T, D
        the variances of its means. V^-1 = I - W (D^-1 + W^T W)^-1 W^T (Woodbury).
        """
        assert self.ambient is not None
        total = 0.0
        order = np.argsort(at, kind="stable")
        for rows in np.split(order, 1 + np.flatnonzero(np.diff(at[order]))):
            x = rest[rows]
            # Rows of one azimuth have the background's error in common: it is gone with their mean.
            if len(rows) == 1 or np.ptp(W := weights[rows].toarray(), axis=0).max() == 0:
                total += float((x**2).sum())
                continue
            inner = np.diag(self.ambient.rows.astype(float)) + W.T @ W
            ones = np.ones((len(x), 1))
            of_x, of_ones = (y - W @ np.linalg.solve(inner, W.T @ y) for y in (x, ones))
            total += float((x * of_x).sum() - ((of_ones.T @ x) ** 2).sum() / of_ones.sum())
        return total

    def _covariance(self, at: Array, weights: sparse.csr_matrix, per: Array, n: int, k: int) -> Array:
        """The covariance of the sensors' dB by the background's noise, over sigma^2, (samples, k, k): A D A^T, A the
        weights of its means in dB, D = diag(1/rows)."""
        assert self.ambient is not None
        pick = sparse.csr_matrix((1 / per[at], (at, np.arange(len(at)))), (n * k, len(at)))
        scaled = (pick @ weights @ sparse.diags(1 / np.sqrt(self.ambient.rows))).tocsr()
        A = [scaled[s::k] for s in range(k)]
        offset = [part[0].toarray().ravel() for part in A]  # zero without unloaded rows
        covariance = np.empty((n - 1, k, k))
        for s in range(k):
            for t in range(k):
                both = np.asarray(A[s].multiply(A[t]).sum(axis=1)).ravel()
                mixed = A[s] @ offset[t] + A[t] @ offset[s]
                covariance[:, s, t] = (both - mixed + offset[s] @ offset[t])[1:]
        return covariance

    def _remarks(self, unloaded: int) -> list[str]:
        remark = self.table.remark + (f"; {unloaded} unloaded" if unloaded else "")
        if self.window:
            remark += f"; averaged over {self.window:g} s"
        return [printable(f"{self.file.name}: {text}.") for text in (remark, *silent_doubts(self.table, self.sensors))]


def _means(values: Array, at: Array, count: Array) -> Array:
    return np.asarray(
        np.stack([np.bincount(at, component, len(count)) for component in values.T], axis=1) / count[:, None]
    )


def silent_doubts(table: Table, sensors: Sequence[str]) -> list[str]:
    """Doubts that a file does not show by itself: a sensor that stands still, and negative numbers that were
    wrapped."""
    doubts = []
    for s, sensor in enumerate(sensors):
        mine = np.arange(len(table.B)) if table.sensor is None else np.flatnonzero(table.sensor == s)
        of = f" of the sensor {sensor}" if len(sensors) > 1 else ""
        if s < table.counts.shape[1] or table.sensor is not None:
            counts = table.counts[mine, s if table.is_wide else 0]
            if found := _frozen(counts):
                first, last = (table.line[mine[i]] for i in found)
                values = ", ".join(f"{value:g}" for value in counts[found[0]])
                doubts.append(
                    f"the readings{of} of the lines {first} to {last} are all ({values}), to the last digit, which "
                    "noise as in the other rows does not do: did the sensor stand still? Leave these rows out"
                )
            for axis in np.flatnonzero(_is_wrapped(counts, table.is_lsb)):
                doubts.append(
                    f"B{'xyz'[axis]}{of} jumps between 0 and 65535: negative numbers of 16 bits were written without "
                    "their sign, 65535 for -1; subtract 65536 from those above 32767"
                )
    return doubts


def _frozen(counts: Array) -> tuple[int, int] | None:
    """First and last row of the longest run of equal rows (n, 3), if noise of several counts makes none as long in a
    million files.

    A run goes on with the probability p: of those that are as long as most of them, the part that is longer; or
    the part of the other rows that read the same, if it is larger. r runs with the median m hold one of L
    rows with a probability below r p^(L - m).
    """
    steps = np.abs(np.diff(counts, axis=0))
    begins = np.flatnonzero(np.concatenate([[True], (steps != 0).any(axis=1)]))
    lengths = np.diff(begins, append=len(counts))
    if len(lengths) < 16:
        return None  # too few to tell what noise does
    steps = steps[begins[1:] - 1]
    count = np.min(np.where(steps > 0, steps, np.inf), axis=0)  # the smallest step of each component
    if np.median((steps / count).max(axis=1)) < 2:
        return None
    run = int(np.argmax(lengths))
    first, length = int(begins[run]), int(lengths[run])
    others = np.delete(lengths, run)
    usual = int(np.median(others))
    longer = ((others > usual).sum() + 1) / ((others >= usual).sum() + 2)
    same = ((counts == counts[first]).all(axis=1).sum() - length + 1) / (len(counts) - length + 2)
    if length < 8 or len(lengths) * max(longer, same) ** (length - usual) > _ONE_BY_CHANCE:
        return None
    return first, first + length - 1


def _is_wrapped(counts: Array, is_lsb: bool) -> Array:
    """True for each of the components (n, 3) that hold whole numbers near 0 and near 65535, and none between or
    below."""
    near = 1 << (14 if is_lsb else 11)
    if (counts < 0).any() or (counts > 65535).any():
        return np.zeros(3, dtype=bool)
    is_low, is_high = counts < near, counts > 65535 - near
    whole = (counts == np.round(counts)).all(axis=0)
    return np.asarray(whole & (is_low | is_high).all(axis=0) & is_low.any(axis=0) & is_high.any(axis=0))
