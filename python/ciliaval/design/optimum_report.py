# SPDX-License-Identifier: LGPL-2.1-or-later
"""An optimum as text, CSV and JSON."""

from __future__ import annotations

import math
from typing import Any

from .. import _core
from .._core import StudyFile, StudyParameter
from .optimum import Limit, Optimum, constraints_of, limits_of
from .search import FEASIBILITY, STATIONARY, LocalOptimum
from .summary import (
    Result,
    cell,
    csv_header,
    csv_text,
    heading,
    pair_json,
    parameter_json,
    value_text,
)


def _band(output: str, result: Result) -> float | None:
    """Error of |dB| (its components' errors are bounds), a component, or a range by slip-off, numerical and by the
    model; None if it is not known."""
    if output == "range":
        parts, times = (result.range_uncertainty, result.range_model_uncertainty), 1.0
    else:
        parts, times = (result.uncertainty, result.model_uncertainty), math.sqrt(3) if output == "dB_norm" else 1.0
    if output not in ("range", "dB_norm", "dB_x", "dB_y", "dB_z") or None in parts:
        return None
    return times * sum(part for part in parts if part is not None)


def limit_states(study: StudyFile, result: Result) -> list[dict[str, Any]]:
    """State of each limit that the study states, for a pair: [{"output", "status": "kept", "missed" or "unknown" (the
    pair has no such value), "value": the output's magnitude (SI units), "by": the missing part, over the limit;
    negative: to spare, "band": uncertainty of the value, numerical and by the model, over the limit; None: not
    known}]."""
    values = {o.id: abs(x) for o, x in zip(study.outputs, result.values) if x is not None}
    states = []
    for limit in limits_of(study):
        value = values.get(limit.output.id)
        by = (1 if limit.is_lower else -1) * (limit.value - value) / limit.value if value is not None else None
        status = "unknown" if by is None else "missed" if by > 2 * FEASIBILITY else "kept"
        band = _band(limit.output.id, result)
        band = band / limit.value if band is not None else None
        states.append({"output": limit.output.id, "status": status, "value": value, "by": by, "band": band})
    return states


def optimum_text(study: StudyFile, optimum: Optimum, width: int = 0) -> str:
    """For a terminal: the designs, what limits them, and what each pair makes of them."""
    search, limits = optimum.search, [_words(limit) for limit in constraints_of(study)]
    text = f"\nLargest {study.goal.symbol} by {study.pairs[0]} within the bounds"
    text += f"{', with ' if limits else ''}{', '.join(limits)}\n"
    text += f"{optimum.evaluations} designs evaluated, {search.local_searches} local searches"
    if search.infeasible:
        text += f", {search.infeasible} without a design that keeps the limits"
    if search.not_stationary:
        text += f", {search.not_stationary} that ended where nothing is stationary"
    text += f"\n\n{_parameter_table(study, optimum, width)}"
    if optimum.found:
        text += _activity(study, optimum.best)
    else:
        text += "\nNo design was found that keeps the limits\n"
    return f"{text}\n{_result_table(study, optimum, width)}{_messages(optimum)}"


def _words(limit: Limit) -> str:
    """ "range >= 2 mN", "|B_z| <= 3000 uT" """
    if limit.is_own_load:
        return f"range >= {limit.value:g} times the load"
    sign, output = ">=" if limit.is_lower else "<=", limit.output
    return f"{output.symbol} {sign} {limit.value / output.shown_size:g} {output.shown_unit}"


def _bound_elasticity(parameter: StudyParameter, optimum: LocalOptimum, i: int) -> float:
    """d ln(goal)/d ln(bound) for a bound that is moved outwards."""
    low, high = parameter.values
    if parameter.logarithmic:
        return optimum.bound_multipliers[i] / abs(math.log(high / low))
    return optimum.bound_multipliers[i] * abs(low if optimum.at_bound[i] < 0 else high) / (high - low)


def _parameter_table(study: StudyFile, optimum: Optimum, width: int) -> str:
    rows = [["", "from", "to", *(design.name for design in optimum.designs)]]
    for i, p in enumerate(study.searched):
        values = [*p.values, *(design.values[i] for design in optimum.designs)]
        rows.append([heading(p), *(f"{value / p.shown_size:.5g}" for value in values)])
    rows.append(["local searches", "", "", "", *(str(local.starts) for local in optimum.search.optima)])
    return _core.text_table(rows, ">", width)


def _activity(study: StudyFile, best: LocalOptimum) -> str:
    """Limits and bounds that hold the best design in its place, and the gain of moving each."""
    goal = study.goal.symbol
    text = "\nOptimum 1:\n"
    for limit, g, multiplier in zip(constraints_of(study), best.trial.constraints, best.multipliers):
        text += f"  {_words(limit)}: "
        if multiplier > 0:
            text += f"reached; 1 % {'less' if limit.is_lower else 'more'} would give {multiplier:.3g} % more {goal}\n"
        else:
            text += f"kept, with {100 * max(math.expm1(-g), 0.0):.3g} % to spare\n"
    for i, p in enumerate(study.searched):
        if best.at_bound[i]:
            is_lower = best.at_bound[i] < 0
            text += f"  {p.name} = {value_text(p, p.values[0 if is_lower else 1])}: at its "
            text += f"{'lower' if is_lower else 'upper'} bound; 1 % {'less' if is_lower else 'more'} would give "
            text += f"{_bound_elasticity(p, best, i):.3g} % more {goal}\n"
    state = "otherwise stationary"
    if best.residual >= STATIONARY:
        state = "not stationary, so that a better one may be near"
    return f"{text}  {state}: |d ln({goal})/du| = {best.residual:.1g} at most, u from 0 to 1 between the bounds\n"


