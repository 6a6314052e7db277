# SPDX-License-Identifier: LGPL-2.1-or-later
"""Headers, roles and units of the columns that loggers write: docs/guide/sensing.md, Files of loggers."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NoReturn

from .._core import quantity
from ..command import printable
from ..errors import InputError

MOST_CELLS = 1000  # of a line
_MOST_LISTED = 50  # faults of a report

_FILLERS = re.compile(r"[ \t_.:/-]")
NUMBER = re.compile(
    r"[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:e[+-]?[0-9]+)?|[+-]?(?:nan|inf|infinity)", re.IGNORECASE
)
_PREFIX = r"s|sensor|ch|channel|probe|node|chip|imu|mlx"
_FIELD = re.compile(
    rf"(?:(?:{_PREFIX}|mag|b|m)?(?P<before>\d{{1,4}}))?"
    r"(?P<family>b|bfield|field|magneticfield|magneticfluxdensity|fluxdensity|mag|magfield|magnetic|magneto|"
    r"magnetometer|compass|m|db|deltab|)(?P<axis>[xyz])(?P<more>axis|component|mag)?"
    rf"(?:(?:{_PREFIX})?(?P<after>\d{{1,4}}))?"
)
_INDEX = re.compile(r"\[(\d{1,2})\]|\((\d{1,2})\)|\.(\d{1,2})$")  # magnetometer_ga[0], mag(1), mag.02
_TIMES = {
    "time", "t", "timestamp", "elapsed", "elapsedtime", "datetime", "date", "localtime", "utc", "utctime", "isotime",
    "unixtime", "epoch", "timeofday", "xvalue",
}  # fmt: skip
_UNITS_OF_TIME = {
    "ns": "ns nsec nsecs nanos nanosec nanosecs nanoseconds", "us": "us usec usecs micros microseconds",
    "ms": "ms msec msecs millis milliseconds", "s": "s sec secs seconds",
}  # fmt: skip
_UNIT_OF_WORD = {word: unit for unit, words in _UNITS_OF_TIME.items() for word in words.split()}
_BESIDE_TIME = set(
    "unix utc iso posix gps rel relative abs absolute since start boot begin launch in of the local system sys host "
    "device rx recv received log logger measurement header field elapsed".split()
)
_LSB = {"lsb", "lsbs", "count", "counts", "digit", "digits", "raw", "cnt", "adc", "bit", "bits"}
_SPELLINGS = {"ga": "G", "UT": "uT", "NT": "nT"}  # PX4's gauss; headers in capitals


class Faults:
    """Faults of a file, each with its line and column from 1."""

    most = 100  # that are looked for

    def __init__(self) -> None:
        self._all: list[tuple[int, int, str]] = []

    def __len__(self) -> int:
        return len(self._all)

    def add(self, what: str, line: int = 1, column: int = 1) -> None:
        self._all.append((line, column, what))

    def refuse(self, file: object, what: str, line: int = 1) -> NoReturn:
        """Raises InputError with the report and this fault."""
        self.add(what, line)
        raise InputError(self.report(file))

    def report(self, file: object) -> str:
        """`file:line:column: what`, a line each, in the order of the file; of very many the first."""
        listed = sorted(self._all, key=lambda fault: fault[:2])
        texts = [f"{file}:{line}:{column}: {what}" for line, column, what in listed[:_MOST_LISTED]]
        if len(listed) > _MOST_LISTED:
            texts.append(f"{file}: {len(listed) - _MOST_LISTED} more faults")
        return "\n".join(texts)

    def require_none(self, file: object) -> None:
        """Raises InputError with the report."""
        if self._all:
            raise InputError(self.report(file))


@dataclass(frozen=True)
class Option:
    """A text of the user's and where it was said: "--unit", "mine.toml:12:1: [readings] unit"."""

    text: str = ""
    where: str = ""

    def refusal(self, why: str) -> InputError:
        return InputError(f"{self.where}: {in_quotes(self.text)} {why}")

    def by(self, read: Callable[[str], Any]) -> Any:
        """Value that a function makes of the text; None if it is empty. Raises InputError that names the option."""
        try:
            return read(self.text) if self.text else None
        except InputError as fault:
            raise InputError(f"{self.where}: {fault}") from fault


@dataclass(frozen=True)
class Cell:
    """A cell without the blanks around it; `column`: where it begins in its line, from 1."""

    text: str
    column: int


@dataclass(frozen=True)
class Column:
    """A column by its header. kind: field (B), change (dB), time, sample, sensor, azimuth, temperature, unit or ""
    (another).

    name: the header without the unit. axis: 0, 1, 2 of x, y, z. sensor: number or name as the header has
    it. family: what stands before the axis, "b" or "mag".
    """

    header: str
    name: str
    unit: str | None = None
    place: int = 1
    kind: str = ""
    axis: int = 0
    sensor: str = ""
    family: str = ""

    @property
    def is_field(self) -> bool:
        return self.kind in ("field", "change")


