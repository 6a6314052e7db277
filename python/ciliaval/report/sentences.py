# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings of a case, in five sentences made from its numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..plot.style import best_first
from ..results import Result
from ..units import describe_load, number, percent, quantity


# The paper's own: elastica and dipoles along the centreline, as at the head of an error budget.
PAPER = "elastica/line"


def findings(result: Result) -> list[str]:
    """Signal; range; the paper's model against the best; what the difference comes from; what may
    be trusted. A sentence that the results do not support is left out."""
    best = best_first(result.models)[0]
    makers = [_signal(result, best), _range(result), _paper(result), _cause(result), _trust(result)]
    return [sentence for sentence in makers if sentence]


def _last(result: Result, model: str) -> int | None:
    """The last step at which a model has a shape."""
    known = [i for i, status in enumerate(result.status(model)) if status == "converged"]
    return known[-1] if known else None


def _signal(result: Result, best: str) -> str:
    step = _last(result, best)
    if step is None:
        return f"The {best} has no equilibrium at any load step."
    tip = result.tip(best)[step]
    pairs = [p for p in best_first(result.pairs) if p.split("/", 1)[0] == best]
    if result.loads[0]["type"] == "sweep":
        way = result.load("travel")
        text = f"While the surface travels {quantity(way.max() - way.min(), 'm')}, the tip stays within "
        x = result.tip(best)[:, 0]
        text += f"{quantity(np.nanmin(x), 'm')} and {quantity(np.nanmax(x), 'm')} ({best})"
        if pairs:
            norm = np.linalg.norm(result.dB(pairs[0])[:, 0], axis=1)
            low, high = np.nanmin(norm), np.nanmax(norm)
            text += f" and |ΔB| at the first sensor between {quantity(low, 'T')} and "
            text += f"{quantity(high, 'T')} ({pairs[0]})"
        return text + "."
    deflection = float(np.hypot(tip[0], tip[1]))
    text = f"Under {describe_load(result.loads[step], result.environments[step])}, the tip moves aside by "
    text += f"{quantity(deflection, 'm')} ({best})"
    if pairs:
        changes = np.linalg.norm(result.dB(pairs[0])[step], axis=1)
        each = [
            f"{quantity(change, 'T')} at sensor {name}"
            for name, change in zip(result.sensor_names, changes)
        ]
        text += f" and the field changes by |ΔB| = {', '.join(each)} ({pairs[0]})"
    return text + "."


def _range(result: Result) -> str:
    for model in best_first(result.models):
        limits = [s["mechanics"].get(model, {}).get("slip_off_force") for s in result.steps]
        known = [limit for limit in limits if limit is not None]
        if known:
            band = result.band(model, "slip_off")[limits.index(known[-1])]
            within = f" ± {percent(band / known[-1], 2)}" if np.isfinite(band) and known[-1] else ""
            text = f"The contact slips off the tip at {quantity(known[-1], 'N')}{within} ({model})"
            largest = max(float(load.get("force") or 0) for load in result.loads)
            if largest:
                text += f", {number(known[-1] / largest, 1, 3)} times the largest load here"
            return f"{text}.{_slip_off_points(result)}"
    if result.loads[0]["type"] == "sweep":
        jumps = {m: sum("jump" in s["mechanics"].get(m, {}) for s in result.steps) for m in result.models}
        each = ", ".join(f"{count} by the {m}" for m, count in jumps.items())
        return f"Jumps from one equilibrium to another along the way: {each}."
    count = len(result.steps)
    solved = sum(status == "converged" for m in result.models for status in result.status(m))
    if solved == count * len(result.models):
        return "No model reaches the end of its range in these load steps."
    return f"{count * len(result.models) - solved} of the models' load steps have no equilibrium."




def _slip_off_points(result: Result) -> str:
    """Sentence on slip-off where the models do not judge by one point of the tip."""
    points: dict[str, str] = {}
    for step in result.steps:
        points |= {m: at for m, entry in step["mechanics"].items() if (at := entry.get("slip_off_at"))}
    if len(set(points.values())) < 2:
        return ""
    by = {at: ", ".join(m for m in points if points[m] == at) for at in sorted(set(points.values()))}
    return (
        f" It is where the tip of the axis comes down to the contact height for {by['axis']}, and where the rim of the "
        f"end face does for {by['rim']}: ranges to compare need slip_off = \"rim\" in [load]."
    )


def _paper(result: Result) -> str:
    """The paper's model against the one that leaves out least."""
    order = best_first(result.models)
    step = _last(result, order[0])
    if step is None or len(order) < 2:
        return ""
    parts = []
    tips = _deflections(result, step)
    if order[-1] in tips and tips.get(order[0]):
        by = tips[order[-1]] / tips[order[0]] - 1
        verdict = _verdict(result, step, order[-1], order[0])
        word = "further" if by > 0 else "less"
        parts.append(f"bends {percent(abs(by))} {word} than the {order[0]} ({verdict})")
    signals = _signals(result, step)
    first, last = _ends(result)
    if first != last and signals.get(first) and last in signals:
        by = signals[last] / signals[first] - 1
        word = "more" if by > 0 else "less"
        parts.append(f"with its field, {last}, reads {percent(abs(by))} {word} |ΔB| than {first}")
    return f"The {order[-1]} {' and, '.join(parts)}." if parts else ""


def _ends(result: Result) -> tuple[str, str]:
    """The pair that leaves out least, and the paper's or else the one that leaves out most."""
    pairs = best_first(result.pairs) or [""]
    return pairs[0], PAPER if PAPER in pairs else pairs[-1]


