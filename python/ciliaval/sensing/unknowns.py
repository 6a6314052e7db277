# SPDX-License-Identifier: LGPL-2.1-or-later
"""A touch by its readings, where its force, azimuth, height or friction are not known: docs/guide/sensing.md."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize, special

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..model import Case
from ..units import in_words, number, shown
from .calibration import TOGETHER, known
from .inversion import TWO_SIDED_95, UNLIKELY, Chips, Whitening, wrapped
from .left_out import with_joints
from .readings import Readings
from .response import Pair, Progress, require_load_to_sense
from .touch_fit import Fit, Number, Quantity, Side, Touch

Prior = float | str | tuple[float | str, float | str]
"""A standard deviation about the case's value, or the ends of a uniform range; SI units, or texts with a unit."""

_TYPES = {"force": ("contact", "section"), "displacement": ("probe",), "speed": ("flow",)}  # whose magnitude it is
_SHARED = ("friction", "height", "azimuth")  # by the readings of one touch; the first is given up first
UNKNOWNS = (*_TYPES, *reversed(_SHARED))
_UNITS = {"force": "N", "displacement": "m", "speed": "m/s", "azimuth": "rad", "height": "m", "base_moment": "N m"}
_MOST_FRICTION = 2.0
_NODES = 4  # of a range: Gauss and Legendre's, between which results are interpolated
_DRAWS = 2048  # places of the ranges, about


@dataclass(frozen=True)
class Known:
    """A quantity with its interval of 95 %. words: its name, or the combination that it is."""

    words: str
    unit: str
    value: float
    low: Side
    high: Side

    @property
    def is_open(self) -> bool:
        return "open" in (self.low.by, self.high.by)

    @property
    def by(self) -> str:
        """How the interval was seen: open, profile or ellipse."""
        return next(by for by in ("open", "profile", "ellipse") if by in (self.low.by, self.high.by))

    def text(self, is_unknown: bool) -> str:
        """ "force = 2.003 ± 0.012 mN"; of an unknown that is open to one side "height > 9.1 mm"."""
        unit, size = shown(self.unit)
        ends = [-math.inf if is_unknown and self.low.by == "open" else self.low.value,
                math.inf if is_unknown and self.high.by == "open" else self.high.value]  # fmt: skip
        v, low, high = (x / size for x in (self.value, *ends))
        if math.isinf(low) and math.isinf(high):
            return f"{self.words}: not determined"
        width = (high - low) / 2 if math.isfinite(high - low) else abs(v - (low if math.isfinite(low) else high))
        decimals = max(0, 1 - math.floor(math.log10(width))) if width > 0 else 4
        value, least, most, half = (f"{x:.{decimals}f}".replace("-", "−") for x in (v, low, high, width))
        if math.isinf(low):
            text = f"< {most}"
        elif math.isinf(high):
            text = f"> {least}"
        else:
            text = f"= {value} ± {half}" if abs(high - v - width) < 0.1 * width else f"= {value} ({least} to {most})"
        return f"{self.words} {text}{'' if unit in ('', '°') else ' '}{unit}"


@dataclass(frozen=True)
class _Combination:
    """A number that readings determine, made of numbers that they do not tell apart."""

    words: str
    unit: str
    of: Quantity
    names: tuple[str, ...]


def sense_unknowns(
    case: Case, readings: Readings, pair: Pair, noise: float, largest: float, unknowns: Sequence[str],
    priors: Mapping[str, Prior] | None = None, touches: Sequence[Hashable] | None = None,
    progress: Progress | None = None, joints: str = "corrected",
) -> Any:
    """A pandas.DataFrame with a row for each reading: see sense(). noise, T. largest: of the load's magnitude, as its
    type has it. Raises InputError, SolverError."""
    import pandas

    require_load_to_sense(case)
    names = [n.strip() for n in unknowns.split(",")] if isinstance(unknowns, str) else list(unknowns)
    magnitude = _require_unknowns(case, names)
    case, fault = with_joints(case, pair.mechanics, joints)
    touch = Touch(case, pair, magnitude, with_offset=not readings.measured_offset)
    numbers, ranges = _numbers(touch, names, dict(priors or {}), largest)
    sought = {n.name for n in numbers if n.deviation == math.inf}
    _require_stated(case, [name for name in ("magnitude", *_SHARED) if name not in {*sought, *ranges}])
    labels: list[Hashable] = list(range(len(readings.names)) if touches is None else touches)
    if len(labels) != len(readings.names):
        raise InputError(f"`touches` has {len(labels)} labels for {len(readings.names)} readings")
    sensing = _Sensing(touch, names, numbers, ranges, readings, noise, largest)
    rows: list[dict[str, Any]] = [{} for _ in labels]
    for i, label in enumerate(dict.fromkeys(labels)):
        if progress:
            progress(f"sense: touch {i + 1}")
        group = [k for k, other in enumerate(labels) if other == label]
        try:
            each = sensing.of(group)
        except SolverError as error:
            each = [{"status": "failed", "knowledge": str(error)} for _ in group]
        for k, found in zip(group, each):
            rows[k] = {"sample": readings.names[k], **found}
    frame = pandas.DataFrame(rows)
    if readings.time is not None:
        frame["time"] = readings.time
    remarks = [*readings.remarks, "Intervals of 95 %, of the noise and the priors alone."]
    frame.attrs = {
        "case": case.name, "models": str(pair), "noise": noise, "largest": largest, "unknowns": names,
        "remarks": remarks + ([f"Joints as the case states them: {fault}"] if fault else []),
    }  # fmt: skip
    return frame


