# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads every series of a result folder with ParaView and lists what is in it:
  pvpython paraview/arrays.py results/fig3b/vtk [arrays.json]
A line for each array: series, time, where it is, name, type, components, range of each component.
Ends with exit code 1 if a series cannot be read or has no points."""
import glob
import json
import os
import sys

from paraview import servermanager
from paraview.simple import PVDReader


def described(array):
    """Name, type, components and their ranges; strings have their values."""
    if array.GetDataType() == 13:  # VTK_STRING
        return {"name": array.GetName(), "type": "string",
                "values": [array.GetValue(i) for i in range(array.GetNumberOfValues())]}
    components = range(array.GetNumberOfComponents())
    return {"name": array.GetName(), "type": array.GetDataTypeAsString(),
            "components": len(components), "tuples": array.GetNumberOfTuples(),
            "ranges": [list(array.GetRange(c)) for c in components]}


def arrays(fields):
    return [described(fields.GetAbstractArray(i)) for i in range(fields.GetNumberOfArrays())]


def read(file):
    """The data of a series at each of its times."""
    source = PVDReader(FileName=file)
    steps = []
    for time in source.TimestepValues:
        source.UpdatePipeline(time)
        data = servermanager.Fetch(source)
        if data is None or data.GetNumberOfPoints() == 0:
            raise ValueError(f"{file}: no points at time {time}")
        steps.append({"time": time, "kind": data.GetClassName(), "points": data.GetNumberOfPoints(),
                      "cells": data.GetNumberOfCells(), "bounds": list(data.GetBounds()),
                      "point_data": arrays(data.GetPointData()),
                      "cell_data": arrays(data.GetCellData()),
                      "field_data": arrays(data.GetFieldData())})
    if not steps:
        raise ValueError(f"{file}: no time steps")
    return steps


def lines(name, step):
    for where in ("point_data", "cell_data", "field_data"):
        for array in step[where]:
            if array["type"] == "string":
                what = " ".join(array["values"])[:80]
            else:
                ranges = ", ".join(f"{a:.6g} to {b:.6g}" for a, b in array["ranges"])
                what = f"{array['components']} x {array['tuples']}: {ranges}"
            yield f"{name} {step['time']:g} {where} {array['name']} {array['type']} {what}"


def main():
    folder = sys.argv[1]
    files = sorted(glob.glob(os.path.join(folder, "*.pvd")))
    if not files:
        sys.exit(f"error: there is no .pvd file in {folder}")
    found = {}
    failed = False
    for file in files:
        name = os.path.basename(file)[:-4]
        try:
            found[name] = read(file)
        except (ValueError, RuntimeError) as error:
            print("error:", error, file=sys.stderr)
            failed = True
            continue
        for step in found[name]:
            print(*lines(name, step), sep="\n")
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w") as out:
            json.dump(found, out, indent=1)
    sys.exit(failed)


main()
