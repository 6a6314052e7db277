# SPDX-License-Identifier: LGPL-2.1-or-later
"""
What does my cilium measure?
============================

You see a probe that slides on the cilium, 6 mm to and fro, with three frictions: its force, and the
sensor's reading. At one displacement all read the same, while the forces are 17 % apart, and the way
back is another curve. The cilium measures displacement; force only where friction is known.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
sensor = [-0.1e-3, 0.2e-3, -1.55e-3]
forward = np.linspace(0.1e-3, 6e-3, 60)
way = np.concatenate([forward, forward[-2::-1]])
there = len(forward) - 1
stiffness = base.young_modulus * np.pi * cilium.diameter**4 / 64  # EI of the base

figure, (forces, readings) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
print("friction  force at 6 mm  on the way back at 5 mm  |dB|  moment at the base")
for friction in (0.0, 0.3, 0.6):
    touch = {"law": "coulomb", "friction": friction, "at": "mantle", "radius": 1e-3}
    path = [cv.Load("probe", displacement=d, height=16e-3, touch=touch) for d in way]
    shapes = cv.bend(cilium, path, "elastica")
    force = 1e3 * np.array([shape.applied_force for shape in shapes])
    signal = 1e6 * np.linalg.norm([shape.field([sensor])["dB"][0] for shape in shapes], axis=1)
    forces.plot(1e3 * way, force, label=f"friction {friction:g}")
    readings.plot(1e3 * way, signal, label=f"friction {friction:g}")
    moment = 1e6 * stiffness * shapes[there].curvature[0]
    back = np.interp(5e-3, way[there:][::-1], force[there:][::-1])
    print(f"{friction:8.1f} {force[there]:10.3f} mN {back:21.3f} mN {signal[there]:7.1f} uT {moment:10.2f} uN m")
for axes, label in ((forces, "force in mN"), (readings, "|ΔB| in µT")):
    axes.set(xlabel="displacement of the probe in mm", ylabel=label)
    axes.grid(alpha=0.3)
    axes.legend()
figure.savefig("touch.png", dpi=100)
