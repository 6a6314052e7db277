# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers of a touch fitted to readings, and how far each may go: docs/theory/sensing.md#unknowns."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..model import Case
from .inversion import TWO_SIDED_95, Chips, Whitening
from .loads import FlowLaw
from .response import Pair

_STEP = 1e-4  # of the differences, in the coordinates of Number
_STRAIGHT = 0.05  # what an ellipse's ends may be off
_CLOSE = 0.01  # what a profile's ends are
_SINGULAR = 1e-6  # of the singular values of J, below which they are errors of the differences
_GAIN, _GAIN_OF_PROFILE = 1e-7, 1e-4  # of chi squared by a step, at which a fit ends
_MOST_ITERATIONS, _MOST_STEPS = 60, 12
_MOST_OF_PROFILE = 20  # iterations, many of which are needed along the edge alone, where sides are open
_EDGE = 1e-3  # of the largest load: how far below it slopes are taken, and what lies beyond is a deviation

Quantity = Callable[[Array], float]
"""A number that is looked for, of the row of Touch.names at a reading."""


@dataclass(frozen=True)
class Number:
    """A number of the load, within `least` and `most`; the fit's coordinate is x, value = scale sinh(x): the
    logarithm but near zero, or the number itself where the scale is 0. deviation: of what is known of it before,
    about what the case states. is_natural: a touch cannot lie beyond `most`."""

    name: str
    stated: float
    least: float
    most: float
    scale: float = 0.0
    deviation: float = math.inf
    is_natural: bool = False

    def value(self, x: float) -> float:
        return self.scale * math.sinh(x) if self.scale else x

    def x(self, value: float) -> float:
        return math.asinh(value / self.scale) if self.scale else value


class Side(NamedTuple):
    """An end of an interval. by: "ellipse" of the linear fit, which chi squared confirms there; "profile" of chi
    squared; "open": the readings do not determine it, and `value` is where the touch itself ends, or infinite."""

    value: float
    by: str


class Seen(NamedTuple):
    """B, or a residual of it, and the quantities of Touch.names. beyond: what the load has above the largest that an
    equilibrium bears, over that; 0 below it."""

    values: Array
    quantities: Array
    beyond: Any  # a number, or one for each reading


