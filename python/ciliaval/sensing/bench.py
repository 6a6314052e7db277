# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated test bench, NAME.sense.toml: docs/guide/sensing.md."""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..files import content
from ..model import Case
from ..units import shown
from .inversion import Chips, LinearFit, directions, invert, wrapped
from .response import Pair, Progress, Response, require_load_to_sense, shapes_up_to, shapes_within
from .loads import BEYOND_THE_LARGEST, FlowLaw

_LEAST_NOISE = 1e-9  # T: weights of a sensor without noise
_ERRORS = {"noise": ("T", 1.0), "quantum": ("T", 1.0), "sensor_position": ("m", 1.0), "stage_azimuth": ("rad", 1.6)}


@dataclass(frozen=True)
class Bench:
    """A sensor on a rotation stage, a load of fixed direction, the ambient field measured at each azimuth
    before, the unloaded cilium read at the first."""

    title: str
    case: Case  # its load path has the magnitudes, its sensors are where they should be
    models: Pair  # by which the readings are inverted
    truth: Pair  # of the cilium that bends and is read
    azimuths: int = 12  # of the load as the sensor sees it, evenly round the circle
    draws: int = 20  # sensors built and benches run, each with its own errors
    seed: int = 1
    noise: float = 0.0  # standard deviation of a component of a reading, T
    quantum: float = 0.0  # one digit of the sensor, T; 0: none
    sensor_position: float = 0.0  # standard deviation of each of its coordinates, m
    stage_azimuth: float = 0.0  # of the angle between stage and load, rad
    ambient: Array = field(default_factory=lambda: np.zeros(3))  # the earth's field at the azimuth 0, T


