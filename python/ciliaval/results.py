# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of the program, from its files: docs/guide/results.md. SI units."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .arrays import Array
from .errors import FileError, InputError
from .files import DAMAGE, content, text_of, within

if TYPE_CHECKING:
    import pandas as pd

# Numbers of a shape in summary.json: quantity, unit, name of its uncertainty and band.
_SHAPE_COLUMNS = (
    ("tip", "m", "tip"),
    ("tip_angle", "rad", "tip_angle"),
    ("applied_force", "N", "applied_force"),
    ("contact_arclength", "m", None),
    ("slip_off_force", "N", "slip_off"),
    ("slip_off_displacement", "m", "slip_off"),
)

# The words of a comparison, docs/guide/results.md.
_WORDS = {
    "quantity": ("centreline", "tip", "tip_angle", "deflection", "B", "dB"),
    "component": (None, "x", "y", "z"),
    "statistic": ("value", "maximum", "rms", "r2", "rrmse"),
    "verdict": ("resolved", "below uncertainty", "inconclusive"),
}


@dataclass(frozen=True)
class Comparison:
    """One figure that separates a model from its reference; None is undefined or unknown.

    step: from 0; None: over the whole load path. sensor: from 0; None: not a field.
    difference, scale and uncertainty in `unit`; relative = difference / scale.
    verdict: "resolved", "below uncertainty" or "inconclusive".
    """

    step: int | None
    sensor: int | None
    quantity: str
    component: str | None
    statistic: str
    model: str
    reference: str
    difference: float | None
    relative: float | None
    scale: float | None
    unit: str | None
    uncertainty: float | None
    verdict: str

    @property
    def interval(self) -> tuple[float, float] | None:
        """The difference less and plus its numerical uncertainty."""
        if self.difference is None or self.uncertainty is None:
            return None
        return self.difference - self.uncertainty, self.difference + self.uncertainty


@dataclass(frozen=True)
class ValidationPoint:
    """A measured value beside a model's; None is not known. SI.

    error = simulated - measured; u_val² = u_num² + u_input² + u_D² (ASME V&V 20).
    verdict: "bounded": |error| > 2 u_val, the model's error is seen, between `least` = |error| - 2 u_val
    and `bound` = |error| + 2 u_val; "not resolved": it is not seen, but below `bound`; "not known".
    contributions: what one standard uncertainty of each input makes of `simulated`.
    """

    step: int
    measured: float
    u_D: float
    simulated: float | None
    error: float | None
    u_num: float | None
    u_input: float | None
    u_val: float | None
    bound: float | None
    verdict: str
    fitted: bool
    source: str
    contributions: tuple[float | None, ...] = ()
    note: str = ""
    least: float | None = None


@dataclass(frozen=True)
class ValidationSeries:
    """One model (or pair) and the values of one measurand.

    quantity: as the case states it, "tip.deflection"; point: (X, Y) in the end section, m.
    sensitivities_by: whose derivatives u_input is from. chi_squared: of the `assessed` points, with
    the inputs' errors the same at all of them; rms_error: √mean error².
    """

    model: str
    quantity: str
    point: tuple[float, float]
    unit: str
    sensitivities_by: str | None
    assessed: int
    bounded: int
    not_resolved: int
    fitted: int
    chi_squared: float | None
    rms_error: float | None
    points: tuple[ValidationPoint, ...]
    bounded_with_u_D: tuple[dict[str, Any], ...] = ()
    bounded_with_twice_u_input: int | None = None


@dataclass(frozen=True)
class Validation:
    """The models against measurements: docs/guide/validation.md.

    inputs: number, uncertainty, relative, unit, source of each. domain: from, to, unit, meaning by
    name; beyond it nothing is said. remarks: for people.
    """

    series: tuple[ValidationSeries, ...]
    inputs: tuple[dict[str, Any], ...]
    domain: dict[str, dict[str, Any]]
    remarks: tuple[str, ...]

    def of(self, **what: Any) -> list[ValidationSeries]:
        """Series with these attributes: of(model="beam", quantity="tip.deflection"). Raises InputError if no series has
        the model, quantity or point at all."""
        names = {"model": (), "quantity": (), "point": ()}
        return _chosen(self.series, ValidationSeries, what, names)


