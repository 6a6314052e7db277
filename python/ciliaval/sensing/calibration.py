# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers of a case from readings at known loads: docs/guide/sensing.md."""

from __future__ import annotations

import difflib
import math
import tomllib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import optimize, special

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..model import Case
from ..units import shown
from .inversion import TWO_SIDED_95, UNLIKELY, Chips
from .left_out import with_joints
from .loads import case_of, noise_of, readings_of
from .readings import Readings
from .response import Pair, Progress

TOGETHER = 0.99  # correlation from which two numbers are named
_SINGULAR = 1e-10  # of the eigenvalues of the normal matrix with a unit diagonal: nothing is known beyond rounding
_PLACE, _ANGLE, _PART = 1e-4, math.radians(1), 0.1  # m, rad, of a number: steps of the fit

_MEMBERS = [*(f"position.{axis}" for axis in "xyz"), *(f"rotation.{axis}" for axis in "xyz"), "gain"]
# Words after a sensor's name, with their members, units and steps.
_OF_SENSOR = {
    "position": (_MEMBERS[:3], "m", _PLACE),
    "rotation": (["rotation.z"], "rad", _ANGLE),
    "orientation": (_MEMBERS[3:6], "rad", _ANGLE),
    "gain": (["gain"], "", _PART),
    "scale": (["gain"], "", _PART),
}


@dataclass(frozen=True)
class Parameter:
    """A number that is fitted. path: of the case; of a sensor its member, with the sensor's number. is_ratio: it keeps
    its sign, and is fitted as start exp(x step/start)."""

    path: str
    name: str
    unit: str
    start: float
    step: float
    sensor: int | None = None

    @property
    def is_ratio(self) -> bool:
        return self.start > 0 and (self.sensor is None or self.path == "gain")

    def value(self, x: float) -> float:
        """Value at x steps from the start."""
        return self.start * math.exp(self.step / self.start * x) if self.is_ratio else self.start + self.step * x

    def slope(self, value: float) -> float:
        """Derivative of the value by x."""
        return self.step * value / self.start if self.is_ratio else self.step


@dataclass(frozen=True)
class Calibration:
    """Numbers of a case as readings at known loads give them.

    values, deviations: (k,), found, and standard deviations by the noise; infinite where the readings do
    not tell. correlation: (k, k). chi_squared, freedom, misfit_probability: of the fit. together: groups of
    numbers that the readings cannot tell apart. case: the calibrated one. residuals: (n, sensors, 3), T,
    read less computed, in the chips' directions.
    """

    parameters: list[Parameter]
    values: Array
    deviations: Array
    correlation: Array
    chi_squared: float
    freedom: int
    together: list[list[str]]
    case: Case
    pair: Pair
    noise: float
    residuals: Array
    remarks: list[str]

    @property
    def misfit_probability(self) -> float:
        """Probability of a larger chi squared by noise alone."""
        return float(special.chdtrc(self.freedom, self.chi_squared)) if self.freedom > 0 else 1.0

    def text(self, width: int) -> str:
        """Tables for people."""
        rows = [["", "start", "found", "+-", "unit"]]
        for p, value, deviation in zip(self.parameters, self.values, self.deviations):
            unit, size = shown(p.unit)
            known = math.isfinite(deviation)
            spread = f"{TWO_SIDED_95 * deviation / size:.2g}" if known else "not known"
            rows.append([p.name, f"{p.start / size:.5g}", f"{value / size:.6g}", spread, unit])
        rms = float(np.sqrt((self.residuals**2).mean()))
        text = (
            f"{self.case.name}: {len(self.parameters)} numbers from {len(self.residuals)} readings at known loads, by "
            f"{self.pair}, noise {1e6 * self.noise:.3g} uT\n"
        )
        text += "".join(f"{remark}\n" for remark in self.remarks) + _core.text_table(rows, "<>>><", width)
        text += (
            "Intervals of 95 %, of the noise alone.\n"
            f"chi^2 {self.chi_squared:.4g} with {self.freedom} degrees of freedom, residuals {1e6 * rms:.3g} uT rms"
        )
        if self.misfit_probability < UNLIKELY:
            text += (
                ": noise alone does so once in a thousand times. The model, what is not fitted, a known load or --noise is "
                "wrong, and the intervals are too small"
            )
        text += ".\n"
        names, r = [p.name for p in self.parameters], self.correlation
        pairs = zip(*np.triu_indices(len(names), 1))
        close = [f"{names[i]} and {names[j]} ({r[i, j]:+.3f})" for i, j in pairs if TOGETHER < abs(r[i, j]) < 1 - 1e-9]
        if close:
            text += f"Known together better than apart (correlation): {', '.join(close)}.\n"
        for group in self.together:
            text += (
                f"The readings cannot tell apart: {', '.join(group)}. Fit one of them less, or read at other loads, "
                "heights or sensors.\n"
            )
        return text.rstrip("\n")

    def json(self, provenance: Mapping[str, Any]) -> dict[str, Any]:
        """docs/guide/sensing.md; SI units."""
        return {
            "schema": 1,
            "case": self.case.name,
            "provenance": provenance,
            "models": str(self.pair),
            "noise": self.noise,
            "parameters": [
                {"path": p.path, "sensor": p.sensor, "unit": p.unit, "start": p.start, "value": value,
                 "deviation": deviation}
                for p, value, deviation in zip(self.parameters, self.values.tolist(), self.deviations.tolist())
            ],
            "correlation": self.correlation.tolist(),
            "chi_squared": self.chi_squared,
            "freedom": self.freedom,
            "misfit_probability": self.misfit_probability,
            "together": self.together,
            "remarks": self.remarks,
            "residuals": self.residuals.tolist(),
        }  # fmt: skip


