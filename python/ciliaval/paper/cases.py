# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped cases of the paper, changed and run; what takes minutes is kept."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _core
from ..arrays import Array
from ..errors import FileError, SolverError
from ..files import content, replacing
from .._core import Cilium, Load, bend_batch
from ..model import Case, Progress
from ..results import Result
from ..sensing.response import Pair

Vectors = Array  # (loads, 3), T

# The paper's two models of the field on its model of the mechanics, and better mechanics.
RODS = (Pair("elastica", "line"), Pair("elastica", "volume"), Pair("beam", "volume"))


@dataclass(frozen=True)
class Setting:
    """Options that all parts of the ledger share.

    folder: of the shipped cases (cases/paper/). with_solid: with the 3D solid, too.
    """

    folder: Path
    with_solid: bool
    progress: Progress | None = None

    def tables(self, name: str) -> dict[str, Any]:
        """The tables of a shipped file. Raises FileError."""
        try:
            return tomllib.loads(content(self.folder / name).decode("utf-8"))
        except ValueError as error:
            raise FileError(f"{self.folder / name}: {error}") from error

    def case(self, name: str) -> Case:
        return Case.from_dict(self.tables(f"{name}.toml"), str(self.folder / f"{name}.toml"))

    def tell(self, what: str) -> None:
        if self.progress:
            self.progress(what)


def run(case: Case, setting: Setting) -> Result:
    """All models of the case, all loads. Raises SolverError if one has no answer."""
    setting.tell(f"{case.name}: {', '.join(case.mechanics)}")
    result = Result(json.loads(_kept(case, lambda: case._core.run(None).text("summary.json"), "summary")))
    for step in result.steps:
        for model, found in step["mechanics"].items():
            if found["status"] != "converged":
                raise SolverError(f"claims: {case.name}: {model}: {found.get('message', '')}")
    return result


def solved(case: Case, setting: Setting, compute: Callable[[], Any], also: str = "") -> Any:
    """compute(), a value that JSON can state, which the case's models make: kept if the solid is one
    of them. also: what else it depends on."""
    setting.tell(f"{case.name}: {', '.join(case.mechanics)}")
    return json.loads(_kept(case, lambda: json.dumps(compute()), f"{compute.__qualname__} {also}"))


def dB(cilia: Sequence[Cilium], loads: Sequence[Load], sensor: Array, pair: Pair) -> Vectors:
    """The change of the field at the sensor, (3,) m, of each cilium under its load, (n, 3), T; NaN
    where it does not bear it."""
    bent, rest = (
        bend_batch(cilia, of, sensor, pair.mechanics, pair.field)["B"][:, 0]
        for of in (loads, [at_rest(load) for load in loads])
    )
    return bent - rest


def at_rest(load: Load) -> Load:
    """A load like this one of no force."""
    parameters = dict(load.parameters)
    parameters["force" if "force" in parameters else "force_per_height"] = 0.0
    return Load(load.type, **parameters)


def _kept(case: Case, make: Callable[[], str], what: str) -> str:
    """Text that make() returns. If the solid is among the models, minutes for a range of cases, the text is kept in the
    user's cache folder by the program's commit, this package's sources and everything that the case states; a program
    from sources without a commit keeps none."""
    program = json.loads(_core.provenance(""))
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    is_known = program["git"] not in ("", "unknown") and not program["git"].endswith("-dirty")
    if "solid" not in case.mechanics or not is_known or home.startswith("~"):
        return make()
    sources = [path.read_text(encoding="utf-8") for path in sorted(Path(__file__).parent.glob("*.py"))]
    words = [program["version"], program["git"], *sources, case.toml(), what]
    name = hashlib.sha256("\n".join(words).encode()).hexdigest()
    file = Path(home) / "ciliaval" / "claims" / f"{name}.json"
    with contextlib.suppress(FileError, ValueError):
        text = content(file).decode("utf-8")
        json.loads(text)
        return text
    text = make()
    with contextlib.suppress(FileError, OSError):  # a cache that cannot be written costs time only
        file.parent.mkdir(parents=True, exist_ok=True)
        with replacing(file) as scratch:
            scratch.write_text(text, encoding="utf-8")
    return text