class Result:
    """Results of a case: load("results/fig3b"), or Case(...).run().

    Arrays have one row for each load step; NaN stands where a model has no equilibrium or does not
    know. `summary` is the whole of summary.json. `validation` is None without [[measurement]].
    """

    def __init__(self, summary: dict[str, Any], folder: Path | None = None, run: Any = None):
        for key in ("sensors", "steps"):
            if not isinstance(summary[key], list):
                raise TypeError(f"`{key}` is no list")
        self.summary = summary
        self.folder = folder
        self.name: str = summary["case"]
        self.title: str = summary["title"]
        self.sensors = np.array(summary["sensors"], dtype=float).reshape(-1, 3)
        self.sensor_names: list[str] = [str(name) for name in summary["sensor_names"]]
        self.steps: list[dict[str, Any]] = summary["steps"]
        self.loads: list[dict[str, Any]] = [step["load"] for step in self.steps]
        self.environments: list[dict[str, Any]] = [step.get("environment", {}) for step in self.steps]
        self.models: list[str] = list(dict.fromkeys(m for s in self.steps for m in s["mechanics"]))
        self.pairs: list[str] = list(dict.fromkeys(f for s in self.steps for f in s["fields"]))
        self.provenance: dict[str, Any] = summary["provenance"]
        self._run = run  # of Case.run(), in place of a folder
        self.validation: Validation | None = _validation(summary.get("validation"))

    def load(self, parameter: str) -> Array:
        """A parameter of the load at each step, (steps,): load("force"), N. Raises InputError for one
        that it does not have."""
        known = [name for name, value in self.loads[0].items() if not isinstance(value, str)]
        if parameter not in known:
            raise InputError(f"the load has no parameter {parameter!r}, but {', '.join(known)}")
        return np.array([float(load[parameter]) for load in self.loads])

    def sensor(self, name: int | str) -> int:
        """The number of a sensor by its name in the case, or by itself. Raises InputError."""
        if name in self.sensor_names:
            return self.sensor_names.index(str(name))
        if isinstance(name, (int, np.integer)) and 0 <= name < len(self.sensors):
            return int(name)
        raise InputError(f"{self.name} has no sensor {name!r}, but {', '.join(self.sensor_names) or 'none'}")

    @property
    def case_text(self) -> str:
        """The case with every value it used, as TOML. Raises FileError if it is not beside the summary."""
        return self._text("case.toml")

    def has_case(self) -> bool:
        return self._run is not None or (self.folder is not None and (self.folder / "case.toml").exists())

    def __getstate__(self) -> dict[str, Any]:
        """Plain data: a run's files as texts."""
        if self._run is None:
            return vars(self)
        return {**vars(self), "_run": Texts({name: self._run.text(name) for name in self._run.names()})}

    def _text(self, name: str) -> str:
        """The text of one of the files of results, on the disk or not."""
        if self._run is not None:
            return str(self._run.text(name))
        if self.folder is None:
            raise FileError(f"{self.name}: there is no {name} beside its summary.json")
        return content(within(self.folder, name)).decode("utf-8", errors="replace")

    def uniform_field(self) -> Array:
        """The field around the cilium at each step, (steps, 3), T: not a part of B."""
        return np.array([around.get("uniform_field", [0.0] * 3) for around in self.environments])

    def status(self, model: str) -> list[str]:
        """ "converged", "slipped_off", "pulled_in" or "failed" at each step."""
        return [str(self._of(step, model).get("status", "failed")) for step in self.steps]

    def tip(self, model: str) -> Array:
        """(steps, 3), m."""
        return self._mechanics(model, "tip", 3)

    def tip_uncertainty(self, model: str) -> Array:
        """Estimated numerical error of the tip's position, (steps,), m."""
        return self._mechanics(model, "tip_uncertainty")

    def tip_angle(self, model: str) -> Array:
        """(steps,), rad."""
        return self._mechanics(model, "tip_angle")

    def applied_force(self, model: str) -> Array:
        """(steps,), N."""
        return self._mechanics(model, "applied_force")

    def model_uncertainty(self, model: str, quantity: str = "tip") -> Array:
        """Error by the effects that a model leaves out, (steps,), SI: of "tip", "tip_angle", "applied_force" or
        "slip_off". NaN where it is not known: of a solid, and of a rod where the corrected joints do not reach
        (docs/theory/band.md)."""
        return self._part(model, "model_uncertainty", quantity)

    def input_uncertainty(self, model: str, quantity: str = "tip") -> Array:
        """Standard uncertainty by the case's [[input_uncertainty]] of a quantity as of model_uncertainty(), (steps,),
        SI; NaN where it is not known, or none is stated."""
        return self._part(model, "input_uncertainty", quantity)

    def band(self, model: str, quantity: str = "tip") -> Array:
        """The 95 % band of a quantity as of model_uncertainty(), (steps,), SI: its numerical error, what the
        model leaves out and 1.96 times what the inputs make; NaN where one is not known."""
        return self._part(model, "band", quantity)

    def contact(self, model: str, quantity: str = "normal_force") -> Array:
        """A number of a sweep's contact at each sample, (steps,), SI: normal_force, friction_force,
        elastic_energy, …; NaN where the cilium touches nothing."""
        known = {k for s in self.steps for k, v in self._of(s, model).get("contact", {}).items() if _is_number(v)}
        if quantity not in known:
            raise InputError(f"{model}'s contact has no number {quantity!r}, but {', '.join(sorted(known)) or 'none'}")
        return _numbers([self._of(s, model).get("contact", {}).get(quantity) for s in self.steps])

    def B(self, pair: str) -> Array:
        """Flux density by a pair of models, "beam/volume", (steps, sensors, 3), T."""
        return self._field(pair, "B")

    def dB(self, pair: str) -> Array:
        """B - B(straight cilium), (steps, sensors, 3), T."""
        return self._field(pair, "dB")

    @property
    def B_external(self) -> Array:
        """The field of uniform field and magnets of the environment at the sensors, (steps, sensors, 3), T; NaN where
        it is the same at all steps."""
        nothing = [[np.nan] * 3] * len(self.sensors)
        return np.array([step.get("B_external", nothing) for step in self.steps])

    def reading(self, pair: str) -> Array:
        """What the chip reads beyond the straight cilium without an environment: dB + B_external, (steps, sensors, 3),
        T; NaN where the environment's field is the same at all steps."""
        return self._field(pair, "reading")

    def dB_uncertainty(self, pair: str) -> Array:
        """The numerical error of dB, of field and shape, (steps, sensors, 3), T."""
        return self._field(pair, "dB_uncertainty")

    def dB_model_uncertainty(self, pair: str) -> Array:
        """Error of dB by the effects that the two models leave out, (steps, sensors, 3), T; NaN where it is not
        known."""
        return self._field(pair, "dB_model_uncertainty")

    def dB_input_uncertainty(self, pair: str) -> Array:
        """Standard uncertainty of dB by the case's [[input_uncertainty]], (steps, sensors, 3), T; NaN where it is not
        known, or none is stated."""
        return self._field(pair, "dB_input_uncertainty")

    def dB_covariance(self, pair: str) -> Array:
        """Covariance of all components of dB by the inputs, whose errors all steps and sensors share: (steps * sensors
        * 3,) * 2, T^2, rows as dB(pair).ravel() has them. NaN where it is not known; 0 if no input is stated."""
        inputs = self.summary.get("inputs", [])
        shape = (len(self.steps), len(self.sensors), 3)
        J = np.full((len(inputs), *shape), np.nan)
        for i, step in enumerate(self.steps):
            for k, rows in enumerate(step["fields"].get(pair, {}).get("dB_input_contributions", [])):
                for s, row in enumerate(rows or []):
                    J[k, i, s] = np.nan if row is None else row
        flat = J.reshape(len(inputs), int(np.prod(shape)))
        return np.asarray(flat.T @ flat)

    def dB_band(self, pair: str) -> Array:
        """The 95 % band of dB: numerical + model + 1.96 input, (steps, sensors, 3), T; NaN where one is not known."""
        return self._field(pair, "dB_band")

    def table(self) -> pd.DataFrame:
        """All numbers of the steps as a pandas frame, one a row: step (from 0), load (its magnitude), model (of a field
        the pair), sensor (its name), quantity, component, unit (SI), value, uncertainty (numerical) and band (95 %);
        NaN where one is not known.

        >>> result.table().query("quantity == 'dB' and component == 'x'")  # doctest: +SKIP
        """
        import pandas as pd

        rows: list[tuple[Any, ...]] = []
        for i, step in enumerate(self.steps):
            load = next((v for v in self.loads[i].values() if _is_number(v)), None)
            for model, entry in step["mechanics"].items():
                band = entry.get("band") or {}
                for quantity, unit, key in _SHAPE_COLUMNS:
                    value = entry.get(quantity)
                    each = zip("xyz", value) if isinstance(value, list) else [(None, value)]
                    for component, number in each if value is not None else ():
                        rows.append((i, load, model, None, quantity, component, unit, number,
                                     entry.get(f"{key}_uncertainty"), band.get(key)))  # fmt: skip
            for pair, entry in step["fields"].items():
                for quantity, prefix in (("B", ""), ("dB", "dB_")):
                    parts = [entry.get(key) or [] for key in (quantity, f"{prefix}uncertainty", f"{prefix}band")]
                    for s, vectors in enumerate(zip_longest(*parts)):
                        each = zip_longest("xyz", *(vector or [None] * 3 for vector in vectors))
                        rows += [(i, load, pair, self.sensor_names[s], quantity, c, "T", *xs) for c, *xs in each]
        names = ["step", "load", "model", "sensor", "quantity", "component", "unit", "value", "uncertainty", "band"]
        return pd.DataFrame(rows, columns=names).astype({name: float for name in ("load", *names[-3:])})

    def show(self) -> Any:
        """The bent cilium in three dimensions, to be turned, with a slider over the load steps: an object that a
        notebook shows. The field in the plane of the load is there if `ciliaval run` has written its grids.

        Raises FileError if no model has a shape, the folder has no case.toml, or libjs-three is not installed.

        >>> cv.load("results/fig3b").show()  # doctest: +SKIP
        """
        from .report.page import view_frame

        return view_frame(self)

    @property
    def comparisons(self) -> list[Comparison]:
        """All differences of two models."""
        names = Comparison.__dataclass_fields__
        return [
            Comparison(**{name: entry.get(name) for name in names})
            for entry in self.summary["comparisons"]
        ]

    def compare(self, **what: Any) -> list[Comparison]:
        """Comparisons with these attributes: compare(quantity="tip", step=0, verdict="below uncertainty").
        Raises InputError where there can be none, as with a misspelt model."""
        names = [*self.models, *self.pairs]
        valid = {
            **_WORDS,
            "model": names,
            "reference": names,
            "step": [None, *range(len(self.steps))],
            "sensor": [None, *range(len(self.sensors))],
        }
        if isinstance(what.get("verdict"), str):
            what["verdict"] = what["verdict"].replace("_", " ")
        return _chosen(self.comparisons, Comparison, what, valid)

    def centreline(self, model: str, step: int) -> dict[str, Array]:
        """S, x, y, z (m), theta (rad) and kappa (1/m) along a deformed centreline."""
        name = self._of(self.steps[step], model).get("centreline")
        if name is None:
            raise FileError(f"there is no file of {model}'s centreline at step {step}")
        return table_of(self._text(name), str((self.folder or Path()) / name))

    def to_meshio(self, model: str, step: int) -> Any:
        """The bent cilium as a meshio.Mesh with its fields, from the folder's VTK files: the body of
        a solid, else the centreline. docs/guide/meshes.md names the fields. Raises FileError."""
        from .export import to_meshio

        return to_meshio(self, model, step)

    def to_pyvista(self, model: str, step: int) -> Any:
        """The same as a pyvista.DataSet. Raises ImportError without PyVista."""
        from .export import to_pyvista

        return to_pyvista(self, model, step)

    def _of(self, step: dict[str, Any], model: str) -> dict[str, Any]:
        if model not in self.models:
            raise InputError(f"{self.name} has no model '{model}', but {', '.join(self.models)}")
        found: dict[str, Any] = step["mechanics"].get(model, {})
        return found

    def _part(self, model: str, what: str, quantity: str) -> Array:
        known = ("tip", "tip_angle", "applied_force", "slip_off")
        if quantity not in known:
            raise InputError(f"there is no {what} of {quantity!r}, but of {', '.join(known)}")
        return _numbers([(self._of(step, model).get(what) or {}).get(quantity) for step in self.steps])

    def _mechanics(self, model: str, quantity: str, size: int | None = None) -> Array:
        found = [self._of(step, model).get(quantity) for step in self.steps]
        if size is not None:
            found = [[None] * size if values is None else values for values in found]
        return _numbers(found, size)

    def _field(self, pair: str, quantity: str) -> Array:
        if pair not in self.pairs:
            raise InputError(f"{self.name} has no pair '{pair}', but {', '.join(self.pairs) or 'none'}")
        none = [None, None, None]
        rows = []
        for step in self.steps:
            values = step["fields"].get(pair, {}).get(quantity)
            values = [none] * len(self.sensors) if values is None else values
            rows.append([none if value is None else value for value in values])
        return _numbers(rows).reshape(len(self.steps), -1, 3)

    def __repr__(self) -> str:
        return (
            f"<Result of {self.name}: {len(self.steps)} steps, {', '.join(self.models)}; "
            f"{', '.join(self.pairs) or 'no fields'}>"
        )


