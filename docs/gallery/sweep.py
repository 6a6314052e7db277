# SPDX-License-Identifier: LGPL-2.1-or-later
"""
What does a sweep over a step look like in the signal?
======================================================

You see the height of the tip, the change of B, and the same as a logger with noise and a high-pass filter records it.
The rod is plain: corrected joints do not reach sweeps. A flank presses the tip down steadily; off the next one it springs up in a jump, which the filter turns into a pulse.
"""
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import ciliaval as cv

CASE = """
[case]
name = "step"
[cilium]
diameter = "3 mm"
segment = [
  { name = "base", length = "3 mm", young_modulus = "0.1 MPa", poisson_ratio = 0.49 },
  { name = "magnet", length = "17 mm", young_modulus = "3 MPa", poisson_ratio = 0.49, magnetization = "75 kA/m" },
]
[surface]
profile = "trapezoid"
height = "1 mm"
top = "12 mm"
bottom = "12 mm"
flank = "1 mm"
radius = "0.5 mm"
friction = 0.3
[load]
type = "sweep"
interference = "1 mm"
travel = "40 mm"
samples = 201
speed = "1 mm/s"
[signal]
sampling_rate = "20 Hz"
noise = "0.5 uT"
cutoff = "0.2 Hz"
[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["elastica"]
fields = ["volume"]
"""
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "step.toml").write_text(CASE)
    result = cv.run(Path(folder, "step.toml"), folder)
    signal = cv.results.read_table(Path(folder, "step", "signal.csv"))

travel, tip = 1e3 * result.load("travel"), 1e3 * result.tip("elastica")[:, 2]
dB = 1e6 * result.dB("elastica/volume")[:, 0, 0]
filtered = 1e6 * signal["elastica/volume.filtered0_x"]
jumps = sum("jump" in step["mechanics"]["elastica"] for step in result.steps)
print(f"dB_x from {dB.min():.1f} uT to {dB.max():.1f} uT, filtered up to {np.abs(filtered).max():.1f} uT, {jumps} jumps")

figure, axes = plt.subplots(3, 1, figsize=(6, 5.4), sharex=True, layout="constrained")
axes[0].plot(travel, tip)
axes[1].plot(travel, dB)
axes[2].plot(signal["time"] * 1.0, filtered, linewidth=0.8)  # at 1 mm/s a second is a millimetre
for panel, label in zip(axes, ("tip's z in mm", "ΔB$_x$ in µT", "ΔB$_x$ in µT,\nas logged and filtered")):
    panel.set_ylabel(label)
    panel.grid(alpha=0.3)
axes[2].set_xlabel("travel of the surface in mm")
figure.align_ylabels()
figure.savefig("sweep.png", dpi=100)
