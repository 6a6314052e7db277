# SPDX-License-Identifier: LGPL-2.1-or-later
"""A statement of the paper, what the models find for it, and what its verdict hangs on."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array

Interval = tuple[float, float]

REPRODUCED = "reproduced"
NOT_REPRODUCED = "not reproduced"
DEPENDS_ON = "depends on "
NOT_CHECKABLE = "not checkable"

SOLID = 5, 40  # the fineness of a scan by the solid, which takes seconds a value


@dataclass(frozen=True)
class Finding:
    """Finding of one pair of models (or one measure): a value or its range over the loads.

    uncertainty: half-width that each end may be off by, where it is known. holds: whether the claim
    does; None: the uncertainty decides nothing.
    """

    models: str
    low: float
    high: float
    unit: str = ""
    holds: bool | None = None
    uncertainty: float = 0.0


def in_range(
    models: str,
    values: float | Iterable[float],
    unit: str,
    at_least: float = -math.inf,
    at_most: float = math.inf,
    uncertainty: float = 0.0,
) -> Finding:
    """A finding whose values must all lie in [at_least, at_most]: it holds if they do with their
    uncertainty, fails if they do not even so, and is undecided between, or if the uncertainty is not
    known (NaN). A value that is NaN fails."""
    all_of = np.atleast_1d(np.asarray(values, dtype=float))
    low, high = float(np.min(all_of)), float(np.max(all_of))
    holds: bool | None = None
    if math.isnan(uncertainty):
        pass  # not known: nothing is decided
    elif low - uncertainty >= at_least and high + uncertainty <= at_most:
        holds = True
    elif not (low + uncertainty >= at_least and high - uncertainty <= at_most):
        holds = False
    return Finding(models, low, high, unit, holds, uncertainty)


@dataclass(frozen=True)
class Unstated:
    """A number on which a claim hangs and that the paper does not state for it.

    low, high: the scanned range, in `unit`; reason: why this range. used: the ledger's own value.
    path: that of the case's number, if it is one.
    """

    name: str
    unit: str
    low: float
    high: float
    used: float
    reason: str
    path: str = ""
    is_logarithmic: bool = False

    def values(self, count: int) -> Array:
        """`count` values of the range, evenly spaced, with the one that is used."""
        space: Any = np.geomspace if self.is_logarithmic else np.linspace
        return np.union1d(space(self.low, self.high, count), [self.used])


@dataclass(frozen=True)
class Scan:
    """Part of the range of an unstated number in which a claim holds by one pair of models: closed intervals, in the
    number's unit."""

    of: Unstated
    models: str
    holds: tuple[Interval, ...]

    @property
    def is_everywhere(self) -> bool:
        return self.holds == ((self.of.low, self.of.high),)


def scanned(
    unstated: Unstated,
    models: str,
    margin: Callable[[float], float],
    fineness: tuple[int, int] = (9, 400),
) -> Scan:
    """Scans a claim that holds where `margin` is not negative.

    fineness: at how many values at first; then, where that changes from one value to the next, the
    change is found by bisection to one of so many parts of the range. NaN (no equilibrium) is no
    margin: it does not hold there. `margin` of a float is a float.
    """
    coarse, parts = fineness
    values = list(unstated.values(coarse))
    marks = [margin(float(x)) >= 0 for x in values]
    resolution = (unstated.high - unstated.low) / parts
    edges: list[float] = []  # where it begins and ends to hold, in turn
    if marks[0]:
        edges.append(values[0])
    for a, b, before, after in zip(values, values[1:], marks, marks[1:]):
        if before == after:
            continue
        while b - a > resolution:
            middle = math.sqrt(a * b) if unstated.is_logarithmic else (a + b) / 2
            if (margin(middle) >= 0) == before:
                a = middle
            else:
                b = middle
        edges.append(a if before else b)  # a value where it does hold
    if marks[-1]:
        edges.append(values[-1])
    return Scan(unstated, models, tuple(zip(edges[::2], edges[1::2])))


