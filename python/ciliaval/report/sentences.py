# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings of a case, in at most five sentences made from its numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..plot.style import best_first
from ..results import Result
from ..units import describe_load, in_words, number, percent, quantity


# The paper's own: elastica and dipoles along the centreline, as at the head of an error budget.
PAPER = "elastica/line"


def findings(result: Result) -> list[str]:
    """At most five sentences: what was run; where the models agree, and where they differ; what may be
    trusted; what to look at. One that the results do not support is left out."""
    best = best_first(result.models)[0]
    said = [_signal(result, best), *_spreads(result, best), _trust(result, best), _with_touch(result, _look(result))]
    return [sentence for sentence in said if sentence]


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
        each = [f"{quantity(change, 'T')} at sensor {name}" for name, change in zip(result.sensor_names, changes)]
        few = each if len(each) < 3 else [f"{each[int(np.argmax(changes))]}, the largest of {len(each)}"]
        text += f" and the field changes by |ΔB| = {' and '.join(few)} ({pairs[0]})"
    return text + "."


def _spreads(result: Result, best: str) -> list[str]:
    """How far the bending models are from the best one in the tip's deflection, and the field models in |ΔB| at the
    first sensor with the same bending: the smaller one first. With it the paper's pair against the best."""
    step = _last(result, best)
    if step is None:
        return []
    found: list[tuple[float, str]] = []
    tips, signals = _deflections(result, step), _signals(result, step)
    if by := {m: tips[m] / tips[best] - 1 for m in tips if m != best and tips[best]}:
        m = max(by, key=lambda m: abs(by[m]))
        text = f"the tip of the {m} moves {_word(by[m])} than that of the {best} ({_verdict(result, step, m, best)})"
        found.append((abs(by[m]), f"The bending models {_agree(by[m])}: {text}"))
    first, paper = _ends(result)
    if by := {p: signals[p] / signals[first] - 1 for p in signals if p != first and p.startswith(f"{best}/") and first in signals}:
        p = max(by, key=lambda p: abs(by[p]))
        text = f"{p} reads {_word(by[p])} |ΔB| than {first}"
        found.append((abs(by[p]), f"The field models {_agree(by[p])}: {text}"))
    said = [text for _, text in sorted(found)]
    if len(said) == 2 and paper.split("/")[0] != best and paper in signals and first in signals:
        total = signals[paper] / signals[first] - 1
        said[1] += f", and with both differences {paper} reads {percent(abs(total))} {_word(total)} |ΔB|"
    return [f"{text}." for text in said]


def _word(by: float) -> str:
    return "more" if by > 0 else "less"


def _agree(by: float) -> str:
    return f"{'agree within' if abs(by) < 0.05 else 'differ by up to'} {_size(abs(by))}"


def _size(part: float) -> str:
    """In %, of what is next to nothing an upper bound."""
    return percent(part) if part >= 1e-5 else percent(1e-5)


def _ends(result: Result) -> tuple[str, str]:
    """The pair that leaves out least, and the paper's or else the one that leaves out most."""
    pairs = best_first(result.pairs) or [""]
    return pairs[0], PAPER if PAPER in pairs else pairs[-1]


def _trust(result: Result, best: str) -> str:
    step = _last(result, best)
    parts = [] if step is None else [*_of_the_tip(result, best, step), *_of_the_signal(result, step)]
    text = "; ".join(parts)
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def _look(result: Result) -> str:
    """Where on the page the case has most to say."""
    statuses = [status for m in result.models for status in result.status(m)]
    lost = sum(status != "converged" for status in statuses)
    jumps = {m: sum("jump" in s["mechanics"].get(m, {}) for s in result.steps) for m in result.models}
    if lost:
        return f"Look at the remarks: {lost} of the models' {len(statuses)} load steps have no equilibrium."
    if result.validation is not None:
        of = result.validation.series
        seen, values = sum(s.bounded for s in of), sum(s.assessed for s in of)
        return f"Look at what was measured: the models' errors are seen at {seen} of {values} values."
    if any(jumps.values()):
        each = in_words(f"{count} times by the {m}" for m, count in jumps.items())
        return f"Look at the contact forces: the cilium jumps from one equilibrium to another {each}."
    compared = Counter(c.verdict for c in result.comparisons)
    if compared:
        text = f"Look at the differences between the models: {compared['resolved']} of {sum(compared.values())} are larger than their numerical errors"
        lost = compared["inconclusive"]
        return f"{text}, and of {lost} the error is not known." if lost else f"{text}."
    return "Look at the shapes."


def _with_touch(result: Result, sentence: str) -> str:
    """The sentence with what friction would do to a contact force, if the case does not state it."""
    text = result.summary.get("unstated_touch", "")
    return f"{sentence.rstrip('.')}; where a probe touches, {text}." if text else sentence


def _range(result: Result) -> str:
    """The force at which the contact slips off, by the best model that knows it; "" if none does."""
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
    return ""


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
    return [f"{text} {_size(u / size)} of its deflection but for what the model leaves out, which is not known"]


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
    """Range, and remarks of the models beside their numbers, each once with its steps."""
    if text := _range(result):
        yield text
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
