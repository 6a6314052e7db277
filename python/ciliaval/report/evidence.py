# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parts of a page that show studies, budgets, convergence, readings, claims and checks."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from .. import plot
from ..plot.style import best_first
from ..plot.study import label_of, largest, symbol, unit_of
from ..units import NOT_KNOWN, Unit, in_words, number, percent, quantity, shown
from .blocks import Block, Cell, Code, Details, Heading, Images, Items, Table, Text, image

_MOST_POINTS = 120
_DEGREE = np.pi / 180


def study_blocks(study: dict[str, Any]) -> list[Block]:
    parameters = study["parameters"]
    text = "An optimum" if "optimum" in study else f"{len(study['points'])} points"
    text += f" of the case {study['case']}"
    if parameters:
        text += f", varied in {in_words(p['name'] for p in parameters)}"
    blocks: list[Block] = [Text(f"{text}; pairs {in_words(best_first(study['pairs']))}.")]
    lost = _exceptions(study)
    if lost:
        blocks.append(Items(lost))
    if parameters and study["points"]:
        drawings = []
        for output in study["outputs"]:
            where = "; ".join(largest(study, output["id"]))
            caption = f"The largest values in magnitude are {where}." if where else "No point has a value."
            name = f"{symbol(output['id'])} over {parameters[0]['name']}"
            drawings.append(image(name, caption, lambda: plot.curves(study, output["id"])))
        blocks.append(Images(drawings))
        tables = [_points(study, pair) for pair in best_first(study["pairs"])]
        blocks.append(Details("The points' numbers", list(tables)))
    blocks += _tolerances(study)
    blocks += _optimum(study)
    resolved = Code("The study, resolved", "\n".join(study["resolved"]))
    return [*blocks, Details("Everything the results depend on, SI units", [resolved])]


def _exceptions(study: dict[str, Any]) -> list[str]:
    lines = []
    for pair in study["pairs"]:
        for status in ("slipped_off", "pulled_in", "failed"):
            found = [p["pairs"][pair] for p in study["points"] if p["pairs"][pair]["status"] == status]
            if found:
                message = next((f["message"] for f in found if f.get("message")), "")
                line = f"{pair}: {status.replace('_', ' ')} at {len(found)} of {len(study['points'])} points"
                lines.append(f"{line}, the first: {message}" if message else line)
    return lines


def _points(study: dict[str, Any], pair: str) -> Table:
    points = study["points"]
    some = sorted({int(i) for i in np.linspace(0, len(points) - 1, min(len(points), _MOST_POINTS))})
    caption = pair
    if len(some) < len(points):
        caption += f": {len(some)} of {len(points)} points, all are in study.csv"
    units = {o["id"]: shown(o["unit"]) for o in study["outputs"]}
    head = ["point", *(label_of(p) for p in study["parameters"])]
    table = Table(caption, [*head, *(f"{symbol(o)} in {u.name}" for o, u in units.items())])
    for i in some:
        of = points[i]["pairs"][pair]
        row = [str(i)]
        row += [number(points[i]["parameters"][p["path"]], unit_of(p).size) for p in study["parameters"]]
        for output, unit in units.items():
            value = of.get(output)
            lost = value is None and of["status"] != "converged"
            row.append(of["status"].replace("_", " ") if lost else number(value, unit.size))
        table.rows.append(row)
    return table


def _tolerances(study: dict[str, Any]) -> list[Block]:
    tolerances = study.get("tolerances")
    if not tolerances:
        return []
    best = best_first(list(tolerances["pairs"]))[0]
    drawings = []
    for output in study["outputs"]:
        entry = tolerances["pairs"][best].get(output["id"])
        if not entry or entry.get("deviation") is None:
            continue
        unit = shown(output["unit"])
        nominal, deviation = entry["nominal"], entry["deviation"]
        caption = f"The output is {number(nominal, unit.size)} ± {number(deviation, unit.size, 2)} {unit.name}"
        if nominal:
            caption += f" ({percent(deviation / abs(nominal), 2)})"
        caption += ", one standard deviation; a bar is what one number does by its own."
        name = f"Tolerances of {symbol(output['id'])}"
        drawings.append(image(name, caption, lambda: plot.tornado(study, best, output["id"])))
    table = Table(
        "One standard deviation of all numbers together",
        ["output", *best_first(list(tolerances["pairs"]))],
    )
    for output in study["outputs"]:
        unit = shown(output["unit"])
        row = [f"{symbol(output['id'])}, {unit.name}"]
        for pair in table.head[1:]:
            entry = tolerances["pairs"][pair].get(output["id"]) or {}
            value, u = entry.get("nominal"), entry.get("deviation")
            row.append(f"{number(value, unit.size)} ± {number(u, unit.size, 2)}")
        table.rows.append(row)
    return [Heading("Tolerances"), Images(drawings), table]