@dataclass
class Claim:
    """A statement of the paper that can be checked, or why it cannot.

    place: "3.3, Fig. 3d". statement: in a few words, with the paper's figure. differ_by: what tells
    the findings apart if not the model.
    """

    place: str
    statement: str
    note: str = ""
    findings: list[Finding] = field(default_factory=list)
    scans: list[Scan] = field(default_factory=list)
    differ_by: str = "the model"

    @property
    def hangs_on(self) -> list[str]:
        """Conditions of the verdict: unstated numbers in a part of whose range the claim holds, and the models if they
        disagree; empty if nothing changes it."""
        names = [scan.of.name for scan in self.scans if scan.holds and not scan.is_everywhere]
        decided = [f.holds for f in self.findings if f.holds is not None]
        whole = [bool(scan.holds) for scan in self.scans if not scan.holds or scan.is_everywhere]
        if len(set(decided)) > 1 or (not names and len({*decided, *whole}) > 1):
            names.append(self.differ_by)
        return list(dict.fromkeys(names))

    @property
    def verdict(self) -> str:
        if all(f.holds is None for f in self.findings):
            return NOT_CHECKABLE
        if self.hangs_on:
            return DEPENDS_ON + " and ".join(self.hangs_on)
        return REPRODUCED if any(f.holds for f in self.findings) else NOT_REPRODUCED

    def json(self) -> dict[str, Any]:
        """Claim as `claims --json` writes it: docs/guide/validation.md."""
        entries = [
            {
                "parameter": scan.of.name,
                "path": scan.of.path or None,
                "unit": scan.of.unit,
                "models": scan.models,
                "scanned": [scan.of.low, scan.of.high],
                "holds": [list(interval) for interval in scan.holds],
                "used": scan.of.used,
                "reason": scan.of.reason,
            }
            for scan in self.scans
        ]
        names = self.hangs_on
        depends_on: list[dict[str, Any]] = [e for e in entries if e["parameter"] in names]
        if self.differ_by in names:
            choices = [f.models for f in self.findings]
            holding = [f.models for f in self.findings if f.holds]
            depends_on.append({"parameter": self.differ_by, "unit": None, "scanned": choices, "holds": [holding]})
        others = [e for e in entries if e["parameter"] not in names]
        return {
            "place": self.place,
            "statement": self.statement,
            "verdict": self.verdict,
            "note": self.note or None,
            "findings": [
                {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in vars(f).items()}
                for f in self.findings
            ],
            "depends_on": depends_on,
            "holds_throughout": [e for e in others if e["holds"]],
            "holds_nowhere": [e for e in others if not e["holds"]],
        }


def value_text(finding: Finding) -> str:
    """ "6.1 to 7.9 +- 0.2 %" """
    low, high = f"{finding.low:.4g}", f"{finding.high:.4g}"
    text = low if low == high else f"{low} to {high}"
    if math.isnan(finding.uncertainty):
        text += " +- not known"
    elif finding.uncertainty > 0:
        text += f" +- {finding.uncertainty:.2g}"
    return f"{text} {finding.unit}".rstrip()


def scan_text(scan: Scan) -> str:
    """ "sensor z, elastica: holds in -3.01 to -2.55 mm of -4 to -1 mm" """
    of = scan.of
    where = ", ".join(f"{a:.3g} to {b:.3g}" for a, b in scan.holds)
    unit = f" {of.unit}" if of.unit else ""
    found = "holds throughout" if scan.is_everywhere else f"holds in {where}{unit}" if where else "holds nowhere"
    return f"{of.name}, {scan.models}: {found} of {of.low:g} to {of.high:g}{unit}"


def ledger_text(claims: Sequence[Claim], width: int = 80) -> str:
    """The ledger for a terminal of this many columns."""

    def wrapped(text: str, indent: str) -> list[str]:
        return textwrap.wrap(text, width, initial_indent=indent, subsequent_indent=indent + "  ")

    holds = {None: "undecided", True: "yes", False: "no"}
    lines = []
    counts = dict.fromkeys([REPRODUCED, NOT_REPRODUCED, DEPENDS_ON, NOT_CHECKABLE], 0)
    for claim in claims:
        counts[DEPENDS_ON if claim.verdict.startswith(DEPENDS_ON) else claim.verdict] += 1
        lines += [*wrapped(f"{claim.place}: {claim.statement}", ""), f"  -> {claim.verdict}"]
        rows = [(f.models, value_text(f), holds[f.holds]) for f in claim.findings]
        widths = [max((len(row[i]) for row in rows), default=0) for i in range(2)]
        lines += [f"    {a:{widths[0]}}  {b:{widths[1]}}  {c}" for a, b, c in rows]
        for scan in claim.scans:
            lines += wrapped(f"over {scan_text(scan)}", "    ")
        reasons = dict.fromkeys(f"{s.of.name}: {s.of.reason}." for s in claim.scans)
        for text in [*reasons, claim.note]:
            lines += wrapped(text, "     ")
        lines.append("")
    lines += wrapped(
        f"{len(claims)} claims: {counts[REPRODUCED]} reproduced, {counts[NOT_REPRODUCED]} not reproduced, "
        f"{counts[DEPENDS_ON]} depend on what is not stated or on the model, {counts[NOT_CHECKABLE]} not checkable",
        "",
    )
    return "\n".join(lines)
