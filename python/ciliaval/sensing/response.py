# SPDX-License-Identifier: LGPL-2.1-or-later
"""dB of the sensors as a function of the load: docs/theory/sensing.md."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..files import declared
from ..model import Case

Progress = Callable[[str], None]

_INTERVALS = 16  # between the Chebyshev-Lobatto magnitudes
_CHECKED = (1, 5, 10, 14)  # those with a check in the middle
_FEWEST_ANGLES, _MOST_ANGLES = 16, 256
_ENOUGH = 1e-9  # error between the angles, of the largest |dB|
_TOO_MUCH = 1e-3  # error of the whole interpolation
_ROUNDING = 1e-14  # part of the largest coefficient, below which the others are noise
_MOST_RANGES = 16  # of loads, each below the one before
_VERTICAL = 1e-9


@dataclass(frozen=True)
class Pair:
    """A mechanics model and the field model that is evaluated on its shapes."""

    mechanics: str
    field: str

    @staticmethod
    def of(text: str) -> Pair:
        """Pair of the text "elastica/volume". Raises InputError if there is no such pair."""
        mechanics, slash, field = (part.strip() for part in text.partition("/"))
        if not slash or "," in text:
            raise InputError(f"a pair of models is written mechanics/field, such as elastica/volume, not `{text}`")
        models = declared()["models"]
        for name, kind in ((mechanics, "mechanics"), (field, "fields")):
            if name not in models[kind]:
                raise InputError(f"`{text}`: there is no model `{name}` among the {kind}: {', '.join(models[kind])}")
        has_body, needs_body = _core.has_body(mechanics, field)
        if needs_body and not has_body:
            raise InputError(f"`{field}` needs the body of a solid; `{mechanics}` has none")
        return Pair(mechanics, field)

    def __str__(self) -> str:
        return f"{self.mechanics}/{self.field}"


def pairs_of(text: str) -> list[Pair]:
    """Pairs of the text "elastica/volume, beam/line". Raises InputError."""
    return list(dict.fromkeys(map(Pair.of, text.split(","))))


@dataclass(frozen=True)
class Shapes:
    """A round cilium's shapes under one load of growing magnitude and azimuth 0."""

    nodes: list[Any]  # at the Chebyshev-Lobatto magnitudes but 0
    checks: list[Any]  # between some of them
    node_magnitudes: Array  # as the load's type has them: N, N/m, m
    check_magnitudes: Array
    limit: str  # why they end below the largest load asked for; empty: they do not

    @property
    def largest(self) -> float:
        return float(self.node_magnitudes[-1])


def require_load_to_sense(case: Case) -> None:
    """Raises InputError unless the case has loads that readings can tell: not of the type
    `environment`, on a cilium and in one environment that are the same from all sides."""
    first = case.loads[0]
    if first.type == "environment":
        raise InputError("the load type 'environment' has no load to be found from readings")
    around = first.environment
    if any(load.environment != around for load in case.loads):
        raise InputError("a load is found in one environment: list one 'uniform_field'")
    sideways = np.concatenate([np.asarray(around.gravity)[:2], np.asarray(around.uniform_field)[:2]])
    if around.magnets or np.abs(sideways).max() > _VERTICAL:
        raise InputError(
            "a load is found by a response that is the same from all sides: an [environment] beside it points along z "
            "and has no magnets"
        )
    across = [np.ndim(s.magnetization) == 1 and np.any(s.magnetization[:2]) for s in case.cilium.segments]
    if case.cilium.sides or any(across):
        raise InputError(
            "a load is found by a response that is the same from all sides: the cilium is round and magnetised along "
            "its axis"
        )


def shapes_within(case: Case, mechanics: str, largest: float, progress: Progress | None = None) -> Shapes:
    """The shapes under the case's load up to the largest magnitude, by the mechanics model. Where the
    cilium slips off below it, or the model has no shape for another reason, up to there. Raises
    SolverError if there is none at all; InputError if the case is not the same from all sides."""
    for key in case._core.user_meshes(mechanics):
        raise InputError(f"a solid with a mesh of the user is not the same from all sides: leave out {key}")
    require_load_to_sense(case)
    if not 0 < largest < math.inf:
        raise InputError("the largest load must be finite and positive")
    limit, reached = "", largest
    first = case.loads[0]
    for _ in range(_MOST_RANGES):
        nodes = reached / 2 * (1 - np.cos(np.pi * np.arange(1, _INTERVALS + 1) / _INTERVALS))
        nodes[-1] = reached
        checks = np.array([(nodes[k - 1] + nodes[k]) / 2 for k in _CHECKED])
        magnitudes = np.concatenate([nodes, checks])
        order = np.argsort(magnitudes)
        loads = [first.changed(magnitude=magnitude, azimuth=0.0) for magnitude in magnitudes[order]]
        path = _core.bend_case(case._core, loads, mechanics, progress)
        missing = next((i for i, shape in enumerate(path) if not shape.has_shape), None)
        if missing is None:
            shapes = [path[i] for i in np.argsort(order)]
            return Shapes(shapes[: len(nodes)], shapes[len(nodes) :], nodes, checks, limit)
        limit = limit or f"{mechanics}: {path[missing].message}"
        reached = _range_below(path[missing], loads[missing - 1].magnitude if missing else 0.0)
    raise SolverError(f"no shape under {reached:g} {first.unit} or more: {limit}")


