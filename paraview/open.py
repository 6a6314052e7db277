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

import numpy
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


# Of a grid and a centreline: how far each point is outside the body, seen along the normal of the
# plane of bending; and B, which beside the body is continued from outside: between a point outside
# and one inside, B would be neither's. First, what ParaView has imported over Python's own names is removed.
OUTSIDE = """
import builtins, numpy
for name in dir(builtins):
    globals().pop(name, None)
(grid, rod), along = inputs, TIP
extent, origin, spacing = (of() for of in (grid.GetExtent, grid.GetOrigin, grid.GetSpacing))
axes = [o + h * numpy.arange(extent[2 * i], extent[2 * i + 1] + 1)
        for i, (o, h) in enumerate(zip(origin, spacing))]
z, y, x = numpy.meshgrid(*axes[::-1], indexing="ij")
u, nearest, outside = x * along[0] + y * along[1], numpy.full(x.shape, numpy.inf), 0.0 * x
S, d3, radius = (numpy.array(rod.PointData[name]) for name in ("S", "d3", "radius"))
for p, s, t, r in zip(numpy.array(rod.Points), S, d3, radius):
    du, dz, tu = u - p.dot(along), z - p[2], t.dot(along)
    way, closer = s + du * tu + dz * t[2], du**2 + dz**2 < nearest
    depth = numpy.maximum(abs(dz * tu - du * t[2]) - r, numpy.maximum(-way, way - S[-1]))
    outside = numpy.where(closer, depth, outside)
    nearest = numpy.where(closer, du**2 + dz**2, nearest)
for mask in {"valid", "vtkValidPointMask"} & set(grid.PointData.keys()):
    outside[numpy.array(grid.PointData[mask]).reshape(x.shape) == 0] = -r
B, known = numpy.array(grid.PointData["B"]).reshape(*x.shape, 3), outside > 0
sides = [(step, axis) for step in (-1, 1) for axis in (0, 1, 2)]
for layer in range(3):
    count = sum(numpy.roll(known, *side).astype(int) for side in sides)
    total = sum(numpy.roll(B * known[..., None], *side) for side in sides)
    new = ~known & (count > 0)
    B[new] = total[new] / count[new][:, None]
    known |= new
output.PointData.append(outside.ravel(), "outside")
output.PointData.append(B.reshape(-1, 3), "B")
"""


def around_the_body(field, name):
    """A field on a grid, cut a little inside of the body, which hides the ends of lines."""
    outside = ProgrammableFilter(registrationName=name + " outside", Input=[field, rod])
    outside.Script = OUTSIDE.replace("TIP", str(tip))
    around = Clip(registrationName=name + " around the body", Input=outside, ClipType="Scalar")
    around.Scalars = ["POINTS", "outside"]
    around.Value = -diameter / 5
    around.Invert = 0
    return around


def field_lines(around, name):
    """Lines of B in the plane of bending to the body, through points beyond both ends of the magnet
    and on both sides of its middle."""
    radius, magnet = diameter / 2, points_of(FindSource("dipoles_" + reference))
    first, *_, before, last = magnet
    up, down, middle = last - before, first - magnet[1], magnet[len(magnet) // 2]
    side = numpy.cross(last - first, to_viewer)
    side *= radius / numpy.linalg.norm(side)
    last = last + up * (1.5 * radius / numpy.linalg.norm(up))
    first = first + down * (max(1.5 * radius, first[2] + radius) / numpy.linalg.norm(down))
    seeds = {"tip": (last - 1.2 * side, last + 1.2 * side, 5),
             "base": (first - 1.2 * side, first + 1.2 * side, 5),
             "right": (middle + 1.8 * side, middle + 4.5 * side, 2),
             "left": (middle - 1.8 * side, middle - 4.5 * side, 2)}
    for place, (one, other, count) in seeds.items():
        lines = StreamTracer(registrationName=f"{name} lines, {place}", Input=around, SeedType="Line")
        lines.Vectors = ["POINTS", "B"]
        lines.MaximumStreamlineLength = 5 * top[2]
        lines.MaximumStepLength = 0.1  # of a cell
        lines.SeedType.Point1, lines.SeedType.Point2 = list(one), list(other)
        lines.SeedType.Resolution = count
        display = Show(lines, view)
        display.LineWidth = 2
        paint(display, [0.0, 0.0, 0.0])
        in_front(display, diameter / 10)


def on_a_grid(octree, name):
    """Lines would end where leaves of different sizes meet, but not on a grid."""
    around = ResampleToImage(registrationName=name + " grid", Input=octree)
    around.UseInputBounds = 0
    around.SamplingBounds = [c + s * top[2] for c in (0.0, 0.0, top[2] / 2) for s in (-1.2, 1.2)]
    around.SamplingDimensions = [61, 61, 61]
    return around


def points_of(source):
    points = paraview.servermanager.Fetch(source).GetPoints()
    return numpy.array([points.GetPoint(i) for i in range(points.GetNumberOfPoints())])


def in_front(display, distance):
    """Of what lies in the plane of bending. The shift is not seen along the viewing direction."""
    display.Position = [distance * x for x in to_viewer]


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
    line = points_of(rod)
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
        in_front(display, 4 * diameter)
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
    Hide(read(name), view)
grids = [name for name in names("field_") if name not in octrees]
# One field is drawn: of the most detailed deformation, and in closed form if there is one.
for name in (grids or octrees)[-1:]:
    field = read(name)
    cut = around_the_body(field if grids else on_a_grid(field, name), name)
    field_lines(cut, name)
    plane = Slice(registrationName=name + " in the plane of bending", Input=cut)
    plane.SliceType.Origin = [0, 0, 0]
    plane.SliceType.Normal = to_viewer
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
