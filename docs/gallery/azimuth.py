# SPDX-License-Identifier: LGPL-2.1-or-later
"""
From where was the cilium touched? Two sensors
==============================================

You see the horizontal signal of two sensors while a contact of 1 mN walks round the cilium.
Under the axis the signal's direction is the load's; 2 mm beside it the two differ by up to 21°, which the models know and a mere arctangent does not.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
sensors = {"on the axis": [0, 0, -1.55e-3], "2 mm aside": [2e-3, 0, -1.55e-3]}

azimuths = np.radians(np.arange(0, 361, 10))
loads = [cv.Load("contact", force=1e-3, height=16e-3, azimuth=a) for a in azimuths]
dB = np.array([shape.dB(list(sensors.values())) for shape in cv.bend(cilium, loads, joints="corrected")])

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
for i, name in enumerate(sensors):
    x, y = 1e6 * dB[:, i, 0], 1e6 * dB[:, i, 1]
    left.plot(x, y, ".-", label=name)
    error = np.degrees(np.angle(np.exp(1j * (np.arctan2(y, x) - azimuths))))
    right.plot(np.degrees(azimuths), error, ".-", label=name)
    print(f"{name}: direction off by up to {np.abs(error).max():.2f} deg")
left.set(xlabel="ΔB$_x$ in µT", ylabel="ΔB$_y$ in µT", aspect="equal")
right.set(xlabel="azimuth of the load in °", ylabel="direction of ΔB − azimuth in °", xticks=range(0, 361, 90))
for axes in (left, right):
    axes.grid(alpha=0.3)
right.set_ylim(-30, 45)
right.legend(loc="upper right")
figure.savefig("azimuth.png", dpi=100)
