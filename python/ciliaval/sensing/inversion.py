# SPDX-License-Identifier: LGPL-2.1-or-later
"""The load of each reading by least squares, with what the noise makes of it: docs/guide/sensing.md."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import special
from scipy.spatial.transform import Rotation

from ..arrays import Array
from ..errors import InputError
from ..model import Case
from .left_out import LeftOut
from .response import Response

TWO_SIDED_95 = float(special.ndtri(0.975))
UNLIKELY = 1e-3
"""Probability below which a reading is no matter of chance."""
_COMPONENTS = 2  # of a load
_SHIFTS = 4  # steps to the load that better models would have found
_MOST_STEPS = 200
_CHUNK = 10_000  # readings at once: what they need stays in the cache

STATUSES = ("found", "nothing", "ambiguous", "beyond range", "misfit", "failed")


@dataclass(frozen=True)
class SensedLoads:
    """The loads found from n readings.

    load: (n, 2), magnitude times direction. covariance: (n, 2, 2) of it, (J^T V^-1 J)^-1, by the noise.
    chi_squared: (n,), (dB - reading)^T V^-1 (dB - reading), whose degrees of freedom are the components that are
    read less 2. model_covariance, input_covariance: (n, 2, 2), of the load, by what the models leave out and by the
    case's [[input_uncertainty]].
    misfit_probability: of a larger one by noise, inputs and what the models leave out. nothing_probability: of a larger
    chi_squared(0) - chi_squared by noise alone, without a load. is_beyond: the load is larger than the
    largest computed. is_ambiguous: another load explains the reading as well, within chi squared of 3.84; it is
    looked for where a chip does not read all components. converged: (n,).
    """

    load: Array
    covariance: Array
    chi_squared: Array
    misfit_probability: Array
    nothing_probability: Array
    is_beyond: Array
    converged: Array
    model_covariance: Array
    input_covariance: Array
    is_ambiguous: Array

    @property
    def magnitude(self) -> Array:
        return np.asarray(np.hypot(*self.load.T))

    @property
    def azimuth(self) -> Array:
        """rad, (-pi, pi]."""
        return np.arctan2(self.load[:, 1], self.load[:, 0])

    @property
    def is_nothing(self) -> Array:
        """No load is seen: the region of 95 % of the load, chi squared of two degrees of freedom, holds zero."""
        return ~(self.nothing_probability < 0.05)

    @property
    def total_covariance(self) -> Array:
        """Covariance by the noise, the effects that the models leave out and the inputs, (n, 2, 2)."""
        return self.covariance + self.model_covariance + self.input_covariance

    @property
    def magnitude_interval(self) -> Array:
        """Half-widths of the intervals that hold the magnitude with 95 %, of all errors, to first order; where no load
        is seen they hold zero too."""
        width = self._along(self.total_covariance)
        return np.where(self.is_nothing, np.maximum(width, self.magnitude), width)

    @property
    def noise_interval(self) -> Array:
        """1.96 standard deviations along the load by the noise alone, (n,)."""
        return self._along(self.covariance)

    @property
    def model_interval(self) -> Array:
        """The same by what the models leave out, (n,)."""
        return self._along(self.model_covariance)

    @property
    def input_interval(self) -> Array:
        """The same by the case's [[input_uncertainty]], (n,)."""
        return self._along(self.input_covariance)

    def _along(self, covariance: Array) -> Array:
        magnitude = self.magnitude
        along = self.load / np.where(magnitude > 0, magnitude, 1)[:, None]
        along[magnitude == 0] = [1, 0]
        with np.errstate(invalid="ignore"):
            width = TWO_SIDED_95 * np.sqrt(np.einsum("ni,nij,nj->n", along, covariance, along))
        return np.where(np.isfinite(covariance).all(axis=(1, 2)), width, np.inf)

    @property
    def azimuth_interval(self) -> Array:
        """Half-widths of the same of the azimuth, rad; pi: not known.

        A direction is in the interval if a load along it is within chi squared of 3.84 of the one found. Where the
        covariance is a circle of radius sigma these are the directions within asin(1.96 sigma/|p|); by p = L y with
        L L^T the covariance any other is one.
        """
        result = np.full(len(self.load), np.pi)
        covariance = self.total_covariance
        seen = ~self.is_nothing & np.isfinite(covariance).all(axis=(1, 2))
        if not seen.any():
            return result
        L = np.linalg.cholesky(covariance[seen])
        y = np.linalg.solve(L, self.load[seen][..., None])[..., 0]
        half = np.arcsin(np.minimum(1, TWO_SIDED_95 / np.hypot(*y.T)))
        azimuth, ends = self.azimuth[seen], []
        for sign in (-1, 1):
            cos, sin = np.cos(half), sign * np.sin(half)
            turned = np.stack([cos * y[:, 0] - sin * y[:, 1], sin * y[:, 0] + cos * y[:, 1]], axis=-1)
            end = np.einsum("nij,nj->ni", L, turned)
            ends.append(np.abs(wrapped(np.arctan2(end[:, 1], end[:, 0]) - azimuth)))
        result[seen] = np.maximum(*ends)
        return result

    @property
    def status(self) -> Array:
        """One of STATUSES for each reading, by the first condition that holds."""
        conditions = [
            ~self.converged, self.is_beyond, self.misfit_probability < UNLIKELY, self.is_nothing, self.is_ambiguous,
        ]  # fmt: skip
        return np.select(conditions, ["failed", "beyond range", "misfit", "nothing", "ambiguous"], "found")


