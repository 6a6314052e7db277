# SPDX-License-Identifier: LGPL-2.1-or-later
"""How often the 95 % intervals of `cv.sense(…, unknowns=…)` hold the true force, base moment and displacement:
seeded touches of the paper's cilium (fig3b), 1 to 3 mN, friction 0 to 0.6, at 16 ± 0.5 mm, read with 0.4 µT.

python3 tests/python/unknowns_coverage.py [TOUCHES]: the table of docs/evidence/sensing.md (400 touches a row).
"""

from __future__ import annotations

import os
import sys
import tomllib
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas

import ciliaval as cv
from ciliaval.sensing.response import Pair
from ciliaval.sensing.touch_fit import Touch

FILE = Path(__file__).resolve().parents[2] / "cases" / "paper" / "fig3b.toml"
NOISE, HEIGHT, FRICTION = 0.4e-6, 0.5e-3, (0.0, 0.6)
MODELS = "elastica/line"
LOOKED_AT = ("force", "base_moment", "displacement")
SECOND = [3e-3, 0.0, -1.55e-3]  # m

# name: sensors, unknowns, what is known of the others
ROWS: dict[str, tuple[int, tuple[str, ...], dict[str, Any]]] = {
    "friction and height stated": (1, ("force", "azimuth"), {"friction": FRICTION, "height": HEIGHT}),
    "height unknown, two sensors": (2, ("force", "azimuth", "height"), {"friction": FRICTION}),
}


def case_of(sensors: int, **touch: Any) -> cv.Case:
    """The paper's cilium, touched with friction, without the models that this does not need."""
    tables = tomllib.loads(cv.Case(FILE).toml())
    tables["load"]["touch"] = {"law": "coulomb", "friction": 0.3, "at": "axis"} | touch
    tables["load"]["force"] = "4 mN"
    tables["models"] = {"mechanics": ["elastica"], "fields": ["line"]}
    first = tables["sensor"]["position"]
    tables["sensor"]["position"] = first if sensors == 1 else [first, [f"{x!r} m" for x in SECOND]]
    return cv.Case.from_dict(tables)


def sensed(sensors: int, read: Any, unknowns: tuple[str, ...], priors: dict[str, Any]) -> pandas.DataFrame:
    return cv.sense(case_of(sensors), read, noise=NOISE, models=MODELS, unknowns=unknowns, priors=priors)


def coverage(row: str, touches: int, seed: int = 1, jobs: int = 1) -> dict[str, float]:
    """Parts of the touches whose intervals hold the truth, and of the intervals of the force that are open."""
    sensors, unknowns, priors = ROWS[row]
    case = case_of(sensors)
    touch = Touch(case, Pair.of(MODELS), "force", with_offset=False)
    rng = np.random.default_rng([seed, list(ROWS).index(row)])
    read, truth = [], []
    for _ in range(touches):
        values = {
            "magnitude": rng.uniform(1e-3, 3e-3), "azimuth": rng.uniform(-np.pi, np.pi),
            "height": case.loads[0].parameters["height"] + rng.normal(0, HEIGHT), "friction": rng.uniform(*FRICTION),
        }  # fmt: skip
        seen = touch.at(values)
        read.append(seen.values + rng.normal(0, NOISE, seen.values.shape))
        truth.append(dict(zip(touch.names, seen.quantities)))
    parts_of_all = [(sensors, part, unknowns, priors) for part in np.array_split(np.array(read), jobs)]
    if jobs == 1:
        frame = sensed(*parts_of_all[0])
    else:
        with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
            frame = pandas.concat(pool.map(sensed, *zip(*parts_of_all)), ignore_index=True)
    parts = {
        name: np.mean(frame[f"{name}_low"].le(t := [one[name] for one in truth]) & frame[f"{name}_high"].ge(t))
        for name in LOOKED_AT
    }
    return {name: float(part) for name, part in parts.items()} | {"open": float((frame["force_by"] == "open").mean())}


def main() -> None:
    touches = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    print(f"| {touches} touches, noise 0.4 µT | {' held | '.join(LOOKED_AT)} held | force open |")
    print("| --- | --- | --- | --- | --- |")
    for row in ROWS:
        part = coverage(row, touches, jobs=os.cpu_count() or 1)
        print(f"| {row} | {' | '.join(f'{100 * value:.1f} %' for value in part.values())} |", flush=True)


if __name__ == "__main__":
    main()