class Touch:
    """The case's first load with other numbers, as the sensors of a rod read it.

    names: of the quantities that at() gives: the magnitude of the load by its name, azimuth, height, friction, and of
    a contact or a probe force, base_moment and displacement. Raises InputError, SolverError.
    """

    def __init__(self, case: Case, pair: Pair, magnitude: str, with_offset: bool):
        self.case, self._pair, self._load = case, pair, case.loads[0]
        if _core.has_body(pair.mechanics, pair.field)[0]:
            raise InputError(f"unknowns are found by a rod, `elastica` or `beam`, not by `{pair.mechanics}`")
        self.flow = FlowLaw.of(case) if magnitude == "speed" else None
        self.is_contact = self._load.type in ("contact", "probe")
        beside = ["height", "friction", "force", "base_moment", "displacement"] if self.is_contact else []
        self.names = list(dict.fromkeys([magnitude, "azimuth", *beside]))
        self._touch: dict[str, Any] = {"at": "axis", "radius": 0.0, **self._load.parameters.get("touch", {})}
        straight = self._bent(self._load.changed(magnitude=0.0)).straight
        self._offset = np.zeros((len(case.sensors), 3)) if with_offset else self._field(straight)
        if self.is_contact:
            self._moments = self._base_moments()

    def stated(self, name: str) -> float:
        """A number of the load as the case has it."""
        if name == "magnitude":
            return self._load.magnitude
        return float(self._touch.get(name, self._load.parameters.get(name, 0.0)))

    def at(self, values: Mapping[str, float]) -> Seen:
        """dB, or B, of the sensors in the case's directions, (s, 3), T; NaN where there is no equilibrium. Each load is
        a touch of its own: a path of several might slide back.

        Beyond the load that slips off both are continued linearly: a fit is led back, and has no wall to get stuck at.
        """
        given = dict(values)
        friction = given.pop("friction", None)
        load = self._load.changed(**given, **({} if friction is None else {"touch": {"friction": friction}}))
        shape = self._bent(load)
        if shape.has_shape:
            return self._seen(shape, values, 0.0)
        nothing = Seen(np.full(self._offset.shape, np.nan), np.full(len(self.names), np.nan), math.nan)
        if shape.slip_off is None or not shape.slip_off < load.magnitude * (1 + 1e-6):
            return nothing
        most = shape.slip_off * (1 - 1e-6) - (shape.slip_off_uncertainty or 0.0)
        sizes = [most * (1 - _EDGE), most]
        edge = [self._bent(load.changed(magnitude=size)) for size in sizes]
        if not all(bent.has_shape for bent in edge):
            return nothing
        a, b = (self._seen(bent, {**values, "magnitude": size}, 0.0) for bent, size in zip(edge, sizes))
        part, beyond = (load.magnitude - most) / (most * _EDGE), load.magnitude / most - 1
        B, q = b.values + part * (b.values - a.values), b.quantities + part * (b.quantities - a.quantities)
        return Seen(B, q, beyond)

    def _bent(self, load: _core.Load) -> _core.Shape:
        return _core.bend_case(self.case._core, [load], self._pair.mechanics, None)[0]

    def _seen(self, shape: _core.Shape, values: Mapping[str, float], beyond: float) -> Seen:
        found = {name: values.get(name, self.stated(name)) for name in ("magnitude", "azimuth", "height", "friction")}
        size = found["magnitude"]
        found[self.names[0]] = float(self.flow.velocity([size])[0]) if self.flow else size
        if self.is_contact:
            curvature = float(shape.curvature[0])
            found["base_moment"] = curvature * float(np.interp(curvature**2, *self._moments))
            found["displacement"] = self._displacement(shape, found["azimuth"], found["height"])
            found["force"] = shape.applied_force
        return Seen(self._field(shape) - self._offset, np.array([found[name] for name in self.names]), beyond)

    def _field(self, shape: _core.Shape) -> Array:
        return np.asarray(_core.fields([shape], self.case.sensors, self._pair.field)[0])

    def _base_moments(self) -> tuple[Array, Array]:
        """Squares of the base's curvature and moment over curvature: a horizontal force F on the axis at h makes the
        moment F h. Corrected joints soften with the square of the load."""
        height, found = self.stated("height"), []
        size = self.case.cilium.segments[0].young_modulus * self.case.cilium.diameter**2
        for force in size * 2.0 ** np.arange(-24, 0):
            shape = self._bent(_core.Load("contact", force=force, height=height))
            if not shape.has_shape:
                break
            curvature = float(shape.curvature[0])
            found.append((curvature**2, force * height / curvature))
        if len(found) < 2:
            raise SolverError(f"{self._pair.mechanics}: {shape.message}")
        squares, stiffness = np.array(found).T
        onwards = stiffness[-1] + 3 * squares[-1] * np.gradient(stiffness, squares)[-1]
        return np.append(squares, 4 * squares[-1]), np.append(stiffness, onwards)

    def _displacement(self, shape: _core.Shape, azimuth: float, height: float) -> float:
        """Displacement of the pin since it first touched, m: w + (R + r)(1 - cos theta) where z + (R + r) sin theta = h
        (docs/theory/touch.md)."""
        reach = self._touch["radius"] + (self.case.cilium.diameter / 2 if self._touch["at"] == "mantle" else 0.0)
        line, theta = shape.centreline, shape.theta
        w = line[:, :2] @ [math.cos(azimuth), math.sin(azimuth)] + reach * (1 - np.cos(theta))
        level = line[:, 2] + reach * np.sin(theta)
        above = int(np.argmax(level >= height)) or len(level) - 1
        return float(np.interp(height, level[above - 1 : above + 1], w[above - 1 : above + 1]))


