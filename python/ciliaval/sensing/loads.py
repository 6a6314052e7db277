# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads from readings, and what is said of them: docs/guide/sensing.md."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import special

from .. import _core
from ..arrays import Array
from ..errors import InputError
from ..model import Case
from ..units import shown
from .columns import Option
from .inversion import STATUSES, TWO_SIDED_95, UNLIKELY, Chips, SensedLoads, invert
from .left_out import LeftOut, with_joints
from .readings import ReadingOptions, Readings, read_readings
from .response import Pair, Progress, Response, Shapes, pairs_of, require_load_to_sense, shapes_within

BEYOND_THE_LARGEST = 1.25
"""The range of loads that is looked for, over the case's largest."""
_LEAST_NOISE = 1e-15  # T, less than any magnetometer's
_SHOWN = 20  # samples of a longer table on the terminal
_COLUMNS = {  # members of SensedLoads, and their units
    **dict.fromkeys(["magnitude", "magnitude_interval", "model_interval", "input_interval"], "load"),
    **dict.fromkeys(["azimuth", "azimuth_interval"], "rad"),
    **dict.fromkeys(["chi_squared", "misfit_probability", "nothing_probability"], ""),
}
_EARTH = 150e-6  # T: the earth's field and a sensor's offset, about, which a reading may be off


@dataclass(frozen=True)
class FlowLaw:
    """Law by which a flow's force per height q gives a velocity, v = sqrt(2 q/(rho d C_d)) (paper, Eq. 10-11).

    density rho, kg/m^3; drag_coefficient C_d, 0: that of a cylinder at its Reynolds number
    rho v d/viscosity; diameter d, m; viscosity, Pa s.
    """

    density: float
    drag_coefficient: float
    diameter: float
    viscosity: float

    @staticmethod
    def of(case: Case) -> FlowLaw | None:
        """The law of a case whose flow is given by its velocity."""
        if not case._core.stated("velocity"):
            return None
        stated = {key: case._core.stated(key) for key in ("density", "drag_coefficient", "viscosity")}
        if differing := [key for key, values in stated.items() if len(set(values)) > 1]:
            raise InputError(f"a speed is found by one law: list one {' and one '.join(differing)} for all load steps")
        density, C_d, viscosity = (values[0] for values in stated.values())
        return FlowLaw(density, C_d, case.cilium.diameter, viscosity)

    def velocity(self, q: npt.ArrayLike) -> Array:
        """m/s of N/m; 0 for a q below 0."""
        squared = 2 * np.maximum(0, q) / (self.density * self.diameter)  # C_d v^2
        if self.drag_coefficient:
            return np.asarray(np.sqrt(squared / self.drag_coefficient))
        low, high = _core.cylinder_reynolds_numbers
        to_reynolds = self.density * self.diameter / self.viscosity
        v: Array = np.sqrt(squared)
        for _ in range(50):  # C_d falls less than as Re^-0.9: each step leaves at most 0.45 of the error
            v = np.sqrt(squared / _core.cylinder_drag_coefficient(np.clip(v * to_reynolds, low, high)))
        return v


