# SPDX-License-Identifier: LGPL-2.1-or-later
"""The interactive view of a case: the bent cilium and |B| in the plane of the load, by view.js."""

from __future__ import annotations

import base64
import re
import zlib
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..arrays import Array
from ..files import content
from ..plain_cilium import PlainCilium
from ..plot.style import SEGMENTS, best_first
from ..results import Result
from ..units import describe_load, in_words
from .blocks import View

# three.js as Debian's libjs-three has it.
_THREE = Path("/usr/share/javascript/three")
_MOST_STEPS = 25
_POINTS = 48  # along a centreline
_PIXELS = 64  # of the plane's picture


def scripts() -> list[str]:
    """three.js, its orbit controls and view.js; empty where three.js is not installed."""
    files = [_THREE / "three.min.js", _THREE / "examples/js/controls/OrbitControls.js"]
    if not all(file.exists() for file in files):
        return []
    files.append(Path(__file__).parent / "templates" / "view.js")
    return [file.read_text(encoding="utf-8") for file in files]


def view(result: Result) -> View | None:
    """View of a result; None if there is nothing to draw with, or nothing to draw."""
    if not scripts() or not result.has_case():
        return None
    cilium = PlainCilium.of(result.case_text)
    model = next((m for m in best_first(result.models) if "converged" in result.status(m)), None)
    if model is None:
        return None
    known = [i for i, status in enumerate(result.status(model)) if status == "converged"]
    grids = {i: grid for i in known if (grid := _grid_file(result, model, i))}
    steps = sorted(grids) or known
    steps = [steps[int(i)] for i in np.unique(np.linspace(0, len(steps) - 1, _MOST_STEPS).astype(int))]
    pictures = {i: _picture(read_grid(grids[i]), result.loads[i]) for i in steps if i in grids}
    values = np.concatenate([p["values"][np.isfinite(p["values"])] for p in pictures.values()] or [[]])
    scale = [float(values.min()), float(values.max())] if values.size else None
    azimuth = result.loads[steps[0]].get("azimuth", 0.0)
    data = {
        "extents": [cilium.extent(azimuth), cilium.extent(azimuth + np.pi / 2)],  # along the load, across
        "is_rectangle": cilium.sides is not None,
        "segments": [
            {"length": s.length, "name": s.name, "magnetic": any(s.magnetization),
             "colour": SEGMENTS[i % len(SEGMENTS)]}
            for i, s in enumerate(cilium.segments)
        ],
        "sensors": [list(map(float, p)) for p in result.sensors],
        "sensor_names": result.sensor_names,
        "scale": scale and [10 ** (s + 3) for s in scale],  # mT
        "pixels": _PIXELS,
        "steps": [_step(result, model, i, pictures.get(i), scale) for i in steps],
    }  # fmt: skip
    caption = f"The cilium is bent by the {model}; turn it with the mouse, a finger or the arrow keys. "
    if scale:
        field = in_words(sorted({re.sub(r".*_(\w+)_\d+$", r"\1", grids[i].stem) for i in grids}))
        caption += f"The plane shows |B| by {model}/{field} on a logarithmic scale."
    return View(f"{result.name} in three dimensions", caption, data)


def _step(
    result: Result, model: str, i: int, picture: dict[str, Any] | None, scale: list[float] | None
) -> dict[str, Any]:
    line = result.centreline(model, i)
    along = np.linspace(0, line["S"][-1], _POINTS)
    points = np.column_stack([np.interp(along, line["S"], line[axis]) for axis in "xyz"])
    step: dict[str, Any] = {
        "load": describe_load(result.loads[i], result.environments[i]),
        "azimuth": float(result.loads[i].get("azimuth", 0.0)),
        "S": [round(float(s), 7) for s in along],
        "points": [round(float(v), 7) for v in points.ravel()],
        "theta": [round(float(t), 4) for t in np.interp(along, line["S"], line["theta"])],
    }
    if picture is not None and scale is not None:
        low, high = scale
        bytes_of = np.clip(255 * (picture["values"] - low) / max(high - low, 1e-12), 0, 255)
        text = base64.b64encode(np.nan_to_num(bytes_of).astype(np.uint8).tobytes()).decode()
        step["plane"] = {"window": picture["window"], "values": text}
    return step


