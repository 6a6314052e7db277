# SPDX-License-Identifier: LGPL-2.1-or-later
# Opens every series of this folder in ParaView (5.10 or later):
#   paraview --script=open.py        to look at it
#   pvpython open.py picture.png     to draw the last step into a file
# Lengths are metres; the time of ParaView is the load in N, N/m or m (or the number of the step,
# if the load does not increase from step to step), of a sweep how far the surface has moved.
import glob
import json
import math
import os
import re
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(globals().get("__file__", "open.py")))
LoadPalette("WhiteBackground")
view = GetActiveViewOrCreate("RenderView")
times = [0.0]
said = []
line_colours = [[0.85, 0.1, 0.55], [0.9, 0.45, 0.0], [0.0, 0.55, 0.6]]


def names(prefix):
    return sorted(os.path.basename(f)[:-4] for f in glob.glob(os.path.join(here, prefix + "*.pvd")))


def read(name):
    source = PVDReader(registrationName=name, FileName=os.path.join(here, name + ".pvd"))
    times.extend(source.TimestepValues)
    # What is shown from now on is of the last step, and so are the ranges that scales follow.
    view.ViewTime = max(times)
    source.UpdatePipeline(view.ViewTime)
    return source


def arrows(source, vector, length, name):
    """Arrows along a vector array, the longest of the given length in metres."""
    largest = source.PointData[vector].GetRange(-1)[1]
    glyph = Glyph(registrationName=name, Input=source, GlyphType="Arrow")
    glyph.OrientationArray = ["POINTS", vector]
    glyph.ScaleArray = ["POINTS", vector]
    glyph.ScaleFactor = length / largest if largest > 0 else 1.0
    glyph.GlyphMode = "All Points"
    return glyph


def field_lines(source, name):
    """Lines of B through lines across both ends of the magnet, in the plane of bending."""
    across = [diameter * x / max(abs(tip[0]), abs(tip[1])) for x in tip]
    for end, centre in (("tip", top), ("base", bottom)):
        lines = StreamTracer(registrationName=f"{name} lines, {end}", Input=source, SeedType="Line")
        lines.Vectors = ["POINTS", "B"]
        lines.MaximumStreamlineLength = 5 * top[2]
        lines.SeedType.Point1 = [a - b for a, b in zip(centre, across)]
        lines.SeedType.Point2 = [a + b for a, b in zip(centre, across)]
        lines.SeedType.Resolution = 10
        display = Show(lines, view)
        display.LineWidth = 2
        paint(display, [0.0, 0.0, 0.0])


def on_a_grid(octree, name):
    """Lines would end where leaves of different sizes meet, but not on a grid."""
    around = ResampleToImage(registrationName=name + " grid", Input=octree)
    around.UseInputBounds = 0
    around.SamplingBounds = [c + s * top[2] for c in (0.0, 0.0, top[2] / 2) for s in (-1.2, 1.2)]
    around.SamplingDimensions = [61, 61, 61]
    return around


def in_front(display):
    """Nothing hides it; along the viewing direction the shift is not seen."""
    display.Position = [4 * diameter * x for x in to_viewer]


def say(text, colour):
    """A line of the list beside the picture."""
    said.append(text)
    display = Show(Text(registrationName=text, Text=text), view, "TextSourceRepresentation")
    display.WindowLocation = "Any Location"
    display.Position = [0.8, 0.78 - 0.035 * len(said)]
    display.FontSize = 9
    display.Color = colour


def paint(display, colour):
    """One colour, of no array."""
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour


def paint_segments(display, where, array):
    """Categories, each with its name: no scale."""
    palette = [[0.75, 0.75, 0.7], [0.25, 0.35, 0.6], [0.85, 0.6, 0.2], [0.35, 0.6, 0.4]]
    ColorBy(display, (where, array))
    colours = GetColorTransferFunction(array)
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [word for i, name in enumerate(segments) for word in (str(i), name)]
    colours.IndexedColors = [x for i in range(len(segments)) for x in palette[i % len(palette)]]
    key = GetScalarBar(colours, view)
    key.Title = "segment"
    key.ComponentTitle = ""
    key.WindowLocation = "Upper Right Corner"
    key.ScalarBarLength = 0.1
    key.TitleFontSize = key.LabelFontSize = 8
    key.HorizontalTitle = 1
    display.SetScalarBarVisibility(view, True)


