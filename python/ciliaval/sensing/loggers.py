# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files as loggers, spreadsheets and serial monitors write them: docs/guide/sensing.md, Files of loggers."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import quantity
from ..arrays import Array
from ..errors import InputError
from .columns import (
    Cell, Column, Faults, Option, cells_of, flux_density_unit, in_quotes, is_unit, number_in, units_in,
    without_brackets,
)  # fmt: skip
from .header import (
    SEPARATORS, Header, MapEntry, choose_columns, find_factors, find_header, is_comment, map_entries, sensor_index,
    sensor_list,
)  # fmt: skip
from .times import calendar_in_ns, numbers_in_ns, time_form

if TYPE_CHECKING:
    from pandas import DataFrame, Series

MOST_ROWS = 1_000_000
_WITHIN = "\x01"  # in place of separators within quotes
_LARGEST_FIELD = 100  # T: more than any magnet makes
_SINCE_1970 = 10**17  # ns: of no record from its beginning
_REPEATED = (
    "the header is repeated: the file holds two records, of which each has its own unloaded reading; make two files "
    "of it"
)


@dataclass
class Table:
    """The readings that a logger wrote; n rows, with k sensors side by side (1 where there is a row for each).

    B: (n, k, 3), or dB if is_change, T. counts: the same as the file has it. number: (n,), of the row below the
    header from 1, those that were left out counted. line: (n,), in the file. sample: (n,), in `names`. sensor:
    (n,), azimuth: (n,), rad, temperature: (n,), K or deg C, time: (n,), s, from the first row on if the file has dates or seconds since
    1970; None: the file has none. timeless: why there is no time. resolution: how well a double holds
    the times as the file states them, s (0.24 us of seconds since 1970): programs that write them
    have held them so. remark: what was read and what was not.
    """

    is_change: bool
    is_wide: bool
    is_lsb: bool
    B: Array
    counts: Array
    number: Array
    line: Array
    sample: Array | None = None
    names: Sequence[str] = ()
    sensor: Array | None = None
    azimuth: Array | None = None
    temperature: Array | None = None
    time: Array | None = None
    timeless: str = ""
    resolution: float = 0.0
    remark: str = ""


def read_table(
    data: bytes,
    sensors: Sequence[str],
    faults: Faults,
    map: Option = Option(),
    unit: Option = Option(),
    scale: Option = Option(),
    skip: bool = False,
    has_temperature: bool = False,
    reads: Array | None = None,
) -> Table | None:
    """Reads a file as loggers write it (docs/guide/sensing.md); None if it has faults, which are added with their
    places.

    `skip` leaves rows without B out. has_temperature: a column with it is needed. reads: (sensors, 3), which components
    the file must have; the others are 0. Raises InputError if an option has a fault.
    """
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        faults.add("the file is in UTF-16: save it as UTF-8")
        return None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    text = text.replace("\r\n", "\n").replace("\r", " " if "\n" in text else "\n").replace("\u2212", "-")
    entries = map_entries(map, sensors)
    lines = text.split("\n")
    header = find_header(lines, sensors, entries, faults)
    if header is None:
        return None
    header.reads = np.ones((len(sensors), 3), dtype=bool) if reads is None else reads
    header.needs = ("temperature",) if has_temperature else ()
    return _Reader(lines, header, sensors, faults, skip).read(entries, map.where, unit, scale)


