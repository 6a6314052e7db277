# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bent cilium for meshio and PyVista, from the VTK files of a result folder."""

from __future__ import annotations

import zlib
from base64 import b64decode
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from .arrays import Array
from .errors import FileError

if TYPE_CHECKING:
    from .results import Result


def to_meshio(result: Result, model: str, step: int) -> Any:
    import meshio

    file = vtk_file(result, model, step)
    try:
        root = ElementTree.parse(file).getroot()
        array = _decoder(root)
        arrays = {
            group: {a.get("Name"): array(a) for a in root.findall(f".//Piece/{group}/DataArray")}
            for group in ("PointData", "CellData", "Points", "Cells", "Lines")
        }
        points = arrays["Points"]["Points"]
        if file.suffix == ".vtp":
            line = arrays["Lines"]["connectivity"]
            return meshio.Mesh(points, {"line": np.stack([line[:-1], line[1:]], 1)}, arrays["PointData"])
        cells = arrays["Cells"]["connectivity"].reshape(-1, 27)
        return meshio.Mesh(
            points + arrays["PointData"]["displacement"],
            {"hexahedron27": cells},
            arrays["PointData"],
            {name: [values] for name, values in arrays["CellData"].items()},
        )
    except (ElementTree.ParseError, KeyError, ValueError, zlib.error) as error:
        raise FileError(f"{file}: is damaged: {error!r}") from error


def to_pyvista(result: Result, model: str, step: int) -> Any:
    try:
        import pyvista
    except ImportError as error:
        raise ImportError(
            "PyVista is not installed; Debian has no package of it: `pip install pyvista` in a "
            "virtual environment"
        ) from error
    file = vtk_file(result, model, step)
    mesh = pyvista.read(file)
    return mesh if file.suffix == ".vtp" else mesh.warp_by_vector("displacement")


def vtk_file(result: Result, model: str, step: int) -> Path:
    """The model's body at the step, or its centreline if it has none. Raises FileError."""
    number = range(len(result.steps))[step]
    status = result.status(model)[number]
    if result.folder is None:
        raise FileError(f"{result!r} has no files: `ciliaval run` writes them")
    names = [f"body_{model}_{number:04d}.vtu", f"centreline_{model}_{number:04d}.vtp"]
    for file in (result.folder / "vtk" / name for name in names):
        if file.exists():
            return file
    raise FileError(
        f"{result.folder / 'vtk'} has neither {names[0]} nor {names[1]}: {model} {status} there"
    )


def _decoder(root: ElementTree.Element) -> Callable[[ElementTree.Element], Array]:
    """Returns a function that makes the array of a <DataArray> of a file that VTK has written: appended, in base64,
    compressed in blocks. meshio cannot read the texts that are among them."""
    text = (root.findtext("AppendedData") or "").strip()[1:]

    def array(element: ElementTree.Element) -> Array:
        rest = text[int(element.attrib["offset"]) :]
        blocks = int(np.frombuffer(b64decode(rest[:8]), "<u4", 1)[0])
        start = _base64_length(4 * (3 + blocks))
        sizes = np.frombuffer(b64decode(rest[:start]), "<u4")[3:]
        body = b64decode(rest[start : start + _base64_length(int(sizes.sum()))])
        ends = np.cumsum(sizes)
        data = b"".join(zlib.decompress(body[end - n : end]) for n, end in zip(sizes, ends))
        values = np.frombuffer(data, np.dtype(element.attrib["type"].lower()))
        components = int(element.get("NumberOfComponents", 1))
        return values.reshape(-1, components) if components > 1 else values

    return array


def _base64_length(n: int) -> int:
    return -(-n // 3) * 4