class Texts:
    """The texts of files of results by their names, in place of a run."""

    def __init__(self, texts: dict[str, str]):
        self._texts = texts

    def names(self) -> list[str]:
        return list(self._texts)

    def text(self, name: str) -> str:
        if name not in self._texts:
            raise FileError(f"there is no {name} among the results")
        return self._texts[name]


class Document(dict[str, Any]):
    """A result file of another command, as its JSON: a dict. `kind` is "study", "budget",
    "converge", "sense", "calibrate", "claims" or "check"."""

    def __init__(self, kind: str, data: dict[str, Any], file: Path | None = None):
        super().__init__(data)
        self.kind = kind
        self.file = file


# The kind of a file by a key that no other has.
_KINDS = {
    "comparisons": "case",
    "points": "study",
    "chain": "budget",
    "studies": "converge",
    "by_magnitude": "sense",  # a test bench
    "samples": "sense",  # readings
    "levels": "sense",  # of a surface
    "residuals": "calibrate",
    "claims": "claims",
    "passed": "check",
}


def load(folder: str | Path) -> Result:
    """The results of a case in the folder that `ciliaval run` has written. Raises FileError."""
    folder = Path(folder)
    found = read(folder / "summary.json" if folder.is_dir() else folder)
    if not isinstance(found, Result):
        raise FileError(f"{folder}: is the result of `{found.kind}`, not of a case")
    return found