def in_quotes(text: str) -> str:
    """The text for a message: control characters escaped, the rest of a long text cut off."""
    return f"'{printable(text[:60])}{'...' if len(text) > 60 else ''}'"


def cells_of(line: str, separator: str = ",") -> list[Cell]:
    """The cells of a line, of very many the first; quotes as in RFC 4180. The separator " " is any blanks."""
    one = rf'((?:"(?:[^"]|"")*"?|[^"{separator}])*)(?:[{separator}]|$)'
    if separator == " ":
        one = r'((?:"(?:[^"]|"")*"?|[^" \t])+)'
    cells: list[Cell] = []
    for found in re.finditer(one, line):
        if separator != " " and cells and found.start() == len(line) and line[-1] != separator:
            break  # the empty match after the last cell
        text = re.sub(r'"((?:[^"]|"")*)"?', lambda m: m[1].replace('""', '"'), found[1])
        cells.append(Cell(text.strip(" \t"), found.start() + 1))
        if len(cells) > MOST_CELLS:
            break
    return cells or [Cell("", 1)]


def number_in(text: str) -> float | None:
    """The number of a cell with a decimal point or comma; None if it is none."""
    return float(text.replace(",", ".")) if len(text) <= 64 and NUMBER.fullmatch(text) else None


def split_unit(header: str) -> tuple[str, str | None]:
    """ "x [mm]" or "x (mm)" taken apart. Digits in brackets are no unit."""
    found = re.fullmatch(r"(.*?)[ \t]*(?:\[([^\[\]]*)\]|\(([^()]*)\))", header)
    if found is None:
        return header, None
    unit = (found[2] if found[2] is not None else found[3]).strip(" \t")
    return (header, None) if unit.isdigit() else (found[1].strip(" \t"), unit)


def units_in(comment: str) -> dict[str, str]:
    """The units by column that a comment states: "# units: Bx uT, By uT"."""
    pairs = (cell.text.split(" ", 1) for cell in cells_of(comment.partition("units:")[2]))
    return {pair[0]: pair[1].strip(" \t") for pair in pairs if len(pair) == 2}


def flux_density_unit(unit: str) -> float | None:
    """A unit of flux density in T; None for a sensor's digits (LSB). Raises InputError if it is neither."""
    unit = unit.strip(" \t")
    return None if unit.lower() in _LSB else quantity(f"1 {_SPELLINGS.get(unit, unit)}", "T")


def is_unit(unit: str, kind: str = "field") -> bool:
    """True if a column of this kind may have the unit."""
    if kind == "temperature":
        return unit.lower().lstrip("deg°_ ") in ("c", "k", "celsius", "kelvin")
    try:
        return kind in ("field", "change", "time") and (
            quantity(f"1 {unit}", "s") > 0 if kind == "time" else flux_density_unit(unit) != 0
        )
    except InputError:
        return False