def _optimum(study: dict[str, Any]) -> list[Block]:
    optimum = study.get("optimum")
    if not optimum:
        return []
    text = f"The largest {symbol(optimum['maximise'])} by {optimum['pair']}: "
    text += f"{optimum['evaluations']} designs evaluated, {optimum['local_searches']} local searches."
    blocks: list[Block] = [Heading("Optimum"), Text(text)]
    if not optimum["found"]:
        return [*blocks, Text("No design was found that keeps the limits.", "bad")]
    blocks.append(Items(_limits(optimum)))
    drawing = plot.optimum_slices(study)
    if drawing:
        caption = "One parameter is moved, the others stay at the best design's."
        blocks.append(Images([image("Slices through the optimum", caption, lambda: drawing)]))
    designs = Table("The designs", ["parameter", "from", "to", *(d["name"] for d in optimum["designs"])])
    for p in optimum["parameters"]:
        size = unit_of(p).size
        row = [label_of(p), number(p["from"], size), number(p["to"], size)]
        for design in optimum["designs"]:
            cell = number(design["parameters"][p["path"]], size)
            bound = (design.get("at_bound") or {}).get(p["path"])
            if bound:
                cell += f" (bound: 1 % beyond would give {number(bound['elasticity'], 1, 3)} % more)"
            row.append(cell)
        designs.rows.append(row)
    units = {o["id"]: shown(o["unit"]) for o in study["outputs"]}
    head = [f"{symbol(o)} in {u.name}" for o, u in units.items()]
    confirmed = Table("The designs by all pairs", ["design", "pair", *head, "numerical error of ΔB, µT"])
    for design in optimum["designs"]:
        for pair, found in design["pairs"].items():
            row = [design["name"], pair, *(number(found.get(o), u.size) for o, u in units.items())]
            confirmed.rows.append([*row, number(found.get("dB_uncertainty"), 1e-6, 1)])
    return [*blocks, designs, confirmed]


def _limits(optimum: dict[str, Any]) -> list[str]:
    lines = []
    for constraint, state in zip(optimum["constraints"], optimum["designs"][1]["constraints"]):
        lower = "at_least" in constraint
        value = constraint["at_least" if lower else "at_most"]
        limit = quantity(value, constraint["unit"])
        if constraint["times_the_load"]:
            limit = f"{number(value)} times the load"
        gain = "kept, not reached"
        if state["reached"]:
            gain = f"reached; 1 % {'less' if lower else 'more'} would give {number(state['elasticity'], 1, 3)} % more"
        lines.append(f"{symbol(constraint['output'])} {'≥' if lower else '≤'} {limit}: {gain}")
    return lines