class _Reader:
    """Reads the rows below a header. The numbers are read all at once; only rows in which something is wrong are
    looked at one by one, for the place and the reason."""

    def __init__(self, lines: Sequence[str], header: Header, sensors: Sequence[str], faults: Faults, skip: bool):
        self.header, self.sensors, self.faults, self.skip = header, sensors, faults, skip
        self.first_line, self.lines = header.first_row + 1, lines[header.first_row :] or [""]
        self.left_out: set[int] = set()  # lines
        self.decimal = ".", self.first_line  # the mark, and its first line
        self.assumed: dict[int, str] = {}  # by column, what is not stated of its time
        self.asked = False  # whether --skip was named

    def read(self, entries: Sequence[MapEntry], where: str, unit: Option, scale: Option) -> Table | None:
        header, faults = self.header, self.faults
        index = self._rows()
        first = cells_of(self.lines[index[0]], header.separator) if index else []
        if header.separator == " " and len(first) == len(header.columns) + 1:
            # A date and a time of day below one name.
            at = next((i for i, cell in enumerate(first) if time_form(cell.text) == "day"), len(first))
            header.columns.insert(min(at + 1, len(header.columns)), Column("", ""))
        if header.columns[-1].header == "Comment" and len(first) == len(header.columns) - 1:
            header.columns.pop()  # LabVIEW's rows have the cell only where there is a comment
        choose_columns(header, self.sensors, entries, where, faults)
        if len(faults):
            return None
        unit_row: list[Cell] = []
        if self._is_unit_row(first):
            unit_row, unit_line = first, self.first_line + index[0]
            index = index[1:]
            for i, column in enumerate(header.columns):
                if column.kind in ("time", "azimuth") and i < len(first) and first[i].text and column.unit is None:
                    header.columns[i] = replace(column, unit=without_brackets(first[i].text))
        if not index:
            last = self.first_line - 1 + len(self.lines) - (not self.lines[-1])
            faults.add("there are no rows below the header", last)
            return None
        if len(index) > MOST_ROWS:
            faults.add(f"there are more than {MOST_ROWS} rows", self.first_line + index[MOST_ROWS])
            return None
        frame, rows = self._frame(index)
        before = len(faults)
        unit_column = self._unit_column(frame)
        self.has_unit_column = bool(unit_column[1])
        line = unit_line if unit_row else 0
        factors, self.units = find_factors(header, unit_row, line, unit_column, unit, scale, faults)
        angle = self._angle_unit()
        sensor = header.one("sensor")
        if sensor is not None and header.is_wide:
            faults.add(
                "the columns are of several sensors already: the column 'sensor' is too much",
                header.line, header.columns[sensor].place,
            )  # fmt: skip
        return None if len(faults) > before else self._table(frame, rows, np.array(index), np.array(factors), angle)

    def _rows(self) -> list[int]:
        """The lines that are rows. Takes the units of comments above the first one."""
        header, rows = self.header, []
        names = [column.header for column in header.columns]
        for i, line in enumerate(self.lines):
            start = line.lstrip(" \t")[:1]
            if start and not (start in "#%/-=|+:" and is_comment(line)):
                rows.append(i)
            elif start:
                if not rows:
                    header.units = units_in(line) | header.units
                texts = [cell.text for cell in cells_of(line.lstrip("#%/ \t"), header.separator)]
                if texts == names and len(names) > 2:
                    self._without_B(_REPEATED, i)
        return rows

    def _is_unit_row(self, cells: Sequence[Cell]) -> bool:
        texts = [cells[i].text if i < len(cells) else "?" for i, _, _ in self.header.fields]
        return any(texts) and all(not t or (number_in(t) is None and is_unit(without_brackets(t))) for t in texts)

    def _frame(self, index: Sequence[int]) -> tuple[DataFrame, Array]:
        """The cells, as texts, of the rows that have as many as the header or empty ones more; and which rows these
        are."""
        import pandas as pd  # it takes half a second

        header, at = self.header, self.header.separator
        within = "[ \t]" if at == " " else re.escape(at)
        is_split_by: dict[str, Any] = {"delim_whitespace": True} if at == " " else {"sep": at}
        rows, kept, most, width = [], [], len(header.columns), len(header.columns)
        for j, i in enumerate(index):
            line = self.lines[i]
            if '"' in line:  # the cells without their quotes, separators within them replaced
                texts = [re.sub(within, _WITHIN, cell.text) for cell in cells_of(line, at)]
                line = at.join(texts if at != " " else (text or _WITHIN for text in texts))
            count = len(re.findall("[^ \t]+", line)) if at == " " else line.count(at) + 1
            if count == width or (count > width and line.rstrip(f"{at} \t").count(at) < width and at != " "):
                rows.append(j)
                kept.append(line)
                most = max(most, count)
            else:
                self._add_width_fault(i, is_last=j == len(index) - 1)
                if len(self.faults) >= Faults.most:
                    break
        kinds = [column.kind for column in header.columns]
        needed = {i for i, _, _ in header.fields} | set(self._others())
        needed |= {i for i, kind in enumerate(kinds) if kind in ("time", "sample", "sensor", "unit")}
        # A column without a role behind a time may be the time of day.
        needed |= {i for i, kind in enumerate(kinds) if i > 0 and kind == "" and kinds[i - 1] == "time"}
        frame = pd.DataFrame(columns=sorted(needed), dtype=str)
        if kept:
            frame = pd.read_csv(
                io.StringIO("\n".join(kept).replace("\0", "?")), header=None, names=range(most), index_col=False,
                usecols=sorted(needed), dtype=str, na_filter=False, quoting=csv.QUOTE_NONE, skip_blank_lines=False,
                **is_split_by,
            )  # fmt: skip
            if re.search("[ \t]", "".join(kept)):
                frame = frame.apply(lambda texts: texts.str.strip(" \t"))
        self.decimal = self._decimal_mark(frame, np.array(index)[rows])
        self._refuse_thousands(frame, np.array(index)[rows])
        return frame, np.array(rows, dtype=int)

    def _numbers(self, texts: Series) -> Array:
        """NaN for a cell that is no number, or has the other decimal mark."""
        mark, _ = self.decimal
        other, joined = "." if mark == "," else ",", "".join(texts)
        if joined.isascii() and other not in joined and "_" not in joined:
            try:
                plain = texts if mark == "." else texts.str.replace(",", ".", regex=False)
                return np.fromiter(map(float, plain), float, len(plain))
            except ValueError:
                pass
        values = (None if other in text else number_in(text) for text in texts)
        return np.array([np.nan if value is None else value for value in values])

    def _add_width_fault(self, i: int, is_last: bool) -> None:
        """Adds the fault of a row with too few or too many cells."""
        header = self.header
        cells = cells_of(self.lines[i], header.separator)
        width = len(header.columns)
        why = ": are there commas in the numbers?" if len(cells) > width else ""
        for other in ";\t,":
            if not why and other != header.separator and other in self.lines[i]:
                why = f": the header is separated by {SEPARATORS[header.separator]}, this row by {SEPARATORS[other]}?"
        if not why and is_last:
            why = ": the last row is cut off; delete it"
        place = cells[min(len(cells) - 1, width)].column
        self._without_B(f"the row has {len(cells)} cells and the header {width}{why}", i, place)

    def _without_B(self, what: str, i: int, place: int = 1) -> None:
        """A fault of a row that has no B, which --skip leaves out."""
        line = self.first_line + i
        if self.skip:
            self.left_out.add(line)
            return
        hint = "" if self.asked or what.endswith("?") else " (--skip leaves rows without B out)"
        self.asked = self.asked or bool(hint)
        self.faults.add(what + hint, line, place)

    def _unit_column(self, frame: DataFrame) -> tuple[str, str]:
        """Name and unit of a column `units` whose cells are all the same unit of a flux density."""
        i = self.header.one("unit")
        if i is None or not len(frame):
            return "", ""
        units = [text for text in frame[i].unique() if text]
        if not units or not all(is_unit(text) for text in units):
            return "", ""
        if len(units) > 1:
            column = self.header.columns[i]
            self.faults.add(
                f"the column {in_quotes(column.header)} has several units: {', '.join(units[:3])}",
                self.header.line, column.place,
            )  # fmt: skip
        return self.header.columns[i].header, units[0]

    def _others(self) -> dict[int, str]:
        """The columns of numbers beside B, and what they are."""
        kinds = ("azimuth", *self.header.needs)
        return {i: kind for kind in kinds if (i := self.header.one(kind)) is not None}

    def _angle_unit(self) -> float:
        i = self.header.one("azimuth")
        if i is None:
            return 1.0
        column = self.header.columns[i]
        try:
            if column.unit is not None:
                return quantity(f"1 {column.unit}", "rad")
            what = "the column 'azimuth' needs the unit of an angle: write \"azimuth [deg]\""
        except InputError as fault:
            what = f"the column 'azimuth': {fault}"
        self.faults.add(what, self.header.line, column.place)
        return 1.0

    def _table(
        self, frame: DataFrame, rows: Array, index: Array, factors: Array, angle: float
    ) -> Table | None:
        header, faults = self.header, self.faults
        fields = [i for i, _, _ in header.fields]
        of = {kind: header.one(kind) for kind in ("sample", "sensor")}
        numbers = np.stack([self._numbers(frame[i]) for i in fields], axis=-1)
        B = numbers * factors
        wrong = ~np.isfinite(B).all(axis=1) | (np.abs(B) > _LARGEST_FIELD).any(axis=1)
        sensor = sample = None
        names: list[str] = []
        others = {kind: self._numbers(frame[i]) for i, kind in self._others().items()}
        for values in others.values():
            wrong |= ~np.isfinite(values)
        if of["sensor"] is not None:
            codes, known = frame[of["sensor"]].factorize()
            found = [sensor_index(name, self.sensors) for name in known]
            sensor = np.array([-1 if s is None else s for s in found])[codes]
            wrong |= sensor < 0
        keep = np.ones(len(frame), dtype=bool)
        for j in np.flatnonzero(wrong):
            keep[j] = self._examine(int(index[rows[j]]), factors)
            if len(faults) >= Faults.most:
                break
        frame, rows, B, numbers = frame[keep], rows[keep], B[keep], numbers[keep]
        if not len(frame):
            if not len(faults):
                faults.add("there are no rows with B below the header", self.first_line)
            return None
        if of["sample"] is not None:
            texts = frame[of["sample"]].str.replace(_WITHIN, header.separator, regex=False)
            sample, names = texts.str.strip(" \t").factorize()
        k = len(self.sensors) if header.is_wide else 1
        order = [3 * (s if header.is_wide else 0) + axis for _, s, axis in header.fields]
        whole = np.zeros((2, len(B), 3 * k))
        whole[0][:, order], whole[1][:, order] = B, numbers
        table = Table(
            header.is_change, header.is_wide, any(flux_density_unit(u) is None for u in self.units),
            whole[0].reshape(-1, k, 3), whole[1].reshape(-1, k, 3), rows + 1,
            self.first_line + index[rows], sample, list(names), None if sensor is None else sensor[keep],
        )  # fmt: skip
        if "azimuth" in others:
            table.azimuth = angle * others["azimuth"][keep]
        if "temperature" in others:
            table.temperature = others["temperature"][keep]
        used = self._read_time(frame, table)
        if len(faults):
            return None
        table.remark = self._remark(len(frame), used)
        return table

    def _examine(self, i: int, factors: Array) -> bool:
        """Adds what is wrong with a row that has as many cells as the header. Returns whether it is a row."""
        header, before = self.header, len(self.faults)
        cells = cells_of(self.lines[i], header.separator)
        if [cell.text for cell in cells[: len(header.columns)]] == [column.header for column in header.columns]:
            self._without_B(_REPEATED, i)
            return False
        fields = [field for field, _, _ in header.fields]
        for at in fields:
            what, has_number = self._fault_in(cells[at].text)
            if what and not has_number and "," not in cells[at].text:
                self._without_B(what, i, cells[at].column)
            elif what:
                self._add_fault(what, i, at)
        if self.skip and any(self._fault_in(cells[at].text)[0] for at in fields):
            return False
        of_sensor = header.one("sensor")
        if of_sensor is not None and sensor_index(cells[of_sensor].text, self.sensors) is None:
            self._add_fault(f"the sensor {{}} is none of the case's, {sensor_list(self.sensors)}", i, of_sensor)
        for at in self._others():
            what, _ = self._fault_in(cells[at].text)
            if what:
                self._add_fault(what, i, at)
        if len(self.faults) == before:
            largest = max(abs((number_in(cells[at].text) or 0.0) * factor) for at, factor in zip(fields, factors))
            if largest > _LARGEST_FIELD:
                what = f"a field of {largest:.3g} T was read; fields up to {_LARGEST_FIELD} T are taken"
                self.faults.add(f"{what}: is the unit in the header right?", self.first_line + i)
        return True

    def _fault_in(self, text: str) -> tuple[str, bool]:
        """Fault of the cell of a number, "" if there is none, and True if it is a finite number nevertheless."""
        comma, value, (mark, first) = "," in text, number_in(text), self.decimal
        if not text:
            return "the cell is empty", False
        if value is None or (comma and self.header.separator == ","):
            more = ": write a decimal point, and nothing between thousands" if comma else ""
            return f"{in_quotes(text)} is not a number{more}", False
        if not np.isfinite(value):
            return f"{in_quotes(text)} is not a finite number", False
        if (comma or "." in text) and mark != ("," if comma else "."):
            other = f"has a decimal {'comma' if comma else 'point'}, line {first} the other"
            return f"{in_quotes(text)} {other}: write the same in all numbers", True
        return "", True

    def _add_fault(self, what: str, i: int, column: int) -> None:
        """Adds a fault at a cell of a row, which stands for {} in the text."""
        cells = cells_of(self.lines[i], self.header.separator)
        cell = cells[column] if column < len(cells) else Cell("", 1)
        self.faults.add(what.replace("{}", in_quotes(cell.text)), self.first_line + i, cell.column)

    def _refuse_thousands(self, frame: DataFrame, index: Array) -> None:
        """Adds a fault where "7,640" stands beside "122", as far as the first rows tell: read as decimals, such marks
        would make numbers a thousand times too small. Another number shows that they are decimals."""
        texts = frame[[field for field, _, _ in self.header.fields]].head(2000).stack()
        marked = texts.str.fullmatch(r"[+-]?[1-9]\d{0,2}[.,]\d{3}").astype(bool)
        plain = texts.str.fullmatch(r"[+-]?\d{1,3}").astype(bool)
        is_decimal = texts[~marked & ~plain].map(number_in).notna().any()
        if marked.any() and not is_decimal and (texts[plain].str.strip("+-0") != "").any():
            row, column = marked.idxmax()
            what = "{} is not a number: does it have a mark between thousands, as the others without one suggest?"
            self._add_fault(f"{what} Write a decimal point, and nothing between thousands", int(index[row]), column)

    def _decimal_mark(self, frame: DataFrame, index: Array) -> tuple[str, int]:
        """The first decimal mark of the numbers, and its line. Between commas it is a point."""
        fields = [field for field, _, _ in self.header.fields]
        if self.header.separator != "," and frame[fields].apply(lambda texts: "," in "".join(texts)).any():
            for i, texts in zip(index, frame[fields].itertuples(index=False)):
                for text in texts:
                    if number_in(text) is not None and (mark := re.search("[.,]", text)):
                        return mark[0], self.first_line + int(i)
        return ".", self.first_line

    # --- Times ---

    def _read_time(self, frame: DataFrame, table: Table) -> list[int]:
        """Reads the time of the rows, if there is one. Returns its columns."""
        columns, unit = self._choose_time(frame, table)
        if not columns:
            return []
        parts = [frame[i] for i in columns]
        form = time_form(parts[0].iloc[0])
        if len(columns) == 2 and form == "number":  # seconds and nanoseconds
            (seconds, wrong), (more, wrong_more) = numbers_in_ns(parts[0], 1e9), numbers_in_ns(parts[1], 1.0)
            ns, wrong = seconds + more, wrong | wrong_more
        elif form == "number":
            ns, wrong = numbers_in_ns(parts[0], 1e9 * quantity(f"1 {unit}", "s") if unit else 1.0)
        else:
            forms, ns = calendar_in_ns(parts[0] if len(parts) == 1 else parts[0] + " " + parts[1])
            wrong = forms != (2 if form == "clock" else 1)
        for j in np.flatnonzero(wrong)[: Faults.most]:
            self._add_fault("{} is no time as in the rows above", int(table.line[j]) - self.first_line, columns[0])
        self._require_order(table, ns, wrong, columns[0])
        if form == "number" and not unit:
            return columns
        origin = ns[0] if form != "number" or ns[0] > _SINCE_1970 else 0
        table.time = (ns - origin) / 1e9
        if origin and form != "clock":
            of = 1e9 * quantity(f"1 {unit}", "s") if form == "number" and len(columns) == 1 else 1e9
            table.resolution = float(np.spacing(float(origin) / of)) * of / 1e9
        return columns

    def _choose_time(self, frame: DataFrame, table: Table) -> tuple[list[int], str | None]:
        """The column of the time, or two: a date and a time of day, or seconds and nanoseconds; and its unit. The
        first row tells its form; of several columns the first one that can be read is taken."""
        header = self.header
        found = [i for i, column in enumerate(header.columns) if column.kind == "time"]
        if not found:
            table.timeless = "there is no column 'time'"
            return [], None
        first = {i: frame[i].iloc[0] for i in frame}
        forms = {i: time_form(text) for i, text in first.items()}
        clocks = [i for i in [*found, *(i + 1 for i in found)] if forms.get(i) == "clock"]
        names = [column.name.lower() for column in header.columns]
        choices: list[tuple[int, list[int], str | None]] = []  # rank, columns, unit
        for i in found:
            stem, is_ns = re.subn(r"(nanosec(ond)?s?|nsecs?)$", "", names[i])
            seconds = [j for j in found if re.fullmatch(re.escape(stem) + r"(sec(ond)?s?|s)", names[j])]
            if forms[i] == "number" and is_ns and seconds and forms[seconds[0]] == "number":
                choices.append((0, [seconds[0], i], "s"))
            elif forms[i] == "day" and clocks:
                choices.append((0, [i, clocks[0]], None))
            elif forms[i] in ("date", "clock") or (forms[i] == "day" and len(found) == 1):
                choices.append((1, [i], None))
            elif forms[i] == "number" and (unit := self._time_unit(i, first[i])) and is_unit(unit, "time"):
                choices.append((1, [i], unit))
        if choices:
            _, columns, unit = min(choices, key=lambda choice: choice[0])
            return columns, unit
        at = next((i for i in found if forms[i] != "day"), found[0])
        column = header.columns[at]
        name = in_quotes(column.header)
        if forms[at] is None:
            table.timeless = (
                f"{in_quotes(first[at])} in the column {name} is no time: write ISO 8601, hh:mm:ss or a number"
            )
            return [], None
        unit = "us" if re.fullmatch(r"\d{6,}", first[at]) else "s"
        advice = f'write "{column.name} [{unit}]" into the header, or --map "time={column.name} [{unit}]"'
        try:
            table.timeless = f"the column {name} has no unit: {advice}"
            if column.unit is not None:
                quantity(f"1 {column.unit}", "s")
        except InputError as fault:
            table.timeless = f"the column {name}: {fault}; {advice}"
        return [at], None

    def _time_unit(self, i: int, text: str) -> str | None:
        """The unit of a column of numbers: as stated, or where it is clear without."""
        column = self.header.columns[i]
        if column.unit is not None or not text.isdigit():
            return column.unit
        since_1970 = {10: "s", 13: "ms", 16: "us", 19: "ns"}.get(len(text))
        if since_1970 and (len(text) == 19 or re.search("unix|epoch|posix", column.name.lower())):
            self.assumed[i] = f"{in_quotes(column.header)} in {since_1970} since 1970"
            return since_1970
        if column.name == "timestamp" and self.header.is_px4:
            self.assumed[i] = f"{in_quotes(column.header)} in us, as PX4 has it"
            return "us"
        return None

    def _require_order(self, table: Table, ns: Array, wrong: Array, column: int) -> None:
        """Adds a fault for each time of a sensor that goes back within a sample."""
        import pandas as pd

        right = np.flatnonzero(~wrong)
        sensor = np.zeros(len(ns), dtype=int) if table.sensor is None else table.sensor
        right = right[np.argsort(sensor[right], kind="stable")]
        record = pd.DataFrame({"sensor": sensor[right]})
        record["sample"] = 0 if table.sample is None else table.sample[right]
        begins = (record != record.shift()).any(axis=1).cumsum()
        latest = pd.Series(ns[right]).groupby(begins).cummax().to_numpy()
        for j in np.sort(right[ns[right] < latest])[: Faults.most]:
            what = "the time goes back at {}: sort the rows, or make a file of each record"
            self._add_fault(what, int(table.line[j]) - self.first_line, column)

    def _remark(self, count: int, times: Sequence[int]) -> str:
        header = self.header
        used = {i for i, _, _ in header.fields} | set(times)
        read = []
        for (i, _, _), unit in zip(header.fields, self.units):
            column = header.columns[i]
            read.append(in_quotes(column.header) + ("" if column.unit == unit else f" in {unit}"))
        more = f" and {len(read) - 6} more columns" if len(read) > 6 else ""
        text = f"{count} rows, {'dB' if header.is_change else 'B'} from {', '.join(read[:6])}{more}"
        if header.is_ros and set(self.units) == {"T"}:
            text += ", the unit of ROS's message sensor_msgs/MagneticField"
        text += "".join(f"; time from {self.assumed[i]}" for i in times if i in self.assumed)
        kinds = ("sample", "sensor", "azimuth", *header.needs) + ("unit",) * self.has_unit_column
        used |= {i for i, column in enumerate(header.columns) if column.kind in kinds}
        ignored = [in_quotes(c.header) for i, c in enumerate(header.columns) if i not in used and c.header]
        if ignored:
            text += f"; columns not read: {', '.join(ignored)}"
        if header.skipped:
            text += f"; {header.skipped} lines above the header not read"
        if self.left_out:
            lines = ", ".join(str(line) for line in sorted(self.left_out)[:10])
            n, more = len(self.left_out), f" and {len(self.left_out) - 10} more" if len(self.left_out) > 10 else ""
            text += f"; {n} row{'s' * (n > 1)} without B left out: line{'s' * (n > 1)} {lines}{more}"
        return text
