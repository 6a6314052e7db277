# SPDX-License-Identifier: LGPL-2.1-or-later
"""How often the 95 % intervals of ciliaval.sensing hold the true load: seeded readings, made by the
response that inverts them, with the noise that is stated.

python3 tests/python/interval_coverage.py [READINGS]: the table of docs/evidence/sensing.md (5,000 readings a row).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import ciliaval as cv
from ciliaval.sensing import Response, invert, readings_of_arrays, shapes_within
from ciliaval.sensing.inversion import wrapped

CASES = Path(__file__).resolve().parents[2] / "cases" / "paper"
NOISE = 0.5e-6  # T
PER_BENCH = 5  # readings with one offset

# name: case, sensors, magnitudes in standard deviations of the load or in parts of the range, background
ROWS = {
    "contact, 0.2 to 1 of the range": ("fig3d", 1, ("range", 0.2, 1.0), None),
    "flow, 0.2 to 1 of the range": ("fig5", 1, ("range", 0.2, 1.0), None),
    "contact, weak: 0 to 1 deviations": ("fig3d", 1, ("deviation", 0.0, 1.0), None),
    "contact, weak: 1 to 2 deviations": ("fig3d", 1, ("deviation", 1.0, 2.0), None),
    "contact, weak: 2 to 4 deviations": ("fig3d", 1, ("deviation", 2.0, 4.0), None),
    "flow, weak: 0 to 4 deviations": ("fig5", 1, ("deviation", 0.0, 4.0), None),
    "contact, no load": ("fig3d", 1, ("range", 0.0, 0.0), None),
    "flow, no load": ("fig5", 1, ("range", 0.0, 0.0), None),
    "contact, background read with each": ("fig3d", 1, ("range", 0.2, 1.0), "each"),
    "no load, background read with each": ("fig3d", 1, ("range", 0.0, 0.0), "each"),
    "three sensors": ("fig3d", 3, ("range", 0.2, 1.0), None),
    "three sensors, no load": ("fig3d", 3, ("range", 0.0, 0.0), None),
    "three sensors, weak: 0 to 4 deviations": ("fig3d", 3, ("deviation", 0.0, 4.0), None),
    "three sensors, background read with each": ("fig3d", 3, ("range", 0.2, 1.0), "each"),
}
LARGEST = {"fig3d": 4e-3, "fig5": 0.4}


def response_of(name: str, sensors: int, made: dict = {}) -> Response:
    if (name, sensors) not in made:
        case = cv.Case(CASES / f"{name}.toml")
        places = np.concatenate([case.sensors, [[2e-3, 0, -1.55e-3], [-1e-3, -2e-3, -1.55e-3]]])[:sensors]
        made[name, sensors] = Response(
            case, "volume", shapes_within(case, "elastica", 1.25 * LARGEST[name]), places
        )
    return made[name, sensors]


def coverage(row: str, readings: int, seed: int = 1) -> dict[str, float]:
    """Parts of the readings: magnitude and azimuth in their intervals (not of no load), found."""
    name, sensors, (kind, low, high), background = ROWS[row]
    response = response_of(name, sensors)
    rng = np.random.default_rng([seed, list(ROWS).index(row)])
    unloaded = 8
    held, directed, found, known = 0, 0, 0, 0
    # Standard deviation of a load by the noise of a reading and of the offset, near zero.
    slope = response.derivative([[0.0, 0.0]])[0].reshape(-1, 2) / NOISE
    deviation = np.sqrt(np.linalg.inv(slope.T @ slope)[0, 0] * (1 + 1 / unloaded) * (2 if background else 1))
    unit = deviation if kind == "deviation" else LARGEST[name]
    for _ in range(readings // PER_BENCH):
        size, angle = rng.uniform(low, high, PER_BENCH) * unit, rng.uniform(-np.pi, np.pi, PER_BENCH)
        loads = np.stack([size * np.cos(angle), size * np.sin(angle)], axis=-1)
        B = np.concatenate([np.zeros((unloaded, sensors, 3)), response.change(loads)]) + response.undeformed
        B += rng.normal(0, 10e-6, (sensors, 3))  # the sensors' offsets
        ambient = rng.normal(0, 30e-6, (len(B), sensors, 3)) if background else np.zeros_like(B)
        read = B + ambient + rng.normal(0, NOISE, B.shape)
        taken = ambient + rng.normal(0, NOISE, B.shape) if background else None
        samples = readings_of_arrays(read, sensors, slice(0, unloaded), taken)
        loads = invert(response, samples.change, NOISE, samples.variance(), samples.background)
        held += (np.abs(loads.magnitude - size) <= loads.magnitude_interval).sum()
        directed += (np.abs(wrapped(loads.azimuth - angle)) <= loads.azimuth_interval).sum()
        found += (loads.status == "found").sum()
        known += (loads.azimuth_interval < np.pi).sum()
    parts = {"magnitude": held, "azimuth": directed, "found": found, "direction known": known}
    return {key: float(value) / readings for key, value in parts.items()}


def main() -> None:
    readings = int(sys.argv[1]) if len(sys.argv) > 1 else 5000
    print(f"| {readings} readings, noise 0.5 µT | magnitude held | azimuth held | found | direction known |")
    print("| --- | --- | --- | --- | --- |")
    for row, (_, _, (_, _, high), _) in ROWS.items():
        part = coverage(row, readings)
        azimuth = f"{100 * part['azimuth']:.1f} %" if high else "–"
        print(
            f"| {row} | {100 * part['magnitude']:.1f} % | {azimuth} | {100 * part['found']:.1f} % | "
            f"{100 * part['direction known']:.1f} % |"
        )


if __name__ == "__main__":
    main()