@dataclass(frozen=True)
class Chips:
    """Orientation and gain of the sensors' chips: axes (s, 3, 3), whose columns are where the chip's own x, y, z point
    in the case; reads (s, 3), which of them it reads. gain (s,): what it reads over what there is."""

    axes: Array
    reads: Array
    gain: Array

    @staticmethod
    def of(case: Case) -> Chips:
        """Chips of the case's sensors (docs/guide/sensing.md, The chip)."""
        axes, reads, gains = [], [], []
        for names, rotation, gain, components in case._core.chips:
            own = [float(f"{name[0]}1") * np.eye(3)["xyz".index(name[1])] for name in names or ("+x", "+y", "+z")]
            axes.append(Rotation.from_euler("xyz", rotation).as_matrix() @ np.stack(own, axis=1))
            reads.append([not components or c in components for c in "xyz"])
            gains.append(gain)
        return Chips(np.array(axes), np.array(reads), np.array(gains))

    def in_case(self, B: Array) -> Array:
        """Components in the case's directions from the chips' own (…, s, 3); 0 for what a chip does not read."""
        own = np.where(self.reads, B, 0.0) / self.gain[:, None]
        return np.asarray(np.einsum("sij,...sj->...si", self.axes, own))

    @property
    def is_plain(self) -> bool:
        """True if they read all components in the case's directions, as they are."""
        return bool(self.reads.all() and (self.axes == np.eye(3)).all() and (self.gain == 1).all())

    def own(self, B: Array) -> Array:
        """The chips' own components from those in the case's directions, 0 for what a chip does not read."""
        own = np.einsum("sij,...si->...sj", self.axes, B) * self.gain[:, None]
        return np.where(self.reads, own, 0.0)


def wrapped(angle: Array) -> Array:
    """Angles within (-pi, pi]."""
    return -(np.remainder(-np.asarray(angle) + np.pi, 2 * np.pi) - np.pi)


def invert(
    response: Response,
    change: npt.ArrayLike,
    noise: npt.ArrayLike,
    variance: npt.ArrayLike = 1.0,
    common: Array | None = None,
    chips: Chips | None = None,
    left_out: LeftOut | None = None,
) -> SensedLoads:
    """The loads whose dB is nearest to readings: least squares weighted by the noise, by the method of Levenberg and
    Marquardt with the response's own derivatives, from the nearest of a grid of 129 loads over the whole range. All
    readings take their steps together: a call of scipy.optimize for each costs a hundred times as much, and gives the
    same (tests/python/test_sensing.py).

    change: dB, (n, s, 3), T. noise: standard deviation of a component of a single reading, T, a number or
    (3,). variance: of dB over noise^2, (n,): 1/m + 1/k of means of m loaded and k unloaded readings.
    common: (n, s, s), the covariance of the sensors by an error that they share, over noise^2. chips: which of
    the components count; None: all. left_out: what the models leave out, and what the inputs make; None:
    nothing. Raises InputError if a number is not finite, the noise not positive, or a shape is another.

    >>> import ciliaval as cv, numpy as np
    >>> from ciliaval.sensing import Response, invert, shapes_within
    >>> case = cv.Case("cases/paper/fig3d.toml")
    >>> response = Response(case, "volume", shapes_within(case, "elastica", 2e-3), case.sensors)
    >>> bool(np.allclose(invert(response, response.change([[1e-3, 5e-4]]), 1e-6).load, [[1e-3, 5e-4]]))
    True
    """
    dB = change = np.asarray(change, dtype=float)
    noise = np.broadcast_to(np.asarray(noise, dtype=float), 3)
    if change.ndim != 3 or change.shape[1:] != (response.sensors, 3):
        raise InputError(f"readings have the shape (n, {response.sensors}, 3), not {change.shape}")
    if not np.isfinite(change).all():
        raise InputError("a reading is not finite")
    if not (np.isfinite(noise).all() and (noise > 0).all()):
        raise InputError("the noise of a reading must be finite and positive")
    if chips is not None and chips.reads.sum() < _COMPONENTS:
        raise InputError("a load has two components: one that a sensor reads does not tell them")
    V = np.broadcast_to(np.asarray(variance, dtype=float), len(change))[:, None, None] * np.eye(response.sensors)
    whitening = Whitening.of(V if common is None else V + common, noise, chips)

    def part(start: int) -> tuple[Array, ...]:
        rows = slice(start, start + _CHUNK)
        return _both(response, dB[rows], whitening.rows(rows), left_out)

    with ThreadPoolExecutor(os.cpu_count()) as threads:  # NumPy lets them run side by side
        parts = list(threads.map(part, range(0, max(1, len(change)), _CHUNK)))
    return SensedLoads(*(np.concatenate(arrays) for arrays in zip(*parts)))


