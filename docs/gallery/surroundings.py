# SPDX-License-Identifier: LGPL-2.1-or-later
"""
What do weight, water and the earth's field do to a reading?
============================================================

You see by how much the tip and the signal of 1 mN change where the cilium stands, hangs or lies, by the beam with corrected joints, against the same cilium without all of this, as in the paper.
The signal is the reading under the load less the reading without it, as a user zeroes the sensor.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6, density=1070)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3, density=1700)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
sensor = [-0.1e-3, 0.2e-3, -1.55e-3]
load = cv.Load("contact", force=1e-3, height=16e-3, azimuth=np.radians(30))
e = np.array([np.cos(np.radians(30)), np.sin(np.radians(30)), 0])  # of the load
up = np.array([0, 0, 1])
g, water = 9.81, 998
places = {  # where the ground is, seen from the cilium
    "upright": -up, "hanging": up, "lying, load down": e, "lying, load up": -e,
}


def response(environment):
    """Deflection of the tip along the load, m, and signal, T, both against no load; signal of no load."""
    bent = cv.bend(cilium, load, "beam", environment=environment, joints="corrected")
    free = cv.bend(cilium, None, "beam", environment=environment, joints="corrected") if environment else None
    tip = bent.tip @ e - (free.tip @ e if free else 0)
    rest = free.dB(sensor)[0] if free else np.zeros(3)
    return tip, np.linalg.norm(bent.dB(sensor)[0] - rest), np.linalg.norm(rest)


tip0, signal0, _ = response(None)
print(f"nothing around it: tip {1e3 * tip0:.4f} mm, signal {1e6 * signal0:.3f} uT")
kinds = ("weight in air", "weight in water", "earth's field", "all, in air")
changes = {kind: [] for kind in kinds}
for place, down in places.items():
    # 20 uT to the north, where the load points (of a lying cilium to the sky: its axis is north), 44 uT down.
    earth = 20e-6 * (up if place.startswith("lying") else e) + 44e-6 * down
    for kind, environment in zip(kinds, (
        cv.Environment(gravity=g * down),
        cv.Environment(gravity=g * down, fluid_density=water),
        cv.Environment(uniform_field=earth),
        cv.Environment(gravity=g * down, uniform_field=earth),
    )):
        tip, signal, rest = response(environment)
        changes[kind].append((100 * (tip / tip0 - 1), 100 * (signal / signal0 - 1)))
        print(f"{place + ', ' + kind:34} tip {changes[kind][-1][0]:+6.2f} %, signal {changes[kind][-1][1]:+6.2f} %, "
              f"at rest {100 * rest / signal0:5.2f} % of it")

figure, axes = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained", sharey=True)
rows = np.arange(len(places))
for n, (kind, values) in enumerate(changes.items()):
    for panel, column in zip(axes, np.transpose(values)):
        panel.barh(rows + 0.2 * (n - 1.5), column, height=0.18, label=kind)
for panel, title in zip(axes, ("deflection of the tip", "signal |B(load) − B(no load)|")):
    panel.set(title=title, xlabel="change in %", yticks=rows, yticklabels=list(places))
    panel.axvline(0, color="0.3", linewidth=0.8)
    panel.grid(axis="x", alpha=0.3)
axes[0].invert_yaxis()
axes[1].legend(loc="lower right", fontsize=8)
figure.savefig("surroundings.png", dpi=100)