def lsb_scale(text: str) -> list[float]:
    """The flux density of one LSB along x, y, z, T: "0.15 uT", "0.15 uT/LSB", "6842 LSB/G", or three of them with
    commas between. Raises InputError."""
    parts = cells_of(text)
    if len(parts) not in (1, 3):
        raise InputError(
            f"{in_quotes(text)} has {len(parts)} parts: write one flux density of an LSB, or three for x, y, z"
        )
    return [_one_scale(part.text) for part in parts] * (3 // len(parts))


def _one_scale(text: str) -> float:
    found = re.fullmatch(r"([^ \t/]+)[ \t]*([^/]*?)[ \t]*(?:/[ \t]*(.*))?", text.strip(" \t"))
    number, unit, divisor = (part or "" for part in found.groups()) if found else ("", "", "")
    scale = 0.0
    if unit.lower() in _LSB and divisor:
        count = quantity(f"{number} T", "T")
        scale = quantity(f"1 {divisor}", "T") / count if count else 0.0
    elif unit and (not divisor or divisor.lower() in _LSB):
        scale = quantity(f"{number} {unit}", "T")
    if not 1e-15 <= scale <= 1:
        raise InputError(
            f'{in_quotes(text)} is no flux density of an LSB between 1 fT and 1 T: write "0.15 uT" or "6842 LSB/G"'
        )
    return scale


def _letters(name: str) -> str:
    """Letters and digits alone: "Delta B_x" gives "deltabx"."""
    return _FILLERS.sub("", re.sub("[Δ∆δ]", "delta", name).lower())


def _time_unit(name: str) -> tuple[bool, str | None]:
    """True if the words name a time ("t_unix_ns", "TimeUS", "seconds elapsed"), and the unit that they imply."""
    letters = _letters(name)
    if letters in _TIMES:
        return True, None
    words = [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+|\d+", name)]
    units = [word for word in words if word in _UNIT_OF_WORD]
    known = [word for word in words if word in _TIMES or word in ("stamp", "8601") or len(word) > 2 and word in units]
    is_time = bool(known) and all(word in known or word in units or word in _BESIDE_TIME for word in words)
    return is_time, _UNIT_OF_WORD[units[-1]] if is_time and units else None


def _role(name: str, sensors: Sequence[str]) -> dict[str, Any]:
    """Role of a column by its name without a unit: fields of Column; {} if the name has none."""
    for sensor in sensors:
        filler = "[ \t_.:/-]+" if len(sensor) < 2 else "[ \t_.:/-]*"
        part = re.escape(sensor)
        found = re.fullmatch(rf"{part}{filler}(.+)|(.+?){filler}{part}", name, re.IGNORECASE)
        role = _field_role(_letters(found[1] or found[2])) if found else {}
        if role and not role["sensor"]:
            return role | {"sensor": sensor}
    # The last parts of a topic are tried, "field.magnetic_field.x"; one letter alone may be another message's.
    parts = re.split(r"[./]", name)
    for first in range(max(1, len(parts) - 1)):
        if role := _field_role(_letters("_".join(parts[first:]))):
            return role
    letters = _letters(name)
    is_time, unit = _time_unit(name)
    if is_time:
        return {"kind": "time", "unit": unit}
    for kind, names in (
        ("sample", ["sample"]), ("azimuth", ["azimuth"]), ("unit", ["unit", "units"]),
        ("temperature", ["temperature", "temp", "chiptemperature", "chiptemp", "sensortemperature"]),
        ("sensor", ["sensor", "sensorid", "sensorname", "sensornumber", "sensorindex"]),
    ):  # fmt: skip
        if letters in names:
            return {"kind": kind}
    return {}


def _field_role(letters: str) -> dict[str, Any]:
    found = _FIELD.fullmatch(letters)
    if found is None or (found["before"] and found["after"]):
        return {}
    family = found["family"] or ("mag" if found["more"] == "mag" else "")
    kind = "change" if family in ("db", "deltab") else "field"
    sensor = found["before"] or found["after"] or ""
    return {"kind": kind, "axis": "xyz".index(found["axis"]), "sensor": sensor, "family": family}


def column_of(cell: Cell, sensors: Sequence[str] = ()) -> Column:
    """Takes a header apart. Case, blanks and the characters _ - . : / do not matter.

    B: `Bx`, `B_x`, `x`, `X axis`, `mag x`, `Magnetic field x`, `mx`; dB: `dBx`, `delta B x`. The sensor's
    number or name stands before or after, `s0_Bx`, `Bx0`, `left Bx`. The unit follows in brackets, or stands
    after a blank, comma, slash or underscore: `Bx [G]`, `Bx (mG)`, `Bx_uT`, `magnetometer_ga_x`.
    """
    name, unit = split_unit(cell.text)
    if unit is not None and unit.lower() in (sensor.lower() for sensor in sensors) and not is_unit(unit):
        name, unit = f"{name} {unit}", None  # Bx (left)
    role = _role(name, sensors)
    if unit is None and not role:
        parts = [m.span() for m in re.finditer(r"[^ \t,/_]+", name)]
        for begin, end in reversed(parts[1:]):
            rest = re.sub(r"[ \t,/_]+(in[ \t,/_]*)?$", "", name[:begin])
            if name[end:]:
                rest += "_" + name[end:].strip(" \t,/_")
            found = _role(rest, sensors)
            if found and is_unit(name[begin:end], str(found["kind"])):
                name, unit, role = rest, name[begin:end], found
                break
    if role.get("kind") == "time" and name in ("T", "t") and unit is not None and not is_unit(unit, "time"):
        role = {}  # T (°C)
    return Column(cell.text, name, place=cell.column, **(role if unit is None else role | {"unit": unit}))


def columns_of(cells: Sequence[Cell], sensors: Sequence[str]) -> list[Column]:
    """The columns of a header. Numbers in brackets are those of sensors, `Bx[0]`, or of axes, `mag[0]`, `mag[1]`,
    `mag[2]`, from 0 or from 1."""
    columns = [column_of(cell, sensors) for cell in cells]
    families: dict[tuple[str, str], dict[int, int]] = {}
    for i, cell in enumerate(cells):
        if (found := _INDEX.search(cell.text)) and not columns[i].kind:
            around = cell.text[: found.start()], cell.text[found.end() :]
            families.setdefault(around, {})[int(found[found.lastindex or 0])] = i
    for (before, after), members in families.items():
        plain = column_of(Cell(before + after, 1), sensors)
        for number, i in members.items():
            part = plain
            if not plain.is_field and sorted(members) in ([0, 1, 2], [1, 2, 3]):
                part = column_of(Cell(f"{before}_{'xyz'[number - min(members)]}{after}", 1), sensors)
            elif plain.is_field:
                part = replace(plain, sensor=str(number))
            if part.is_field:
                name = cells[i].text if part.unit is None else split_unit(cells[i].text)[0]
                columns[i] = replace(part, header=cells[i].text, name=name, place=cells[i].column)
    return columns


def without_brackets(text: str) -> str:
    """ "[uT]" or "(uT)" without the brackets."""
    name, unit = split_unit(text)
    return unit if unit is not None and not name else text