def calibrate(
    case: Case | str | Path,
    readings: npt.ArrayLike | str | Path,
    fit: Sequence[str],
    *,
    models: str = "elastica/volume",
    noise: float | str = 1e-6,
    joints: str = "corrected",
    progress: Progress | None = None,
    **options: Any,
) -> Calibration:
    """Fits numbers of a case to readings at its loads, which are known: one reading, or sample of averaged ones,
    for each load step, in their order, by weighted least squares of dB (scipy.optimize.least_squares).

    fit: "base.young_modulus", any number by its path in studies or the end of it; "sensor.position" (three
    numbers), "sensor.rotation" (about z), "sensor.orientation" (about x, y, z), "sensor.gain" or "scale"; with
    several sensors "NAME.gain", or "sensor.gain" for each of them. readings, noise, joints, options: as of
    sense(); the case that is written has the joints that were used. Deviations are (J^T V^-1 J)^-1 by the noise alone,
    that of the offset, which all readings share, included. Raises InputError, SolverError.

    >>> import ciliaval as cv
    >>> from ciliaval.sensing import calibrate
    >>> case = cv.Case("cases/paper/fig3d.toml")
    >>> soft = case.changed({"cilium.segment.base.young_modulus": 0.09e6})
    >>> dB = [shape.dB(case.sensors)[0] for shape in cv.bend(soft.cilium, soft.loads, joints="corrected")]
    >>> found = calibrate(case, dB, ["base.young_modulus"], noise=1e-6)
    >>> round(float(found.values[0]))
    90000
    """
    pair, sigma = Pair.of(models), noise_of(noise)
    case, _ = with_joints(case_of(case), pair.mechanics, joints)
    read = readings_of(case, readings, **options)
    read.require_offset("a calibration")
    if len(read.change) != len(case.loads):
        raise InputError(
            f"there are {len(read.change)} readings and {len(case.loads)} load steps in the case: it lists the known loads, "
            "one for each reading (or sample), in their order"
        )
    parameters = [p for name in fit for p in parameters_of(case, name)]
    names = [p.name for p in parameters]
    if not parameters:
        raise InputError("fit names no number")
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise InputError(
            f"fit names {', '.join(twice)} twice (sensor.rotation is orientation.z alone): {', '.join(fit)}"
        )
    fitting = _Fitting(case, read, parameters, pair, sigma, progress)
    start = fitting.residual(np.zeros(len(parameters)))
    data = int(Chips.of(case).reads.sum()) * len(read.change)
    if data < len(parameters):
        raise InputError(f"{len(parameters)} numbers cannot be found from {data} components of dB")
    if not np.isfinite(start).all():
        raise SolverError(f"the case as it stands has no shape under all loads: {fitting.failure}")
    found = optimize.least_squares(
        fitting.residual, np.zeros(len(parameters)), jac=fitting.jacobian, method="lm", xtol=1e-12, ftol=1e-14
    )
    if not found.success or not np.isfinite(found.fun).all():
        raise SolverError(f"the fit did not converge: {fitting.failure or found.message}")
    deviations, correlation, together = known(found.jac, names)
    values = fitting.values(found.x)
    return Calibration(
        parameters, values, deviations * [p.slope(v) for p, v in zip(parameters, values)], correlation, float(2 * found.cost),
        data - len(parameters) + len(together), together,
        fitting.case(values), pair, sigma, fitting.read - fitting.computed(values), read.remarks,
    )  # fmt: skip