class Whitening:
    """V^-1/2 of readings: values times it have the covariance 1."""

    def __init__(self, factor: Array, chips: Chips | None):
        self._factor, self.chips = factor, chips  # (n, 3, s, s)

    @staticmethod
    def of(V: Array, noise: Array, chips: Chips | None) -> Whitening:
        """V over noise^2, (n, s, s), holds for each component over the sensors that read it; a number that is not read
        is 0 whatever it is divided by."""
        V = np.broadcast_to(V[:, None], (len(V), 3, *V.shape[1:]))
        if chips is not None:
            V = np.where((chips.reads[:, None] & chips.reads).transpose(2, 0, 1), V, np.eye(V.shape[-1]))
        factor = np.linalg.inv(np.linalg.cholesky(V)) / noise[:, None, None]
        return Whitening(factor, None if chips is None or chips.is_plain else chips)

    def rows(self, chosen: Array | slice) -> Whitening:
        return Whitening(self._factor[chosen], self.chips)

    def _own(self, values: Array) -> Array:
        return values if self.chips is None else self.chips.own(values)

    def __call__(self, values: Array) -> Array:
        """Whitened values of each reading, (n, …, s, 3) with any axes between: (n, …, 3 s)."""
        *axes, s, _ = values.shape
        return np.asarray(np.einsum("ncst,n...tc->n...sc", self._factor, self._own(values)).reshape(*axes, 3 * s))

    def squares(self, known: Array, read: Array) -> Array:
        """|V^-1/2 (known - read)|^2 of each reading (n, s, 3) and known value (l, s, 3), less a number of
        each reading: (n, l)."""
        (n, s, _), known = read.shape, self._own(known)
        metric = np.einsum("ncrs,ncrt->ncst", self._factor, self._factor)
        products = np.einsum("lsc,ltc->lcst", known, known)
        weighted = np.einsum("ncst,ntc->nsc", metric, self._own(read)).reshape(n, 3 * s)
        own = metric.reshape(n, 3 * s * s) @ products.reshape(-1, 3 * s * s).T
        return np.asarray(own - 2 * weighted @ known.reshape(-1, 3 * s).T)


def _both(
    response: Response, change: Array, whitened: Whitening, left_out: LeftOut | None
) -> tuple[Array, ...]:
    """_invert(), and whether another load explains the reading as well; the better one is the first."""
    first = _invert(response, change, whitened, _starts(response, change, whitened), left_out)
    if whitened.chips is None or whitened.chips.reads.all():
        return *first, np.zeros(len(change), dtype=bool)
    second = _invert(response, change, whitened, _starts(response, change, whitened, first[0]), left_out)
    better = second[6] & (second[2] < first[2])
    best = [np.where(better.reshape(-1, *[1] * (a.ndim - 1)), b, a) for a, b in zip(first, second)]
    apart = np.hypot(*(first[0] - second[0]).T) > 1e-3 * np.hypot(*best[0].T)
    also = second[6] & first[6] & (np.abs(second[2] - first[2]) <= TWO_SIDED_95**2) & apart
    return *best, also


