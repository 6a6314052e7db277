# SPDX-License-Identifier: LGPL-2.1-or-later
"""
Which forces did my sensor read?
================================

You see forces and directions with their 95 % intervals, found from a file of readings.
The readings are simulated here: contacts of 0 to 4 mN by the beam, with 1 µT of noise, the true forces as circles.
"""
import tempfile
from pathlib import Path

import numpy as np

import ciliaval as cv

CASE = """
[case]
name = "sensor"
[cilium]
diameter = "3 mm"
segment = [
  { name = "base", length = "3 mm", young_modulus = "0.1 MPa", poisson_ratio = 0.49 },
  { name = "magnet", length = "17 mm", young_modulus = "3 MPa", poisson_ratio = 0.49, magnetization = "75 kA/m" },
]
[load]
type = "contact"
force = "4 mN"
height = "16 mm"
[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["beam"]
fields = ["volume"]
"""
random = np.random.default_rng(2)
forces = np.concatenate([np.zeros(20), np.linspace(0, 4e-3, 40), np.linspace(4e-3, 0, 40)])
with tempfile.TemporaryDirectory() as folder:
    file, log = Path(folder, "sensor.toml"), Path(folder, "log.csv")
    file.write_text(CASE)
    case = cv.Case(file)
    loads = [cv.Load("contact", force=f, height=16e-3, azimuth=np.radians(30)) for f in forces]
    B = np.array([s.B(case.sensors)[0] for s in cv.bend(case.cilium, loads, "beam", joints="corrected")])
    B += random.normal(0, 1e-6, B.shape)
    rows = np.column_stack([0.1 * np.arange(len(B)), 1e6 * B])
    np.savetxt(log, rows, delimiter=",", header="time [s], Bx [uT], By [uT], Bz [uT]", comments="", fmt="%.3f")
    found = cv.sense(file, log, models="beam/volume", noise="1 uT", unloaded="0 s..1.9 s")

loads = found[found["status"] == "found"]
print(f"{len(loads)} of {len(found)} samples have a load")
print(f"largest: {1e3 * loads['magnitude'].max():.3f} mN, true: {1e3 * forces.max():.3f} mN")
figure = cv.plot.readings(found)
figure.axes[0].plot(rows[::5, 0], 1e3 * forces[::5], "ko", markersize=5, markerfacecolor="none")
figure.savefig("readings.png", dpi=100)
