# SPDX-License-Identifier: LGPL-2.1-or-later
"""How often the 95 % bands of rods hold the solid's values, on random designs: docs/evidence/band.md.

python3 tests/python/band_coverage.py rods [designs [first seed]]
python3 tests/python/band_coverage.py range [designs [first seed]]
python3 tests/python/band_coverage.py sense [designs [first seed]]
python3 tests/python/band_coverage.py inputs [draws [seed]]
"""

import math
import sys

import numpy as np
from scipy import stats

import ciliaval as cv

LOADS = ("contact", "flow", "section", "dead", "probe")
PAIRS = ("elastica/line", "elastica/volume", "beam/volume")
REFERENCE = "solid/mesh"


def random_cilium(rng, seed):
    """Base of 0.5 to 8 d, magnet of 2 to 10 d and 1 to 100 times stiffer; every second one with a segment between."""
    d = 1e-3 * math.exp(rng.uniform(0, math.log(4)))
    E = 1e6 * math.exp(rng.uniform(math.log(0.03), math.log(1)))
    ratio = math.exp(rng.uniform(0, math.log(100)))
    segments = [(d * math.exp(rng.uniform(math.log(0.5), math.log(8))), E, 0.0)]
    if seed % 2:
        segments.append((d * rng.uniform(0.5, 3), E * ratio ** rng.uniform(0.2, 0.8), 0.0))
    segments.append((d * rng.uniform(2, 10), E * ratio, 75e3))
    nu = [rng.uniform(0.3, 0.4999) for _ in segments]
    return cv.Cilium(d, [
        cv.Segment(length, modulus, nu[i], magnetization=M, name=f"s{i}") for i, (length, modulus, M) in enumerate(segments)
    ])  # fmt: skip


def random_load(rng, seed, cilium):
    """A load that turns the elastica's tip by 2 to 60 degrees; None where none does."""
    kind, L = LOADS[seed % len(LOADS)], cilium.length
    place = {"contact": {"height": L * rng.uniform(0.6, 0.9)}, "probe": {"height": L * rng.uniform(0.6, 0.9)},
             "section": {"arclength": L * rng.uniform(0.6, 1)}}.get(kind, {})  # fmt: skip
    wanted = math.radians(math.exp(rng.uniform(math.log(2), math.log(60))))
    azimuth = rng.uniform(-math.pi, math.pi)
    name = {"flow": "force_per_height", "dead": "force_per_length", "probe": "displacement"}.get(kind, "force")
    low, high, best = 1e-9, 10.0, None
    for _ in range(60):
        middle = math.sqrt(low * high)
        load = cv.Load(kind, **{name: middle}, **place, azimuth=azimuth)
        try:
            shape = cv.bend(cilium, load, "elastica")
            angle = shape.tip_angle if shape.has_shape else math.inf
        except (cv.SolverError, cv.InputError):
            angle = math.inf
        low, high, best = (middle, high, load) if angle < wanted else (low, middle, best)
    return best


def random_case(seed):
    rng = np.random.default_rng(seed)
    cilium = random_cilium(rng, seed)
    load = random_load(rng, seed, cilium)
    d, phi = cilium.diameter, rng.uniform(-math.pi, math.pi, 3)
    aside = d * np.array([0.0, rng.uniform(0, 0.3), rng.uniform(0.5, 1.5)])
    sensors = np.stack([aside * np.cos(phi), aside * np.sin(phi), -d * rng.uniform(0.3, 2, 3)], axis=-1)
    return cv.Case.from_objects(cilium, load, sensors, ["elastica", "beam", "solid"], ["line", "volume", "mesh"], f"seed{seed}")