def _cause(result: Result) -> str:
    """Sentence on the shares of bending and field model in the difference in |ΔB|."""
    step = _last(result, best_first(result.models)[0])
    if len(result.pairs) < 3 or step is None:
        return ""
    signals = _signals(result, step)
    first, last = _ends(result)
    between = f"{first.split('/', 1)[0]}/{last.split('/', 1)[1]}"
    if between in (first, last) or any(p not in signals for p in (first, last, between)):
        return ""
    scale = signals[first]
    bending = (signals[last] - signals[between]) / scale
    field = (signals[between] - scale) / scale
    return (
        f"Of this difference in |ΔB| the bending model makes {percent(bending)} "
        f"({last} less {between}) and the field model {percent(field)} ({between} less {first})."
    )


def _trust(result: Result) -> str:
    verdicts = Counter(c.verdict.replace(" ", "_") for c in result.comparisons)
    model = best_first(result.models)[0]
    step = _last(result, model)
    parts = []
    if step is not None:
        parts += _of_the_tip(result, model, step) + _of_the_signal(result, step)
    total = sum(verdicts.values())
    if total:
        parts.append(
            f"of {total} differences between models {verdicts['resolved']} are larger than the "
            f"numerical errors, {verdicts['below_uncertainty']} smaller, and for "
            f"{verdicts['inconclusive']} the error is not known"
        )
    return " ".join(f"{part[:1].upper()}{part[1:]}." for part in parts)


def _of_the_tip(result: Result, model: str, step: int) -> list[str]:
    """Sentence on the tip's band and the largest part of it."""
    x, y, _ = result.tip(model)[step]
    size = float(np.hypot(x, y))
    if size == 0:
        return []
    u, left_out, inputs, band = (
        float(values[step])
        for values in (result.tip_uncertainty(model), result.model_uncertainty(model), result.input_uncertainty(model),
                       result.band(model))
    )  # fmt: skip
    text = f"the tip of the {model} is known to"
    if np.isfinite(band):
        # A corrected rod's numerical error has what its corrections are uncertain by, so its model part is the first.
        parts = {"what the rod leaves out": left_out, "its inputs": 1.96 * float(np.nan_to_num(inputs)), "its numerical error": u}
        share = max(parts, key=lambda part: parts[part])
        return [f"{text} ± {percent(band / size, 2)} of its deflection at 95 %, most of it {share}"]
    if np.isnan(u):
        return [f"the numerical error of the {model} is not known"]
    return [f"{text} {percent(u / size, 2)} of its deflection but for what the model leaves out, which is not known"]


def _of_the_signal(result: Result, step: int) -> list[str]:
    """The largest component of dB by the best pair, its band and what makes most of it."""
    pair = next(iter(best_first(result.pairs)), "")
    if not pair or not np.isfinite(result.dB_band(pair)[step]).any():
        return []
    dB, band = result.dB(pair)[step], result.dB_band(pair)[step]
    at = np.unravel_index(np.argmax(np.where(np.isfinite(band), np.abs(dB), -1)), dB.shape)
    inputs = result.steps[step]["fields"][pair].get("dB_input_contributions", [])
    parts = {
        "what the models leave out": float(result.dB_model_uncertainty(pair)[step][at]),
        "numerical errors": float(result.dB_uncertainty(pair)[step][at]),
        **{path: 1.96 * abs(rows[at[0]][at[1]]) for path, rows in zip(result.summary.get("inputs", []), inputs)},
    }
    share = max(parts, key=lambda part: parts[part])
    sensor = f" at sensor {result.sensor_names[at[0]]}" if len(dB) > 1 else ""
    places = max(0, 1 - math.floor(math.log10(max(1e6 * band[at], 1e-12))))  # two digits of the band
    value, spread, most = (f"{1e6 * x:.{places}f}" for x in (float(dB[at]), float(band[at]), parts[share]))
    return [f"ΔB_{'xyz'[at[1]]}{sensor} is {value} ± {spread} µT at 95 % ({pair}), {most} of it from {share}"]


def _deflections(result: Result, step: int) -> dict[str, float]:
    tips = {m: result.tip(m)[step] for m in result.models}
    return {m: float(np.hypot(t[0], t[1])) for m, t in tips.items() if np.isfinite(t).all()}


def _signals(result: Result, step: int) -> dict[str, float]:
    """|ΔB| at the first sensor."""
    all_of = {p: float(np.linalg.norm(result.dB(p)[step, 0])) for p in result.pairs}
    return {p: value for p, value in all_of.items() if np.isfinite(value) and value > 0}


def _verdict(result: Result, step: int, model: str, reference: str) -> str:
    found = result.compare(quantity="tip", step=step, model=model, reference=reference)
    found = found or result.compare(quantity="centreline", step=step, model=model, reference=reference)
    verdicts = {c.verdict.replace("_", " ") for c in found if c.relative}
    for verdict in ("inconclusive", "resolved", "below uncertainty"):
        if verdict in verdicts:
            return verdict
    return "not compared"


def remarks(result: Result) -> Iterator[str]:
    """Remarks of the models beside their numbers, each once with its steps."""
    found: dict[str, list[int]] = {}
    for i, step in enumerate(result.steps):
        entries: list[tuple[str, dict[str, Any]]] = [*step["mechanics"].items(), *step["fields"].items()]
        for name, entry in entries:
            message = entry.get("message") or ""
            status = entry.get("status")
            limit = entry.get("slip_off_force")
            if status == "slipped_off" and not message and limit is not None:
                message = f"slips off above {quantity(limit, 'N')}"
            elif status == "failed":
                message = f"failed: {message}"
            if message:
                found.setdefault(f"{name}: {message}", []).append(i + 1)
    for text, steps in found.items():
        shown = [str(s) for s in steps[:8]] + (["…"] if len(steps) > 8 else [])
        yield f"load step{'s' if len(steps) > 1 else ''} {', '.join(shown)}: {text}"
