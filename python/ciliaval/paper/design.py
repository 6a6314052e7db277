# SPDX-License-Identifier: LGPL-2.1-or-later
"""Claims of the paper on its design studies (3.4, Fig. 4)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from .._core import Cilium
from ..arrays import Array
from ..model import Case, bend
from ..sensing.response import Pair
from .cases import RODS, Setting, dB, solved
from .claim import Claim, Finding, Interval, Scan, Unstated, in_range, scanned

_COUNT = 41  # of values from end to end of a study
_PEAK = (0.65, 0.95)  # "approximately 0.7-0.9", with room of half a digit
_BASE = "cilium.segment.base.young_modulus"
_MAGNET = "cilium.segment.magnet.young_modulus"
_PROPORTION = "cilium.segment.magnet.proportion"

Signal = Callable[[Array], Array]  # of dB, (n, 3), T


def _magnitude(change: Array) -> Array:
    return np.asarray(np.linalg.norm(change, axis=1))


def _x(change: Array) -> Array:
    return change[:, 0]


def design_claims(setting: Setting) -> list[Claim]:
    case = setting.case("fig3b")  # the numbers of 3.4.1; its first load is 1 mN
    moduli = case.changed({_BASE: "0.5 MPa", _MAGNET: "1 MPa"})  # of 3.4.2, 3.4.3
    setting.tell("claims: design studies")
    return [
        *youngs_moduli(case),
        aspect_ratio(moduli),
        *proportion(moduli, setting),
    ]


def _designs(case: Case, path: str, values: Iterable[float]) -> list[Cilium]:
    return [case.changed({path: float(x)}).cilium for x in values]


def _curve(case: Case, path: str, values: Iterable[float], pair: Pair) -> Array:
    """dB at 1 mN over a number of the case, (n, 3), T; NaN where it does not bear that."""
    cilia = _designs(case, path, values)
    return dB(cilia, [case.loads[0]] * len(cilia), case.sensors[0], pair)


def _trend(
    claim: Claim, case: Case, path: str, unstated: Unstated, size: float, signal: Signal, sign: int
) -> None:
    """Adds for each pair the signal from end to end of the study, and from which lower end on it
    rises (sign 1) or falls (-1) all the way to the upper one, `unstated.high`.

    unstated: the lower end, in a unit of `size`; its range begins where the study's would be asked
    for at most, its `used` is the study's own.
    """
    space: Any = np.geomspace if unstated.is_logarithmic else np.linspace
    values = np.union1d(space(unstated.low, unstated.high, 2 * _COUNT), [unstated.used])
    for pair in RODS:
        found = 1e6 * signal(_curve(case, path, values * size, pair))
        as_claimed = sign * np.diff(found) > 0  # False for NaN: the cilium has slipped off
        first = len(values) - 1 - int(np.argmax(~as_claimed[::-1])) if not as_claimed.all() else 0
        of_study = found[values >= unstated.used]
        borne = of_study[~np.isnan(of_study)]
        name = str(pair)
        holds = bool(first < len(values) - 1 and values[first] <= unstated.used)
        # From the study's first value that the cilium bears: thinner ones have no signal at all.
        low, high = sorted([float(borne[0]), float(borne[-1])])
        claim.findings.append(Finding(f"{name}: dB at the ends", low, high, "uT", holds))
        intervals: tuple[Interval, ...] = ()
        if first < len(values) - 1:
            intervals = ((float(values[first]), unstated.high),)
        claim.scans.append(Scan(unstated, name, intervals))


def youngs_moduli(case: Case) -> list[Claim]:
    soft = Claim("3.4.1, Fig. 4a", "the signal falls as E1 grows", "E2 = 1 MPa, as stated; up to E1 = 3 MPa.")
    lowest = Unstated("lowest E1", "MPa", 0.03, 3, 0.1, "the figure's range is not in the text: soft silicone to PDMS", _BASE, True)
    _trend(soft, case.changed({_MAGNET: "1 MPa"}), _BASE, lowest, 1e6, _magnitude, -1)

    stiff = case.changed({_BASE: "1 MPa"})
    lowest = Unstated("lowest E2", "MPa", 0.1, 10, 0.1, "the figure's range is not in the text: a tenth of E1 to ten times it", _MAGNET, True)
    magnitude = Claim(
        "3.4.1, Fig. 4a",
        "the signal |dB| grows with E2",
        "Where the magnet is softer than some 0.2 MPa it bends so far that dB_x has the other sign, and |dB| falls first.",
    )
    _trend(magnitude, stiff, _MAGNET, lowest, 1e6, _magnitude, 1)

    return [soft, magnitude, plateau(stiff)]


def plateau(case: Case) -> Claim:
    """How soon dB_x settles as E2 grows, from end to end of a range that the text does not state."""
    claim = Claim(
        "3.4.1, Fig. 4a",
        "dB_x grows with E2 and reaches a plateau",
        "A plateau: 95 % of the change from end to end by half of the upper end. Steep curves over a wide range of E2 have one, the "
        "part above 0.5 MPa alone has not.",
    )
    values = np.geomspace(0.1, 30, 4 * _COUNT)
    lowest = Unstated("lowest E2", "MPa", 0.1, 1, 0.1, "the figure's range is not in the text: a tenth of E1 to E1", _MAGNET, True)
    highest = Unstated("highest E2", "MPa", 2, 30, 10, "the figure's range is not in the text: twice to thirty times E1", _MAGNET, True)
    for pair in RODS:
        found = 1e6 * _x(_curve(case, _MAGNET, 1e6 * values, pair))
        name = str(pair)

        def settled(low: float, high: float) -> float:
            """E2 by which 95 % of the change has happened, over the upper end; NaN if it does not grow."""
            within = (values >= low) & (values <= high)
            x = np.concatenate([[low], values[within], [high]])
            y = np.interp(np.log(x), np.log(values), found)
            if not (np.diff(y[1:-1]) > 0).all():
                return math.nan
            return float(np.interp(y[0] + 0.95 * (y[-1] - y[0]), y, x)) / high

        ends = [float(np.interp(np.log(x), np.log(values), found)) for x in (lowest.used, highest.used)]
        claim.findings.append(in_range(f"{name}: dB_x over the range", ends, "uT"))
        at = settled(lowest.used, highest.used)
        claim.findings.append(in_range(f"{name}: 95 % by, of the upper end", at, "", 0, 0.5))
        claim.scans.append(scanned(lowest, name, lambda x: 0.5 - settled(x, highest.used)))
        claim.scans.append(scanned(highest, name, lambda x: 0.5 - settled(lowest.used, x)))
    return claim



def aspect_ratio(case: Case) -> Claim:
    claim = Claim(
        "3.4.2, Fig. 4b",
        "the signal grows with the aspect ratio (thinner cilia)",
        "E1 = 0.5, E2 = 1 MPa, as stated; up to d = 5 mm. Thinner cilia than the holding ones slip off at 1 mN.",
    )
    thinnest = Unstated("thinnest d", "mm", 1, 5, 1.5, "the figure's range is not in the text: L0/d of 20 to 4", "cilium.diameter")
    _trend(claim, case, "cilium.diameter", thinnest, 1e-3, _magnitude, -1)
    return claim


def _peak(case: Case, pair: Pair) -> float:
    """L2/L0 of the largest |dB|: the best of a grid, then by Brent's method beside it."""

    def signal(values: Iterable[float]) -> Array:
        return np.nan_to_num(_magnitude(_curve(case, _PROPORTION, values, pair)))

    grid = np.linspace(0.05, 0.99, 48)
    of_grid = signal(grid)
    best = int(np.argmax(of_grid))
    if best in (0, len(grid) - 1):
        return math.nan  # no peak
    around = (grid[best - 1], grid[best + 1])
    found = minimize_scalar(lambda x: -signal([x])[0], bounds=around, method="bounded", options={"xatol": 1e-5})
    return float(found.x)


