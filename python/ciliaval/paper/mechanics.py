# SPDX-License-Identifier: LGPL-2.1-or-later
"""Claims of the paper on its materials, equations and model of the mechanics (2, 3.2)."""

from __future__ import annotations

import math

import numpy as np
from scipy.constants import mu_0

from ..errors import SolverError
from ..model import Case, bend
from ..results import Result
from .cases import Setting, at_rest, solved
from .claim import SOLID, Claim, Finding, Unstated, in_range, scanned
from .equations import printed_fields

_R2 = 0.99


def mechanics_claims(case: Case, result: Result, setting: Setting) -> list[Claim]:
    """case: fig3d's, result: of its run with the paper's two models of the field."""
    return [
        intractable(result),
        powder(case),
        base_bends(case),
        misprints(case),
        shapes(case, result, setting),
        orders(case),
    ]


def intractable(result: Result) -> Claim:
    claim = Claim("1, 2.2", "finite elements are computationally intractable here")
    counts = []
    for model in result.models:
        if model == "elastica":
            continue
        steps = [step["mechanics"][model] for step in result.steps]
        solved = sum(step["status"] == "converged" for step in steps)
        claim.findings.append(in_range(f"{model}: loads solved of {len(steps)}", solved, "", 0, 0))
        counts.append(
            f"{model}: {steps[0]['unknowns']} unknowns, {sum(s['iterations'] for s in steps)} iterations of Newton"
        )
    claim.note = "; ".join(counts) + ". Wall times are in docs/measurements.md; no verdict hangs on them."
    return claim


def powder(case: Case) -> Claim:
    """Table 1 in itself, and beside the magnetisation of 3.4.1."""
    B_r, energy, coercivity = (0.838, 0.878), (105e3, 117e3), (710e3, 780e3)  # T, J/m^3, A/m
    other_units = [(8.38, 8.78), (13.2, 14.7), (8.9, 9.8)]  # kG, MGOe, kOe
    sizes = [0.1, 1e5 / (4 * math.pi), 1e6 / (4 * math.pi)]  # SI values of these units
    off = [
        100 * abs(here / (there * size) - 1)
        for si, others, size in zip((B_r, energy, coercivity), other_units, sizes)
        for here, there in zip(si, others)
    ]
    M = case.cilium.segments[-1].magnetization
    parts = [100 * M * mu_0 / B for B in B_r]
    by_weight = [100 / (1 + (100 / p - 1) * 1.03 / 7.6) for p in parts]  # PDMS 1.03, NdFeB 7.6 g/cm^3
    claim = Claim("2.1, Table 1; 3.4.1", "the powder's data agree with themselves and with M = 75 kA/m")
    claim.findings = [
        in_range("second column off the first", off, "%", 0, 1),
        in_range("W over its bound B_r^2/(4 mu_0)", [w / (B**2 / (4 * mu_0)) for w, B in zip(energy, B_r)], "", 0, 1),
        in_range("M mu_0/B_r: powder by volume", parts, "%", 0, 60),
    ]
    claim.note = (
        f"Saturated, aligned powder of {min(parts):.1f} to {max(parts):.1f} % by volume, some {np.mean(by_weight):.0f} % "
        "by weight, has this magnetisation; isotropic powder takes twice as much. A fraction that can be cast is at most some 60 %."
    )
    return claim


def base_bends(case: Case) -> Claim:
    claim = Claim(
        "2.2, 3.2",
        "deformation is predominantly in the non-magnetic base",
        "Share of the tip's rotation that the base makes.",
    )
    length = case.cilium.segments[0].length
    for model in case.mechanics:
        shares, off = [], 0.0
        for shape in bend(case.cilium, case.loads, model):
            if shape.status != "converged":
                raise SolverError(f"claims: {case.name}: {model}: {shape.message}")
            share = 100 * float(np.interp(length, shape.S, shape.theta)) / shape.tip_angle
            # Either angle may be off by as much, in proportion.
            off = float(np.maximum(off, 2 * share * _known(shape.tip_angle_uncertainty) / abs(shape.tip_angle)))
            shares.append(share)
        claim.findings.append(in_range(model, shares, "%", 50, 100, off))
    return claim


