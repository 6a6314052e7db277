# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surface of a sweep, for pictures: without the compiled models (problem/surroundings/surface.h)."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Array
from .plain_cilium import as_number


@dataclass(frozen=True)
class PlainSurface:
    """kind: flat, sine, trapezoid, random or file; numbers: those of the case's [surface], SI."""

    kind: str
    numbers: dict[str, float]

    @staticmethod
    def of(text: str) -> PlainSurface | None:
        """From a case with every value it used; None if it has no surface."""
        table: dict[str, Any] = tomllib.loads(text).get("surface", {})
        if not table:
            return None
        return PlainSurface(table["profile"], {k: as_number(v) for k, v in table.items() if k not in ("profile", "path")})

    def z(self, x: Array, length: float, load: dict[str, Any]) -> Array:
        """L - interference - p(x - travel), m, under a sweep's load: where the surface is over x (n,), m."""
        return np.asarray(length - load["interference"] - self.height(x - load["travel"]))

    def height(self, x: Array) -> Array:
        """p(x) with the tilt, m, positive towards the cilium; x (n,), m. Of a file the tilt alone."""
        of = self.numbers
        p = np.zeros_like(x)
        if self.kind == "sine":  # a sin(2πx/λ)
            p = of["amplitude"] * np.sin(2 * np.pi * x / of["wavelength"])
        elif self.kind == "random":  # Σ a_j cos(2πjx/λ + φ_j), a_j² ∝ j^−(1+2H), Σ a_j²/2 = rms²
            j = np.arange(1, int(of["longest"] / of["shortest"] * (1 + 1e-12)) + 1)
            a = j ** -(0.5 + of["hurst"])
            draws = np.random.RandomState(int(of["seed"])).randint(0, 2**32, j.size, np.uint64)  # std::mt19937
            phases = 2 * np.pi * (draws + 0.5) / 2**32
            seen = slice(5000)  # of the up to 100,000 waves; shorter ones are not seen
            waves = np.cos(2 * np.pi / of["longest"] * np.outer(x, j[seen]) + phases[seen])
            p = waves @ a[seen] * of["rms"] / np.sqrt(np.sum(a**2) / 2)
        elif self.kind == "trapezoid":
            p = self._trapezoid(x)
        return np.asarray(p + np.tan(of["tilt"]) * x)

    def _trapezoid(self, x: Array) -> Array:
        """Straight valleys, flanks and plateaus, x = 0 in the middle of a valley, joined by arcs."""
        h, top, bottom, flank, radius = (self.numbers[k] for k in ("height", "top", "bottom", "flank", "radius"))
        period = top + bottom + 2 * flank
        distance = np.abs(x - period * np.round(x / period))  # from the middle of the valley
        upper = distance > (bottom + flank) / 2  # which mirrors the lower half
        s = np.where(upper, period / 2 - distance - top / 2, distance - bottom / 2)  # beyond the corner
        edge = radius * np.tan(np.arctan2(h, flank) / 2)  # the arc touches both sides so far from it
        on_arc = radius - np.sqrt(np.maximum(radius**2 - (s + edge) ** 2, 0))
        low = np.where(s < edge * flank / np.hypot(flank, h), on_arc, h / flank * s)
        low = np.where(s > -edge, low, 0.0)
        return np.asarray(np.where(upper, h - low, low))
