# SPDX-License-Identifier: LGPL-2.1-or-later
"""The largest gain in the unit box [0, 1]^n under constraints, with SciPy, and what the conditions of
Karush, Kuhn and Tucker say of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy import optimize

from ..arrays import Array

FEASIBILITY = 1e-8  # a constraint may be missed by so much: the searches approach it from outside
STATIONARY = 1e-3  # a residual below: from one side of the box to the other the gain would change by less

_SEED = 20261122
_STEP = 1e-4  # of the differences: their truncation is some 1e-8, and noise of 1e-12 makes as much
_BOUND_WIDTH = 1e-6  # nearer to a bound than this is at it
_REACHED_WIDTH = 1e-5  # the same of a constraint
_SAME_PLACE = 1e-3  # optima nearer than this are one
_POPULATION = 10  # of the global search, members for each dimension
_AGREED = 0.1  # deviation of its members' gains at which it has come near enough


@dataclass(frozen=True)
class Trial:
    """A point as a search sees it: the gain, and the constraints g, which are kept where g <= 0."""

    gain: float
    constraints: tuple[float, ...] = ()
    is_defined: bool = True  # False: `gain` is a stand-in for what is not there

    @property
    def violation(self) -> float:
        """The largest g, or 0."""
        return max(0.0, *self.constraints) if self.constraints else 0.0


Function = Callable[[list[tuple[float, ...]]], Sequence[Trial]]  # of several points, which may be computed at once


@dataclass
class LocalOptimum:
    """A point at which a local search ended, with grad(gain) = sum_j lambda_j grad(g_j) + mu + residual,
    lambda >= 0 of the constraints that are reached, mu_i <= 0 where u_i = 0, >= 0 where u_i = 1, else 0."""

    u: tuple[float, ...]
    trial: Trial
    multipliers: list[float]  # lambda: d gain/d g_j of a constraint that is relaxed; 0 of others
    bound_multipliers: list[float]  # |mu|: d gain of a bound that is moved outwards
    at_bound: list[int]  # -1: u_i = 0; 1: u_i = 1; 0: between
    residual: float  # the largest component of what is left, per unit of u
    starts: int = 1  # local searches that ended here


@dataclass
class SearchResult:
    """optima: feasible and stationary, the best first; if a point that is not stationary is better, that
    before them."""

    optima: list[LocalOptimum] = field(default_factory=list)
    local_searches: int = 0
    not_stationary: int = 0  # local searches that ended elsewhere
    infeasible: int = 0  # … without a point that keeps the constraints


def maximise(
    function: Function, start: Sequence[float], global_evaluations: int = 2000, starts: int = 10
) -> SearchResult:
    """The largest gain in the unit box under g <= 0.

    1. Differential evolution over the whole box with at most `global_evaluations` points (0: none), a
       generation at a time (scipy.optimize.differential_evolution; constraints by Lampinen's rule).
    2. From its end, from `start` and from `starts` points of a Sobol' sequence SLSQP (Kraft 1988) with
       central differences, whose 2n points the function gets at once. Where it does not come to a
       stationary point, because points without a gain or a kink are in its way, COBYLA (Powell 1994),
       which needs no derivatives, and SLSQP from its end.
    3. Each end is judged by the non-negative least squares of the gradients (scipy.optimize.nnls).

    All random numbers have a fixed seed: the same function gives the same sequence of points. What the
    function raises comes through.
    """
    objective = _Objective(function)
    points = [objective.clipped(start)]
    if global_evaluations > 0:
        points.append(_search_globally(objective, points[0], global_evaluations))
    result = SearchResult()
    elsewhere: list[LocalOptimum] = []
    for point in points + _sobol_points(len(start), starts):
        result.local_searches += 1
        optimum = _search_locally(objective, point)
        if optimum is None:
            result.infeasible += 1
        else:
            (result.optima if optimum.residual < STATIONARY else elsewhere).append(optimum)
    result.not_stationary = len(elsewhere)
    result.optima, elsewhere = _merged(result.optima), _merged(elsewhere)
    # A better point is the result, even if nothing is known of its surroundings.
    if elsewhere and not (result.optima and elsewhere[0].trial.gain <= result.optima[0].trial.gain + FEASIBILITY):
        result.optima.insert(0, elsewhere[0])
    return result


class _Objective:
    """The function with a memory, as SciPy calls it."""

    def __init__(self, function: Function):
        self._function = function
        self._trials: dict[tuple[float, ...], Trial] = {}
        self.best: tuple[float, ...] | None = None  # feasible, with the largest gain since restart()
        self.nearest: tuple[float, ...] = ()

    def clipped(self, u: npt.ArrayLike) -> tuple[float, ...]:
        return tuple(np.clip(u, 0.0, 1.0).tolist())

    def at(self, *points: tuple[float, ...]) -> list[Trial]:
        unknown = [u for u in dict.fromkeys(points) if u not in self._trials]
        if unknown:
            self._trials.update(zip(unknown, self._function(unknown)))
        return [self._trials[u] for u in points]

    def values(self, *points: tuple[float, ...]) -> Array:
        """The gain and the constraints, (m, 1 + c)."""
        return np.array([(t.gain, *t.constraints) for t in self.at(*points)])

    def derivative(self, u: tuple[float, ...]) -> Array:
        """d/du of the gain (row 0) and the constraints, (1 + c, n), by differences of second order
        within the box."""
        moved: list[tuple[float, ...]] = []
        sides = [1 if x < _STEP else -1 if x > 1 - _STEP else 0 for x in u]
        for i, side in enumerate(sides):
            for steps in (side, 2 * side) if side else (1, -1):
                moved.append((*u[:i], min(max(u[i] + steps * _STEP, 0.0), 1.0), *u[i + 1 :]))
        middle, *values = self.values(u, *moved)
        columns = [
            side * (4 * first - second - 3 * middle) if side else first - second
            for side, first, second in zip(sides, values[::2], values[1::2])
        ]
        return np.asarray(np.stack(columns, axis=1) / (2 * _STEP))

    def restart(self) -> None:
        self.best = None

    def prefer(self, x: Array) -> None:
        """Takes the end of a search for the best, unless it is worse by more than a missed constraint may
        be worth: a point on the way may miss one by more."""
        u = self.clipped(x)
        (trial,) = self.at(u)
        if trial.is_defined and trial.violation <= FEASIBILITY and trial.gain >= self.best_gain - 2 * FEASIBILITY:
            self.best = u

    @property
    def best_gain(self) -> float:
        return self.at(self.best)[0].gain if self.best else -np.inf

    def asked(self, x: Array) -> Array:
        """The values at points that a search asks for, (n,) or the columns of (n, m), which it remembers."""
        points = [self.clipped(u) for u in (x.T if x.ndim == 2 else x[None])]
        values = self.values(*points)
        for u, trial in zip(points, self.at(*points)):
            if not self.nearest or trial.violation < self.at(self.nearest)[0].violation:
                self.nearest = u
            if trial.is_defined and trial.violation <= FEASIBILITY and trial.gain > self.best_gain:
                self.best = u
        return values.T if x.ndim == 2 else np.asarray(values[0])


def _search_globally(objective: _Objective, start: tuple[float, ...], evaluations: int) -> tuple[float, ...]:
    n = len(start)
    members = max(5, min(_POPULATION * n, evaluations))  # SciPy takes five or more
    random = np.random.default_rng(_SEED)
    # A member in each of as many equal slices of each dimension.
    slices = np.stack([random.permutation(members) for _ in range(n)], axis=1)
    limits = optimize.NonlinearConstraint(lambda x: objective.asked(x)[1:], -np.inf, 0.0)
    optimize.differential_evolution(
        lambda x: -objective.asked(x)[0] if x.size else np.zeros(0),  # no member may be feasible
        [(0.0, 1.0)] * n,
        x0=start,
        seed=random,
        polish=False,
        vectorized=True,
        updating="deferred",
        init=(slices + random.random((members, n))) / members,
        tol=0.0,
        atol=_AGREED,
        maxiter=max(evaluations // members - 1, 0),
        constraints=[limits] if objective.at(start)[0].constraints else (),
    )
    return objective.best or objective.nearest


def _sobol_points(dimensions: int, count: int) -> list[tuple[float, ...]]:
    if count == 0:
        return []
    from scipy.stats import qmc  # half a second

    points = qmc.Sobol(dimensions, scramble=False).fast_forward(1).random(count)  # the first one is a corner
    return [tuple(point) for point in points.tolist()]


def _search_locally(objective: _Objective, start: tuple[float, ...]) -> LocalOptimum | None:
    """Local optimum from a start; None if there is no point that keeps the constraints."""
    objective.restart()
    _slsqp(objective, start)
    found = _judged(objective, objective.best) if objective.best else None
    if found is None or found.residual >= STATIONARY:
        _cobyla(objective, objective.best or start)
        if objective.best:
            _slsqp(objective, objective.best)
            found = _judged(objective, objective.best)
    return found


def _slsqp(objective: _Objective, start: tuple[float, ...]) -> None:
    count = len(objective.at(start)[0].constraints)
    limits = {
        "type": "ineq",
        "fun": lambda x: -objective.asked(x)[1:],
        "jac": lambda x: -objective.derivative(objective.clipped(x))[1:],
    }
    for _ in range(3):  # with a new Hessian: points without a gain have spoilt it
        before = objective.best_gain
        end = optimize.minimize(
            lambda x: -objective.asked(x)[0],
            objective.best or start,
            method="SLSQP",
            jac=lambda x: -objective.derivative(objective.clipped(x))[0],
            bounds=[(0.0, 1.0)] * len(start),
            constraints=limits if count else (),
            options={"ftol": 1e-11, "maxiter": 100},
        )
        objective.prefer(end.x)
        if objective.best_gain <= before + FEASIBILITY:
            break


def _cobyla(objective: _Objective, start: tuple[float, ...]) -> None:
    box = {"type": "ineq", "fun": lambda x: np.concatenate([x, 1 - x])}
    limits = {"type": "ineq", "fun": lambda x: -objective.asked(x)[1:]}
    optimize.minimize(
        lambda x: -objective.asked(x)[0],
        start,
        method="COBYLA",
        constraints=[box, limits] if objective.at(start)[0].constraints else [box],
        options={"rhobeg": 0.1, "tol": 1e-4, "maxiter": 60 * (len(start) + 1)},
    )


def _judged(objective: _Objective, u: tuple[float, ...]) -> LocalOptimum:
    """A point with its multipliers, on a bound if it is within rounding of it and loses nothing there."""
    on = tuple(float(round(x)) if min(x, 1 - x) <= _BOUND_WIDTH else x for x in u)
    there, here = objective.at(on, u)
    if there.is_defined and there.violation <= FEASIBILITY and there.gain >= here.gain - FEASIBILITY:
        u, here = on, there
    n = len(u)
    gradient, *slopes = objective.derivative(u)
    at_bound = [-1 if x <= _BOUND_WIDTH else 1 if x >= 1 - _BOUND_WIDTH else 0 for x in u]
    reached = [j for j, g in enumerate(here.constraints) if g >= -_REACHED_WIDTH]
    bounds = [i for i in range(n) if at_bound[i]]
    columns = [slopes[j] for j in reached] + [at_bound[i] * np.eye(n)[i] for i in bounds]
    weights, rest = np.zeros(0), gradient
    if columns:
        matrix = np.stack(columns, axis=1)
        weights, _ = optimize.nnls(matrix, gradient)
        rest = gradient - matrix @ weights
    multipliers, bound_multipliers = [0.0] * len(slopes), [0.0] * n
    for j, weight in zip(reached, weights):
        multipliers[j] = float(weight)
    for i, weight in zip(bounds, weights[len(reached) :]):
        bound_multipliers[i] = float(weight)
    return LocalOptimum(u, here, multipliers, bound_multipliers, at_bound, float(np.abs(rest).max()))


def _merged(optima: list[LocalOptimum]) -> list[LocalOptimum]:
    """The distinct ones, the best first."""
    distinct: list[LocalOptimum] = []
    for optimum in sorted(optima, key=lambda o: -o.trial.gain):
        for known in distinct:
            if np.abs(np.subtract(known.u, optimum.u)).max() < _SAME_PLACE:
                known.starts += 1
                break
        else:
            distinct.append(optimum)
    return distinct