def load_study(folder: str | Path) -> Document:
    """The results of a study in the folder that `ciliaval study` has written. Raises FileError."""
    folder = Path(folder)
    found = read(folder / "study.json" if folder.is_dir() else folder)
    if not isinstance(found, Document) or found.kind != "study":
        raise FileError(f"{folder}: is no result of `ciliaval study`")
    return found


def read(file: str | Path) -> Result | Document:
    """Any JSON file of results, told by its keys. Raises FileError."""
    file = Path(file)
    try:
        data = json.loads(content(file).decode("utf-8"))
    except FileError:
        raise
    except DAMAGE as error:
        raise FileError(f"{file}: is damaged: {text_of(error)}") from error
    known = data if isinstance(data, dict) and "schema" in data else {}
    key = next((key for key in _KINDS if key in known), None)
    if key is None:
        raise FileError(f"{file}: is no result of ciliaval")
    if key != "passed" and not isinstance(data[key], list):
        raise FileError(f"{file}: is damaged: `{key}` is no list")
    for name, of in (("case", str), ("study", str), ("title", str), ("provenance", dict)):
        if not isinstance(data.get(name, of()), of):
            raise FileError(f"{file}: is damaged: `{name}` is of the wrong type")
    kind = _KINDS[key]
    return _result(data, file) if kind == "case" else Document(kind, data, file)