def of_design(seed):
    """{(pair, quantity): [(error, band, the solid's own numerical error), …]}; None: the solid does not bear the load."""
    case = random_case(seed)
    result = case.run()
    if result.status("solid") != ["converged"]:
        return None
    runs = [(result, "")]
    corrected, fault = case._core.corrected("beam")
    if not fault:
        corrected.mechanics, corrected.fields = ["beam"], ["volume"]
        runs.append((cv.Case._of(corrected).run(), "corrected "))
    found = {}
    dB = result.dB(REFERENCE)[0]
    for run, word in runs:
        for model in run.models:
            if model == "solid" or run.status(model) != ["converged"]:
                continue
            for quantity in ("tip", "tip_angle"):
                values = run.tip if quantity == "tip" else run.tip_angle
                known = result.tip if quantity == "tip" else result.tip_angle
                error = float(np.linalg.norm(values(model)[0] - known("solid")[0]))
                own = result.steps[0]["mechanics"]["solid"][f"{quantity}_uncertainty"]
                own = math.nan if own is None else own
                found[word + model, quantity] = [(error, float(run.band(model, quantity)[0]), own)]
        for pair in set(PAIRS) & set(run.pairs):
            change = np.linalg.norm(run.dB(pair)[0], axis=1) - np.linalg.norm(dB, axis=1)
            bands = np.linalg.norm(run.dB_band(pair)[0], axis=1)
            own = np.linalg.norm(result.dB_uncertainty(REFERENCE)[0], axis=1)
            found[word + pair, "|dB|"] = list(zip(np.abs(change), bands, own))
    return found


