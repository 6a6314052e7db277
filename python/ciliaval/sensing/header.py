# SPDX-License-Identifier: LGPL-2.1-or-later
"""The header of a logger's file, and what it says of the columns: docs/guide/sensing.md, Files of loggers."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import Array
from ..errors import InputError
from .columns import (
    MOST_CELLS, Cell, Column, Faults, Option, cells_of, column_of, columns_of, flux_density_unit, in_quotes, is_unit,
    lsb_scale,
    number_in, split_unit, units_in, without_brackets,
)  # fmt: skip
from .times import time_form

SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "|", " ": "blanks"}
NAMED = "Bx, By, Bz; say which columns they are: --map \"bx=NAME, by=NAME, bz=NAME\""
_EITHER = "the columns must be either Bx, By, Bz, or dBx, dBy, dBz for the change against the undeformed cilium"
_ROS_FIELD = re.compile(r"(?:.*[./])?magnetic_field[./][xyz]")
_COMMENT = re.compile(r"[ \t]*(#|%|//)")
_RULE = re.compile(r"[\s|+:=-]*[-=]{3,}[\s|+:=-]*")  # below the header of a table
_NAMED_NUMBER = re.compile(r"[A-Za-z]\w*\"?\s*[:=]\s*[-+]?[.\d]")  # "Bx:1.2,By:3"


@dataclass
class Header:
    """The header of a file. line: its number, 0 of a file that has none. first_row: index of the line below it.

    skipped: lines above it that are no comments. units: by name, of comments. fields: of the chosen columns of B or dB
    (cell, sensor, axis). reads: (sensors, 3), which of them there must be. needs: kinds of further columns that must be
    there.
    """

    separator: str
    line: int
    columns: list[Column]
    first_row: int = 0
    skipped: int = 0
    units: dict[str, str] = field(default_factory=dict)
    fields: list[tuple[int, int, int]] = field(default_factory=list)
    is_change: bool = False
    is_wide: bool = False
    reads: Array = field(default_factory=lambda: np.ones((1, 3), dtype=bool))
    needs: tuple[str, ...] = ()

    def one(self, kind: str) -> int | None:
        return next((i for i, column in enumerate(self.columns) if column.kind == kind), None)

    def names(self) -> str:
        return ", ".join(in_quotes(column.header) for column in self.columns if column.header)

    @property
    def is_ros(self) -> bool:
        """True if this is ROS's message sensor_msgs/MagneticField: it is in T."""
        return sum(bool(_ROS_FIELD.fullmatch(column.name)) for column in self.columns) >= 3

    @property
    def is_px4(self) -> bool:
        """True if these are PX4's names, whose `timestamp` is in us."""
        names = {column.name for column in self.columns}
        return {"timestamp", "timestamp_sample"} <= names or any("magnetometer_ga" in name for name in names)


@dataclass(frozen=True)
class MapEntry:
    """An entry of --map: "bx=Mag X" or "bx=Mag X [mG]"."""

    role: Column
    header: str
    name: str
    unit: str | None

    def names(self, column: Column) -> bool:
        return self.header.lower() == column.header.lower() or self.name.lower() == column.name.lower()


def map_entries(option: Option, sensors: Sequence[str]) -> list[MapEntry]:
    """The entries of --map. Raises InputError."""
    entries = []
    for cell in cells_of(option.text) if option.text else []:
        key, sign, header = (part.strip(" \t") for part in cell.text.partition("="))
        role = column_of(Cell(key, 1), sensors)
        if not sign or role.kind in ("", "unit"):
            raise InputError(
                f"{option.where}: {in_quotes(cell.text)} is no entry NAME=COLUMN with a name of bx, by, bz, dbx, dby, "
                "dbz (for several sensors s0_bx, …), time, sample, sensor, azimuth, temperature"
            )
        if role.kind == "field":
            role = replace(role, family="b")
        entries.append(MapEntry(role, header, *split_unit(header)))
    return entries


