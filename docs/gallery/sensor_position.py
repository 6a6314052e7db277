# SPDX-License-Identifier: LGPL-2.1-or-later
"""
Where shall the sensor lie?
===========================

You see the change of B under a contact of 1 mN along the cilium's axis below the base.
It halves from 1 mm to 2 mm, while the magnet's own field falls more slowly.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
shape = cv.bend(cilium, cv.Load("contact", force=1e-3, height=16e-3), joints="corrected")

z = np.linspace(-0.5e-3, -10e-3, 100)
points = np.column_stack([np.zeros_like(z), np.zeros_like(z), z])
field = shape.field(points)  # B, dB and their numerical errors

figure, axes = plt.subplots(figsize=(5.5, 3.8), layout="constrained")
axes.semilogy(-1e3 * z, 1e6 * np.abs(field["dB"][:, 0]), label="|ΔB$_x$|, the signal")
axes.semilogy(-1e3 * z, 1e6 * np.abs(field["B"][:, 2]), "--", label="|B$_z$|, mostly the magnet itself")
axes.set(xlabel="depth of the sensor below the base in mm", ylabel="flux density in µT")
axes.grid(alpha=0.3)
axes.legend()
figure.savefig("sensor_position.png", dpi=100)
for depth in (1e-3, 2e-3, 4e-3, 8e-3):
    print(f"{1e3 * depth:g} mm: dB_x = {1e6 * np.interp(depth, -z, field['dB'][:, 0]):.2f} uT")