def _result_table(study: StudyFile, optimum: Optimum, width: int) -> str:
    goal = next((i for i, o in enumerate(study.outputs) if o.id == study.goal.id), None)

    def magnitude(result: Result | None) -> float | None:
        value = result.values[goal] if result and goal is not None else None
        return abs(value) if value is not None else None

    rows = [["", "pair", *map(heading, study.outputs), "+-dB(uT)", f"{study.goal.symbol} of start", "limits"]]
    for design in optimum.designs:
        for pair, result in design.results.items():
            row = [design.name, pair, *(cell(result, i, output) for i, output in enumerate(study.outputs))]
            parts = (result.uncertainty, result.model_uncertainty)
            known = sum(part for part in parts if part is not None)
            row.append("-" if parts == (None, None) else f"{'' if None not in parts else '>'}{known / 1e-6:.1g}")
            before, now = magnitude(optimum.designs[0].results.get(pair)), magnitude(result)
            row.append(f"{now / before:.4g}" if before and now is not None else "-")
            rows.append([*row, _limits_text(study, result)])
    return _core.text_table(rows, ">", width)


def _limits_text(study: StudyFile, result: Result) -> str:
    """Limits of the study that a pair misses, or keeps by less than the value's uncertainty; in per cent of the
    limit."""
    states = limit_states(study, result)
    if not states:
        return "-"
    texts = []
    for s in states:
        if s["status"] == "unknown":
            texts.append(f"{s['output']} unknown")
        elif s["status"] == "missed" or (s["band"] is not None and -s["by"] < s["band"]):
            band = "" if s["band"] is None else f" +-{100 * s['band']:.2g}"
            texts.append(f"{s['output']} {s['status']} by {100 * abs(s['by']):.2g}{band} %")
    return ", ".join(texts) or "kept"


def _messages(optimum: Optimum) -> str:
    """Reasons why a pair has no result at a design."""
    lines = [
        f"{design.name}, {pair}: {result.status}: {result.message}\n"
        for design in optimum.designs
        for pair, result in design.results.items()
        if result.message
    ]
    return "\n" + "".join(lines) if lines else ""


def optimum_csv(study: StudyFile, optimum: Optimum) -> str:
    """optimum.csv: a line for each design and pair, as study.csv has it."""
    columns, comment = csv_header(study, study.searched, "design")
    rows: list[list[Any]] = [columns]
    for design in optimum.designs:
        for pair, result in design.results.items():
            rows.append([design.name, *design.values, pair, result.status, *result.values, result.message])
    return csv_text(rows, comment)


def optimum_json(study: StudyFile, optimum: Optimum) -> dict[str, Any]:
    """The object `optimum` of study.json (docs/guide/studies.md), SI units."""
    parameters, search = study.searched, optimum.search
    ends = [{"from": p.values[0], "to": p.values[1]} for p in parameters]
    return {
        "maximise": study.goal.id,
        "pair": study.pairs[0],
        "found": optimum.found,
        "evaluations": optimum.evaluations,
        "local_searches": search.local_searches,
        "not_stationary": search.not_stationary,
        "infeasible": search.infeasible,
        "parameters": [parameter_json(p, of) for p, of in zip(parameters, ends)],
        "constraints": [
            {
                "output": limit.output.id,
                "at_least" if limit.is_lower else "at_most": limit.value,
                "times_the_load": limit.is_own_load,
                "unit": "" if limit.is_own_load else limit.output.unit,
            }
            for limit in constraints_of(study)
        ],
        "designs": [_design_json(study, optimum, i) for i in range(len(optimum.designs))],
        "slices": [
            {"path": p.path, "best": best, "at": s.at, "values": s.values, "kept": s.kept}
            for p, s, best in zip(parameters, optimum.slices, optimum.designs[-1 if not optimum.found else 1].values)
        ],
    }


def _design_json(study: StudyFile, optimum: Optimum, index: int) -> dict[str, Any]:
    parameters, design = study.searched, optimum.designs[index]
    document: dict[str, Any] = {
        "name": design.name,
        "parameters": dict(zip((p.path for p in parameters), design.values)),
        "pairs": {
            pair: {**pair_json(study, result), "limits": limit_states(study, result)}
            for pair, result in design.results.items()
        },
    }
    if index == 0:
        return document
    local = optimum.search.optima[index - 1]
    document["local_searches"] = local.starts
    document["residual"] = local.residual
    document["at_bound"] = {
        p.path: {"bound": "from" if side < 0 else "to", "elasticity": _bound_elasticity(p, local, i)}
        for i, (p, side) in enumerate(zip(parameters, local.at_bound))
        if side
    }
    document["constraints"] = [{"reached": x > 0, "elasticity": x} for x in local.multipliers]
    return document
