# SPDX-License-Identifier: LGPL-2.1-or-later
"""Claims of the paper on the flow (3.5, Fig. 5)."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from ..arrays import Array
from ..model import Case, bend, toml_of
from ..sensing.bench import bench_json, read_bench, run_bench
from ..sensing.response import Pair
from .cases import RODS, Setting, at_rest, dB, solved
from .claim import Claim, Unstated, in_range, scanned

_BASE = "cilium.segment.base.young_modulus"
_R2 = 0.99
_ANGLE = 10.0  # degrees
_PART = 99.0  # % of the readings within it
_WATER = 1.0e-6  # kinematic viscosity of water at 20 deg C, m^2/s


def flow_claims(setting: Setting) -> list[Claim]:
    case = setting.case("fig5")
    setting.tell("claims: flow")
    return [largest_force(case), drag(case), linear_response(case, setting), direction(setting)]


def _speeds(case: Case) -> Array:
    """The case's velocities, m/s, by Eq. 11 with the paper's 1000 kg/m^3 and C_d = 1."""
    q = np.array([load.parameters["force_per_height"] for load in case.loads])
    return np.asarray(np.sqrt(2 * q / (1000 * case.cilium.diameter)))


def largest_force(case: Case) -> Claim:
    claim = Claim("3.5, Eq. 11", "the largest force per length is 0.375 N/m at 0.5 m/s")
    q = case.loads[-1].parameters["force_per_height"]
    claim.findings = [in_range("rho v2 C_d d/2", q, "N/m", 0.3745, 0.3755)]
    return claim


def drag(case: Case) -> Claim:
    """C_d of a circular cylinder across the flow.

    Without ends: Sucker and Brauer (1975), as `drag_coefficient = "cylinder"` has it. Over a free end
    the wake fills from above, which takes 20 to 40 % of it at L/d = 7: assumed, of the order that
    experiments with cylinders on a wall report.
    """
    claim = Claim("3.5", "the drag coefficient is approximately 1")
    v = _speeds(case)
    Re = v * case.cilium.diameter / _WATER
    C_d = _core.cylinder_drag_coefficient(Re)
    claim.findings = [
        in_range("cylinder without ends", C_d, "", 0.5, 1.5),
        in_range("with a free end, assumed 0.6 to 0.8 of it", [0.6 * C_d.min(), 0.8 * C_d.max()], "", 0.5, 1.5),
    ]
    claim.note = (
        f"Sucker and Brauer (1975) at Re = {Re[0]:.0f} to {Re[-1]:.0f}; with room of half a digit. It changes by "
        f"{100 * (C_d.max() / C_d.min() - 1):.0f} % over the speeds, so that the force is not quite v2."
    )
    return claim


def linear_response(case: Case, setting: Setting) -> Claim:
    claim = Claim(
        "3.5",
        "the field's change is approximately linear in v2",
        "R2 of a straight line through |dB| over the case's velocities; held to R2 > 0.99, as the paper's other "
        "comparisons are. The paper gives no figure.",
    )
    number = Unstated(
        "E1", "MPa", 0.05, 0.2, 1e-6 * case.cilium.segments[0].young_modulus,
        "3.5 names Ecoflex 0030 and no modulus; its data sheet has 69 kPa at 100 % strain, 3.2 some 0.1 MPa", _BASE, True,
    )  # fmt: skip
    pairs = [*RODS, Pair("solid", "mesh")] if setting.with_solid else RODS
    for pair in pairs:

        def r2(of: Case) -> float:
            return _linearity(of, pair)

        if pair.mechanics == "solid":
            of = case.changed({})
            of.mechanics = ["solid"]
            claim.findings.append(in_range(str(pair), solved(of, setting, lambda: r2(of)), "", _R2, 1))
            continue
        claim.findings.append(in_range(str(pair), r2(case), "", _R2, 1))
        claim.scans.append(scanned(number, str(pair), lambda x: r2(case.changed({_BASE: 1e6 * x})) - _R2))
    return claim


def _linearity(case: Case, pair: Pair) -> float:
    """R2 of |dB| = a q + b: q is v2 but for a factor. NaN if the cilium does not bear the flow."""
    q = np.array([load.parameters["force_per_height"] for load in case.loads])
    if pair.mechanics == "solid":
        rest, *bent = bend(case.cilium, [at_rest(case.loads[0]), *case.loads], pair.mechanics)
        change = np.array([s.dB(case.sensors[:1], pair.field)[0] for s in bent])
    else:
        change = dB([case.cilium] * len(q), case.loads, case.sensors[0], pair)
    y = np.linalg.norm(change, axis=1)
    misfit = y - np.polyval(np.polyfit(q, y, 1), q) if np.isfinite(y).all() else np.array(math.nan)
    return float(1 - np.sum(misfit**2) / np.sum((y - y.mean()) ** 2))


def direction(setting: Setting) -> Claim:
    """The bench of fig5.sense.toml, with other noise and other slowest flows."""
    claim = Claim(
        "abstract, 3.5, Fig. 5e",
        "direction of the flow within 10 deg, 0 to 0.5 m/s",
        "Simulated with the stated errors of cases/paper/fig5.sense.toml, without turbulence: 99 % of the readings within "
        "10 deg; +-: 95 %, from the scatter of the simulated sensors. At rest there is no direction. The paper's readings "
        "were not published.",
    )
    bench = setting.tables("fig5.sense.toml")
    case = setting.tables("fig5.toml")
    truths = ["beam/volume", "solid/mesh"] if setting.with_solid else ["beam/volume"]
    for truth in truths:
        bench["bench"]["truth"] = truth
        result = _simulated(bench, case, setting)
        name = f"{truth} by {result['models']}"
        of_all = result["sources"][-1]
        for what, errors in (
            (name, of_all["inversion"]),
            (f"{name}, linear fit", of_all["linear_fit"]),
            (f"{name}, slowest flow", result["by_magnitude"][0]),
        ):
            rms, off = math.degrees(errors["azimuth_rms"]), math.degrees(errors["azimuth_rms_interval"])
            claim.findings.append(in_range(f"{what}, rms", rms, "deg", 0, _ANGLE, off))
            part = 100 * errors["below_ten_degrees"]
            claim.findings.append(in_range(f"{what}, within 10 deg", part, "%", _PART, 100))

    bench["bench"]["truth"] = truths[0]
    noise = Unstated("noise", "uT", 0.1, 4, 0.5, "not in the paper: an MLX90393 has 0.3 to 4 uT by its averaging", "", True)
    slowest = Unstated("slowest flow", "m/s", 0.02, 0.2, 0.1, "\"0 to 0.5 m/s\": five speeds that the text does not name", "load.velocity", True)

    def margin(of_noise: float, speed: float) -> float:
        errors = {**bench["errors"], "noise": f"{of_noise!r} uT"}
        speeds = [f"{v!r} m/s" for v in (speed, 0.3, 0.5)]
        changed = {**case, "load": {**case["load"], "velocity": speeds}}
        result = _simulated({"bench": bench["bench"], "errors": errors}, changed, setting)
        return 100 * float(result["by_magnitude"][0]["below_ten_degrees"]) - _PART

    name = f"{truths[0]} by {bench['bench']['models']}"
    claim.scans = [
        scanned(noise, name, lambda x: margin(x, slowest.used)),
        scanned(slowest, name, lambda x: margin(noise.used, x)),
    ]
    return claim


def _simulated(bench: dict[str, Any], case: dict[str, Any], setting: Setting) -> dict[str, Any]:
    """Result of `ciliaval sense` for the bench with this case, both as tables."""
    whole = Case.from_dict(case, "fig5")
    whole.mechanics = [bench["bench"]["truth"].split("/")[0]]
    text = toml_of({**bench, "bench": {**bench["bench"], "case": "case.toml"}})

    def simulate() -> dict[str, Any]:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "case.toml").write_text(toml_of(case), encoding="utf-8")
            file = Path(folder) / "bench.sense.toml"
            file.write_text(text, encoding="utf-8")
            bench_of_file = read_bench(file)
            return bench_json(bench_of_file, run_bench(bench_of_file), {})

    found: dict[str, Any] = solved(whole, setting, simulate, text)
    return found