def proportion(case: Case, setting: Setting) -> list[Claim]:
    peak = Claim(
        "3.4.3, Fig. 4c",
        "the signal has its peak at L2/L0 = 0.7 to 0.9",
        "\"Approximately 0.7 to 0.9\" is met from 0.65 to 0.95. \"Other parameters as above\": E1 = 0.5, E2 = 1 MPa of 3.4.2.",
    )
    used = case.cilium.segments[0].young_modulus
    numbers = [
        Unstated("E1", "MPa", 0.1, 1, 1e-6 * used, "\"as above\" may be 0.5 MPa (3.4.2) or 1 MPa (3.4.1); 3.2 has 0.1", _BASE, True),
        Unstated("E2", "MPa", 0.5, 10, 1, "\"as above\" is 1 MPa (3.4.1, 3.4.2); 3.2 has 3", _MAGNET, True),
    ]  # fmt: skip
    for pair in RODS:
        peak.findings.append(in_range(f"{pair}: peak at", _peak(case, pair), "", *_PEAK, 1e-4))

        for number in numbers:

            def margin(x: float) -> float:
                at = _peak(case.changed({number.path: 1e6 * x}), pair)
                return min(at - _PEAK[0], _PEAK[1] - at)

            peak.scans.append(scanned(number, str(pair), margin))
    if setting.with_solid:
        # About the peaks of the rods: elsewhere these have shown that there is none.
        grid = np.arange(0.84, 0.945, 0.01)
        signal = _of_solid(case, grid, setting)
        best = int(np.argmax(signal))
        at, off = grid[best], math.nan
        if 0 < best < len(grid) - 1:
            a, b, c = signal[best - 1 : best + 2]
            at, off = grid[best] + 0.005 * (a - c) / (a - 2 * b + c), 0.01
        peak.findings.append(in_range("solid/mesh: peak at", at, "", *_PEAK, off))

    return [peak, *mechanisms(case)]


