# SPDX-License-Identifier: LGPL-2.1-or-later
"""From what the sensors read while a cilium is drawn over a surface back to the surface."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import special

from .. import _core
from ..arrays import Array
from ..errors import InputError, SolverError
from ..model import Case
from .inversion import TWO_SIDED_95, UNLIKELY, Chips
from .readings import Readings
from .response import Pair, Progress

_POINTS = 241  # of the curve
_TRAVEL = 0.02  # of a step, in lengths of the cilium: enough that it slides on
_FEWEST = 5  # readings of a level
_CHUNK = 2_000  # readings at once

LEVEL, OFF_CURVE, AMBIGUOUS, BEYOND = "level", "off the curve", "ambiguous", "beyond range"


class LevelCurve:
    """dB of all sensors under a level surface that slides over the tip, over the interference.

    Follows the case's cilium under a flat surface with the case's friction, pressed from nothing to
    `largest` (m) in small steps, while it slides. interference: (k,), m. change: (k, 3 s), T. limit: why
    the curve ends below the largest interference asked for; empty: it does not. Raises InputError if
    the models do not take the case, SolverError where they fail.
    """

    def __init__(self, sweep: Case, pair: Pair, largest: float, progress: Progress | None = None):
        tables = tomllib.loads(sweep.toml())
        tables["surface"] = {"profile": "flat", "friction": tables["surface"]["friction"]}
        for key in ("signal", "measurement", "external"):  # of the case's own path
            tables.pop(key, None)
        flat = Case.from_dict(tables, sweep.name)
        part = np.arange(_POINTS) / (_POINTS - 1)
        # Finer where the cilium is nearly straight: dB grows there with the root of the interference.
        sizes = largest * np.maximum(part**2, 1e-4)
        step = _TRAVEL * flat.cilium.length
        loads = [
            flat.loads[0].changed(interference=size, travel=i * step) for i, size in enumerate(sizes.tolist())
        ]
        shapes = _core.bend_case(flat._core, loads, pair.mechanics, progress)
        count = next((i for i, shape in enumerate(shapes) if shape.status != "converged"), len(shapes))
        self.limit = ""
        if count < len(shapes):
            failed = f"no shape under an interference of {sizes[count]:g} m: {shapes[count].message}"
            self.limit = f"{pair.mechanics}: {failed}"
        if count < 2:
            raise SolverError(self.limit)
        kept = [i for i in range(count) if i + 1 == count or sizes[i + 1] > sizes[i]]  # it begins at rest
        B = _core.fields([shapes[0].straight, *(shapes[i] for i in kept)], sweep.sensors, pair.field)
        self.interference = sizes[kept]
        # In the chips' own directions, in which the readings are.
        self.change = Chips.of(sweep).own(B[1:] - B[0]).reshape(len(kept), -1)

    @property
    def largest(self) -> float:
        return float(self.interference[-1])

    def nearest(self, change: Array) -> dict[str, Array]:
        """Nearest point of the curve for each reading (n, 3 s): its interference, m; the distance, T; slope |d dB/d
        delta|, T/m; is_end: it lies beyond the largest interference; other: the distance of the nearest point at
        another interference, where it has a minimum too, or infinity. (n,) each."""
        chunks = [self._nearest(part) for part in np.array_split(change, 1 + len(change) // _CHUNK)]
        return {name: np.concatenate([chunk[name] for chunk in chunks]) for name in chunks[0]}

    def _nearest(self, change: Array) -> dict[str, Array]:
        start, along = self.change[:-1], np.diff(self.change, axis=0)
        length = np.einsum("kc,kc->k", along, along)
        rest = change[:, None, :] - start
        t = np.einsum("nkc,kc->nk", rest, along) / length
        inside = np.clip(t, 0, 1)
        distance = np.linalg.norm(rest - inside[..., None] * along, axis=2)
        row, best = np.arange(len(change)), distance.argmin(axis=1)
        width = np.diff(self.interference)
        piece = np.arange(len(start))
        elsewhere = (t == inside) & (np.abs(piece - best[:, None]) > 1)
        return {
            "interference": self.interference[best] + inside[row, best] * width[best],
            "distance": distance[row, best],
            "slope": np.sqrt(length[best]) / width[best],
            "is_end": (best == len(start) - 1) & (t[row, best] > 1),
            "other": np.where(elsewhere, distance, math.inf).min(axis=1),
        }


@dataclass(frozen=True)
class Level:
    """Successive readings of one level: rows from 0; the mean of three quarters of them, m, and the
    half-width of its 95 %."""

    first: int
    last: int
    interference: float
    interval: float


@dataclass(frozen=True)
class SensedSurface:
    """The readings one by one, and the levels among them: five or more in a row whose interferences
    differ by no more than their noise. The interval of a level's mean: the readings' own noise averages
    out, that of offset and background, which they have in common, does not."""

    case: str
    pair: Pair
    noise: float  # T
    status: Array  # (n,) of LEVEL, OFF_CURVE, AMBIGUOUS, BEYOND
    interference: Array  # (n,), m
    interval: Array  # (n,), half-widths of 95 % by the noise, m
    levels: list[Level]

    def text(self, width: int) -> str:
        """A table of the levels for people, with the steps between them and what is not known there."""
        text = f"{self.case}: levels of the surface by {self.pair}, noise {1e6 * self.noise:g} uT\n"
        rows = [["rows", "", "interference", "+- (mm)", "height (mm)", "step (mm)"]]
        heights = [level.interference - self.levels[0].interference for level in self.levels]
        for k, (level, height) in enumerate(zip(self.levels, heights)):
            step = f"{1e3 * (height - heights[k - 1]):+.4f}" if k else ""
            rows.append(
                [str(level.first + 1), f"- {level.last + 1}", f"{1e3 * level.interference:.4f}",
                 f"{1e3 * level.interval:.4f}", f"{1e3 * height:.4f}", step]
            )  # fmt: skip
        count = {status: int((self.status == status).sum()) for status in (OFF_CURVE, AMBIGUOUS, BEYOND)}
        known = sum(level.last - level.first + 1 for level in self.levels)
        return (
            text
            + _core.text_table(rows, "><>", width)
            + f"{known} of {len(self.status)} readings belong to levels. Of the others the height is not known: there "
            "the field\nis not that of a level surface (a flank, a tip that sticks or turns back), or it changes.\n"
            f"{count[OFF_CURVE]} readings are off the curve of level surfaces, {count[AMBIGUOUS]} ambiguous, "
            f"{count[BEYOND]} beyond its range."
        )

    def json(self, provenance: Mapping[str, Any]) -> dict[str, Any]:
        """SI; height over the first level, towards the cilium."""
        columns = ("status", "interference", "interval")
        readings = zip(*(getattr(self, name).tolist() for name in columns))
        return {
            "schema": 1,
            "case": self.case,
            "provenance": provenance,
            "models": str(self.pair),
            "noise": self.noise,
            "readings": [dict(zip(columns, values)) for values in readings],
            "levels": [
                vars(level) | {"height": level.interference - self.levels[0].interference} for level in self.levels
            ],
        }

    def csv(self) -> str:
        """A line for each reading, units in the header."""
        import pandas as pd

        columns = {"status": self.status, "interference [m]": self.interference, "interval [m]": self.interval}
        return str(pd.DataFrame(columns, index=range(1, len(self.status) + 1)).to_csv(index_label="row"))


def sense_surface(
    sweep: Case, readings: Readings, pair: Pair, noise: float, curve: LevelCurve
) -> SensedSurface:
    """The levels of the surface from readings in the order of the sweep. Raises InputError if they are
    no changes."""
    readings.require_offset("a surface")
    reads = Chips.of(sweep).reads
    change = np.where(reads, readings.change, 0.0).reshape(len(readings.change), -1)
    common = noise * np.sqrt(readings.common_variance())
    sigma = np.hypot(common, noise / np.sqrt(readings.rows))
    place = curve.nearest(change)
    far = sigma * math.sqrt(special.chdtri(int(reads.sum()) - 1, UNLIKELY))
    status = np.select(
        [place["is_end"], place["distance"] > far, place["other"] <= far], [BEYOND, OFF_CURVE, AMBIGUOUS], LEVEL
    )
    interval = TWO_SIDED_95 * sigma / place["slope"]
    shared = TWO_SIDED_95 * common / place["slope"]
    levels = _levels(status, place["interference"], interval, shared)
    return SensedSurface(sweep.name, pair, noise, status, place["interference"], interval, levels)


def _levels(status: Array, height: Array, interval: Array, shared: Array) -> list[Level]:
    def inner(first: int, end: int) -> slice:
        """All but an eighth at each end, where a flank begins within the noise."""
        margin = (end - first) // 8
        return slice(first + margin, end - margin)

    levels, first = [], 0
    for i in range(len(status) + 1):
        is_level = i < len(status) and status[i] == LEVEL
        if is_level and i > first:
            # It goes on while a reading is not farther from the mean so far than two may be by noise.
            apart = abs(height[i] - height[inner(first, i)].mean())
            is_level = bool(apart <= 2 * max(interval[i], interval[first]))
        if is_level:
            continue
        if i - first >= _FEWEST:
            rows = inner(first, i)
            own, common = (interval[rows] ** 2 - shared[rows] ** 2).max(), (shared[rows] ** 2).max()
            half_width = math.sqrt(own / (rows.stop - rows.start) + common)
            levels.append(Level(first, i - 1, float(height[rows].mean()), half_width))
        first = i if i < len(status) and status[i] == LEVEL else i + 1
    return levels