def from_summary(text: str) -> Result:
    """The result whose summary.json this is."""
    return Result(json.loads(text))


def from_run(run: Any) -> Result:
    """The result of a case that has run in this process: _core.CaseRun."""
    return Result(json.loads(run.text("summary.json")), run=run)


def _result(data: dict[str, Any], file: Path) -> Result:
    try:
        return Result(data, file.parent)
    except DAMAGE as error:
        raise FileError(f"{file}: is damaged: {error!r}") from error


def read_table(file: str | Path) -> dict[str, Array]:
    """The columns of one of the program's CSV files; text columns are arrays of str. Raises
    FileError."""
    try:
        text = content(Path(file)).decode("utf-8")
    except ValueError as error:
        raise FileError(f"{file}: is damaged: {text_of(error)}") from error
    return table_of(text, str(file))


def table_of(text: str, file: str) -> dict[str, Array]:
    """The columns of a CSV text; errors name the file. Raises FileError."""
    try:
        lines = text.splitlines(keepends=True)
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    except DAMAGE as error:
        raise FileError(f"{file}: is damaged: {text_of(error)}") from error
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        raise FileError(f"{file}: is damaged: its rows differ in length")
    columns = {}
    for name, *texts in zip(*rows):
        try:
            columns[name] = np.array([float(text) if text else np.nan for text in texts])
        except ValueError:
            columns[name] = np.array(texts)
    return columns


