# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's quantitative statements, each with what the models find and what it hangs on.

The paper: Liu et al., "Modeling and Optimization of Biomimetic Magnetic Cilia for Multifunctional
Tactile Sensor". docs/evidence/paper.md.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..model import Case
from .cases import Setting, run
from .claim import Claim, Finding, Scan, Unstated, ledger_text
from .design import design_claims
from .dipoles import dipole_claims
from .flow import flow_claims
from .mechanics import mechanics_claims
from .surfaces import surface_claims

__all__ = ["Claim", "Finding", "Scan", "Unstated", "claims", "ledger_text"]


def claims(
    folder: str | Path, with_solid: bool = True, progress: Callable[[str], None] | None = None
) -> list[Claim]:
    """The ledger: every quantitative statement that the paper's text allows to be checked, and those
    that it does not, in the paper's order.

    folder: that of the shipped cases, cases/paper/. with_solid: also with the 3D solid, some minutes
    the first time; its part is kept in the user's cache folder. progress: called with a line of text.

    Raises InputError and FileError if a case is missing or not as shipped, SolverError if a model
    fails.

    >>> from ciliaval.paper import claims
    >>> ledger = claims("cases/paper", with_solid=False)  # doctest: +SKIP
    >>> [c.statement for c in ledger if c.verdict.startswith("depends on")]  # doctest: +SKIP
    """
    setting = Setting(Path(folder), with_solid, progress)
    tables = setting.tables("fig3d.toml")
    tables["models"] = {
        "mechanics": ["elastica", "beam", *(["solid"] if with_solid else [])],
        "fields": ["line", "volume"],
        "volume": {"slices": "stacked"},  # Eq. 8-9
    }
    case = Case.from_dict(tables, str(setting.folder / "fig3d.toml"))
    result = run(case, setting)
    return [
        *mechanics_claims(case, result, setting),
        *dipole_claims(case, result),
        *design_claims(setting),
        *flow_claims(setting),
        *surface_claims(setting),
    ]