def known(
    J: Array, names: Sequence[str], singular: float = _SINGULAR
) -> tuple[Array, Array, list[list[str]]]:
    """Deviations and correlations by the normal matrix J^T J, and groups of numbers that it cannot tell apart: whose
    eigenvalues with a unit diagonal are below `singular`."""
    size = np.linalg.norm(J, axis=0)
    free = size > 1e-12 * max(size.max(), 1e-300)  # the others change nothing at all
    unit = np.where(free, size, 1)
    values, vectors = np.linalg.eigh((J / unit).T @ (J / unit))
    weak = values < singular
    inverse = (vectors[:, ~weak] / values[~weak]) @ vectors[:, ~weak].T
    unknown = (np.abs(vectors[:, weak]) > 0.1).any(axis=1)
    deviations = np.where(unknown, np.inf, np.sqrt(np.diag(inverse)) / unit)
    spread = np.sqrt(np.maximum(np.diag(inverse), 1e-300))
    correlation = inverse / np.outer(spread, spread)
    correlation[unknown] = correlation[:, unknown] = 0
    np.fill_diagonal(correlation, 1)
    together = [[name for name, c in zip(names, vector) if abs(c) > 0.1] for vector in vectors[:, weak].T]
    return deviations, correlation, together


def parameters_of(case: Case, name: str) -> list[Parameter]:
    """The numbers that a word of `fit` names. Raises InputError with what there is."""
    owner, _, what = name.rpartition(".") if name not in _OF_SENSOR else ("sensor", "", name)
    numbers = case._core.numbers()
    sensors = case.sensor_names
    members = _OF_SENSOR.get(what)
    if what in tuple("xyz") and owner.rpartition(".")[2] in ("position", "orientation", "rotation"):
        owner, _, kind = owner.rpartition(".")
        each, unit, step = _OF_SENSOR["position" if kind == "position" else "orientation"]
        members = ([each["xyz".index(what)]], unit, step)
    if members and (owner == "sensor" or owner in sensors):
        paths, unit, step = members
        chosen = range(len(sensors)) if owner == "sensor" else [sensors.index(owner)]
        if sensors[0] == "0" and not paths[0].startswith("position"):
            chosen = [0]  # a list of places has one chip for all
        starts, names = _sensors_of(case), ["sensor"] if len(sensors) == 1 else sensors
        return [
            Parameter(path, f"{names[s]}.{path}", unit, float(starts[s, _MEMBERS.index(path)]), step, s)
            for s in chosen
            for path in paths
        ]
    ends = [path for path in numbers if path == name or path.endswith(f".{name}")]
    if len(ends) != 1:
        near = difflib.get_close_matches(name, [p.removeprefix("cilium.segment.") for p in numbers], 1, 0.5)
        meant = f"; did you mean `{near[0]}`?" if near else ""
        what = f"is one of {', '.join(ends)}: say which" if ends else f"is no number of the case{meant}"
        raise InputError(f"fit: `{name}` {what} (sensors have {', '.join(f'sensor.{k}' for k in _OF_SENSOR)})")
    value, unit = numbers[ends[0]]
    key = ends[0].removeprefix("load.")
    if key != ends[0] and len({load.parameters.get(key) for load in case.loads}) > 1:
        raise InputError(f"fit: `{name}` is not the same in all load steps, and one number is fitted for all")
    short = ends[0].removeprefix("cilium.segment.")
    return [Parameter(ends[0], short, unit, value, _PART * abs(value) or _PART)]