def mechanisms(case: Case) -> list[Claim]:
    """Why the signal falls towards L2/L0 = 1: what the tip turns, and the signal for each degree."""
    compliance = Claim(
        "3.4.3",
        "towards L2/L0 = 1 the lost compliance costs signal",
        "Rotation at 1 mN of the magnet's foot, where the base ends, and of the tip: L2/L0 = 0.95 over 0.8.",
    )
    distance = Claim(
        "3.4.3",
        "towards L2/L0 = 1 the magnet is too close: small displacements make smaller changes",
        "|dB| for each degree of rotation over its largest at a smaller L2/L0: 1 while it grows, and then the lost compliance alone "
        "makes the peak. The tip turns with the magnet's own bending, too, which moves its near end little.",
        differ_by="what counts as displacement",
    )
    largest = Unstated(
        "largest L2/L0", "", 0.9, 0.99, 0.95, "the figure's range is not in the text; at 0.95 the base is a disc of 1 mm", _PROPORTION
    )
    values = np.union1d(np.linspace(0.1, 0.99, 90), [0.8, largest.used])
    near, far = (int(np.argmin(np.abs(values - x))) for x in (0.8, largest.used))
    cilia = _designs(case, _PROPORTION, values)
    turned = {}
    for mechanics in ("elastica", "beam"):
        shapes = [bend(cilium, case.loads[0], mechanics) for cilium in cilia]
        feet = [float(np.interp(s.cilium.segments[0].length, s.S, s.theta)) for s in shapes]
        turned[mechanics] = {"foot": np.abs(feet), "tip": np.abs([s.tip_angle for s in shapes])}
        for place, angle in turned[mechanics].items():
            compliance.findings.append(in_range(f"{mechanics}: {place}", angle[far] / angle[near], "", 0, 0.95))
    for pair in RODS:
        signal = _magnitude(_curve(case, _PROPORTION, values, pair))
        for place, angle in turned[pair.mechanics].items():
            per_degree = signal / angle
            of_largest = per_degree / np.maximum.accumulate(per_degree)
            name = f"{pair}: per degree of the {place}"
            distance.findings.append(in_range(name, of_largest[far], "", 0, 0.999))
            distance.scans.append(
                scanned(largest, name, lambda x: 0.999 - float(np.interp(x, values, of_largest)))
            )
    return [compliance, distance]


def _of_solid(case: Case, proportions: Array, setting: Setting) -> Array:
    """|dB| by solid/mesh at 1 mN, T."""
    found = []
    for x in proportions:
        design = case.changed({_PROPORTION: float(x)})
        design.mechanics = ["solid"]

        def signal() -> float:
            shape = bend(design.cilium, design.loads[0], "solid")
            return float(np.linalg.norm(shape.dB(design.sensors[:1], "mesh")[0]))

        found.append(solved(design, setting, signal))
    return np.array(found)