def rods(designs=200, first=0, of_one=of_design):
    table, borne = {}, 0
    for seed in range(first, first + designs):
        try:
            found = of_one(seed)
        except cv.Error as error:
            print(f"seed {seed}: {error}", file=sys.stderr)
            continue
        borne += found is not None
        for key, values in (found or {}).items():
            table.setdefault(key, []).extend((seed, *value) for value in values)
            for error, band, own in values:
                if not error <= band:
                    print(f"seed {seed}: {' '.join(key)} is off by {error:.3g}, band {band:.3g}, solid's own {own:.3g}", file=sys.stderr)
    print(f"{borne} of {designs} designs, seeds {first} to {first + designs - 1}, count: the solid bears the load, or knows its range\n")
    print("| model | quantity | n | not known | in the band | with the solid's own error | median error | median band / error |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for (model, quantity), rows in table.items():
        seeds, error, band, own = np.array(rows, dtype=float).T
        known = np.isfinite(band)
        e, b, u = error[known], band[known], np.nan_to_num(own[known])  # where it knows it
        print(f"| {model} | {quantity} | {len(e)} | {(~known).sum()} | {100 * (e <= b).mean():.1f} % | {100 * (e <= b + u).mean():.1f} % | {np.median(e):.2e} | {np.median(b / e):.2f} |")


def of_range(seed):
    """{(model, "slip_off"): [(error, band, the solid's own)]} under half more than what the elastica bears; None: the
    solid does not slip off. Every second one is a probe."""
    rng = np.random.default_rng(seed)
    cilium = random_cilium(rng, seed)
    L, kind, name = cilium.length, *(("probe", "displacement") if seed // 2 % 2 else ("contact", "force"))
    place = {"height": min(L * rng.uniform(0.6, 0.9), L - 1e-3), "azimuth": rng.uniform(-math.pi, math.pi)}
    limit = cv.bend(cilium, cv.Load(kind, **{name: 1e-6}, **place, slip_off="rim"), "elastica").slip_off
    load = cv.Load(kind, **{name: 1.5 * limit}, **place, slip_off="rim")
    case = cv.Case.from_objects(cilium, load, [], ["elastica", "beam", "solid"], [], f"seed{seed}")
    result = case.run()
    solid = result.steps[0]["mechanics"]["solid"]
    key = "slip_off_displacement" if kind == "probe" else "slip_off_force"
    if solid["status"] != "slipped_off" or solid[key] is None:
        return None
    runs = [(result, "")]
    corrected, fault = case._core.corrected("beam")
    if not fault:
        corrected.mechanics = ["beam"]
        runs.append((cv.Case._of(corrected).run(), "corrected "))
    found = {}
    for run, word in runs:
        for model in set(run.models) - {"solid"}:
            value = run.steps[0]["mechanics"][model][key]
            if value is not None:
                own = solid["slip_off_uncertainty"]
                error, band = abs(value - solid[key]), run.band(model, "slip_off")[0]
                found[word + model, kind] = [(error / solid[key], band / solid[key], (math.nan if own is None else own) / solid[key])]
    return found


FORCES, DRAWS, NOISE = 11, 10, 0.4e-6


def sensed(seed):
    """Readings of the solid under eleven forces, with noise, and what sense makes of them: by each way of asking, of
    each reading (error, interval, of which the model's), N; None: the solid does not bear the largest."""
    rng = np.random.default_rng(seed)
    cilium = random_cilium(rng, seed)
    load = random_load(rng, 0, cilium)  # a contact
    force, height, phi, d = load.parameters["force"], load.parameters["height"], rng.uniform(-3, 3), cilium.diameter
    forces = force * np.linspace(1 / FORCES, 1, FORCES)
    aside = d * rng.uniform(0, 0.3)
    sensor = [aside * math.cos(phi), aside * math.sin(phi), -d * rng.uniform(0.3, 2)]
    azimuth = rng.uniform(-math.pi, math.pi)
    path = [cv.Load("contact", force=f, height=height, azimuth=azimuth) for f in forces]
    result = cv.Case.from_objects(cilium, path, sensor, ["solid"], ["mesh"]).run()
    if set(result.status("solid")) != {"converged"}:
        return None
    B = np.repeat(result.dB(REFERENCE)[:, 0], DRAWS, axis=0)
    B = B + NOISE * rng.standard_normal(B.shape)
    case = cv.Case.from_objects(cilium, path, sensor, ["elastica"], ["volume"])
    found = {}
    for joints in ("corrected", "case"):
        frame = cv.sense(case, B, noise=NOISE, joints=joints)
        error = np.abs(frame["magnitude"] - np.repeat(forces, DRAWS))
        counted = frame["status"].isin(["found", "nothing", "misfit"])
        found[joints] = np.stack([error, frame["magnitude_interval"], frame["model_interval"]], axis=-1)[counted]
        found[joints + ", noise alone"] = found[joints].copy()
        total, model = found[joints][:, 1], found[joints][:, 2]
        found[joints + ", noise alone"][:, 1] = np.sqrt(total**2 - model**2)
    return found


def sense(designs=100, first=0):
    table, borne = {}, 0
    for seed in range(first, first + designs):
        try:
            found = sensed(seed)
        except cv.Error as error:
            print(f"seed {seed}: {error}", file=sys.stderr)
            continue
        borne += found is not None
        for key, rows in (found or {}).items():
            table.setdefault(key, []).append(rows)
            if not (rows[:, 0] <= rows[:, 1]).mean() > 0.9:
                print(f"seed {seed}: {key}: {(rows[:, 0] <= rows[:, 1]).mean():.2f}", file=sys.stderr)
    print(f"{borne} of {designs} designs, seeds {first} to {first + designs - 1}, {FORCES} forces of {DRAWS} readings each\n")
    print("| joints, interval | readings | hold the force | designs with 90 % | median interval / error | of it the model |")
    print("| --- | --- | --- | --- | --- | --- |")
    for key, of_designs in table.items():
        rows = np.concatenate(of_designs)
        held = rows[:, 0] <= rows[:, 1]
        each = [(r[:, 0] <= r[:, 1]).mean() >= 0.9 for r in of_designs]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio, share = np.nanmedian(rows[:, 1] / rows[:, 0]), np.nanmedian(rows[:, 2] / rows[:, 1])
        print(f"| {key} | {len(rows)} | {100 * held.mean():.1f} % | {100 * np.mean(each):.0f} % | {ratio:.2f} | {100 * share:.0f} % |")


# Standard uncertainties: of E of the base, E and M of the magnet, and the sensor's z (m).
INPUTS = {"cilium.segment.base.young_modulus": "5 %", "cilium.segment.magnet.young_modulus": "5 %",
          "cilium.segment.magnet.magnetization": "3 %", "sensor.position.z": "0.05 mm"}  # fmt: skip
OF_INPUTS = """
[case]
name = "inputs"
[cilium]
diameter = "3 mm"
segment = [
  { name = "base", length = "3 mm", young_modulus = "0.1 MPa", poisson_ratio = 0.49 },
  { name = "magnet", length = "17 mm", young_modulus = "3 MPa", poisson_ratio = 0.49, magnetization = "75 kA/m" },
]
LOAD
[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["elastica"]
fields = ["volume"]
"""
OF_LOADS = {
    "contact": '[load]\ntype = "contact"\nforce = ["1 mN", "3 mN"]\nheight = "16 mm"\nazimuth = "30 deg"',
    "flow": '[load]\ntype = "flow"\nvelocity = ["0.2 m/s", "0.5 m/s"]\nazimuth = "-70 deg"',
    "sweep": '[load]\ntype = "sweep"\ninterference = "1 mm"\ntravel = "12 mm"\nsamples = 13\n[surface]\nprofile = "flat"\n'
    "friction = 0.2",
}


def with_inputs(load):
    """The case with its uncertainties."""
    tables = "".join(f'[[input_uncertainty]]\nnumber = "{n}"\nuncertainty = "{u}"\n' for n, u in INPUTS.items())
    return cv.Case.from_text(OF_INPUTS.replace("LOAD", OF_LOADS[load]) + tables)


def drawn(case, rng):
    """The case with other inputs, within their uncertainties."""
    numbers = case._core.numbers()
    values = {}
    for name, u in INPUTS.items():
        value = numbers[name][0]
        sigma = float(u.split()[0]) / 100 * value if "%" in u else 1e-3 * float(u.split()[0])
        values[name] = value + sigma * rng.standard_normal()
    return case.changed(values)


def inputs(draws=1000, seed=0):
    print("| load | steps | tip in 1.96 u_in | each dB in 1.96 u_in | all dB of a path in their joint region |")
    print("| --- | --- | --- | --- | --- |")
    for load in OF_LOADS:
        case, rng = with_inputs(load), np.random.default_rng(seed)
        result = case.run()
        tip, dB = result.tip("elastica"), result.dB("elastica/volume")
        u_tip, u = result.input_uncertainty("elastica"), result.dB_input_uncertainty("elastica/volume")
        values, vectors = np.linalg.eigh(result.dB_covariance("elastica/volume"))
        kept_directions = values > 1e-3 * values.max()  # in the others what is left of the linearisation counts
        directions, variances = vectors[:, kept_directions], values[kept_directions]
        limit = stats.chi2.ppf(0.95, len(variances))
        plain = cv.Case.from_text(OF_INPUTS.replace("LOAD", OF_LOADS[load]))
        held_tip, held, chi = [], [], []
        for _ in range(draws):
            one = drawn(plain, rng)
            shapes = cv.bend(one.cilium, one.loads)
            kept = [i for i, s in enumerate(shapes) if s.has_shape and np.isfinite(u_tip[i]) and u_tip[i] > 0]
            away = np.array([shapes[i].tip for i in kept]) - tip[kept]
            # The tip moves along a curve: one degree of freedom, whose standard deviation is that of its distance.
            held_tip.append(np.linalg.norm(away, axis=1) <= 1.96 * u_tip[kept])
            off = np.array([shapes[i].dB(one.sensors)[0] for i in kept]) - dB[kept, 0]
            known = u[kept, 0] > 1e-3 * u.max()
            held.append((np.abs(off) <= 1.96 * u[kept, 0])[known])
            if len(kept) == len(shapes):
                chi.append(((off.ravel() @ directions) ** 2 / variances).sum() <= limit)
        print(f"| {load} | {len(tip)} | {100 * np.concatenate(held_tip).mean():.1f} % | {100 * np.concatenate(held).mean():.1f} % | "
              f"{100 * np.mean(chi) if chi else math.nan:.1f} % |")  # fmt: skip


if __name__ == "__main__":
    what, *numbers = sys.argv[1:] or ["rods"]
    {"rods": rods, "range": lambda *n: rods(*n, of_one=of_range), "sense": sense, "inputs": inputs}[what](*map(int, numbers))
