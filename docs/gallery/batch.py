# SPDX-License-Identifier: LGPL-2.1-or-later
"""
Which of 10,000 designs reads best?
===================================

You see the signal at 1 mN over the largest force that each of 10,000 random designs bears.
Signal costs range; the design with the largest signal among those that bear 5 mN is marked.
"""
import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

random = np.random.default_rng(1)
n = 10_000
diameter = random.uniform(1.5e-3, 4e-3, n)
base = random.uniform(4e-3, 12e-3, n)  # length of the base; the whole has 20 mm
stiffness = 10 ** random.uniform(4.7, 6, n)  # E of the base, Pa

cilia = [
    cv.Cilium(d, [cv.Segment(b, e), cv.Segment(20e-3 - b, 3e6, magnetization=75e3)])
    for d, b, e in zip(diameter, base, stiffness)
]
loads = [cv.Load("contact", force=f, height=16e-3) for f in (0.0, 1e-3)]
straight, bent = (cv.bend_batch(cilia, [load] * n, [[0, 0, -1.55e-3]], joints="corrected") for load in loads)

signal = 1e6 * (bent["B"] - straight["B"])[:, 0, 0]
largest = 1e3 * bent["slip_off"]
allowed = bent["converged"] & (largest >= 5)
best = np.flatnonzero(allowed)[np.argmax(signal[allowed])]
print(f"{bent['converged'].sum()} of {n} designs bear 1 mN, {allowed.sum()} bear 5 mN")
print(f"best: d = {1e3 * diameter[best]:.2f} mm, base {1e3 * base[best]:.2f} mm of {stiffness[best] / 1e3:.0f} kPa: "
      f"{signal[best]:.1f} uT at 1 mN, up to {largest[best]:.2f} mN")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
dots = axes.scatter(largest, signal, s=3, c=1e3 * base, cmap="viridis", rasterized=True)
axes.plot(largest[best], signal[best], "r*", markersize=12, label="best above 5 mN")
axes.axvline(5, color="0.5", linestyle=":")
axes.set(xscale="log", yscale="log", xlabel="largest force in mN", ylabel="ΔB$_x$ at 1 mN in µT")
axes.legend(loc="lower left")
figure.colorbar(dots, label="length of the base in mm")
figure.savefig("batch.png", dpi=100)