def loaded_points(load, rod):
    """Where the load of the last step acts on a centreline, and along which direction."""
    points = paraview.servermanager.Fetch(rod).GetPoints()
    line = [points.GetPoint(i) for i in range(points.GetNumberOfPoints())]
    if "height" in load:
        chosen = [min(line, key=lambda point: abs(point[2] - load["height"]))]
    elif "arclength" in load:
        length = segment_lengths and sum(segment_lengths) or top[2]
        chosen = [line[round(load["arclength"] / length * (len(line) - 1))]]
    elif load["type"] in ("flow", "dead"):
        chosen = [line[round(part * (len(line) - 1))] for part in (0.2, 0.4, 0.6, 0.8, 1.0)]
    else:
        chosen = []  # the surface of a sweep has arrows of its own
    return chosen, [math.cos(load["azimuth"]), math.sin(load["azimuth"]), 0.0]


def load_arrows(load, rod):
    """Arrows of one length that end where the load acts."""
    points, direction = loaded_points(load, rod)
    for i, point in enumerate(points):
        length = (2 if len(points) == 1 else 1) * diameter
        arrow = Arrow(registrationName=f"load arrow {i}")
        placed = Transform(registrationName=f"load {i}", Input=arrow)
        placed.Transform.Scale = [length] * 3
        placed.Transform.Rotate = [0, 0, math.degrees(load["azimuth"])]
        reach = length + diameter / 2
        placed.Transform.Translate = [p - reach * e for p, e in zip(point, direction)]
        paint(Show(placed, view), [0.8, 0.1, 0.1])


def beside(name):
    """Text of a file of the results, or nothing: a folder may have been moved."""
    try:
        with open(os.path.join(here, os.pardir, name), encoding="utf-8") as stream:
            return stream.read()
    except OSError:
        return ""


segments = re.findall(r"\[\[cilium\.segment\]\]\s*name = ['\"](.*)['\"]", beside("case.toml"))
segment_lengths = [
    float(length)
    for length in re.findall(
        r'\[\[cilium\.segment\]\][^[]*?\nlength = "([-+.0-9e]+) m"', beside("case.toml")
    )
]
diameter = 1e-3
tip = [1.0, 0.0, 0.0]  # the direction of bending
top = [0.0, 0.0, 0.0]  # where the tip is
bottom = [0.0, 0.0, segment_lengths[0] if len(segment_lengths) > 1 else 0.0]  # of the magnet
summary = json.loads(beside("summary.json") or "{}")
steps = summary.get("steps", [])
# The model that leaves out least is the last, the reference.
order = list(steps[-1]["mechanics"]) if steps else ["elastica", "beam", "calculix", "solid"]
models = [name[len("centreline_") :] for name in names("centreline_")]
models.sort(key=lambda model: order.index(model) if model in order else -1)
reference = models[-1] if models else ""
rods = {model: read("centreline_" + model) for model in models}
rod = rods.get(reference)
if rod:
    diameter = 2 * rod.PointData["radius"].GetRange()[1]
    bounds = rod.GetDataInformation().GetBounds()
    deflection = [max(bounds[0:2], key=abs), max(bounds[2:4], key=abs), 0.0]
    tip = deflection if any(deflection) else tip
    top = deflection[:2] + [bounds[5]]
    segments = segments or [str(i) for i in range(int(rod.PointData["segment"].GetRange()[1]) + 1)]
tip = [x / math.hypot(*tip) for x in tip]
to_viewer = [tip[1], -tip[0], 0.0]

for i, model in enumerate(models):
    tube = Tube(registrationName=f"centreline_{model} tube", Input=rods[model])
    tube.Scalars = ["POINTS", "radius"]
    tube.VaryRadius = "By Absolute Scalar"
    tube.NumberofSides = 32
    display = Show(rods[model], view)
    if model != reference:
        Hide(tube, view)
        display.LineWidth = 3
        paint(display, line_colours[i % len(line_colours)])
        in_front(display)
        say(f"line: {model}", line_colours[i % len(line_colours)])
    elif "body_" + model in names("body_"):
        Hide(tube, view)
        Hide(rods[model], view)
    else:
        paint_segments(Show(tube, view), "POINTS", "segment")
