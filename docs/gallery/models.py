# SPDX-License-Identifier: LGPL-2.1-or-later
"""
How far is the paper's model from the solid?
============================================

You see the deflection and the signal under growing contact forces by the paper's elastica, the beam with corrected joints and the solid.
The solid bends a tenth less than the elastica, because nearly incompressible rubber between bonded ends is stiffer; the corrected beam knows that.
The signals agree nevertheless: in the paper's pair the errors of bending and field cancel.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
sensor = [-0.1e-3, 0.2e-3, -1.55e-3]
forces = np.array([1e-3, 2e-3, 3e-3, 4e-3])  # N
loads = [cv.Load("contact", force=f, height=16e-3) for f in forces]

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
models = (("elastica", "line", "o-", {}), ("beam", "volume", "s", {"joints": "corrected"}), ("solid", "mesh", "D:", {}))
for mechanics, field, style, options in models:
    shapes = cv.bend(cilium, loads, model=mechanics, **options)
    tip = np.array([1e3 * s.tip[0] for s in shapes])
    signal = np.array([1e6 * s.dB(sensor, field)[0, 0] for s in shapes])
    joints = ", corrected joints" if options else ""
    look = {"markersize": 10, "markerfacecolor": "none"} if options else {}
    left.plot(1e3 * forces, tip, style, label=mechanics + joints, **look)
    right.plot(1e3 * forces, signal, style, **look, label=f"{mechanics}/{field}{joints}")
    print(f"{mechanics}/{field}{joints}: tip {tip[0]:.3f} mm, dB_x {signal[0]:.2f} uT at 1 mN")
left.set(xlabel="force in mN", ylabel="deflection of the tip in mm")
right.set(xlabel="force in mN", ylabel="ΔB$_x$ at the sensor in µT")
for axes in (left, right):
    axes.set(xlim=(0, 4.2), ylim=(0, None))
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right", fontsize=8)
figure.savefig("models.png", dpi=100)