def choose_columns(
    header: Header, sensors: Sequence[str], entries: Sequence[MapEntry], where: str, faults: Faults
) -> None:
    """Chooses the columns to be read. Faults: not all of Bx, By, Bz, or both B and dB; two columns of one name;
    sensors that the case does not have; a name of --map that is not there."""
    if len(header.columns) > MOST_CELLS:
        faults.add(f"there are more than {MOST_CELLS} columns", header.line)
        return
    before = len(faults)
    _apply_map(header, entries, where, faults)
    if len(faults) > before:
        return
    names = [(column.kind, column.name.lower()) for column in header.columns]
    for i, column in enumerate(header.columns):
        if column.kind in ("time", "sample", "sensor", "azimuth", *header.needs) and names[i] in names[:i]:
            faults.add(f"there is a second column '{column.name}'", header.line, column.place)
        if column.kind in header.needs and column.unit is not None and not is_unit(column.unit, column.kind):
            what = f"the column {in_quotes(column.header)} is in {column.unit}: write it in K or degC"
            faults.add(what, header.line, column.place)
    for kind in header.needs:
        if header.one(kind) is None:
            faults.add(f"there is no column '{kind}' (columns: {header.names()})", header.line)
    _choose_fields(header, sensors, faults)


def _apply_map(header: Header, entries: Sequence[MapEntry], where: str, faults: Faults) -> None:
    """The columns that the map names get its roles; without a map, or with one of others, their own roles stay."""
    kinds = {entry.role.kind for entry in entries}
    has_fields = any(entry.role.is_field for entry in entries)
    columns = header.columns
    for i, column in enumerate(columns):
        if column.kind in kinds or (has_fields and column.is_field):
            columns[i] = replace(column, kind="", sensor="", family="")
    taken = set()
    for entry in entries:
        whole = [i for i, column in enumerate(columns) if entry.header.lower() == column.header.lower()]
        found = whole or [i for i, column in enumerate(columns) if entry.names(column)]
        if not found:
            near = difflib.get_close_matches(entry.header, [c.header for c in columns], 1, 0.7)
            meant = f"; did you mean '{near[0]}'?" if near else ""
            faults.add(
                f"there is no column {in_quotes(entry.header)}, which {where} names{meant} (columns: {header.names()})",
                header.line,
            )
            continue
        i = found[0]
        column = columns[i]
        if i in taken:
            faults.add(f"{where} names the column {in_quotes(column.header)} twice", header.line, column.place)
        taken.add(i)
        unit = column.unit
        if not whole and entry.unit is not None:
            if unit is not None and unit != entry.unit:
                faults.add(
                    f"the column {in_quotes(column.header)} has the unit {unit} here and {entry.unit} in {where}",
                    header.line, column.place,
                )  # fmt: skip
            unit = entry.unit
        role = entry.role
        columns[i] = replace(column, unit=unit, kind=role.kind, axis=role.axis, sensor=role.sensor, family=role.family)