def _require_unknowns(case: Case, names: Sequence[str]) -> str:
    """The name of the load's magnitude. Raises InputError for unknowns that the load does not have."""
    of = case.loads[0].type
    for name in names:
        if name not in UNKNOWNS:
            raise InputError(f"unknowns: there is no `{name}`; there are: {', '.join(UNKNOWNS)}")
    if not names:
        raise InputError(f"unknowns: name at least one of {', '.join(UNKNOWNS)}")
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise InputError(f"unknowns: {', '.join(twice)} stands there twice")
    if len(sizes := [name for name in names if name in _TYPES]) > 1:
        raise InputError(
            f"unknowns: {in_words(sizes)} are one unknown, the size of the load, of which each follows from the other: "
            "leave out all but one (beside the force of a touch stands its displacement)"
        )
    magnitude = next((name for name, types in _TYPES.items() if of in types), "")
    if not magnitude:
        known_types = ", ".join(itertools.chain(*_TYPES.values()))
        raise InputError(f"unknowns: a load of the type {known_types} has them, not `{of}`")
    for name in sizes:
        if name != magnitude:
            raise InputError(f"unknowns: a {of} is stated by its {magnitude}: take that in place of the {name}")
    if magnitude == "speed" and not case._core.stated("velocity"):
        raise InputError("unknowns: the flow has no speed: state its `velocity`")
    if "height" in names and of not in ("contact", "probe"):
        raise InputError(f"unknowns: a {of} has no height")
    if "friction" in names:
        _require_friction(case, "unknowns")
    return magnitude


def _require_friction(case: Case, what: str) -> None:
    if case.loads[0].parameters.get("touch", {}).get("law") != "coulomb":
        raise InputError(f'{what}: the load has no friction: state [load.touch] law = "coulomb"')


def _require_stated(case: Case, names: Sequence[str]) -> None:
    """Raises InputError unless the case has one value of each."""
    for name in names:
        values = {load.magnitude if name == "magnitude" else load.parameters.get(name) for load in case.loads}
        if len(values) > 1:
            what = "size of the load" if name == "magnitude" else name
            raise InputError(f"the {what} is no unknown and not the same in all load steps: state one")


def _numbers(
    touch: Touch, names: Sequence[str], priors: dict[str, Prior], largest: float
) -> tuple[list[Number], dict[str, tuple[float, float]]]:
    """The numbers that are fitted, and the ranges of the others. Raises InputError."""
    length, deviations, ranges = touch.case.cilium.length, {}, {}
    for name, prior in priors.items():
        if name not in _SHARED or (name == "height" and "height" not in touch.names):
            raise InputError(f"priors: there is no `{name}` of this load; there are: {', '.join(_SHARED)}")
        if name in names:
            raise InputError(f"priors: {name} is an unknown: it has no prior")
        if name == "friction":
            _require_friction(touch.case, "priors")
        ends = [_quantity(x, _UNITS.get(name, "")) for x in (prior if isinstance(prior, (tuple, list)) else [prior])]
        if len(ends) == 1 and 0 < ends[0] < math.inf:
            deviations[name] = ends[0]
        elif len(ends) == 2 and -math.inf < ends[0] < ends[1] < math.inf:
            ranges[name] = (ends[0], ends[1])
        else:
            raise InputError(f"priors: {name} has a positive standard deviation, or the ends of a range, not {prior}")
    limits = {
        "friction": (0.0, _MOST_FRICTION, 0.0, False),
        "height": (touch.stated("radius") + 1e-3 * length, length * (1 - 1e-9), 1e-2 * length, True),
        "azimuth": (-4 * math.pi, 4 * math.pi, 0.0, False),
    }
    for name, (low, high) in ranges.items():
        if low < limits[name][0] or high > limits[name][1]:
            raise InputError(f"priors: the range of the {name} has numbers that it cannot have: {low:g} to {high:g}")
    numbers = [Number("magnitude", 0.0, 0.0, largest, 1e-2 * largest)] if {*names} & {*_TYPES} else []
    for name, (least, most, scale, natural) in limits.items():
        if name in names or name in deviations:
            deviation = deviations.get(name, math.inf)
            numbers.append(Number(name, touch.stated(name), least, most, scale, deviation, natural))
    return numbers, ranges