def _invert(
    response: Response, change: Array, whitened: Whitening, starts: Array, left_out: LeftOut | None
) -> tuple[Array, ...]:
    n, largest = len(change), response.largest
    x = starts / largest
    converged = np.zeros(n, dtype=bool)
    damping = np.full(n, 1e-3)
    r, J = _misfit(response, x, change, whitened)
    cost = np.einsum("nk,nk->n", r, r)
    active = np.arange(n)
    for _ in range(_MOST_STEPS):
        if not len(active):
            break
        A = np.einsum("nki,nkj->nij", J[active], J[active])
        g = np.einsum("nki,nk->ni", J[active], r[active])
        step = -_solved(A, g, damping[active])
        tried = x[active] + step
        r_new, J_new = _misfit(response, tried, change[active], whitened.rows(active))
        new = np.einsum("nk,nk->n", r_new, r_new)
        better = new <= cost[active]
        size = np.hypot(*step.T)
        # The error left is as small as the step; rounding of the cost leaves no smaller one.
        done = size <= 1e-10 * (np.hypot(*x[active].T) + 1e-3)
        done |= np.abs(cost[active] - new) <= 1e-11 * cost[active] + 1e-24
        done |= ~better & (size <= 1e-9)
        taken = active[better]
        x[taken], r[taken], J[taken], cost[taken] = tried[better], r_new[better], J_new[better], new[better]
        damping[active] = np.where(better, damping[active] / 10, damping[active] * 10)
        converged[active[done]] = True
        active = active[~done]
    freedom = (3 * response.sensors if whitened.chips is None else int(whitened.chips.reads.sum())) - _COMPONENTS
    load = x * largest
    J = J / largest
    covariance = _inverse(np.einsum("nki,nkj->nij", J, J))
    without = np.einsum("nk,nk->n", *[whitened(change)] * 2)
    known = np.where(np.isfinite(covariance), covariance, 0)
    input_covariance = np.zeros((n, 2, 2))
    explained = np.zeros(n)  # of chi squared by V + sum d d^T, d of the inputs
    inputs = [whitened(d) for d in left_out.of_inputs(load)] if left_out is not None else []
    if inputs:
        d = np.stack(inputs, axis=-1)
        shift = np.einsum("nij,nkj,nkd->nid", known, J, d)
        input_covariance = np.einsum("nid,njd->nij", shift, shift)
        along = np.einsum("nk,nkd->nd", r, d)
        inner = np.eye(len(inputs)) + np.einsum("nkd,nke->nde", d, d)
        explained = np.einsum("nd,nd->n", along, np.linalg.solve(inner, along[..., None])[..., 0])
    by_better, model_covariance = _left_out(response, change, whitened, left_out, load, J, known)
    rest = cost - explained
    if freedom > 0:
        rest = np.minimum(rest, by_better(rest > special.chdtri(freedom, UNLIKELY)))
    return (
        load,
        covariance,
        cost,
        special.chdtrc(freedom, rest) if freedom > 0 else np.ones(n),
        special.chdtrc(_COMPONENTS, np.maximum(0, without - cost)),
        np.hypot(*load.T) > largest * (1 + 1e-9),
        converged & np.isfinite(load).all(axis=1),
        model_covariance,
        input_covariance,
    )


def _left_out(
    response: Response, change: Array, whitened: Whitening, left_out: LeftOut | None, load: Array, J: Array,
    known: Array,
) -> tuple[Callable[[Array], Array], Array]:
    """chi squared by better models, of chosen rows (infinite of the others), and the covariance of the load by what
    the models leave out, (n, 2, 2).

    The true load p* has the reading by a better model, dB(p*) + d(p*) = dB(p): p* = p - G d(p*) with
    G = (J^T V^-1 J)^-1 J^T V^-1, known = (J^T V^-1 J)^-1. The parts of d are bounds: their shifts add up.
    """
    n = len(load)
    shifts = np.zeros((n, 2, 0))
    for _ in range(_SHIFTS if n else 0):
        parts = left_out.of_models(load - shifts.sum(axis=2)) if left_out is not None else []
        if not parts:
            break
        d = np.stack([whitened(part) for part in parts], axis=-1)
        before, shifts = shifts.sum(axis=2), np.einsum("nij,nkj,nkd->nid", known, J, d)
        if np.abs(shifts.sum(axis=2) - before).max() < 1e-3 * response.largest:
            break

    def by_better(chosen: Array) -> Array:
        result = np.full(n, np.inf)
        if left_out is not None and shifts.size and chosen.any():
            true = load[chosen] - shifts[chosen, :, 0]
            off = response.change(true) + left_out.of_models(true)[0] - change[chosen]
            rest = whitened.rows(chosen)(off)
            result[chosen] = np.einsum("nk,nk->n", rest, rest)
        return result

    if not shifts.size:
        return by_better, np.zeros((n, 2, 2))
    signs = np.where(np.einsum("ni,nid->nd", shifts[:, :, 0], shifts) < 0, -1.0, 1.0)
    shift = np.einsum("nid,nd->ni", shifts, signs) / TWO_SIDED_95
    return by_better, np.einsum("ni,nj->nij", shift, shift)