def _choose_fields(header: Header, sensors: Sequence[str], faults: Faults) -> None:
    """Finds the columns of B or dB by sensor and axis."""
    axes: dict[str, set[int]] = {}
    for column in header.columns:
        if column.kind == "field":
            axes.setdefault(column.family, set()).add(column.axis)
    # All of x, y, z before others, `b` before other names before none.
    rank = {family: (len(found), 2 if family == "b" else int(family != "")) for family, found in axes.items()}
    family = max(sorted(rank), key=lambda name: rank[name], default="")
    chosen = [
        (i, column)
        for i, column in enumerate(header.columns)
        if column.kind == "change" or (column.kind == "field" and column.family == family)
    ]
    labels = {column.sensor for _, column in chosen}
    if len({column.kind for _, column in chosen}) != 1:
        faults.add(
            f'{_EITHER} (columns: {header.names()}); --map "bx=NAME, by=NAME, bz=NAME" chooses them', header.line
        )
        return
    header.is_change = chosen[0][1].kind == "change"
    header.is_wide = len(labels) > 1 or (len(sensors) > 1 and labels != {""})
    # Numbered from 1, as in "Bx1, By1, Bz1, Bx2, …": none is called 0.
    first = int(len(labels) == len(sensors) and {"1", str(len(sensors))} <= labels and "0" not in labels)
    reads = header.reads if header.is_wide else header.reads.any(axis=0, keepdims=True)
    missing = {(int(sensor), int(axis)) for sensor, axis in np.argwhere(reads)}
    taken = set()
    for i, column in chosen:
        sensor = 0 if labels == {""} else sensor_index(column.sensor, sensors, first)
        if sensor is None:
            faults.add(
                f"the column {in_quotes(column.header)} is of a sensor that the case does not have (it has "
                f'{sensor_list(sensors)}); --map "bx=NAME, …" chooses columns',
                header.line, column.place,
            )  # fmt: skip
            return
        if (sensor, column.axis) in taken:
            faults.add(f"there is a second column {in_quotes(column.name)}", header.line, column.place)
            return
        taken.add((sensor, column.axis))
        if reads[sensor, column.axis]:
            header.fields.append((i, sensor, column.axis))
    if missing - taken:
        sensor, axis = min(missing - taken)
        of = f" of the sensor {sensors[sensor]}" if header.is_wide else ""
        name = f"{'d' if header.is_change else ''}B{'xyz'[axis]}"
        faults.add(f"{_EITHER}: there is no column {name}{of} (columns: {header.names()})", header.line)


def sensor_index(text: str, sensors: Sequence[str], first: int = 0) -> int | None:
    """The sensor of a name, or of a number from `first` on; None if there is no such sensor."""
    if first == 0:
        for i, sensor in enumerate(sensors):
            if text.lower() == sensor.lower():
                return i
    number = int(text) - first if text.isascii() and text.isdigit() else -1
    return number if 0 <= number < len(sensors) else None


def sensor_list(sensors: Sequence[str]) -> str:
    return f"0 to {len(sensors) - 1}" if sensors[0] == "0" else ", ".join(sensors)


def find_factors(
    header: Header, unit_row: Sequence[Cell], unit_line: int, unit_column: tuple[str, str], unit: Option, scale: Option,
    faults: Faults,
) -> tuple[list[float], list[str]]:
    """The factors to T of the chosen columns, and their units as the file or the options state them.

    By the header, the row of units (may be empty), comments, the column `units` (its name and unit, "" if
    there is none), --unit, or ROS's message. Two that differ, and none, are faults. Raises InputError.
    """  # fmt: skip
    scales = scale.by(lsb_scale)
    unit.by(flux_density_unit)
    factors, units, without, before = [], [], [], len(faults)
    for i, _, axis in header.fields:
        column = header.columns[i]
        here = (header.line, column.place)
        of_row = unit_row[i] if i < len(unit_row) else Cell("", 1)
        statements = (  # unit, by what it is stated, line and column
            (column.unit, "the header", here),
            (without_brackets(of_row.text) or None, "the row of units", (unit_line, of_row.column)),
            (header.units.get(column.name), "a comment", here),
            (unit_column[1] or None, f"the column '{unit_column[0]}'", here),
            (unit.text or None, unit.where, here),
        )
        stated = [(text, by, place) for text, by, place in statements if text is not None]
        if not stated and header.is_ros and _ROS_FIELD.fullmatch(column.name):
            stated = [("T", "ROS", here)]
        factors.append(1.0)
        units.append(stated[0][0] if stated else "")
        if not stated:
            without.append(in_quotes(column.header))
            continue
        first, by, place = stated[0]
        try:
            factor = flux_density_unit(first)
            other = next((other for other in stated if flux_density_unit(other[0]) != factor), None)
            if other is not None:
                faults.add(
                    f"the column {in_quotes(column.header)} has two units: {in_quotes(first)} by {by}, "
                    f"{in_quotes(other[0])} by {other[1]}",
                    *other[2],
                )
            if factor is not None:
                factors[-1] = factor
            elif scales is not None:
                factors[-1] = scales[axis]
            else:
                faults.add(
                    f"the column {in_quotes(column.header)} is in {in_quotes(first)}: state the flux density of one, "
                    'from the sensor\'s data sheet: --scale "0.15 uT" or --scale "6842 LSB/G"',
                    *place,
                )
        except InputError as fault:
            faults.add(f"the column '{column.name}': {fault}", *place)
    if without:
        faults.add(
            f'no unit of {", ".join(without)}: write it into the header, "Bx [uT]", or state it: --unit uT (T, mT, uT, '
            'nT, G, mG; LSB with --scale "0.15 uT")',
            header.line,
        )
    if scales and len(faults) == before and all(flux_density_unit(text) is not None for text in units):
        faults.add(f"no column is in LSB: leave {scale.where} out", header.line)
    return factors, units


