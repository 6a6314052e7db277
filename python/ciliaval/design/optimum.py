# SPDX-License-Identifier: LGPL-2.1-or-later
"""The design whose goal has the largest magnitude within bounds and limits: docs/guide/studies.md.

A design is a point u of the unit box, u_i from 0 to 1 between the bounds of parameter i, by the logarithm
of a logarithmic one. The gain is ln|y| of the goal y, a constraint ln(limit/|y|) or ln(|y|/limit), so that
the multipliers are elasticities: per cent of the goal for one per cent of the limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from .._core import StudyFile, StudyOutput, StudyParameter, StudyStore
from .search import FEASIBILITY, LocalOptimum, SearchResult, Trial, maximise
from .summary import Result, results_of

Progress = Callable[[str], None]

# The gain of a design without a goal, and the least of one that has it: ln of the goal in the unit in
# which people read it.
_NO_GAIN = -10.0
_UNKNOWN_VIOLATION = 10.0  # the constraints of a design of which nothing is known
_MARGIN = 1e-3  # of the own load below the range
_SENSITIVITY_STEP = 0.01  # of the loads of a slope, compare/budget/sensitivity.h
_SLICE_STEPS = 25


class Limit(NamedTuple):
    """Limit that a design must keep: the output's magnitude is at least, or at most, `value` (SI units); of the range,
    if `is_own_load`, at least that many times the design's own load."""

    output: StudyOutput
    is_lower: bool
    value: float
    is_own_load: bool = False


@dataclass
class Design:
    """A design with what the pairs make of it: the start and the best by all of them, the others by those
    of the mechanics model that searched."""

    name: str  # "start", "optimum 1", …
    values: list[float]  # of the parameters, SI units
    results: dict[str, Result] = field(default_factory=dict)  # by pair


@dataclass
class Slice:
    """The goal along one parameter through the best design, the others held there."""

    at: list[float]  # values of the parameter, SI units, ascending
    values: list[float | None]  # of the goal; None where a design has none
    kept: list[bool]  # whether the design keeps the limits


@dataclass
class Optimum:
    """Result of an optimisation. designs: the start, then each of search.optima."""

    search: SearchResult
    designs: list[Design]
    slices: list[Slice]  # one of each parameter, by the pair that searched
    evaluations: int  # distinct designs that the search has asked for

    @property
    def found(self) -> bool:
        return len(self.designs) > 1

    @property
    def best(self) -> LocalOptimum:
        return self.search.optima[0]


def limits_of(study: StudyFile) -> list[Limit]:
    """Limits that the study states."""
    return [Limit(*limit) for limit in study.limits]


def constraints_of(study: StudyFile) -> list[Limit]:
    """Limits of the search: the study's limits, and that a contact or probe does not slip off under the design's own
    load. A slope is that between loads somewhat lower and higher."""
    limits = limits_of(study)
    if not study.slips:
        return limits
    has_slope = study.goal.id == "sensitivity" or any(l.output.id in ("sensitivity", "resolution") for l in limits)
    factor = 1 + _MARGIN + (2 * _SENSITIVITY_STEP if has_slope else 0.0)
    return [*limits, Limit(study.range, True, factor, True)]


def optimise(study: StudyFile, store: StudyStore, progress: Progress | None = None) -> Optimum:
    """Searches with the study's first pair and confirms with all of them.

    A design without a goal, because it slips off or the model fails, has a stand-in far below; how far it
    is from bearing its load is known from its range all the same. Designs of rods are solved on all cores,
    as many as the search asks for at once. The search asks for the same sequence of designs again and finds
    those that the store keeps. Raises FileError, InputError, KeyboardInterrupt; what has been solved is kept.
    """
    designs = _Designs(study, store, progress)
    start = [to_unit(p, value) for p, value in zip(study.searched, study.start)]
    search = maximise(designs.trials, start, study.global_evaluations, study.starts)
    evaluations = designs.evaluations
    found = [designs.confirmed("start", study.start, study.mechanics)]
    for i, local in enumerate(search.optima):
        mechanics = study.mechanics if i == 0 else study.mechanics[:1]
        found.append(designs.confirmed(f"optimum {i + 1}", designs.values(local.u), mechanics))
    slices = designs.slices(search.optima[0].u) if search.optima else []
    return Optimum(search, found, slices, evaluations)