@dataclass(frozen=True)
class Sensing:
    """A case's readings and the loads found from them, by one pair of models."""

    case: str
    pair: Pair
    noise: float  # T
    unit: str  # of the load's magnitude
    response: Response
    readings: Readings
    loads: SensedLoads
    flow: FlowLaw | None
    left_out: LeftOut
    flow_shifts: list[tuple[FlowLaw, FlowLaw, float]]  # of each input, and the deviations between
    remarks: list[str] = field(default_factory=list)
    others: Sequence[Sensing] = ()  # the same readings by other pairs

    @property
    def spread(self) -> Array:
        """The largest less the smallest magnitude that a pair finds, (n,); NaN where one of them fails."""
        by_pair = [np.where(s.loads.converged, s.loads.magnitude, np.nan) for s in (self, *self.others)]
        return np.asarray(np.ptp(by_pair, axis=0))

    def velocities(self) -> tuple[Array, Array, Array]:
        """Velocity for q, and for the ends of its interval, m/s, each (n,)."""
        q, width = self.loads.magnitude, self.loads.magnitude_interval
        assert self.flow is not None
        v, low, high = (self.flow.velocity(value) for value in (q, q - width, q + width))
        of_law = np.zeros(len(q))  # squares: of fluid and drag, beside those of q
        for lower, upper, deviations in self.flow_shifts:
            of_law += (TWO_SIDED_95 * (upper.velocity(q) - lower.velocity(q)) / deviations) ** 2
        return v, np.maximum(0, v - np.sqrt((v - low) ** 2 + of_law)), v + np.sqrt((high - v) ** 2 + of_law)

    def columns(self) -> dict[str, tuple[str, Any]]:
        """Unit and values, (n,), of each column of a table."""
        found = self.loads
        table: dict[str, tuple[str, Any]] = {
            "sample": ("", self.readings.names),
            "status": ("", found.status),
            "load_x": (self.unit, found.load[:, 0]),
            "load_y": (self.unit, found.load[:, 1]),
        }
        for name, unit in _COLUMNS.items():
            table[name] = (self.unit if unit == "load" else unit, getattr(found, name))
        if self.flow:
            names = ("velocity", "velocity_low", "velocity_high")
            table |= {name: ("m/s", values) for name, values in zip(names, self.velocities())}
        if self.readings.time is not None:
            table["time"] = ("s", self.readings.time)
        if self.others:
            table |= {f"magnitude {other.pair}": (self.unit, other.loads.magnitude) for other in self.others}
            table["spread"] = (self.unit, self.spread)
        return table

    def frame(self) -> Any:
        """pandas.DataFrame of a row for each reading, SI units; attrs: case, models, noise, unit, largest,
        remarks."""
        import pandas

        frame = pandas.DataFrame({name: values for name, (_, values) in self.columns().items()})
        frame.attrs = {
            "case": self.case, "models": str(self.pair), "noise": self.noise, "unit": self.unit,
            "largest": self.response.largest, "remarks": self.remarks,
        }  # fmt: skip
        return frame

    def csv(self) -> str:
        """A line for each sample, units in the header."""
        import pandas

        columns = {f"{name} [{unit}]" if unit else name: v for name, (unit, v) in self.columns().items()}
        return str(pandas.DataFrame(columns).to_csv(index=False))

    def json(self, provenance: Mapping[str, Any]) -> dict[str, Any]:
        """docs/guide/sensing.md; angles in rad, half-widths of 95 %."""
        found = self.loads
        each: dict[str, Sequence[Any]] = {"sample": self.readings.names, "rows": self.readings.rows.tolist()}
        if self.readings.time is not None:
            each["time"] = self.readings.time.tolist()
        covariances = ("covariance", "model_covariance", "input_covariance")
        for name in ("status", "load", *_COLUMNS, "noise_interval", *covariances):
            each[name] = getattr(found, name).tolist()
        if self.flow:
            v, low, high = self.velocities()
            each |= {"velocity": v.tolist(), "velocity_interval": np.stack([low, high], axis=-1).tolist()}
        if self.others:
            by_pair = {str(sensing.pair): sensing.loads.load.tolist() for sensing in (self, *self.others)}
            each["loads"] = [dict(zip(by_pair, loads)) for loads in zip(*by_pair.values())]
            each["spread"] = self.spread.tolist()
        return {
            "schema": 1,
            "case": self.case,
            "provenance": provenance,
            "models": str(self.pair),
            "joints": "corrected" if self.is_corrected else "none",
            "model_uncertainty_unknown": self.left_out.unknown or None,
            "noise": [self.noise] * 3,
            "unit": self.unit,
            "largest": self.response.largest,
            "interpolation_error": self.response.interpolation_error,
            "offset": "measured" if self.readings.measured_offset else "of the model",
            "remarks": self.remarks,
            "samples": [dict(zip(each, values)) for values in zip(*each.values())],
        }

    def text(self, width: int) -> str:
        """A table for people; of many samples the first and the last ones, and how many there are of each
        status."""
        unit, size = shown(self.unit)
        r = self.response
        text = (
            f"{self.case}: loads up to {r.largest / size:.4g} {unit} from readings, by {self.pair}; noise "
            f"{self.noise * 1e6:.3g} uT; response interpolated to {r.interpolation_error / r.largest_change:.1g} "
            f"of the largest |dB|, {r.largest_change * 1e6:.4g} uT\n"
        )
        text += "".join(f"{remark}\n" for remark in self.remarks)
        if not self.readings.measured_offset:
            text += (
                "There is no reading of the unloaded cilium: the model's own B is taken off instead, and the earth's "
                "field and the sensor's offset are read as load.\n"
            )
        columns = {name: np.asarray(values) for name, (_, values) in self.columns().items()}
        n = len(columns["sample"])
        heads = ["sample", f"load ({unit})", "+-", "azimuth", "+- deg"]
        rows = [heads + (["v (m/s)", "from", "to"] if self.flow else []) + ["status"]]
        for i in self._rows_shown():
            if i is None:
                rows.append(["…"])
                continue
            c = {name: values[i] for name, values in columns.items()}
            known = c["azimuth_interval"] < math.pi
            row = [c["sample"], f"{c['magnitude'] / size:.5g}", f"{c['magnitude_interval'] / size:.2g}"]
            row += [f"{math.degrees(c[k]):.2f}" if known else "" for k in ("azimuth", "azimuth_interval")]
            if not known:
                row[3] = "-"
            if self.flow:
                row += [f"{c[k]:.4f}" for k in ("velocity", "velocity_low", "velocity_high")]
            rows.append([*map(str, row), c["status"]])
        text += _core.text_table(rows, "<>>>>>>><" if self.flow else "<>>>><", width)
        if None in self._rows_shown():
            counts = [(status, int((columns["status"] == status).sum())) for status in STATUSES]
            of_each = ", ".join(f"{count} {status}" for status, count in counts if count)
            text += f"{n} samples: {of_each}. --csv and --json have them all; --average takes means.\n"
        return text + self._of_intervals() + (self._of_spread(width) if self.others else "")

    def _rows_shown(self) -> list[int | None]:
        """All samples, or of many the first and the last ones with None between them."""
        n = len(self.readings.names)
        return [*range(n)] if n <= _SHOWN + 1 else [*range(_SHOWN // 2), None, *range(n - _SHOWN // 2, n)]

    def _of_spread(self, width: int) -> str:
        """A table of the smallest and the largest load that a pair finds."""
        unit, size = shown(self.unit)
        pairs = [str(sensing.pair) for sensing in (self, *self.others)]
        by_pair = np.stack([sensing.loads.magnitude for sensing in (self, *self.others)]) / size
        least, most, spread = by_pair.argmin(axis=0), by_pair.argmax(axis=0), self.spread / size
        rows = [["sample", "spread", "least", "by", "most", "by"]]
        for i in self._rows_shown():
            if i is None:
                rows.append(["…"])
                continue
            rows.append([self.readings.names[i], f"{spread[i]:.2g}"])
            for k in (least[i], most[i]):
                rows[-1] += [f"{by_pair[k, i]:.5g}", pairs[k]]
        text = f"Spread of the load found by {', '.join(pairs[:-1])} and {pairs[-1]}, {unit}:\n"
        return text + _core.text_table(rows, "<>><><", width)

    @property
    def is_corrected(self) -> bool:
        return self.left_out.is_corrected

    def _of_intervals(self) -> str:
        """Parts of the intervals, each at the largest load found, and the effects that they do not hold."""
        left_out, found = self.left_out, self.loads
        parts = [("the noise of reading, offset and background", found.noise_interval)]
        name = f"{self.pair}{' with corrected joints' if self.is_corrected else ''}"
        if not left_out.unknown:
            parts.append((f"what {name} leaves out", found.model_interval))
        if left_out.inputs:
            parts.append(("the inputs", found.input_interval))
        unit, size = shown(self.unit)
        seen = np.flatnonzero((found.status == "found") & np.isfinite(found.magnitude_interval))
        largest = seen[found.magnitude[seen].argmax()] if len(seen) else None
        texts = [f"{what} ({width[largest] / size:.2g} {unit})" if largest is not None else what for what, width in parts]
        at = f", at {found.magnitude[largest] / size:.3g} {unit}" if largest is not None else ""
        text = f"Intervals of 95 %{at}: {', '.join(texts)}.\n"
        if left_out.unknown:
            text += f"What {name} leaves out is not known: {left_out.unknown}.\n"
        elif largest is not None and found.magnitude[largest] > left_out.beyond:
            text += f"Beyond {left_out.beyond / size:.3g} {unit} the corrections are not known to hold.\n"
        return text


def sense_readings(
    case: Case,
    readings: Readings,
    pair: Pair,
    noise: float,
    largest: float,
    progress: Progress | None = None,
    joints: str = "corrected",
) -> Sensing:
    """The load of each reading of the case's sensors: see sense(). Raises InputError, SolverError."""
    require_load_to_sense(case)
    case, _ = with_joints(case, pair.mechanics, joints)
    shapes = shapes_within(case, pair.mechanics, largest, progress)
    response = Response(case, pair.field, shapes, case.sensors)
    left_out = LeftOut.of(case, pair, shapes, response, progress)
    left_out = replace(left_out, with_offset=not readings.measured_offset)
    chips = Chips.of(case)
    change = chips.in_case(readings.change)
    if not readings.measured_offset:
        change = change - response.undeformed
    loads = invert(response, change, noise, readings.variance(), readings.background, chips, left_out)
    unit = case.loads[0].unit
    remarks = [*readings.remarks]
    if shapes.limit:
        name, size = shown(unit)
        reached, asked = shapes.largest / size, largest / size
        remarks.append(f"Loads are looked for up to {reached:.4g} {name}, not {asked:.4g} {name}: {shapes.limit}")
    freedom = readings.freedom
    if freedom and special.chdtrc(freedom, readings.squares / noise**2) < UNLIKELY:
        remarks.append(
            f"Rows that are averaged differ by {1e6 * math.sqrt(readings.squares / freedom):.3g} uT (standard "
            f"deviation), more than the noise of {1e6 * noise:.3g} uT: state --noise as the sensor has it, and see "
            "that they are of one load."
        )
    remarks += _axes_remark(readings, response, chips, case.sensor_names)
    flow = FlowLaw.of(case)
    laws = [(FlowLaw.of(Case._of(a)), FlowLaw.of(Case._of(b)), width) for a, b, width in case._core.input_shifts()]
    shifts = [(a, b, width) for a, b, width in laws if a is not None and b is not None]
    return Sensing(case.name, pair, noise, unit, response, readings, loads, flow, left_out, shifts, remarks)


def _axes_remark(readings: Readings, response: Response, chips: Chips, names: list[str]) -> list[str]:
    """A doubt about the sensor where its unloaded reading is not the model's by more than the earth's field and an
    offset make; and which of its axes points elsewhere, where a component is large enough to tell."""
    if readings.unloaded is None or not chips.reads.all():
        return []
    remarks = []
    for i, (read, known) in enumerate(zip(chips.in_case(readings.unloaded), response.undeformed)):
        limit = max(_EARTH, 0.2 * float(np.abs(known).max()))
        if np.abs(read - known).max() <= limit:
            continue
        told = [
            f"its own {'xyz'[own]} seems to point along the case's {'+' if sign > 0 else '-'}{'xyz'[k]}"
            for k in np.flatnonzero(np.abs(known) > limit)
            for own, sign in itertools.product(range(3), (1, -1))
            if abs(sign * read[own] - known[k]) <= limit and (own, sign) != (k, 1)
        ]
        text = (
            f"Unloaded, sensor {names[i]} reads ({', '.join(f'{1e6 * v:.4g}' for v in read)}) uT where the model has "
            f"({', '.join(f'{1e6 * v:.4g}' for v in known)}) uT"
        )
        if told and (chips.axes[i] == np.eye(3)).all():
            text += f": {', '.join(told)} (key `axes` of the sensor)"
        remarks.append(f"{text}. Is the sensor turned, or its unit, place or magnet another?")
    return remarks


def noise_of(value: float | str) -> float:
    """The standard deviation of a component, T, of a number or a text. Raises InputError."""
    noise = _core.quantity(value, "T") if isinstance(value, str) else float(value)
    if not _LEAST_NOISE <= noise <= 1:
        raise InputError(f"--noise: the noise of a reading lies between 1 fT and 1 T, not `{value}`")
    return noise


def largest_of(case: Case, largest: float | str | None) -> float:
    """The largest load to look for, as the load's type has it. Raises InputError."""
    if largest is not None:
        return _core.quantity(largest, case.loads[0].unit) if isinstance(largest, str) else float(largest)
    limit = BEYOND_THE_LARGEST * max(load.magnitude for load in case.loads)
    if not limit > 0:
        raise InputError("the case has no load but zero: say --largest")
    return limit


def case_of(case: Case | str | Path) -> Case:
    """A case with sensors. Raises InputError."""
    made = case if isinstance(case, Case) else Case(case)
    if not len(made.sensors):
        raise InputError(f"{made.file or made.name}: the case has no sensor")
    return made


def readings_of(
    case: Case, readings: npt.ArrayLike | str | Path, unloaded: Any = None, background: Any = None, **options: Any
) -> Readings:
    """Readings of the case's sensors from a file or arrays: see sense(). Raises InputError, FileError."""
    chips = Chips.of(case)
    if isinstance(readings, (str, Path)):
        stated: dict[str, Any] = {name: Option(*option) for name, option in case._core.readings.items()}
        for name, text in (options | {"unloaded": unloaded}).items():
            if text:
                stated[name] = text if name == "skip" else Option(text, f"--{name}")
        ambient = None if background is None else Path(background)
        return read_readings(Path(readings), case.sensor_names, ReadingOptions(**stated), ambient, chips.reads)
    if given := [name for name, value in options.items() if value]:
        raise InputError(f"{', '.join(given)}: of a file of readings alone; arrays are in T")
    return readings_of_arrays(readings, len(case.sensors), unloaded, background, chips)


def sensed(
    case: Case | str | Path,
    readings: npt.ArrayLike | str | Path,
    models: str = "elastica/volume",
    noise: float | str = 1e-6,
    largest: float | str | None = None,
    joints: str = "corrected",
    progress: Progress | None = None,
    **options: Any,
) -> Sensing:
    """The Sensing from which sense() makes its frame."""
    case = case_of(case)
    require_load_to_sense(case)
    pairs, sigma, limit = pairs_of(models), noise_of(noise), largest_of(case, largest)
    read = readings_of(case, readings, **options)  # before the models run, which may take a minute
    first, *others = [sense_readings(case, read, pair, sigma, limit, progress, joints) for pair in pairs]
    more = [f"{s.pair}: {remark}" for s in others for remark in s.remarks if remark not in first.remarks]
    return replace(first, others=others, remarks=[*first.remarks, *more])


def sense(
    case: Case | str | Path,
    readings: npt.ArrayLike | str | Path,
    *,
    models: str = "elastica/volume",
    noise: float | str = 1e-6,
    unloaded: Any = None,
    background: npt.ArrayLike | str | Path | None = None,
    largest: float | str | None = None,
    map: str | None = None,
    unit: str | None = None,
    scale: str | None = None,
    average: str | None = None,
    temperature: str | None = None,
    skip: bool = False,
    joints: str = "corrected",
    unknowns: Sequence[str] | None = None,
    priors: Mapping[str, Any] | None = None,
    touches: Sequence[Any] | None = None,
    progress: Progress | None = None,
) -> Any:
    """The load of each reading: a pandas.DataFrame with a row for each, SI units, whose columns are sample,
    status, load_x, load_y, magnitude, magnitude_interval, model_interval, input_interval, azimuth,
    azimuth_interval, chi_squared, misfit_probability, nothing_probability, of a flow velocity, velocity_low, velocity_high, and
    time where it is known. Intervals of 95 %, by the noise, what the models leave out, which model_interval has
    alone, and the case's [[input_uncertainty]].

    case: a Case or its file; its sensors, its kind of load. readings: B, (n, 3) of one sensor or
    (n, sensors, 3), T; or a logger's file, to which map, unit, scale, average, temperature and skip belong
    (docs/guide/sensing.md). noise: standard deviation of a component, T, or "0.4 uT". unloaded: which of
    the readings are of the straight cilium, a slice or indices, which are averaged and left out of the
    frame; "model" takes the model's own B; None: the readings are changes dB. Of a file as --unloaded.
    background: the ambient field that goes with each reading, as large as these, each with the noise of
    a reading; or one field for all, which drops out of dB. Of a file the background's file. models: the
    pair that is inverted, or several with commas between: the first one's loads, and in the columns
    `magnitude beam/line` and `spread` what the others find. joints: "corrected", those of a rod where the corrections
    reach (docs/theory/joints.md), or "case", as the case states them. largest: the largest load to look for.

    unknowns: which of force, displacement, speed, azimuth, height and friction are looked for; None: the size of the
    load and its azimuth, as above. The frame then has sample, status (not determined, too), of each unknown, and of a
    touch of force, base_moment and displacement, NAME, NAME_low, NAME_high, the ends of its interval of 95 % by
    the noise and the priors, and NAME_by, how that was seen: ellipse, profile (of chi squared), open; covariance of
    the unknowns, knowledge in words, chi_squared and misfit_probability. priors: what is known of others,
    {"friction": (0, 0.6), "height": 0.5e-3}: a uniform range, or a standard deviation about the case's value. touches:
    a label for each loaded reading; those of one label share azimuth, height and friction.
    docs/guide/sensing.md#what-a-sensor-can-know.

    Raises InputError, FileError, SolverError.

    >>> import ciliaval as cv, numpy as np
    >>> case = cv.Case("cases/paper/fig5.toml")
    >>> rng = np.random.default_rng(1)
    >>> B = np.zeros((30, 3)) + [9e-5, 1e-6, -2e-5] + rng.normal(0, 4e-7, (30, 3))
    >>> B[:20] = rng.normal(0, 4e-7, (20, 3))  # unloaded
    >>> frame = cv.sense(case, B, noise=4e-7, unloaded=slice(0, 20))
    >>> len(frame), list(frame.columns[:4])
    (10, ['sample', 'status', 'load_x', 'load_y'])

    The height of a touch is not known:

    >>> case = cv.Case("cases/paper/fig3b.toml")
    >>> dB = [shape.dB(case.sensors)[0] for shape in cv.bend(case.cilium, case.loads[1:2])]
    >>> frame = cv.sense(case, dB, noise=4e-7, unknowns=("force", "azimuth", "height"), joints="case")
    >>> print(*frame.knowledge[0].split("; ")[-2:], sep="\\n")
    force × (height − 0.99 mm) = 30.02 ± 0.13 µN m
    force and height apart: not determined by this sensor
    """
    options = {
        "unloaded": unloaded, "background": background, "map": map, "unit": unit, "scale": scale, "average": average,
        "temperature": temperature, "skip": skip,
    }  # fmt: skip
    if unknowns is None:
        if priors is not None or touches is not None:
            raise InputError("`priors` and `touches` belong to `unknowns`: name those")
        return sensed(case, readings, models, noise, largest, joints, progress, **options).frame()
    from .unknowns import sense_unknowns

    case, pair, sigma = case_of(case), Pair.of(models), noise_of(noise)
    limit = largest_of(case, largest)
    read = readings_of(case, readings, **options)
    return sense_unknowns(case, read, pair, sigma, limit, unknowns, priors, touches, progress, joints)


def readings_of_arrays(
    B: npt.ArrayLike, sensors: int, unloaded: Any, background: Any, chips: Chips | None = None
) -> Readings:
    """Readings from arrays: see sense(). Raises InputError."""
    B = _by_sensor(B, sensors, "the readings", chips)
    n = len(B)
    is_change = unloaded is None
    is_unloaded = np.zeros(n, dtype=bool)
    if not is_change and not (isinstance(unloaded, str) and unloaded == "model"):
        try:
            is_unloaded[unloaded] = True
        except (IndexError, TypeError, ValueError) as error:
            raise InputError(f"`unloaded` is a slice, indices of the readings, \"model\" or None: {error}") from error
        if not is_unloaded.any():
            raise InputError("`unloaded` names no reading")
        if is_unloaded.all():
            raise InputError("there is no reading but of the unloaded cilium")
    variance = 1.0  # over that of a reading
    taken = np.zeros_like(B)
    if background is not None and is_change:
        raise InputError("changes dB have no background any more: leave the background out, or say `unloaded`")
    if background is not None:
        taken = np.asarray(background, dtype=float)
        if taken.shape != (3,):
            taken = _by_sensor(taken, sensors, "the background", chips)
            if len(taken) != n:
                raise InputError(f"there are {n} readings and {len(taken)} of the background")
            variance = 2.0
    rest = B - taken
    offset = rest[is_unloaded].mean(axis=0) if is_unloaded.any() else np.zeros((sensors, 3))
    scatter = rest[is_unloaded] - offset
    count = int(is_unloaded.sum())
    loaded = np.flatnonzero(~is_unloaded)
    return Readings(
        names=[str(i) for i in loaded],
        change=rest[loaded] - offset,
        rows=np.ones(len(loaded), dtype=int),
        time=None,
        # Variance of the own backgrounds of sample and unloaded rows, independent of the other sensors.
        background=None if variance == 1 else np.tile(np.eye(sensors) * (1 + (1 / count if count else 0)), (len(loaded), 1, 1)),
        measured_offset=is_change or count > 0,
        offset_variance=1 / count if count else 0.0,
        squares=float((scatter**2).sum() / variance),
        freedom=(3 * sensors if chips is None else int(chips.reads.sum())) * max(count - 1, 0),
        unloaded=B[is_unloaded].mean(axis=0) if count else None,
        remarks=[f"{len(loaded)} readings" + (f"; {count} unloaded" if count else "")],
    )


def _by_sensor(values: npt.ArrayLike, sensors: int, what: str, chips: Chips | None) -> Array:
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} are numbers in T: {error}") from error
    if array.ndim == 2 and sensors == 1:
        array = array[:, None, :]
    if array.ndim != 3 or array.shape[1:] != (sensors, 3):
        wanted = "(n, 3)" if sensors == 1 else f"(n, {sensors}, 3)"
        raise InputError(f"{what} have the shape {wanted}, T, not {array.shape}")
    if chips is not None:  # what a chip does not read does not matter
        array = np.where(chips.reads, array, 0.0)
    if not np.isfinite(array).all():
        raise InputError(f"{what} have a number that is not finite in row {np.argwhere(~np.isfinite(array))[0][0]}")
    if (np.abs(array) > 100).any():
        raise InputError(f"{what} have {np.abs(array).max():g} T, which no magnet makes: are they in T?")
    return array