def read_bench(file: Path) -> Bench:
    """The bench of a file. Raises InputError with every fault of the file, a line each; FileError."""
    try:
        root = tomllib.loads(content(file, 1 << 20).decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: {error}") from error
    pair = root["bench"].get("models") if isinstance(root.get("bench"), dict) else None
    # Keys of each table, with their defaults and readers.
    keys: dict[str, dict[str, tuple[Any, Callable[[Any], Any]]]] = {
        "bench": {
            "title": ("", _line),
            "case": (None, lambda value: _case(file, value)),
            "models": ("elastica/volume", lambda value: Pair.of(_line(value))),
            "truth": (pair or "elastica/volume", lambda value: Pair.of(_line(value))),
            "azimuths": (Bench.azimuths, _count(1, 3600)),
            "draws": (Bench.draws, _count(1, 100_000)),
            "seed": (Bench.seed, _count(0, 2**32 - 1)),
        },
        "errors": {key: (f"0 {unit}", _quantity(unit, 0.0, most)) for key, (unit, most) in _ERRORS.items()}
        | {"ambient": (["0 T"] * 3, _ambient)},
    }
    faults = [f"there is no key `{name}`; there are the tables {', '.join(keys)}" for name in root if name not in keys]
    values: dict[str, Any] = {}
    for name, known in keys.items():
        table = root.get(name)
        if not isinstance(table, dict):
            faults.append(f"there is no table [{name}]")
            table = {}
        for key in table:
            if key not in known:
                near = difflib.get_close_matches(key, known, 1)
                meant = f"; did you mean `{near[0]}`?" if near else f"; its keys are {', '.join(known)}"
                faults.append(f"[{name}]: there is no key `{key}`{meant}")
        for key, (default, read) in known.items():
            try:
                values[key] = read(table.get(key, default))
            except InputError as error:
                faults.append(f"[{name}] {key}: {error}")
    if faults:
        raise InputError("\n".join(f"{file}: {fault}" for fault in faults))
    return Bench(**values)


def _line(value: Any) -> str:
    if not isinstance(value, str) or "\n" in value or len(value) > 200:
        raise InputError(f"a text of one line, not {value!r:.40}")
    return value


def _count(least: int, most: int) -> Callable[[Any], int]:
    def read(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            raise InputError(f"a whole number from {least} to {most}, not {value!r}")
        return value

    return read


def _quantity(unit: str, least: float, most: float) -> Callable[[Any], float]:
    def read(value: Any) -> float:
        if not isinstance(value, str):
            raise InputError(f"a quantity with its unit in quotes, not {value!r:.40}")
        number = _core.quantity(value, unit)
        if not least <= number <= most:
            raise InputError(f"{value} does not lie between {least:g} and {most:g} {unit}: a slip in the unit?")
        return number

    return read


def _ambient(value: Any) -> Array:
    if not isinstance(value, list) or len(value) != 3:
        raise InputError('it has three components, such as ["20 uT", "0 uT", "-43 uT"]')
    return np.array([_quantity("T", -1.0, 1.0)(component) for component in value])


def _case(file: Path, name: Any) -> Case:
    """The case that the bench names, beside the bench's file."""
    if name is None:
        raise InputError("there is no key `case`")
    try:
        case = Case(file.parent / _line(name))
        if not len(case.sensors):
            raise InputError("the case has no sensor")
        if case.loads[0].type == "sweep":
            raise InputError("it is a sweep, and a bench has loads with a magnitude")
        require_load_to_sense(case)
        if not Chips.of(case).is_plain:
            raise InputError("a bench reads along the case's axes: leave axes, rotation, gain and components out")
        if min(load.magnitude for load in case.loads) <= 0:
            raise InputError("the case has a load that is zero")
    except InputError as error:
        raise InputError(f"the case cannot be used: {error}") from error
    return case


SOURCES = ("none", "noise", "digits", "sensor position", "stage azimuth", "ambient field", "models", "all")


@dataclass(frozen=True)
class BenchErrors:
    """Errors of one estimator over draws, azimuths and magnitudes.

    magnitude_rms: of (found - true)/true. speed_rms: m/s; 0 if the load is no flow of a velocity.
    azimuth_rms, azimuth_largest: rad. azimuth_rms_interval: 95 % half-width of azimuth_rms, from the
    scatter of its square over the draws, which are independent as the readings of one sensor are not
    (Student's t); 0 if there is one draw. below_ten_degrees: part of the readings.
    """

    magnitude_rms: float
    speed_rms: float
    azimuth_rms: float
    azimuth_rms_interval: float
    azimuth_largest: float
    below_ten_degrees: float
    readings: int


@dataclass(frozen=True)
class BenchResult:
    """rows: of each source alone where it has a size, then of all: source, inversion, linear fit.
    by_magnitude: all sources, full inversion. first_draw: truth and found, (n, 2) each, of one sensor.
    fit: the linear one. roundness: of the first sensor's loads, for each magnitude the largest over the
    smallest found over the azimuths."""

    rows: list[tuple[str, BenchErrors, BenchErrors]]
    by_magnitude: list[BenchErrors]
    truth: Array
    found: Array
    fit: LinearFit
    roundness: list[float]


@dataclass(frozen=True)
class _Readings:
    magnitude: Array  # (n,) index in the load path
    draw: Array  # (n,)
    truth: Array  # (n, 2)
    change: Array  # (n, s, 3): dB from the readings, without offsets


class Simulation:
    """The bench with all that its readings are made and inverted with."""

    def __init__(self, bench: Bench, progress: Progress | None = None):
        self.bench, self._progress = bench, progress
        case = bench.case
        self.magnitudes = np.array([load.magnitude for load in case.loads])
        largest = float(self.magnitudes.max())
        self._shapes = shapes_within(case, bench.models.mechanics, BEYOND_THE_LARGEST * largest, progress)
        if self._shapes.largest < largest:
            raise SolverError(
                f"no shape under the bench's largest load, {largest:g} {case.loads[0].unit}: {self._shapes.limit}"
            )
        self.response = Response(case, bench.models.field, self._shapes, case.sensors)
        self._truth_shapes, self._truth = self._shapes, self.response
        if bench.truth != bench.models:
            if bench.truth.mechanics != bench.models.mechanics:
                self._truth_shapes = shapes_up_to(case, bench.truth.mechanics, largest, progress)
            self._truth = Response(case, bench.truth.field, self._truth_shapes, case.sensors)
        self.noise = max(bench.noise, bench.quantum, _LEAST_NOISE)
        self.fit = LinearFit(self.response, self.noise)

    def errors(self, source: str) -> dict[str, Any]:
        """The sizes of the errors of one simulation: those of the bench, or zero where they are left out."""
        bench = self.bench
        sizes: dict[str, tuple[Any, str]] = {
            "noise": (bench.noise, "noise"),
            "background_noise": (bench.noise, "ambient field"),
            "quantum": (bench.quantum, "digits"),
            "sensor_position": (bench.sensor_position, "sensor position"),
            "stage_azimuth": (bench.stage_azimuth, "stage azimuth"),
            "ambient": (bench.ambient, "ambient field"),
            "models": (bench.truth != bench.models, "models"),
        }
        chosen = {k: size if source in ("all", of) else 0 * size for k, (size, of) in sizes.items()}
        # An ambient field does no harm without the noise of its reading.
        harm = [k for k, size in chosen.items() if k not in ("background_noise", "ambient") and size > 0]
        return chosen | {"any": bool(harm) or chosen["background_noise"] > 0 and bool(np.any(chosen["ambient"]))}

    def readings(self, source: str) -> _Readings:
        """Readings of the sensors of all draws with the errors of a source; "none" and "models" have one draw. A source
        but "models" is simulated with the inverting pair itself, so that its errors hold nothing else."""
        draws = 1 if source in ("none", "models") else self.bench.draws
        parts = []
        for draw in range(draws):
            if self._progress:
                self._progress(f"{source}: sensor {draw + 1} of {self.bench.draws}")
            parts.append(self._draw(self.errors(source), draw))
        loads, azimuths = len(self.magnitudes), self.bench.azimuths
        angle = 2 * np.pi * np.arange(azimuths) / azimuths
        truth = (self.magnitudes[None, :, None] * directions(angle)[:, None]).reshape(-1, 2)
        return _Readings(
            np.tile(np.arange(loads), azimuths * draws),
            np.repeat(np.arange(draws), azimuths * loads),
            np.tile(truth, (draws, 1)),
            np.concatenate(parts),
        )

    def _draw(self, errors: Mapping[str, Any], draw: int) -> Array:
        """dB of one draw's sensors, (azimuths x loads, s, 3), T."""
        bench, case = self.bench, self.bench.case
        # The same random numbers in every simulation, whatever the size of its errors.
        random = np.random.default_rng([bench.seed, draw])
        sensors = case.sensors + errors["sensor_position"] * random.standard_normal(case.sensors.shape)
        stage = errors["stage_azimuth"] * float(random.standard_normal())
        shapes = self._truth_shapes if errors["models"] else self._shapes
        truth = self._truth if errors["models"] else self.response
        if errors["sensor_position"] > 0:
            pair = bench.truth if errors["models"] else bench.models
            truth = Response(case, pair.field, shapes, sensors)

        def read(B: Array, noise: float) -> Array:
            B = B + noise * random.standard_normal(B.shape)
            return np.asarray(np.round(B / errors["quantum"]) * errors["quantum"] if errors["quantum"] > 0 else B)

        angle = 2 * np.pi * np.arange(bench.azimuths) / bench.azimuths
        cos, sin = np.cos(angle), np.sin(angle)
        x, y, z = errors["ambient"]
        ambient = np.stack([cos * x - sin * y, sin * x + cos * y, np.full_like(cos, z)], axis=-1)[:, None, :]
        ambient = np.broadcast_to(ambient, (bench.azimuths, truth.sensors, 3))
        background = read(ambient, errors["background_noise"])
        offset = read(ambient[0] + truth.undeformed, errors["noise"]) - background[0]
        loads = self.magnitudes[None, :, None] * directions(angle + stage)[:, None, :]
        change = truth.change(loads.reshape(-1, 2)).reshape(bench.azimuths, -1, truth.sensors, 3)
        B = read(ambient[:, None] + truth.undeformed + change, errors["noise"])
        return np.asarray((B - background[:, None] - offset).reshape(-1, truth.sensors, 3))


def run_bench(bench: Bench, progress: Progress | None = None) -> BenchResult:
    """Runs the bench: each source alone, where it has a size, then all of them. Raises SolverError."""
    simulation = Simulation(bench, progress)
    flow = FlowLaw.of(bench.case)
    rows, by_magnitude, roundness = [], [], []
    for source in SOURCES:
        if source not in ("none", "all") and not simulation.errors(source)["any"]:
            continue
        read = simulation.readings(source)
        sensed = invert(simulation.response, read.change, simulation.noise)
        if not sensed.converged.all():
            raise SolverError("the least squares of the bench did not converge")
        linear = simulation.fit(read.change)
        rows.append((source, _errors(read, sensed.load, flow), _errors(read, linear, flow)))
    for m in range(len(simulation.magnitudes)):
        chosen = read.magnitude == m
        part = _Readings(*(values[chosen] for values in vars(read).values()))
        by_magnitude.append(_errors(part, sensed.load[chosen], flow))
        size = np.hypot(*sensed.load[chosen & (read.draw == 0)].T)
        roundness.append(float(size.max() / size.min()))
    first = read.draw == 0
    return BenchResult(rows, by_magnitude, read.truth[first], sensed.load[first], simulation.fit, roundness)


def _errors(read: _Readings, found: Array, flow: FlowLaw | None) -> BenchErrors:
    size, true = np.hypot(*found.T), np.hypot(*read.truth.T)
    speed = flow.velocity(size) - flow.velocity(true) if flow else np.zeros(len(size))
    angle = wrapped(np.arctan2(found[:, 1], found[:, 0]) - np.arctan2(read.truth[:, 1], read.truth[:, 0]))

    def rms(values: Array) -> float:
        return float(np.sqrt((values**2).mean()))

    draws = int(read.draw.max()) + 1
    interval, azimuth_rms = 0.0, rms(angle)
    if draws > 1 and azimuth_rms > 0:
        # d sqrt(x) = dx/(2 sqrt(x)) with dx of the mean square x.
        squares = np.bincount(read.draw, angle**2) / np.bincount(read.draw)
        error = squares.std(ddof=1) / math.sqrt(draws)
        interval = float(special.stdtrit(draws - 1, 0.975)) * error / (2 * azimuth_rms)
    return BenchErrors(
        rms(size / true - 1), rms(speed), azimuth_rms, float(interval), float(np.abs(angle).max()),
        float((np.abs(angle) < math.radians(10)).mean()), len(size),
    )  # fmt: skip


def bench_text(bench: Bench, result: BenchResult, width: int) -> str:
    """Tables for people."""
    velocity = bench.case._core.stated("velocity")
    text = (
        f"{bench.title}\n{bench.case.name}: {len(bench.case.loads)} loads at {bench.azimuths} azimuths, {bench.draws} "
        f"sensors; read by {bench.truth}, inverted by {bench.models}\nStated errors (standard deviations): noise "
        f"{bench.noise * 1e6:.3g} uT, digits of {bench.quantum * 1e6:.3g} uT, sensor position "
        f"{bench.sensor_position * 1e3:.3g} mm, stage {math.degrees(bench.stage_azimuth):.3g} deg; ambient field "
        f"{float(np.linalg.norm(bench.ambient)) * 1e6:.3g} uT, measured at each azimuth\n\n"
    )
    rows = [["error alone", "found by", "load %", *(["v m/s"] if velocity else []), "dir deg", "largest", "<10 deg%"]]

    def add(label: str, method: str, e: BenchErrors) -> None:
        rows.append(
            [label, method, f"{100 * e.magnitude_rms:.2f}", *([f"{e.speed_rms:.4f}"] if velocity else []),
             f"{math.degrees(e.azimuth_rms):.2f}", f"{math.degrees(e.azimuth_largest):.2f}",
             f"{100 * e.below_ten_degrees:.1f}"]
        )  # fmt: skip

    for source, inversion, linear in result.rows:
        add(source, "full inversion", inversion)
        add("", "linear fit of dB (paper)", linear)
    labels = [f"{v:g} m/s" for v in velocity]
    if not labels:
        unit, size = shown(bench.case.loads[0].unit)
        labels = [f"{load.magnitude / size:g} {unit}" for load in bench.case.loads]
    for label, errors in zip(labels, result.by_magnitude):
        add(f"all at {label}", "full inversion", errors)
    squared = ", ".join(f"{value:.4f}" for value in result.fit.r_squared)
    round_ = ", ".join(f"{value:.3f}" for value in result.roundness)
    return (
        text
        + _core.text_table(rows, "<<>", width)
        + "\nRoot mean squares of (found - true)/true load, speed and direction; largest error of direction; part of "
        f"the readings within 10 deg.\ndB is linear in the load but for {100 * result.fit.misfit:.2g} % over the range: "
        f"R^2 of dB_x, dB_y, dB_z {squared}.\nRoundness, largest over smallest load found over the azimuths by the "
        f"first sensor: {round_}."
    )


def bench_json(bench: Bench, result: BenchResult, provenance: Mapping[str, Any]) -> dict[str, Any]:
    """docs/guide/sensing.md."""
    return {
        "schema": 1,
        "title": bench.title,
        "case": bench.case.name,
        "provenance": provenance,
        "unit": bench.case.loads[0].unit,
        "models": str(bench.models),
        "truth": str(bench.truth),
        "azimuths": bench.azimuths,
        "draws": bench.draws,
        "seed": bench.seed,
        "errors": {key: getattr(bench, key) for key in _ERRORS} | {"ambient": bench.ambient.tolist()},
        "linear_misfit": result.fit.misfit,
        "r_squared": result.fit.r_squared.tolist(),
        "sources": [
            {"source": source, "inversion": vars(inversion), "linear_fit": vars(linear)}
            for source, inversion, linear in result.rows
        ],
        "by_magnitude": [
            vars(errors) | {"magnitude": load.magnitude, "roundness": roundness}
            for errors, load, roundness in zip(result.by_magnitude, bench.case.loads, result.roundness)
        ],
        "first_draw": [
            {"truth": truth, "found": found} for truth, found in zip(result.truth.tolist(), result.found.tolist())
        ],
    }