def to_unit(parameter: StudyParameter, value: float) -> float:
    """A value between the bounds as a number from 0 to 1."""
    low, high = parameter.values
    u = math.log(value / low) / math.log(high / low) if parameter.logarithmic else (value - low) / (high - low)
    return min(max(u, 0.0), 1.0)


def from_unit(parameter: StudyParameter, u: float) -> float:
    """The inverse, exactly the bounds at 0 and 1."""
    low, high = parameter.values
    if u <= 0:
        return low
    if u >= 1:
        return high
    return low * math.pow(high / low, u) if parameter.logarithmic else low + u * (high - low)


class _Designs:
    """Evaluates designs."""

    def __init__(self, study: StudyFile, store: StudyStore, progress: Progress | None):
        self.study, self.store, self.progress = study, store, progress
        self.parameters, self.goal, self.constraints = study.searched, study.goal, constraints_of(study)
        # The search computes no output that it does not need.
        self.outputs = list(dict.fromkeys([self.goal.id, *(limit.output.id for limit in self.constraints)]))
        self.evaluations = 0
        self.largest = _NO_GAIN

    def values(self, u: Sequence[float]) -> list[float]:
        return [from_unit(p, x) for p, x in zip(self.parameters, u)]

    def trials(self, points: Sequence[Sequence[float]]) -> list[Trial]:
        """Trials of points by the pair that searches."""
        trials = [trial for trial, _ in self.searched([self.values(u) for u in points])]
        self.evaluations += len(points)
        gains = [t.gain for t in trials if t.is_defined and t.violation <= FEASIBILITY]
        self.largest = max([self.largest, *gains])
        if self.progress:
            best = f"{math.exp(self.largest):.5g} {self.goal.shown_unit}"
            self.progress(f"{self.study.name}: {self.evaluations} designs, the best so far {best}")
        return trials

    def searched(self, designs: list[list[float]]) -> list[tuple[Trial, float | None]]:
        """Each with its goal's magnitude, by the pair that searches."""
        solved = self.store.evaluate(designs, self.study.mechanics[0], self.outputs)
        return [self._trial(values, Result(*pairs[0])) for values, pairs in zip(designs, solved)]

    def _trial(self, values: list[float], result: Result) -> tuple[Trial, float | None]:
        magnitudes = {id: abs(x) for id, x in zip(self.outputs, result.values) if x is not None}
        goal = magnitudes.get(self.goal.id)
        gain = _NO_GAIN if goal is None else max(_log(goal / self.goal.shown_size), _NO_GAIN)
        violations = []
        for limit in self.constraints:
            g = _UNKNOWN_VIOLATION
            value = magnitudes.get(limit.output.id)
            if value is not None:
                bound = limit.value * self.study.load(values) if limit.is_own_load else limit.value
                g = (1 if limit.is_lower else -1) * (_log(bound) - _log(value))
            violations.append(min(max(g, -_UNKNOWN_VIOLATION), _UNKNOWN_VIOLATION))
        return Trial(gain, tuple(violations), goal is not None), goal

    def confirmed(self, name: str, values: list[float], mechanics: Sequence[str]) -> Design:
        """Design with its results by some of the mechanics models."""
        say = self.progress
        inner = (lambda text: say(f"{self.study.name}: {name}: {text}")) if say else None
        design = Design(name, values)
        solved = {m: results_of(self.store.evaluate([values], m, None, inner))[0] for m in mechanics}
        for pair in self.study.pairs:
            of_model = solved.get(pair.split("/")[0])
            if of_model:
                design.results[pair] = of_model.pop(0)
        return design

    def slices(self, best: Sequence[float]) -> list[Slice]:
        slices = []
        for i, here in enumerate(best):
            along = sorted({here, *(k / _SLICE_STEPS for k in range(_SLICE_STEPS + 1))})
            designs = [self.values([*best[:i], u, *best[i + 1 :]]) for u in along]
            found = self.searched(designs)
            kept = [trial.violation <= FEASIBILITY for trial, _ in found]
            slices.append(Slice([values[i] for values in designs], [goal for _, goal in found], kept))
        return slices


def _log(value: float) -> float:
    return math.log(value) if value > 0 else -math.inf