def shapes_up_to(case: Case, mechanics: str, largest: float, progress: Progress | None = None) -> Shapes:
    """The same up to the largest magnitude itself: raises SolverError if they end below it."""
    shapes = shapes_within(case, mechanics, largest, progress)
    if shapes.limit:
        unit = case.loads[0].unit
        raise SolverError(
            f"no shape beyond {shapes.largest:g} {unit}, within the range of loads up to {largest:g} {unit} that is "
            f"asked for: {shapes.limit}"
        )
    return shapes


def _range_below(missing: Any, last: float) -> float:
    """A range of loads below one without a shape: up to the slip-off, less what the model does not
    know of it; where this is not known, up to the last load with a shape, or the first of all."""
    load = missing.load.magnitude
    if missing.slip_off is not None and missing.slip_off > last:
        known = missing.slip_off * (1 - 1e-6) - (missing.slip_off_uncertainty or 0.0)
        if last < known < load:
            return float(known)
    return last or load


class Response:
    """dB at sensors as a function of the horizontal load vector p, |p| the magnitude and its direction
    e, for one pair of models. The cilium is round and the field turns with it, so that with the sensor
    at (rho, beta, z)

      dB(p) = Q(phi) b(|p|, beta - phi),  b(F, beta) = dB under the azimuth 0 at (rho, beta, z).

    b is interpolated: polynomials in F through Chebyshev-Lobatto points (barycentric: Berrut and
    Trefethen, SIAM Review 46, 501, 2004, Eq. 4.2), trigonometric ones in beta. Both converge
    exponentially; the error is measured between the nodes.

    undeformed: B of the straight cilium, (s, 3), T. largest: load. interpolation_error, largest_change:
    the largest error found between the nodes and the largest |dB|, T.

    Raises InputError and SolverError as the models do; SolverError too if the interpolation is worse
    than 1e-3 of the largest |dB|.
    """

    def __init__(self, case: Case, field: str, shapes: Shapes, sensors: npt.ArrayLike):
        sensors = np.asarray(sensors, dtype=float).reshape(-1, 3)
        self.largest = shapes.largest
        self._nodes = np.concatenate([[0.0], shapes.node_magnitudes])
        signs = np.where(np.arange(len(self._nodes)) % 2, -1.0, 1.0)
        signs[[0, -1]] /= 2
        self._signs = signs
        self._beta = np.arctan2(sensors[:, 1], sensors[:, 0])
        straight = shapes.nodes[0].straight
        angles = _FEWEST_ANGLES
        while True:
            change, self.undeformed = _changes([straight, *shapes.nodes], sensors, angles, 0.0, field)
            self.largest_change = float(np.linalg.norm(change, axis=-1).max())
            self._tabulate(change)
            # Between the angles, under the largest load; and between the magnitudes.
            half = math.pi / angles
            exact, _ = _changes([straight, shapes.nodes[-1], *shapes.checks], sensors, angles, half, field)
            magnitudes = np.concatenate([[self.largest], shapes.check_magnitudes])
            beta = half * (2 * np.arange(angles) + 1)
            errors = [self._error(exact[k], magnitudes[k], beta) for k in range(len(magnitudes))]
            if errors[0] <= _ENOUGH * self.largest_change or angles >= _MOST_ANGLES:
                break
            angles *= 2
        self.interpolation_error = max(errors)
        if not self.largest_change > 0:
            raise InputError("no load changes the field at the sensors: has the cilium a magnet?")
        if not self.interpolation_error <= _TOO_MUCH * self.largest_change:
            raise SolverError(
                f"the response up to {self.largest:g} is too steep to be interpolated: off by "
                f"{self.interpolation_error:.2g} of {self.largest_change:.2g} T between the loads computed; choose a "
                "smaller range"
            )

    @property
    def sensors(self) -> int:
        return len(self._beta)

    def _tabulate(self, change: Array) -> None:
        """change: (k, s, n angles, 3) at the magnitudes but 0. Keeps z of Re sum_m z_m exp(i m beta) and
        its derivative by the magnitude, each (k + 1, s, 3, modes)."""
        count = change.shape[2]
        z = np.fft.rfft(change, axis=2) * (2 / count)
        z[:, :, 0] /= 2
        if count % 2 == 0:
            z[:, :, -1] /= 2
        size = np.abs(z).max(axis=(0, 1, 3))
        z = z[:, :, : 1 + int(np.flatnonzero(size > _ROUNDING * size.max())[-1])] if size.any() else z
        values = np.concatenate([np.zeros_like(z[:1]), z]).swapaxes(2, 3)
        # Derivatives at the nodes of the polynomial through the values there.
        x, w = self._nodes, self._signs
        apart = x[:, None] - x[None, :] + np.eye(len(x))
        D = w[None, :] / w[:, None] / apart
        np.fill_diagonal(D, 0.0)
        np.fill_diagonal(D, -D.sum(axis=1))
        slopes = np.tensordot(D, values, axes=1)
        self._modes = values.shape[-1]
        self._table = np.stack([values, slopes], axis=1)  # (k, 2, s, 3, modes)

    def _weights(self, magnitude: Array) -> Array:
        """Weights of the nodes' values in the values at the magnitudes, (n, k)."""
        apart = magnitude[:, None] - self._nodes
        hit = apart == 0
        weights = self._signs / np.where(hit, 1.0, apart)
        rows = hit.any(axis=1)
        weights[rows] = hit[rows]
        return np.asarray(weights / weights.sum(axis=1, keepdims=True))

    def _error(self, exact: Array, magnitude: float, beta: Array) -> float:
        """The largest error at angles, exact: (s, n, 3)."""
        z = np.tensordot(self._weights(np.array([magnitude]))[0], self._table[:, 0], axes=1)
        waves = np.exp(1j * np.outer(beta, np.arange(self._modes)))
        b = np.einsum("scm,nm->snc", z, waves).real
        return float(np.linalg.norm(b - exact, axis=-1).max())

    def _evaluate(self, magnitude: Array, azimuth: Array) -> tuple[Array, Array, Array]:
        """b, its derivatives by the magnitude and by beta, each (n, s, 3), in the load's own frame."""
        n, s = len(magnitude), self.sensors
        table = self._table.reshape(len(self._nodes), -1)
        z = (self._weights(magnitude) @ table).reshape(n, 2, s, 3, self._modes)
        waves = np.ones((n, s, self._modes), dtype=complex)
        waves[..., 1:] = np.exp(1j * (self._beta - azimuth[:, None]))[..., None]
        np.cumprod(waves, axis=-1, out=waves)
        b, by_force = np.moveaxis(np.einsum("nkscm,nsm->nksc", z, waves).real, 1, 0)
        by_angle = -np.einsum("nscm,nsm->nsc", z[:, 0], waves * np.arange(self._modes)).imag
        return b, by_force, by_angle

    def change(self, p: npt.ArrayLike) -> Array:
        """dB of all sensors under loads p, (n, 2): (n, s, 3), T. Beyond `largest` it goes on linearly."""
        return self.change_and_derivative(p)[0]

    def derivative(self, p: npt.ArrayLike) -> Array:
        """d dB/dp, (n, s, 3, 2); beyond `largest` without the mixed derivative."""
        return self.change_and_derivative(p)[1]

    def change_and_derivative(self, p: npt.ArrayLike) -> tuple[Array, Array]:
        """change() and derivative() of the same loads."""
        p = np.asarray(p, dtype=float).reshape(-1, 2)
        magnitude, azimuth = np.hypot(*p.T), np.arctan2(p[:, 1], p[:, 0])
        is_zero = magnitude < 1e-9 * self.largest
        inside = np.minimum(magnitude, self.largest)
        cos, sin = np.cos(azimuth)[:, None], np.sin(azimuth)[:, None]
        b, by_force, by_angle = self._evaluate(inside, azimuth)
        own = b + (magnitude - inside)[:, None, None] * by_force
        change = _turned(own, cos, sin)
        radial = _turned(by_force, cos, sin)
        quarter = np.stack([-own[..., 1], own[..., 0], np.zeros_like(own[..., 0])], axis=-1)  # e_z x own
        with np.errstate(invalid="ignore", divide="ignore"):
            around = _turned(quarter - by_angle, cos, sin) / magnitude[:, None, None]
        derivative = np.stack(
            [cos[..., None] * radial - sin[..., None] * around, sin[..., None] * radial + cos[..., None] * around],
            axis=-1,
        )
        if is_zero.any():  # the derivatives are the slopes along x and y
            for axis, (c, s) in enumerate(((1.0, 0.0), (0.0, 1.0))):
                _, slope, _ = self._evaluate(np.zeros(1), np.array([axis * np.pi / 2]))
                derivative[is_zero, ..., axis] = _turned(slope, np.array([[c]]), np.array([[s]]))
        return change, derivative


def _turned(vectors: Array, cos: Array, sin: Array) -> Array:
    """(n, s, 3) turned about z by angles (n, 1)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def _changes(
    shapes: Sequence[Any], sensors: Array, angles: int, first: float, field: str
) -> tuple[Array, Array]:
    """dB of all shapes but the first, the straight one, on the circles of the sensors, (k, s, angles, 3);
    and B of the straight one at the sensors, (s, 3)."""
    beta = first + 2 * np.pi * np.arange(angles) / angles
    rho = np.hypot(sensors[:, 0], sensors[:, 1])[:, None]
    z = np.broadcast_to(sensors[:, 2:], (len(sensors), angles))
    circles = np.stack([rho * np.cos(beta), rho * np.sin(beta), z], axis=-1)
    B = _core.fields(shapes, np.concatenate([circles.reshape(-1, 3), sensors]), field)
    on_circles = B[:, : -len(sensors)].reshape(len(shapes), len(sensors), angles, 3)
    return on_circles[1:] - on_circles[0], B[0, -len(sensors) :]