def _quantity(value: float | str, unit: str) -> float:
    try:
        return _core.quantity(value, unit) if isinstance(value, str) else float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"priors: {value} is no number") from error


class _Sensing:
    """Readings, and the numbers that are looked for in them."""

    def __init__(
        self, touch: Touch, unknowns: Sequence[str], numbers: Sequence[Number],
        ranges: Mapping[str, tuple[float, float]], readings: Readings, noise: float, largest: float,
    ):
        self._touch, self._unknowns, self._numbers, self._readings = touch, unknowns, numbers, readings
        self._noise, self._largest, self._chips = noise, largest, Chips.of(touch.case)
        beside = ("force", "base_moment", "displacement") if touch.is_contact else ()
        self._names = list(dict.fromkeys([*unknowns, *beside]))
        self._middle = {name: (low + high) / 2 for name, (low, high) in ranges.items()}
        # The nodes of the ranges, and results at places all over them from those at the nodes.
        nodes, fine = special.roots_legendre(_NODES)[0], round(_DRAWS ** (1 / max(1, len(ranges))))
        nodes, places = nodes[:, None], (np.arange(fine)[:, None] + 0.5) / fine * 2 - 1
        one, at_nodes = (special.eval_legendre(np.arange(_NODES), x) for x in (places, nodes))
        self._spread = np.ones((1, 1))
        for _ in ranges:
            self._spread = np.kron(self._spread, one @ np.linalg.inv(at_nodes))
        each = [[low + (high - low) * (t + 1) / 2 for t in nodes.ravel()] for low, high in ranges.values()]
        self._nodes = [dict(zip(ranges, values)) for values in itertools.product(*each)]
        self._starts = self._grid()
        self._zero = touch.at({"magnitude": 0.0}).values
        self._finds_size = any(n.name == "magnitude" for n in numbers)

    def _grid(self) -> list[tuple[float, float, Array]]:
        """Magnitudes, azimuths and the chips' readings over all loads."""
        fitted = {n.name for n in self._numbers}
        sizes, turns = [self._largest * k / 8 for k in range(1, 9)], [math.pi * k / 8 for k in range(16)]
        if "magnitude" not in fitted:
            sizes = [self._touch.stated("magnitude")]
        if "azimuth" not in fitted:
            turns = [self._touch.stated("azimuth")]
        grid = []
        for size, azimuth in itertools.product(sizes, turns):
            seen = self._touch.at({**self._middle, "magnitude": size, "azimuth": azimuth})
            if seen.beyond == 0:
                grid.append((size, azimuth, self._chips.own(seen.values)))
        if not grid:
            raise SolverError("no load of the range has an equilibrium")
        return grid

    def _start(self, read: Array) -> Array:
        """The coordinates of the nearest load of the grid."""
        squares = np.array([[((own - one) ** 2).sum() for _, _, own in self._starts] for one in read])
        azimuths = np.array([azimuth for _, azimuth, _ in self._starts])
        by_azimuth = {a: np.where(azimuths == a, squares, np.inf) for a in dict.fromkeys(azimuths.tolist())}
        azimuth = min(by_azimuth, key=lambda a: float(by_azimuth[a].min(axis=1).sum()))
        sizes = [self._starts[i][0] for i in by_azimuth[azimuth].argmin(axis=1)]
        by_name = {n.name: n for n in self._numbers}
        magnitude = by_name.pop("magnitude", None)
        own = [magnitude.x(size) for size in sizes] if magnitude else []
        return np.array(own + [n.x(azimuth if n.name == "azimuth" else n.stated) for n in by_name.values()])

    def of(self, group: Sequence[int]) -> list[dict[str, Any]]:
        """The columns of each reading of a touch. Raises SolverError."""
        r, chips = self._readings, self._chips
        own = r.change[list(group)]
        n, s, _ = own.shape
        V = np.zeros((n, s, n, s))
        for i, k in enumerate(group):
            V[i, :, i] = np.eye(s) / r.rows[k] + (0 if r.background is None else r.background[k])
        V += r.offset_variance * np.eye(s)[None, :, None]  # the readings share the offset
        of_all = Chips(np.tile(chips.axes, (n, 1, 1)), np.tile(chips.reads, (n, 1)), np.tile(chips.gain, n))
        whitened = Whitening.of(V.reshape(1, n * s, n * s), np.full(3, self._noise), of_all)
        read = chips.in_case(own)

        def fit(fixed: Mapping[str, float], start: Array) -> Fit:
            return Fit(self._touch, self._numbers, read, whitened, fixed, start)

        middle = fit(self._middle, self._start(np.where(chips.reads, own, 0.0)))
        fits = [fit(fixed, middle.x) for fixed in self._nodes] if self._middle else [middle]
        chi_squared = min(f.chi_squared for f in fits)
        freedom = int(chips.reads.sum()) * n + sum(x.deviation < math.inf for x in middle.numbers)
        freedom -= np.linalg.matrix_rank(middle.J)
        misfit = float(special.chdtrc(freedom, chi_squared)) if freedom > 0 else 1.0
        without = whitened((self._zero - read).reshape(1, -1, 3))[0]
        is_seen = special.chdtrc(2, max(0.0, float(without @ without) - chi_squared)) < 0.05
        same: dict[str, Any] = {"chi_squared": chi_squared, "misfit_probability": misfit}
        if misfit < UNLIKELY:
            same["status"] = "misfit"
        elif self._finds_size and not is_seen:
            same |= {"status": "nothing", "knowledge": "no load is seen"}
        return [self._row(fits, middle, row) | same for row in range(n)]

    def _row(self, fits: Sequence[Fit], middle: Fit, row: int) -> dict[str, Any]:
        """The columns of one reading, but for those that its touch shares."""
        weights = self._weights(fits)
        of = {name: self._quantity(name) for name in self._names}
        found = {
            name: self._known(fits, weights, name.replace("_", " "), _UNITS.get(name, ""), of[name], row)
            for name in self._names
        }
        combinations = self._combinations(middle, row)
        together = [self._known(fits, weights, c.words, c.unit, c.of, row) for c in combinations]
        is_open = {name for name in self._unknowns if found[name].is_open}
        words = [found[name].text(name in self._unknowns) for name in self._names]
        for combination, each in zip(combinations, together):
            apart = f"{in_words(combination.names)} apart"
            known_apart = "not determined by" if is_open & {*combination.names} else "known far less well from"
            words += [each.text(False), f"{apart}: {known_apart} {self._source(len(middle.rows))}"]
        columns: dict[str, Any] = {"status": "not determined" if is_open else "found"}
        for name, k in found.items():
            value = float(wrapped(np.array(k.value))) if name == "azimuth" else k.value
            columns |= {name: value, f"{name}_low": k.low.value - k.value + value,
                        f"{name}_high": k.high.value - k.value + value, f"{name}_by": k.by}  # fmt: skip
        covariance = self._covariance(fits, weights, [of[name] for name in self._unknowns], row)
        return columns | {"covariance": covariance, "knowledge": "; ".join(words)}

    def _source(self, rows: int) -> str:
        if rows > 1:
            return "these readings"
        return "this sensor" if len(self._touch.case.sensors) == 1 else "these sensors"

    def _quantity(self, name: str) -> Quantity:
        index = self._touch.names.index(name)
        return lambda row: float(row[index])

    def _weights(self, fits: Sequence[Fit]) -> Array:
        """Weights of the places in the ranges: the likelihoods of their best fits."""
        chi_squared = self._spread @ [f.chi_squared for f in fits]
        weights = np.exp(-(chi_squared - chi_squared.min()) / 2)
        return np.asarray(weights / weights.sum())

    def _known(self, fits: Sequence[Fit], weights: Array, words: str, unit: str, of: Quantity, row: int) -> Known:
        """A quantity over the ranges: at each place it has a normal distribution, with the widths of its interval on
        either side."""
        values = [of(f.rows[row]) for f in fits]
        each = [f.interval(of, row, math.pi if words == "azimuth" else math.inf) for f in fits]
        if len(each) == 1:
            return Known(words, unit, values[0], *each[0])
        of_nodes = np.array([(v, v - low.value, high.value - v) for v, (low, high) in zip(values, each)]).T
        is_known = np.isfinite(of_nodes).all(axis=1)
        value = self._spread @ of_nodes[0]
        below, above = (  # a side that is not known has the other's width: it counts in the other end alone
            np.maximum(self._spread @ of_nodes[k if is_known[k] else 3 - k], 1e-300) / TWO_SIDED_95 for k in (1, 2)
        )

        def end(k: int, probability: float) -> Side:
            by = next(by for by in ("open", "profile", "ellipse") if by in {sides[k - 1].by for sides in each})
            if not is_known[k]:
                return Side(math.copysign(math.inf, probability - 0.5), by)

            def excess(g: float) -> float:
                return float(weights @ special.ndtr((g - value) / np.where(g < value, below, above))) - probability

            return Side(float(optimize.brentq(excess, (value - 4 * below).min(), (value + 4 * above).max())), by)

        return Known(words, unit, float(weights @ value), end(1, 0.025), end(2, 0.975))

    def _covariance(self, fits: Sequence[Fit], weights: Array, of: Sequence[Quantity], row: int) -> Array:
        """(u, u), of the unknowns; infinite where the readings tell nothing."""
        within = np.stack([f.covariances(of, row) for f in fits])
        values = self._spread @ np.array([[g(f.rows[row]) for g in of] for f in fits])
        off = values - weights @ values
        total = np.tensordot(weights @ self._spread, np.where(np.isfinite(within), within, 0.0), axes=1)
        return np.where(np.isfinite(within).all(axis=0), total + (weights * off.T) @ off, np.inf)

    def _combinations(self, fit: Fit, row: int) -> list[_Combination]:
        """The combinations that a reading determines of unknowns that it does not tell apart, or far less well.

        Some, `free`, are given up until the others are known well with these fixed; each of the others then follows
        them along the valley of chi squared, d(others)/d(free) = T.
        """
        is_chosen = [k == row if n.name == "magnitude" else n.name in self._unknowns for k, n in enumerate(fit.numbers)]
        chosen = np.flatnonzero(is_chosen).tolist()
        size = next((name for name in self._unknowns if name in _TYPES), "")
        names = [size if fit.numbers[k].name == "magnitude" else fit.numbers[k].name for k in chosen]
        others = np.delete(fit.J, chosen, axis=1)
        J = fit.J[:, chosen] - others @ np.linalg.pinv(others) @ fit.J[:, chosen]
        J = J / [fit.gradient(self._quantity(name), row)[k] for k, name in zip(chosen, names)]
        rest, order = list(range(len(names))), [*_SHARED, size]
        free: list[int] = []
        while groups := known(J[:, rest], [names[i] for i in rest], 1 - TOGETHER)[2]:
            together_names = {*itertools.chain(*groups)}
            given_up = min((i for i in rest if names[i] in together_names), key=lambda i: order.index(names[i]))
            rest.remove(given_up)
            free.append(given_up)
        if not free or not rest:
            return []
        apart = known(J, names)[0][rest]
        inverse = np.linalg.pinv(J[:, rest])
        together, T = np.linalg.norm(inverse, axis=1), -inverse @ J[:, free]
        return [
            self._combination(fit, row, names[i], [names[j] for j in free], T[k])
            for k, i in enumerate(rest)
            if apart[k] > 2 * together[k]
        ]

    def _combination(self, fit: Fit, row: int, name: str, free: list[str], T: Array) -> _Combination:
        """The combination that stays where `name` follows the free numbers."""
        one, more = self._quantity(name), [self._quantity(other) for other in free]
        unit, size = shown(_UNITS.get(name, ""))
        if name == "force" and free == ["height"]:
            # Along the valley dF/dh = -F/(h - c).
            arm = float(more[0](fit.rows[row]) + one(fit.rows[row]) / T[0])
            words = f"force × (height {'−' if arm >= 0 else '+'} {number(abs(arm), 1e-3, 2)} mm)"
            return _Combination(words, "N m", lambda row: one(row) * (more[0](row) - arm), (name, *free))
        words = name
        for other, slope in zip(free, T):
            its, its_size = shown(_UNITS.get(other, ""))
            per = f"{unit}/{its}" if its else unit
            words += f" {'−' if slope >= 0 else '+'} {number(abs(slope) * its_size / size, 1.0, 3)} {per} × {other}"

        def stays(row: Array) -> float:
            return one(row) - sum(float(slope) * other(row) for slope, other in zip(T, more))

        return _Combination(words, _UNITS.get(name, ""), stays, (name, *free))