def _sensors_of(case: Case) -> Array:
    """Position, m, rotation, rad, and gain of the sensors, (s, 7)."""
    chips = [[*rotation, gain] for _, rotation, gain, _ in case._core.chips]
    return np.hstack([case.sensors, chips])


class _Fitting:
    """Computed less read dB as a function of the numbers, in steps from their starts."""

    def __init__(
        self, case: Case, read: Readings, parameters: Sequence[Parameter], pair: Pair, noise: float, progress: Progress | None
    ):
        self._case, self._parameters, self._pair, self._progress = case, parameters, pair, progress
        self._reads = Chips.of(case).reads
        self.read = np.where(self._reads, read.change, 0.0)
        self.failure = ""
        self._evaluations = 0
        # V^-1/2 of V = sigma^2 (diag(1/rows) + v 1 1^T), v of the offset.
        self._whitening = np.linalg.inv(np.linalg.cholesky(np.diag(1 / read.rows) + read.offset_variance)) / noise

    def values(self, x: Array) -> Array:
        return np.array([p.value(float(value)) for p, value in zip(self._parameters, x)])

    def case(self, values: Array) -> Case:
        """The case with these numbers. Raises InputError where one is out of its range."""
        of_case = {p.path: float(v) for p, v in zip(self._parameters, values) if p.sensor is None}
        changed = self._case.changed(of_case) if of_case else self._case
        of_sensor = [(p, float(v)) for p, v in zip(self._parameters, values) if p.sensor is not None]
        if not of_sensor:
            return changed
        tables, sensors = tomllib.loads(changed.toml()), _sensors_of(changed)
        for p, value in of_sensor:
            sensors[p.sensor, _MEMBERS.index(p.path)] = value
        named = isinstance(tables["sensor"], list)
        places = [[f"{c!r} m" for c in place] for place in sensors[:, :3].tolist()]
        for s, table in enumerate(tables["sensor"] if named else [tables["sensor"]]):
            table["position"] = places[s] if named or len(places) == 1 else places
            if any(p.path.startswith("rotation") for p, _ in of_sensor):
                table["rotation"] = [f"{angle!r} rad" for angle in sensors[s, 3:6].tolist()]
            if any(p.path == "gain" for p, _ in of_sensor):
                table["gain"] = float(sensors[s, 6])
        return Case.from_dict(tables, str(changed.file or changed.name))

    def computed(self, values: Array) -> Array:
        """dB in the chips' directions, (n, s, 3), T; NaN where there is no shape."""
        self._evaluations += 1
        if self._progress:
            self._progress(f"calibrate: evaluation {self._evaluations}")
        try:
            case = self.case(values)
            shapes = _core.bend_case(case._core, case.loads, self._pair.mechanics, None)
            missing = next((shape for shape in shapes if not shape.has_shape), None)
            if missing is not None:
                raise SolverError(f"{self._pair.mechanics}: {missing.message}")
            B = _core.fields([shapes[0].straight, *shapes], case.sensors, self._pair.field)
        except (InputError, SolverError) as error:
            self.failure = str(error)
            return np.full(self.read.shape, np.nan)
        chips = Chips.of(case)
        return np.asarray(chips.own(B[1:] - B[0]))

    def residual(self, x: Array) -> Array:
        off = self.computed(self.values(x)) - self.read
        return np.asarray(np.tensordot(self._whitening, off, axes=1)[:, self._reads].ravel())

    def jacobian(self, x: Array) -> Array:
        """Jacobian by central differences of 1e-3 steps."""
        steps = 1e-3 * np.eye(len(x))
        return np.stack([(self.residual(x + h) - self.residual(x - h)) / 2e-3 for h in steps], axis=1)