def budget_blocks(budget: dict[str, Any]) -> list[Block]:
    chain = Table("From the paper's model to the best one, an assumption at a time", ["model", "what changes"])
    for stage in budget["chain"]:
        chain.rows.append([stage["name"], Cell(stage["physics"], "text")])
    loads = budget.get("loads") or []
    rows = [r for r in budget["rows"] if r["links"]]
    blocks: list[Block] = []
    steps = sorted({r["step"] for r in rows})
    drawing = plot.budget(budget)
    if drawing:
        load = f", {loads[steps[-1]]}" if loads else ""
        caption = f"The chain is that of load step {steps[-1] + 1}{load}. Whiskers are the numerical error; "
        caption += "a grey bar is below it, and of a hollow bar it is not known."
        blocks.append(Images([image("What each assumption changes", caption, lambda: drawing)]))
    blocks.append(chain)
    notes = [*budget["remarks"], *(f"not run: {name}" for name in budget["not_run"])]
    if notes:
        blocks.append(Items(notes))
    tables = []
    for step in steps:
        load = f": {loads[step]}" if loads else ""
        table = Table(
            f"Load step {step + 1}{load}",
            ["number", "paper's model", "links: next less previous", "best model", "total"],
        )
        for row in (r for r in rows if r["step"] == step):
            unit = shown(row["unit"])
            links = "; ".join(f"{link['to']} {_link(link, unit)}" for link in row["links"])
            name = f"{row['quantity']}{'_' + row['component'] if row['component'] else ''}"
            if row["sensor"]:
                name += f", sensor {budget['sensor_names'][row['sensor']]}"
            table.rows.append(
                [f"{name}, {unit.name}", number(row["paper"], unit.size), Cell(links, "text"),
                 number(row["best"], unit.size), _link(row["total"], unit)]
            )  # fmt: skip
        tables.append(table)
    legend = Text("±: numerical error. ~: below it, cannot be told from zero. ?: the error is not known.")
    return [*blocks, Details("The budget's numbers", [*tables, legend])]


def _link(link: dict[str, Any], unit: Unit) -> str:
    mark = {"resolved": "", "inconclusive": "? "}.get(link["verdict"], "~ ")
    text = mark + number(link["value"], unit.size)
    return text if link["uncertainty"] is None else f"{text} ± {number(link['uncertainty'], unit.size, 1)}"


def convergence_blocks(data: dict[str, Any]) -> list[Block]:
    failures, drawings, tables = [], [], []
    for study in data["studies"]:
        if study["failure"]:
            failures.append(f"{study['model']}: inconclusive: {study['failure']}")
            continue
        drawing = plot.convergence(data, study["model"])
        if drawing:
            caption = f"The points are the distance of {study['model']} from its extrapolated limit f₀ by {study['option']}; the lines have the observed order."
            drawings.append(image(f"Convergence of {study['model']}", caption, lambda: drawing))
        table = Table(
            f"{study['model']}, {study['option']} {', '.join(map(number, study['settings']))}, finest first",
            ["quantity", "unit", "finest", "order", "extrapolated", "±", "remark"],
        )
        for q in study["quantities"]:
            if not q["levels"] or not any(k in q["id"] for k in ("/tip", "slip_off", "/dB/")):
                continue
            known = q["conclusive"]
            row = [q["id"], q["unit"], number(q["levels"][0]["value"], 1, 7), number(q["order"], 1, 3)]
            row += [number(q["limit"], 1, 7) if known else NOT_KNOWN]
            row += [number(q["uncertainty"], 1, 2) if known else NOT_KNOWN]
            reason = q["reason"] or ""
            table.rows.append([*row, Cell(reason if known else f"inconclusive: {reason}", "text")])
        tables.append(table)
    blocks: list[Block] = [Items(failures)] if failures else []
    return [*blocks, Images(drawings), Details("Orders and intervals", tables)]


def bench_blocks(bench: dict[str, Any]) -> list[Block]:
    e, unit = bench["errors"], shown(bench["unit"])
    text = (
        f"Simulated readings of the case {bench['case']}: read by {bench['truth']}, inverted by "
        f"{bench['models']}; {bench['azimuths']} azimuths, {bench['draws']} sensors drawn. Standard "
        f"deviations: noise {quantity(e['noise'], 'T', 3)}, digits of {quantity(e['quantum'], 'T', 3)}, "
        f"sensor position {quantity(e['sensor_position'], 'm', 3)}, stage {quantity(e['stage_azimuth'], 'rad', 3)}."
    )
    flow = any(row["inversion"]["speed_rms"] for row in bench["sources"])
    head = ["load, %", *(["speed, m/s"] if flow else []), "direction, °", "largest, °", "within 10°, %"]

    def cells(errors: dict[str, Any]) -> list[str]:
        speed = [number(errors["speed_rms"], 1, 3)] if flow else []
        angles = [number(errors[k], _DEGREE, 3) for k in ("azimuth_rms", "azimuth_largest")]
        return [number(errors["magnitude_rms"], 0.01, 3), *speed, *angles,
                number(errors["below_ten_degrees"], 0.01)]  # fmt: skip

    inversion = Table("Full inversion: root mean squares with each error alone, then all", ["error", *head])
    fit = Table("Linear fit of ΔB, as in the paper", ["error", *head])
    for row in bench["sources"]:
        inversion.rows.append([row["source"], *cells(row["inversion"])])
        fit.rows.append([row["source"], *cells(row["linear_fit"])])
    loads = Table("Full inversion with all errors, by load", ["load", *head])
    for row in bench["by_magnitude"]:
        loads.rows.append([f"{number(row['magnitude'], unit.size)} {unit.name}", *cells(row)])
    blocks: list[Block] = [Text(text)]
    if bench.get("first_draw"):
        caption = "Of the first sensor that was drawn, with all errors, the circles are the true loads and the dots are what was found."
        blocks.append(Images([image("Loads found on the bench", caption, lambda: plot.bench(bench))]))
    return [*blocks, inversion, loads, fit]