def misprints(case: Case) -> Claim:
    claim = Claim(
        "2.2.2, Eq. 6, 8",
        "Eq. 6 and 8 to the letter are the field of Eq. 5",
        "1/cos is once too many in y and z of Eq. 6 and in all of Eq. 8, as Eq. 5 shows. Our source is a text "
        "extracted from the paper: the misprint may be the extraction's.",
    )
    first, last = case.loads[0], case.loads[-1]
    shapes = bend(case.cilium, [at_rest(first), first, last], "elastica")
    straight, *bent = (printed_fields(shape, case.sensors[0]) for shape in shapes)
    for shape, fields in zip(shapes[1:], bent):
        force = 1e3 * shape.load.parameters["force"]
        for equation, printed, meant, rest in (
            ("Eq. 6", fields.line_printed, fields.line, straight.line),
            ("Eq. 8", fields.volume_printed, fields.volume, straight.volume),
        ):
            off = 100 * float(np.linalg.norm(printed - meant) / np.linalg.norm(meant - rest))
            claim.findings.append(Finding(f"{equation} off by, of |dB| at {force:g} mN", off, off, "%", False))
    return claim


def orders(case: Case) -> Claim:
    base, magnet = case.cilium.segments[0].young_modulus, case.cilium.segments[-1].young_modulus
    claim = Claim("3.2", "E = 0.1 and 3 MPa differ by approximately two orders of magnitude")
    claim.findings = [in_range("log10 of the ratio", math.log10(magnet / base), "", 1.5, 2.5)]
    claim.note = "Both moduli are stated; \"two\" is met from 1.5 on."
    return claim


def shapes(case: Case, result: Result, setting: Setting) -> Claim:
    """R2 between the shapes of the elastica and of finite elements, and over what Fig. 3b does not
    state."""
    claim = Claim(
        "abstract, 3.2, Fig. 3b",
        "deformation agrees with finite elements, R2 > 0.99",
        "R2 is not defined in the paper: 1 - SSE/SST of w(z), and the squared correlation, which is blind to a factor. "
        "Over L1/d the total length stays; of the loads those that the cilium bears.",
    )
    references = [model for model in case.mechanics if model != "elastica"]
    for reference in references:
        r2, by_correlation = _agreement(result, reference)
        claim.findings += [
            in_range(f"elastica - {reference}: 1 - SSE/SST", r2[0], "", _R2, math.inf, r2[1]),
            in_range(f"elastica - {reference}: squared correlation", by_correlation[0], "", _R2, math.inf, by_correlation[1]),
        ]
    diameter = case.cilium.diameter
    length = case.cilium.length
    unstated = [
        Unstated("Poisson ratio", "", 0.3, 0.495, case.cilium.segments[0].poisson_ratio,
                 "not in the paper; a finite-element program's default is 0.3, rubber has 0.45 to 0.4999",
                 "cilium.segment.*.poisson_ratio"),
        Unstated("L1/d", "", 0.5, 3, case.cilium.segments[0].length / diameter,
                 "Fig. 3b states no size; 3.4.1 has 1 for Fig. 4", "cilium.segment.base.length"),
    ]  # fmt: skip
    for reference in references:
        for number in unstated:

            def margin(x: float) -> float:
                if number.name == "L1/d":
                    values = {"base.length": x * diameter, "magnet.length": length - x * diameter}
                else:
                    values = {"base.poisson_ratio": x, "magnet.poisson_ratio": x}
                other = case.changed({f"cilium.segment.{k}": v for k, v in values.items()})
                other.mechanics, other.fields = ["elastica", reference], ["line"]
                of_loads = solved(other, setting, lambda: _r2_of(other, reference))
                return min(of_loads, default=math.nan) - _R2

            found = scanned(number, f"elastica - {reference}", margin, *([SOLID] if reference == "solid" else []))
            claim.scans.append(found)
    return claim


def _known(uncertainty: float | None) -> float:
    """NaN if it is not known."""
    return math.nan if uncertainty is None else uncertainty


def _r2_of(case: Case, reference: str) -> list[float]:
    return [float(x) for x in _agreement(case.run(), reference)[0][0]]


def _agreement(result: Result, reference: str) -> tuple[tuple[list[float], float], tuple[list[float], float]]:
    """R2 = 1 - SSE/SST and the squared correlation over the loads, each with how far it may be off.

    w(z) may be off by u everywhere: the misfit by u, R2 = 1 - (misfit/deviation)^2 by as much as that
    makes of it; of the correlation the misfit is that of the best line.
    """
    r2, correlation, off, off_correlation = [], [], 0.0, 0.0
    for entry in result.summary["comparisons"]:
        pair = (entry["model"], entry["reference"])
        if entry["statistic"] != "r2" or pair != ("elastica", reference) or entry["r2"] is None:
            continue
        u = _known(entry["uncertainty"]) / entry["scale"]
        r2.append(entry["r2"])
        correlation.append(entry["correlation"])
        misfit = entry["difference"] / entry["scale"]
        off = float(np.maximum(off, u * (2 * misfit + u)))
        off_by_line = u * (2 * math.sqrt(max(1 - entry["correlation"], 0)) + u)
        off_correlation = float(np.maximum(off_correlation, off_by_line))
    return (r2, off), (correlation, off_correlation)
