# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a result folder's open.py in ParaView and writes what it made of it: each object of the
pipeline with its points, bounds and whether it is shown; the picture; and how much is in the picture:
  pvpython pipeline.py results/one/vtk picture.png pipeline.json"""
import json
import os
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

folder, picture, written = sys.argv[1:]
script = os.path.join(folder, "open.py")
sys.argv = [script, picture]
with open(script) as text:
    exec(compile(text.read(), script, "exec"), {"__file__": script, "__name__": "__main__"})

view = simple.GetActiveView()
objects = {}
for (name, _), source in simple.GetSources().items():
    information = source.GetDataInformation()
    display = servermanager.GetRepresentation(source, view)  # None: never shown
    data = servermanager.Fetch(source)
    vectors = data.GetPointData().GetArray("B") if "lines" in name else None
    objects[name] = {"type": source.GetXMLName(), "points": information.GetNumberOfPoints(),
                     "bounds": list(information.GetBounds()), "shown": bool(display and display.Visibility),
                     "coloured_by": getattr(display, "ColorArrayName", ["", ""])[1] or ""}
    if vectors is not None and data.GetNumberOfLines() > 0:
        # How well the lines follow B: the cosine between a line's pieces and B, at the least.
        points, B = vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(vectors)
        cosines = []
        for cell in range(data.GetNumberOfCells()):
            ids = data.GetCell(cell).GetPointIds()
            at = [ids.GetId(i) for i in range(ids.GetNumberOfIds())]
            steps, along = numpy.diff(points[at], axis=0), (B[at][1:] + B[at][:-1]) / 2
            lengths = numpy.linalg.norm(steps, axis=1) * numpy.linalg.norm(along, axis=1)
            cosines.extend(abs((steps * along).sum(axis=1)[lengths > 0] / lengths[lengths > 0]))
        objects[name]["median_cosine"] = float(numpy.median(cosines))

reader = vtkPNGReader()
reader.SetFileName(picture)
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3]
objects["picture"] = {"size": list(reader.GetOutput().GetDimensions()[:2]),
                      "drawn": float((pixels != 255).any(axis=1).mean()),
                      "colours": len(numpy.unique(pixels, axis=0))}
with open(written, "w") as out:
    json.dump(objects, out, indent=1)