def readings_blocks(sensing: dict[str, Any]) -> list[Block]:
    unit = shown(sensing["unit"])
    samples = sensing["samples"]
    counts = Counter(s["status"] for s in samples)
    text = f"{len(samples)} samples read by {sensing['models']}: "
    text += in_words(f"{count} {status}" for status, count in counts.items())
    table = Table(
        "The loads",
        ["sample", "status", f"load, {unit.name}", "± (95 %)", "direction, °", "± (95 %)"],
    )
    for s in samples[:_MOST_POINTS]:
        row = [str(s["sample"]), s["status"]]
        row += [number(s["magnitude"], unit.size), number(s["magnitude_interval"], unit.size, 2)]
        row += [number(s["azimuth"], _DEGREE), number(s["azimuth_interval"], _DEGREE, 2)]
        table.rows.append(row)
    if len(samples) > _MOST_POINTS:
        table.caption += f": the first {_MOST_POINTS} of {len(samples)}"
    drawing = image("Load and direction", "The bands are those of 95 %.", lambda: plot.readings(sensing))
    return [Text(f"{text}."), Images([drawing]), Details("The loads' numbers", [table])]


def calibration_blocks(data: dict[str, Any]) -> list[Block]:
    text = (
        f"{len(data['parameters'])} numbers from {len(data['residuals'])} readings at known loads by {data['models']}; "
        f"χ² {number(data['chi_squared'])} with {data['freedom']} degrees of freedom."
    )
    table = Table("Intervals of 95 %, of the noise alone", ["number", "unit", "start", "found", "±"])
    for p in data["parameters"]:
        unit = shown(p["unit"])
        spread = None if p["deviation"] is None else 1.96 * p["deviation"]
        values = [number(p["start"], unit.size), number(p["value"], unit.size, 6), number(spread, unit.size, 2)]
        table.rows.append([p["path"], unit.name, *values])
    apart = [f"The readings cannot tell apart: {in_words(group)}." for group in data["together"]]
    return [Text(text), table, *map(Text, apart)]


def surface_blocks(profile: dict[str, Any]) -> list[Block]:
    counts = Counter(r["status"] for r in profile["readings"])
    text = f"{len(profile['readings'])} readings by {profile['models']}: "
    text += in_words(f"{count} {status.replace('_', ' ')}" for status, count in counts.items())
    table = Table(
        "Levels of the surface", ["rows", "interference, mm", "± (95 %)", "height above the first, mm"]
    )
    for level in profile["levels"]:
        row = [f"{level['first'] + 1} to {level['last'] + 1}"]
        row += [number(level[key], 1e-3) for key in ("interference", "interval", "height")]
        table.rows.append(row)
    drawing = image("Levels found", "The grey points are single readings.", lambda: plot.levels(profile))
    return [Text(f"{text}."), Images([drawing]), table]


