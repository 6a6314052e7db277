# SPDX-License-Identifier: LGPL-2.1-or-later
"""
How does the paper's cilium bend under a touch?
===============================================

You see the centreline under five contact forces at the height of 16 mm, by the paper's elastica; the solid bends a tenth less (see "How far is the paper's model from the solid?").
Nearly all of the bending is in the soft base, and the tip sinks as it moves aside.
"""
import matplotlib.pyplot as plt

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])

figure, axes = plt.subplots(figsize=(5, 5), layout="constrained")
for force in (0, 1e-3, 2e-3, 3e-3, 4e-3):  # N
    shape = cv.bend(cilium, cv.Load("contact", force=force, height=16e-3))
    x, _, z = 1e3 * shape.centreline.T
    axes.plot(x, z, label=f"{1e3 * force:g} mN")
    print(f"{1e3 * force:g} mN: tip at x = {x[-1]:.3f} mm, z = {z[-1]:.3f} mm")
axes.axhline(3, color="0.7", linestyle=":")
axes.annotate("end of the base", (5, 3), (0, 4), textcoords="offset points", color="0.4")
axes.set(xlabel="x in mm", ylabel="z in mm", aspect="equal", xlim=(-4, 16), ylim=(0, 21))
axes.legend(title="force", loc="center right")
figure.savefig("bending.png", dpi=100)
