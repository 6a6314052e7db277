# SPDX-License-Identifier: LGPL-2.1-or-later
"""
What does each assumption of the paper's model cost?
====================================================

You see the way from the paper's model to the most detailed one, one assumption at a time, for the tip and the signal.
The solid's three dimensions take away a tenth of the deflection; the magnet's thickness adds to the signal.
"""
import tempfile
from pathlib import Path

import ciliaval as cv

CASE = """
[case]
name = "paper"
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
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["elastica"]
fields = ["line"]
"""
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "paper.toml").write_text(CASE)
    budget = cv.budget(Path(folder, "paper.toml"), without=["potential", "sensitivity"])

for row in budget["rows"]:
    if row["quantity"] == "tip" and row["component"] == "x":
        for stage, link in zip(budget["chain"][1:], row["links"]):
            print(f"{stage['name']}: {1e3 * link['value']:+.4f} mm")
cv.plot.budget(budget).savefig("error_budget.png", dpi=110)