if models:
    shown = "body" if "body_" + reference in names("body_") else "tube"
    say(f"{shown}: {reference}", [0.0, 0.0, 0.0])

for name in names("surface"):
    surface = read(name)
    # Its border too: from the side the surface is a line.
    for shown, width in ((surface, 1), (FeatureEdges(registrationName="border", Input=surface), 3)):
        display = Show(shown, view)
        paint(display, [0.55, 0.45, 0.3])
        display.LineWidth = width

for name in names("contact_"):
    force = arrows(read(name), "force", 2 * diameter, name + " force")
    paint(Show(force, view), [0.8, 0.1, 0.1])

if rod and steps:
    load_arrows(steps[-1]["load"], rod)

for name in names("body_"):
    body = read(name)
    deformed = WarpByVector(registrationName=name + " deformed", Input=body)
    deformed.Vectors = ["POINTS", "displacement"]
    deformed.ScaleFactor = 1.0
    if name == "body_" + reference:
        display = Show(deformed, view)
        display.NonlinearSubdivisionLevel = 2
        paint_segments(display, "CELLS", "MaterialIDs")

for name in names("dipoles_"):
    moments = read(name)
    if moments.GetDataInformation().GetNumberOfPoints() > 0:
        Hide(arrows(moments, "moment", diameter, name + " arrows"), view)

octrees = names("field_*_potential")
for name in octrees:
    field = read(name)
    if name == octrees[-1]:  # the most detailed deformation
        field_lines(on_a_grid(field, name), name)
    Hide(field, view)

grids = [name for name in names("field_") if name not in octrees]
for name in grids:
    field = read(name)
    valid = Threshold(registrationName=name + " valid", Input=field)
    valid.Scalars = ["POINTS", "valid"]
    valid.LowerThreshold = 1
    valid.UpperThreshold = 1
    if name == grids[-1] and not octrees:
        field_lines(field, name)
    plane = Slice(registrationName=name + " in the plane of bending", Input=valid)
    plane.SliceType.Origin = [0, 0, 0]
    plane.SliceType.Normal = [-tip[1], tip[0], 0.0]
    display = Show(plane, view)
    display.Opacity = 0.5
    ColorBy(display, ("POINTS", "B", "Magnitude"))
    colours = GetColorTransferFunction("B")
    colours.MapControlPointsToLogSpace()
    colours.UseLogScale = 1
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title = "magnitude of B in T, " + name[len("field_"):].replace("_", "/")
    bar.ComponentTitle = ""
    bar.TitleFontSize = 8
    bar.LabelFontSize = 8
    bar.ScalarBarLength = 0.5

for name in names("sensors"):
    points = read(name)
    symbols = Glyph(registrationName=name + " symbols", Input=points, GlyphType="Box")
    symbols.ScaleArray = ["POINTS", "No scale array"]
    symbols.OrientationArray = ["POINTS", "No orientation array"]
    symbols.ScaleFactor = diameter / 4
    symbols.GlyphMode = "All Points"
    paint(Show(symbols, view), [0.1, 0.5, 0.2])
    changes = [vector for vector in points.PointData.keys() if vector.startswith("dB_")]
    for vector in changes:
        paint(Show(arrows(points, vector, diameter, vector), view), [0.1, 0.5, 0.2])
    for vector in changes[:-1]:  # the arrows of the others lie on the most detailed pair's
        Hide(FindSource(vector), view)

animation = GetAnimationScene()
animation.UpdateAnimationUsingDataTimeSteps()
animation.AnimationTime = max(times)
view.ViewTime = max(times)
view.CameraParallelProjection = 1
view.CameraPosition = to_viewer
view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraViewUp = [0.0, 0.0, 1.0]
ResetCamera(view)
Render(view)
if len(sys.argv) > 1 and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1200, 900])