def _inverse(A: Array) -> Array:
    """Inverses of symmetric matrices (n, 2, 2); infinite where they are singular."""
    regular = np.linalg.det(A) > 1e-12 * np.trace(A, axis1=1, axis2=2) ** 2
    regular = regular[:, None, None]
    return np.where(regular, np.linalg.inv(np.where(regular, A, np.eye(2))), np.inf)


def _misfit(
    response: Response, x: Array, change: Array, whitened: Whitening
) -> tuple[Array, Array]:
    """V^-1/2 (dB(p) - reading), (n, 3 s), and its derivative by x, p over the largest load, (n, 3 s, 2)."""
    dB, derivative = response.change_and_derivative(response.largest * x)
    J = whitened(response.largest * np.moveaxis(derivative, -1, 1))
    return whitened(dB - change), np.moveaxis(J, 1, -1)


def _solved(A: Array, g: Array, damping: Array) -> Array:
    """(A + damping diag A)^-1 g of each reading."""
    a, d = A[:, 0, 0] * (1 + damping), A[:, 1, 1] * (1 + damping)
    b = A[:, 0, 1]
    determinant = a * d - b * b
    return np.asarray(np.stack([d * g[:, 0] - b * g[:, 1], a * g[:, 1] - b * g[:, 0]], axis=-1) / determinant[:, None])


def directions(azimuth: Array) -> Array:
    """Unit vectors at azimuths (n,), rad, (n, 2)."""
    return np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)


def loads_over(largest: float, magnitudes: int = 8, azimuths: int = 16) -> Array:
    """Loads over the whole range, the zero load first, (n, 2)."""
    size = largest * np.arange(1, magnitudes + 1) / magnitudes
    loads = size[:, None, None] * directions(2 * np.pi * np.arange(azimuths) / azimuths)
    return np.concatenate([np.zeros((1, 2)), loads.reshape(-1, 2)])


def _starts(response: Response, change: Array, whitened: Whitening, avoided: Array | None = None) -> Array:
    """Nearest load over the range for each reading; with `avoided`, among the loads that point elsewhere than it does
    by more than 30 degrees."""
    # Two components leave narrow valleys, which a coarse grid misses.
    all_read = whitened.chips is None or whitened.chips.reads.all()
    loads = loads_over(response.largest) if all_read else loads_over(response.largest, 24, 48)
    squares = whitened.squares(response.change(loads), change)
    if avoided is not None:
        size = np.hypot(*avoided.T)[:, None] * np.hypot(*loads.T)
        squares = np.where(avoided @ loads.T > math.cos(math.radians(30)) * size - 1e-300, np.inf, squares)
    return np.asarray(loads[squares.argmin(axis=1)])


class LinearFit:
    """The paper's way (section 3.5): dB linear in the load, dB = A p, with A the least-squares fit to the
    response over the whole range; then p = A^+ dB. misfit: root mean square of |dB - A p| over that of
    |dB|. r_squared: (3,), of each component of dB over those loads, all sensors together."""

    def __init__(self, response: Response, noise: npt.ArrayLike):
        loads = loads_over(response.largest)
        change = response.change(loads)
        flat = change.reshape(len(loads), -1)
        A, *_ = np.linalg.lstsq(loads, flat, rcond=None)  # (2, 3 s)
        rest = flat - loads @ A
        self.misfit = float(np.sqrt((rest**2).sum() / (flat**2).sum()))
        total = ((flat - flat.mean(axis=0)) ** 2).reshape(change.shape).sum(axis=(0, 1))
        with np.errstate(invalid="ignore", divide="ignore"):
            self.r_squared = 1 - (rest**2).reshape(change.shape).sum(axis=(0, 1)) / total
        weights = np.tile(1 / np.broadcast_to(np.asarray(noise, dtype=float), 3), response.sensors)
        self._inverse = np.linalg.pinv(weights[:, None] * A.T) * weights

    def __call__(self, change: Array) -> Array:
        """p, (n, 2), of dB, (n, s, 3)."""
        return change.reshape(len(change), -1) @ self._inverse.T
