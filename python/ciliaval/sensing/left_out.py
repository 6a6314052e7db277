# SPDX-License-Identifier: LGPL-2.1-or-later
"""Effects that the inverted models leave out of dB: docs/theory/band.md."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _core
from ..arrays import Array
from ..errors import InputError
from ..model import Case
from .response import Pair, Progress, Response, Shapes, shapes_within


def with_joints(case: Case, mechanics: str, joints: str) -> tuple[Case, str]:
    """The case with the rod's joints corrected ("corrected"), or as it states them ("case"); and why
    they are not corrected where they cannot be. Raises InputError."""
    if joints == "case":
        return case, ""
    if joints != "corrected":
        raise InputError(f"joints: `corrected`, or `case`, as the case states them, not `{joints}`")
    core, fault = case._core.corrected(mechanics)
    return (case, fault) if fault else (Case._of(core, case.file), "")


@dataclass(frozen=True)
class LeftOut:
    """The pair that is inverted held against the rod with corrected joints and the best quick field, and
    that one against joints as much softer as their correction is uncertain by.

    inputs: of each [[input_uncertainty]] of the case the pair's response with the number lower and higher, and how many
    standard uncertainties lie between.
    with_offset: B of the straight cilium is the model's, so that its error counts too.
    unknown: why there is no such thing; else empty. is_corrected: the pair's own joints. beyond: magnitude from which on the rod is bent further
    than the corrections are known.
    """

    asked: Response
    better: Response | None = None
    softer: Response | None = None
    unknown: str = ""
    is_corrected: bool = False
    beyond: float = math.inf
    inputs: tuple[tuple[Response, Response, float], ...] = ()
    with_offset: bool = False

    @staticmethod
    def of(case: Case, pair: Pair, shapes: Shapes, asked: Response, progress: Progress | None) -> LeftOut:
        """LeftOut of a response that was made from the shapes of a case."""

        def response(core: Any) -> Response:
            shifted = Case._of(core)
            within = shapes_within(shifted, pair.mechanics, shapes.largest, progress)
            return Response(shifted, pair.field, within, shifted.sensors)

        inputs = tuple((response(low), response(high), width) for low, high, width in case._core.input_shifts())
        better = shapes
        if shapes.nodes[0].with_softer_joints is None:
            corrected, fault = with_joints(case, pair.mechanics, "corrected")
            if fault:
                return LeftOut(asked, unknown=fault, inputs=inputs)
            better = shapes_within(corrected, pair.mechanics, shapes.largest, progress)
        nodes, checks = ([s.with_softer_joints for s in of] for of in (better.nodes, better.checks))
        if None in nodes or None in checks:
            unknown = "with joints as soft as they may be, a load has no equilibrium"
            return LeftOut(asked, unknown=unknown, inputs=inputs)
        field = _core.best_field()
        known = asked if better is shapes and pair.field == field else Response(case, field, better, case.sensors)
        softer = Response(case, field, replace(better, nodes=nodes, checks=checks), case.sensors)
        outside = [m for s, m in zip(better.nodes, better.node_magnitudes) if "outside of the domain" in s.message]
        return LeftOut(asked, known, softer, "", better is shapes, min(outside, default=math.inf), inputs)

    def of_models(self, load: Array) -> list[Array]:
        """dB of the better models less theirs, and of the softer joints less that, each (n, s, 3), T."""
        if self.better is None or self.softer is None:
            return []
        dB = self._within([self.asked, self.better, self.softer], load)
        return [dB[1] - dB[0], dB[2] - dB[1]]

    def of_inputs(self, load: Array) -> list[Array]:
        """Change of dB by one standard uncertainty of each input, each (n, s, 3), T."""
        each = [(self._within([low, high], load), width) for low, high, width in self.inputs]
        return [(dB[1] - dB[0]) / width for dB, width in each]

    def _within(self, responses: list[Response], load: Array) -> list[Array]:
        """dB, or B, of each response at the loads, or at the largest along them that all of them know."""
        most = min(r.largest for r in responses)
        size = np.hypot(*load.T)
        inside = load * np.minimum(1, most / np.where(size > 0, size, 1))[:, None]
        return [r.change(inside) + (r.undeformed if self.with_offset else 0.0) for r in responses]