def claims_blocks(data: dict[str, Any]) -> list[Block]:
    counts = Counter(_kind_of(claim["verdict"]) for claim in data["claims"])
    text = in_words(f"{count} {verdict}" for verdict, count in counts.most_common())
    verdicts = Table("The paper's statements", ["place", "statement", "verdict", "holds"])
    found = Table(
        "What the models find", ["statement", "remark", "model or measure", "value", "holds"]
    )
    for claim in data["claims"]:
        kind = "text plain" if claim["verdict"] == "reproduced" else "text"
        verdicts.rows.append(
            [
                Cell(claim["place"], "text plain"),
                Cell(claim["statement"], "text plain"),
                Cell(claim["verdict"], kind),
                Cell("; ".join(_where(e) for e in claim.get("depends_on", [])), "text plain"),
            ]
        )
        rows = max(len(claim["findings"]), 1)
        row: list[str | Cell] = [
            Cell(claim["statement"], "text plain", rows),
            Cell(claim.get("note") or "", "text plain", rows),
        ]
        for f in claim["findings"]:
            answer = {None: "undecided", True: "yes", False: "no"}[f["holds"]]
            found.rows.append([*row, Cell(f["models"], "text plain"), _finding(f), answer])
            row = []
        if not claim["findings"]:
            found.rows.append([*row, NOT_KNOWN, NOT_KNOWN, NOT_KNOWN])
    blocks: list[Block] = [
        Text(f"{len(data['claims'])} claims: {text}."), verdicts, Details("What the models find", [found])
    ]  # fmt: skip
    ranges = _ranges(data["claims"])
    return [*blocks, Details("What the paper does not state, and how it was varied", [ranges])] if ranges.rows else blocks


def _where(entry: dict[str, Any]) -> str:
    """ "sensor z -2.69 to -2.08 mm (elastica: B)" """
    if entry["unit"] is None:
        return "by " + ", ".join(name for names in entry["holds"] for name in names)
    held = ", ".join(_interval(interval) for interval in entry["holds"]) or "nowhere"
    unit = f" {entry['unit']}" if entry["unit"] and entry["holds"] else ""
    whole = "all of " if entry["holds"] == [entry["scanned"]] else ""
    return f"{entry['parameter']} {whole}{held}{unit} ({entry['models']})"


def _kind_of(verdict: str) -> str:
    depends = "depends on "
    return "depend on what the paper does not state, or on the model" if verdict.startswith(depends) else verdict


def _ranges(claims: list[dict[str, Any]]) -> Table:
    """Numbers that the paper does not state, the range over which each was varied, and the part in which the claim
    holds."""
    table = Table(
        "What the verdicts hang on",
        ["statement", "not stated", "model or measure", "varied over", "holds in", "in the ledger"],
    )
    for claim in claims:
        entries = [e for key in ("depends_on", "holds_throughout", "holds_nowhere") for e in claim.get(key, []) if e["unit"] is not None]
        row: list[str | Cell] = [Cell(claim["statement"], "text", max(len(entries), 1))]
        for entry in entries:
            unit = f" {entry['unit']}" if entry["unit"] else ""
            held = ", ".join(_interval(interval) for interval in entry["holds"])
            whole = entry["holds"] == [entry["scanned"]]
            table.rows.append(
                [
                    *row,
                    Cell(f"{entry['parameter']}: {entry['reason']}", "text plain"),
                    Cell(entry["models"], "text plain"),
                    _interval(entry["scanned"]) + unit,
                    "all of it" if whole else held + unit if held else "nowhere",
                    number(entry["used"]) + unit,
                ]
            )
            row = []
    return table


def _interval(ends: list[float]) -> str:
    return f"{number(ends[0])} to {number(ends[1])}"


def _finding(finding: dict[str, Any]) -> str:
    low, high = number(finding["low"]), number(finding["high"])
    text = low if low == high else f"{low} to {high}"
    if finding["uncertainty"]:
        text += f" ± {number(finding['uncertainty'], 1, 1)}"
    return f"{text} {finding['unit']}"


def check_blocks(check: dict[str, Any]) -> list[Block]:
    table = Table("Results against the accepted ones", ["case", "passed", "numbers compared", "failures"])
    failures = []
    for entry in check["cases"]:
        passed = Cell("yes", "word") if entry["passed"] else Cell("no", "word bad")
        table.rows.append([entry["case"], passed, str(entry["compared"]), str(entry["failures"])])
        for finding in entry["findings"]:
            if not finding["passed"]:
                failures.append(f"{entry['case']}: {finding['id']}: {finding.get('message') or ''}")
    blocks: list[Block] = [table]
    return [*blocks, Items(failures)] if failures else blocks