def _grid_file(result: Result, model: str, step: int) -> Path | None:
    if result.folder is None:
        return None
    found = sorted((result.folder / "vtk").glob(f"field_{model}_*_{step:04d}.vti"))
    return found[0] if found else None


def _picture(grid: dict[str, Any], load: dict[str, Any]) -> dict[str, Any]:
    """log10 |B| (T) in the vertical plane of the load through the axis, rows from below; `window` is
    (left, right, bottom, top) in m."""
    origin, spacing, field = grid["origin"], grid["spacing"], grid["B"]
    counts = np.array(field.shape[2::-1])
    low, high = origin, origin + spacing * (counts - 1)
    c, s = np.cos(load.get("azimuth", 0.0)), np.sin(load.get("azimuth", 0.0))
    # The field's plane reaches as far as it stays inside the grid's box.
    ends = []
    for sign in (-1, 1):
        reach = [
            (high[k] if sign * d > 0 else low[k]) / (sign * d)
            for k, d in enumerate((c, s))
            if abs(d) > 1e-9
        ]
        ends.append(sign * min(reach))
    along = np.linspace(ends[0], ends[1], _PIXELS)
    z = np.linspace(low[2], high[2], _PIXELS)
    points = np.stack(np.broadcast_arrays(c * along[None, :], s * along[None, :], z[:, None]), -1)
    norm = np.linalg.norm(field, axis=3)
    values = np.log10(np.maximum(_trilinear(norm, (points - low) / spacing), 1e-12))
    return {"values": values, "window": [float(v) for v in (*ends, low[2], high[2])]}


def _trilinear(values: Array, at: Array) -> Array:
    """values[z, y, x] at positions (…, 3) in cells."""
    most = np.array(values.shape[::-1]) - 2
    cell = np.clip(np.floor(at).astype(int), 0, most)
    part = np.clip(at - cell, 0, 1)
    total = np.zeros(at.shape[:-1])
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod([p if b else 1 - p for p, b in zip(np.moveaxis(part, -1, 0), corner)], axis=0)
        x, y, z = (cell + corner)[..., 0], (cell + corner)[..., 1], (cell + corner)[..., 2]
        total += weight * values[z, y, x]
    return total


def read_grid(file: Path) -> dict[str, Any]:
    """B of a .vti file of the program's: origin, spacing (m), B[z, y, x, component] (T). The format:
    VTK's XML with one appended, base64-coded, zlib-compressed section."""
    text = content(file)
    head, _, tail = text.partition(b"<AppendedData")
    data = tail[tail.index(b"_") + 1 : tail.index(b"</AppendedData")].strip()
    root = ElementTree.fromstring(head + b"</VTKFile>")
    image = root.find("ImageData")
    array = root.find(".//PointData/DataArray[@Name='B']")
    if image is None or array is None:
        raise ValueError(f"{file}: has no field B")
    extent = np.array(image.get("WholeExtent", "").split(), dtype=int).reshape(3, 2)
    counts = extent[:, 1] - extent[:, 0] + 1
    offset = int(array.get("offset", "0"))
    # The header: number of blocks, their size, the last one's size, the compressed sizes.
    count = int(np.frombuffer(base64.b64decode(data[offset : offset + 8])[:4], "<u4")[0])
    size = -(-4 * (3 + count) // 3) * 4
    header = np.frombuffer(base64.b64decode(data[offset : offset + size])[: 4 * (3 + count)], "<u4")
    body = base64.b64decode(data[offset + size : offset + size + -(-int(header[3:].sum()) // 3) * 4])
    ends = np.cumsum([0, *header[3:]])
    raw = b"".join(zlib.decompress(body[a:b]) for a, b in zip(ends, ends[1:]))
    return {
        "origin": np.array(image.get("Origin", "").split(), dtype=float),
        "spacing": np.array(image.get("Spacing", "").split(), dtype=float),
        "B": np.frombuffer(raw, "<f8").reshape(*counts[::-1], 3),
    }
