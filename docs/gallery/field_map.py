# SPDX-License-Identifier: LGPL-2.1-or-later
"""
What does the field of the bent cilium look like?
=================================================

You see the magnitude of B and its field lines in the bending plane, by the magnet's bent volume.
The sensor sits below the clamped end, where the lines that enter the magnet's lower end come together.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import ciliaval as cv

base = cv.Segment(length=3e-3, young_modulus=0.1e6)
magnet = cv.Segment(length=17e-3, young_modulus=3e6, magnetization=75e3)
cilium = cv.Cilium(diameter=3e-3, segments=[base, magnet])
shape = cv.bend(cilium, cv.Load("contact", force=4e-3, height=16e-3), joints="corrected")

x, z = np.linspace(-12e-3, 20e-3, 64), np.linspace(-8e-3, 26e-3, 68)
grid = np.stack(np.meshgrid(x, 0, z, indexing="ij"), axis=-1).reshape(-1, 3)
B = shape.B(grid).reshape(len(x), len(z), 3).transpose(1, 0, 2)
strength = 1e3 * np.linalg.norm(B, axis=-1)
print(f"|B| from {strength.min():.3f} mT to {strength.max():.1f} mT")

figure, axes = plt.subplots(figsize=(6.6, 5), layout="constrained")
image = axes.pcolormesh(1e3 * x, 1e3 * z, strength, norm=LogNorm(0.1, 30), cmap="viridis", shading="gouraud")
axes.streamplot(1e3 * x, 1e3 * z, B[..., 0], B[..., 2], color="w", linewidth=0.6, arrowsize=0.7, density=1.1)
line = 1e3 * shape.centreline
normal = 1.5 * np.array([np.cos(shape.theta), -np.sin(shape.theta)]).T  # radius in mm
outline = np.vstack([line[:, [0, 2]] + normal, (line[:, [0, 2]] - normal)[::-1]])
axes.fill(*outline.T, facecolor="0.85", edgecolor="k", linewidth=0.8, zorder=3)
axes.plot(-0.1, -1.55, "rs", markersize=5, zorder=4, label="sensor")
axes.set(xlabel="x in mm", ylabel="z in mm", aspect="equal")
axes.legend(loc="lower right")
figure.colorbar(image, label="|B| in mT")
figure.savefig("field_map.png", dpi=100)