def find_header(
    lines: Sequence[str], sensors: Sequence[str], entries: Sequence[MapEntry], faults: Faults
) -> Header | None:
    """The first line in which two of Bx, By, Bz or of the columns of --map are found with one of the separators; or
    the last comment before the first numbers in which they are. None is a fault."""
    in_comment = None
    units: dict[str, str] = {}
    skipped, above, above_number, labview = 0, "", 1, 0
    if lines[0].startswith("LabVIEW Measurement"):  # whose own lines may look like numbers
        labview = max((i for i, line in enumerate(lines, 1) if "***End_of_Header***" in line), default=0)
    for number, line in enumerate(lines, 1):
        if not line.strip(" \t") or number <= labview:
            skipped += bool(line.strip(" \t"))
            continue
        if _COMMENT.match(line):
            stated = units_in(line)
            header = _header_in(line.lstrip("#%/ \t"), number, lines, sensors, entries)
            in_comment = header if header and not stated else in_comment
            units = stated | units
            continue
        header = _header_in(line, number, lines, sensors, entries)
        if header and labview:
            stated_unit = re.search(r"^Y_Unit_Label[\t,;]+([^\t,;\n]+)", "\n".join(lines[:labview]), re.MULTILINE)
            units = {c.name: stated_unit[1] for c in header.columns if c.is_field and stated_unit} | units
        first_row = number
        if header is None and _is_row(line, in_comment):
            header, first_row = in_comment or _by_numbers(line, entries), number - 1
            if header is None:
                _add_no_header(line, number, above, above_number, sensors, faults)
                return None
        if header:
            header.first_row, header.skipped, header.units = first_row, skipped, units
            return header
        if len(_NAMED_NUMBER.findall(line)) > 2:
            faults.add(
                f"each number of {in_quotes(line)} has its name before it: write the names once, in a header line, and "
                'the numbers alone below it, such as "Bx [uT],By [uT],Bz [uT]"',
                number,
            )
            return None
        skipped, above, above_number = skipped + 1, line, number
    if above:
        what = f"no header with {NAMED}; columns are separated by commas, semicolons, tabs, | or blanks"
        faults.add(what, above_number)
    else:
        faults.add("the file is empty: it needs a header line with the names and units of the columns")
    return None


def _split(line: str, separator: str, count: int = 0) -> list[Cell]:
    """The cells of a header. Between blanks a name may have single ones where two part it from the next, and the
    unit in brackets belongs to the name before it; `count`: of cells in a row."""
    if separator != " ":
        return cells_of(line, separator)
    wide = [Cell(found[0], found.start() + 1) for found in re.finditer(r"\S+(?: \S+)*", line)]
    if len(wide) in (count, count - 1) and len(wide) > 2:
        return wide
    cells: list[Cell] = []
    for cell in cells_of(line, " "):
        if cells and cell.text.startswith(("[", "(")):
            cells[-1] = Cell(f"{cells[-1].text} {cell.text}", cells[-1].column)
        else:
            cells.append(cell)
    return cells