def _validation(data: dict[str, Any] | None) -> Validation | None:
    if data is None:
        return None
    series = []
    for entry in data["series"]:
        points = tuple(_of_fields(ValidationPoint, p) for p in entry["points"])
        series.append(_of_fields(ValidationSeries, {**entry, "points": points}))
    return Validation(tuple(series), tuple(data["inputs"]), data["domain"], tuple(data["remarks"]))


def _of_fields(kind: Any, data: dict[str, Any]) -> Any:
    """A dataclass from what the file knows of its fields; lists become tuples."""
    known = {key: data[key] for key in kind.__dataclass_fields__ if key in data}
    return kind(**{key: tuple(v) if isinstance(v, list) else v for key, v in known.items()})


def _chosen(entries: Any, kind: Any, what: dict[str, Any], valid: dict[str, Any]) -> list[Any]:
    """The entries with these attributes. `valid`: the values that each attribute can have besides
    those of the entries; an attribute that it does not name can have any."""
    unknown = set(what) - set(kind.__dataclass_fields__)
    if unknown:
        raise TypeError(f"{kind.__name__} has no {', '.join(sorted(unknown))}")
    for name, value in what.items():
        if name in valid:
            known = list(dict.fromkeys([*valid[name], *(getattr(e, name) for e in entries)]))
            if value not in known:
                raise InputError(f"{name}={value!r}: there is {', '.join(map(repr, known)) or 'none'}")
    return [e for e in entries if all(getattr(e, name) == value for name, value in what.items())]


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _numbers(values: list[Any], size: int | None = None) -> Array:
    """Array of the values, with NaN for None."""
    array = np.array(values, dtype=object)
    array = np.where(np.equal(array, np.array(None)), np.nan, array).astype(float)
    return array.reshape(-1, size) if size else array