class Fit:
    """Numbers fitted to the readings of one touch: least squares by Levenberg and Marquardt's method, weighted by the
    noise and by what is known before. Of each reading its own magnitude, of all together the others.

    read: (n, s, 3), T, in the case's directions; whitened: of all n s sensors in a row. fixed: numbers that are
    not fitted. start: of the coordinates. Raises SolverError.

    x: (k,), the coordinates found. chi_squared. J: (m, k), derivative of the whitened residual. rows: (n, q), the
    quantities of Touch at x.
    """

    def __init__(
        self, touch: Touch, numbers: Sequence[Number], read: Array, whitened: Whitening, fixed: Mapping[str, float],
        start: Array,
    ):
        self._touch, self._read, self._whitened, self._fixed = touch, read, whitened, dict(fixed)
        self._within: list[Array] = []  # quantities at points of profiles
        self._of_rows = [n for n in numbers if n.name == "magnitude"] * len(read)
        self.numbers = [*self._of_rows, *(n for n in numbers if n.name not in ("magnitude", *fixed))]
        self._least = np.array([n.x(n.least) for n in self.numbers])
        self._most = np.array([n.x(n.most) for n in self.numbers])
        self._set(self._solve(np.asarray(start, dtype=float)))
        for _ in range(_MOST_STEPS):
            if not any(high.beyond.any() for _, high, _ in self._nearby):
                break
            # A fit that has met the edge follows it: it goes on from within, along the least known direction.
            values, vectors = np.linalg.eigh(self._covariance)
            x, chi_squared = self.x, self.chi_squared
            self._set(self._solve(self._inwards(TWO_SIDED_95 * math.sqrt(values[-1]) * vectors[:, -1])))
            if self.chi_squared > chi_squared - _GAIN:
                self._set(x)
                break

    def _set(self, x: Array) -> None:
        """The coordinates found, and all that is known there."""
        self.x, here = x, self._at(x)
        self.rows, self.chi_squared = here.quantities, float(here.values @ here.values)
        self._nearby = self._differences(x)
        self.J = np.stack([(high.values - low.values) / width for low, high, width in self._nearby], axis=1)
        inverse = np.linalg.pinv(self.J, rcond=_SINGULAR)
        self._covariance, self._untold = inverse @ inverse.T, np.eye(len(x)) - inverse @ self.J

    def _inwards(self, step: Array) -> Array:
        """A part of a step from the coordinates found; where that is beyond the edge, back."""
        ends = [np.clip(self.x + part * step, self._least, self._most) for part in (0.25, -0.25)]
        return next((x for x in ends if not self._at(x).beyond.any()), self.x)

    def _at(self, x: Array) -> Seen:
        """Whitened residual, with that of what is known before, and quantities, (n, q)."""
        n, own = len(self._read), len(self._of_rows)
        values = [number.value(float(v)) for number, v in zip(self.numbers, x)]
        shared: dict[str, float] = self._fixed | {a.name: v for a, v in zip(self.numbers[own:], values[own:])}
        each = [self._touch.at(shared | ({"magnitude": values[i]} if own else {})) for i in range(n)]
        off = np.stack([seen.values for seen in each]) - self._read
        known = [(v - a.stated) / a.deviation for a, v in zip(self.numbers, values) if a.deviation < math.inf]
        residual = np.concatenate([self._whitened(off.reshape(1, -1, 3))[0], known])
        return Seen(residual, np.stack([seen.quantities for seen in each]), np.array([seen.beyond for seen in each]))

    def _differences(self, x: Array) -> list[tuple[Seen, Seen, float]]:
        """Residuals and quantities below and above x in each coordinate, and their distance."""
        result = []
        for k, step in enumerate(_STEP * np.eye(len(x))):
            low, high = np.maximum(x - step, self._least), np.minimum(x + step, self._most)
            result.append((self._at(low), self._at(high), float(high[k] - low[k])))
        return result

    def _solve(self, x: Array, pull: Callable[[Array], float] | None = None) -> Array:
        """The coordinates of least squares from x; with a pull, whose square counts, too."""

        def residual(seen: Seen) -> Array:
            pulled = [] if pull is None else [pull(seen.quantities)]
            return np.concatenate([seen.values, seen.beyond / _EDGE, pulled])

        x = np.clip(x, self._least, self._most)
        r, damping = residual(self._at(x)), 1e-6
        if not np.isfinite(r).all():
            raise SolverError("there is no equilibrium near what the readings ask for")
        for _ in range(_MOST_ITERATIONS if pull is None else _MOST_OF_PROFILE):
            steps = np.where(x + _STEP > self._most, -_STEP, _STEP)
            J = np.stack([(residual(self._at(x + h)) - r) / h.sum() for h in np.diag(steps)], axis=1)
            if not np.isfinite(J).all():
                raise SolverError("there is no equilibrium near what the readings ask for")
            A, g = J.T @ J, J.T @ r
            free = ~(((x <= self._least) & (g > 0)) | ((x >= self._most) & (g < 0)))
            scale = np.diag(np.maximum(np.diag(A), 1e-12 * np.trace(A) + 1e-300))
            for _ in range(_MOST_STEPS):
                step = np.zeros(len(x))
                step[free] = -np.linalg.solve((A + damping * scale)[np.ix_(free, free)], g[free])
                tried = np.clip(x + step, self._least, self._most)
                r_new = residual(self._at(tried))
                gain = float(r @ r - r_new @ r_new)
                if gain >= 0:  # not of NaN
                    break
                damping *= 10
            else:
                return x
            x, r, damping = tried, r_new, damping / 10
            if gain < (_GAIN if pull is None else _GAIN_OF_PROFILE):
                break
        return x

    def gradient(self, of: Quantity, row: int) -> Array:
        """Derivative of a quantity by the coordinates, (k,)."""
        return np.array(
            [(of(high.quantities[row]) - of(low.quantities[row])) / width for low, high, width in self._nearby]
        )

    def covariances(self, of: Sequence[Quantity], row: int) -> Array:
        """Covariance of quantities by the linear fit; infinite where the readings tell nothing."""
        G = np.stack([self.gradient(g, row) for g in of])
        C = G @ self._covariance @ G.T
        untold = np.linalg.norm(G @ self._untold, axis=1) > _SINGULAR * np.linalg.norm(G, axis=1)
        C[untold], C[:, untold] = math.inf, math.inf
        return np.asarray(C)

    def interval(self, of: Quantity, row: int, span: float = math.inf) -> tuple[Side, Side]:
        """Both ends of the interval of 95 % of a quantity: where the least chi squared with the quantity there is
        3.84 above the least of all. They are the ellipse's where chi squared confirms those to 5 %. span: as far as a
        side goes at most."""
        deviation = math.sqrt(max(0.0, float(self.covariances([of], row)[0, 0])))
        best = of(self.rows[row])
        step = np.zeros(len(self.x))
        if 0 < deviation < math.inf:
            step = TWO_SIDED_95 / deviation * (self._covariance @ self.gradient(of, row))
        if 0 < TWO_SIDED_95 * deviation < span and deviation < math.inf:
            ends = [self.x - step, self.x + step]
            if all((self._least <= end).all() and (end <= self._most).all() for end in ends):
                at = [self._at(end) for end in ends]
                sides = np.array([of(seen.quantities[row]) for seen in at])
                up = np.array([self._root(seen) for seen in at]) / TWO_SIDED_95
                even = np.abs(sides - best) / (np.ptp(sides) / 2 or math.nan)
                straight = np.abs(np.concatenate([up, even]) - 1) <= _STRAIGHT
                if straight.all() and not any(seen.beyond.any() for seen in at):
                    return Side(float(sides.min()), "ellipse"), Side(float(sides.max()), "ellipse")
        width = min(span, TWO_SIDED_95 * deviation if 0 < deviation < math.inf else abs(best) or 1.0)
        low, high = self._end(of, row, -width, span, -step), self._end(of, row, width, span, step)
        # Points of other profiles that chi squared allows lie within, where a fit in a narrow valley has ended early.
        known = [of(quantities[row]) for quantities in self._within]
        return low._replace(value=min([low.value, *known])), high._replace(value=max([high.value, *known]))

    def _root(self, seen: Seen) -> float:
        """Root of the rise of chi squared."""
        return math.sqrt(max(0.0, float(seen.values @ seen.values) - self.chi_squared))

    def _end(self, of: Quantity, row: int, width: float, span: float, step: Array) -> Side:
        """The end of the profile on one side, `width` or so from the least; step: of the coordinates, to it.

        What minimises chi^2 + ((g - target)/w)^2 has the least chi^2 of all with its own g, whatever w is: each
        solution is a point of the profile, and the target only moves along it.
        """
        start = self._inwards(step)
        best, distance, x = of(self.rows[row]), width, start
        below, above = (0.0, 0.0), (math.inf, math.inf)  # root of the rise of chi squared, and distance
        for _ in range(_MOST_STEPS):
            target, soft = best + distance, max(abs(distance) / 20, 1e-9 * abs(width))
            x = self._solve(x, lambda rows: (of(rows[row]) - target) / soft)
            there = self._at(x)
            rise, gone = self._root(there), of(there.quantities[row]) - best
            if rise < TWO_SIDED_95 and not there.beyond.any():
                self._within.append(there.quantities)
            if abs(rise / TWO_SIDED_95 - 1) < _CLOSE:
                return Side(best + gone * TWO_SIDED_95 / rise, "profile")
            if rise < TWO_SIDED_95 and (abs(gone) < 0.8 * abs(distance) or abs(distance) >= span):
                at_limit = (x > self._most - 1e-3) & np.array([not n.is_natural for n in self.numbers])
                end = span if span < math.inf else math.inf if at_limit.any() else abs(gone)
                return Side(best + math.copysign(end, width), "open")
            x = x if rise < 3 * TWO_SIDED_95 else start
            short = distance / gone if gone / (distance or 1.0) > 0.5 else 1.0
            if rise < TWO_SIDED_95:
                below = (rise, gone)
            else:
                above = (rise, gone)
            if above[0] < math.inf:
                distance = below[1] + (TWO_SIDED_95 - below[0]) / (above[0] - below[0]) * (above[1] - below[1])
            else:
                distance = gone * min(3.0, 1.05 * TWO_SIDED_95 / max(rise, 1e-3))
            distance = math.copysign(min(span, abs(distance * short)), width)
        return Side(best + distance, "profile")