def _header_in(
    line: str, number: int, lines: Sequence[str], sensors: Sequence[str], entries: Sequence[MapEntry]
) -> Header | None:
    """The line as a header, with the separator by which the most columns are known; None if fewer than two are.
    Blanks separate only where the rows below have as many cells: else the line is a sentence."""
    if len(_NAMED_NUMBER.findall(line)) > 2:
        return None
    best, most = None, 1
    for separator in SEPARATORS:
        counts = [0]
        if separator == " ":
            below = (lines[i] for i in range(number, len(lines)) if lines[i].strip(" \t") and not is_comment(lines[i]))
            counts = [len(row) for row in (cells_of(row, " ") for row, _ in zip(below, range(2))) if _numbers(row) > 2]
        for count in counts:
            cells = _split(line, separator, count)
            if separator == " " and len(cells) not in (count, count - 1):
                continue
            columns = columns_of(cells, sensors)
            named = [number_in(c.header) is None and any(entry.names(c) for entry in entries) for c in columns]
            known = sum(c.is_field or is_named for c, is_named in zip(columns, named))
            if known > most:
                most = known
                while len(columns) > 1 and not columns[-1].header:
                    columns.pop()
                best = Header(separator, number, columns)
    return best


def is_comment(line: str) -> bool:
    return bool(_COMMENT.match(line) or _RULE.fullmatch(line))


def _numbers(cells: Sequence[Cell]) -> int:
    return sum(number_in(cell.text) is not None for cell in cells)


def _is_row(line: str, in_comment: Header | None = None) -> bool:
    """True if the line holds three numbers or more: between blanks, times and numbers alone, or as many cells as the
    header in a comment has."""
    if any(_numbers(cells_of(line, separator)) > 2 for separator in SEPARATORS if separator != " "):
        return True
    cells = cells_of(line, " ")
    is_plain = all(number_in(cell.text) is not None or time_form(cell.text) for cell in cells)
    fits = in_comment is not None and in_comment.separator == " " and len(cells) == len(in_comment.columns)
    return _numbers(cells) > 2 and (is_plain or fits)


def _by_numbers(line: str, entries: Sequence[MapEntry]) -> Header | None:
    """The columns of a file without a header by their numbers from 1, if the map names numbers alone."""
    if not entries or not all(entry.name.isdigit() for entry in entries):
        return None
    separator = max(SEPARATORS, key=lambda separator: _numbers(cells_of(line, separator)))
    columns = [Column(str(i), str(i)) for i, _ in enumerate(cells_of(line, separator), 1)]
    return Header(separator, 1, columns)


def _add_no_header(
    line: str, number: int, above: str, above_number: int, sensors: Sequence[str], faults: Faults
) -> None:
    columns = max((columns_of(cells_of(above, separator), sensors) for separator in ",;\t|"), key=len) if above else []
    if len(columns) > 2:
        faults.add(f"no columns {NAMED} (columns: {Header(',', 0, columns).names()})", above_number)
        return
    cells = cells_of(line, max(SEPARATORS, key=lambda separator: _numbers(cells_of(line, separator))))
    B = [i for i, cell in enumerate(cells, 1) if number_in(cell.text) is not None][-3:]
    of_time = "time=1, " if B[0] > 1 else ""
    faults.add(
        f"there is no header above the numbers {in_quotes(line)}: put a line with the names and units of the columns "
        'first, such as "time [s],Bx [uT],By [uT],Bz [uT]", and # before lines that are no readings; or name the '
        f'columns by their numbers: --map "{of_time}bx={B[0]}, by={B[1]}, bz={B[2]}" --unit uT',
        number,
    )
