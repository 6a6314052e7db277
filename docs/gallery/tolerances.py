# SPDX-License-Identifier: LGPL-2.1-or-later
"""
Which tolerance decides about the signal?
=========================================

You see what one standard deviation of each uncertain number does to the magnitude of the signal under 1 mN.
The modulus of the base and the sensor's depth decide here, so measure these two better.
"""
import tempfile
from pathlib import Path

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
force = "1 mN"
height = "16 mm"
[sensor]
position = ["0 mm", "0 mm", "-1.55 mm"]
[models]
mechanics = ["beam"]
fields = ["volume"]
[models.beam]
joints = "corrected"
"""
STUDY = """
[study]
name = "tolerances"
case = "sensor.toml"
pairs = ["beam/volume"]
outputs = ["dB_norm"]
[tolerances]  # standard deviations
cilium.diameter = "0.05 mm"
cilium.segment.base.length = "0.05 mm"
cilium.segment.base.young_modulus = "10 %"
cilium.segment.magnet.magnetization = "5 %"
load.height = "0.1 mm"
sensor.position.z = "0.1 mm"
"""
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "sensor.toml").write_text(CASE)
    Path(folder, "tolerances.study.toml").write_text(STUDY)
    study = cv.study(Path(folder, "tolerances.study.toml"))

entry = study["tolerances"]["pairs"]["beam/volume"]["dB_norm"]
print(f"|dB| = {1e6 * entry['nominal']:.2f} uT +- {1e6 * entry['deviation']:.2f} uT")
cv.plot.tornado(study, "beam/volume", "dB_norm").savefig("tolerances.png", dpi=120)
