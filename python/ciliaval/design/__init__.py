# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies, tolerances and optima of a case: docs/guide/studies.md. The points are solved by the compiled
module; what is made of them is here: summary, tolerances, search, optimum.

python3 -m ciliaval.design STUDY.toml: what `ciliaval study` runs.
"""
