# SPDX-License-Identifier: LGPL-2.1-or-later
# Opens every series of this folder in ParaView (5.10 or later):
#   paraview --script=open.py        to look at it
#   pvpython open.py picture.png     to draw the last step into a file
# Lengths are metres; the time of ParaView is the load in N, N/m or m (or the number of the step,
# if the load does not increase from step to step), of a sweep how far the surface has moved.
# The picture is a view across the plane of bending: on the left the field in this plane with all
# that is in it, on the right the column that says what is what, above both a line about the step.
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
view.OrientationAxesVisibility = 0  # it would lie on the field; the column names the plane

# Pixels.
picture_height, column_width, line_height = 900, 330, 44

black, load_colour, sensor_colour = [0.0, 0.0, 0.0], [0.8, 0.1, 0.1], [0.5, 0.0, 0.55]
surface_colour, plate_colour = [0.55, 0.45, 0.3], [0.5, 0.5, 0.55]
field_colour, gravity_colour = [0.0, 0.35, 0.1], [0.3, 0.3, 0.3]
# As in the report's pictures.
segment_colours = [[0.79, 0.81, 0.84], [0.91, 0.6, 0.55], [0.56, 0.72, 0.87], [0.66, 0.84, 0.73]]
model_colours = {"elastica": [0.0, 0.45, 0.7], "beam": [0.84, 0.37, 0.0],
                 "calculix": [0.0, 0.62, 0.45], "solid": [0.8, 0.47, 0.65]}
field_colours = [[1.0, 1.0, 0.85], [0.78, 0.91, 0.71], [0.25, 0.71, 0.77], [0.13, 0.37, 0.66],
                 [0.03, 0.11, 0.35]]

# ---- Reading -----------------------------------------------------------------------------------


def names(prefix):
    return sorted(os.path.basename(f)[:-4] for f in glob.glob(os.path.join(here, prefix + "*.pvd")))


def read(name):
    source = PVDReader(registrationName=name, FileName=os.path.join(here, name + ".pvd"))
    # The ranges that scales follow are of the step that is shown.
    source.UpdatePipeline(view.ViewTime)
    return source


def beside(name):
    """Text of a file of the results, or nothing: a folder may have been moved."""
    try:
        with open(os.path.join(here, os.pardir, name), encoding="utf-8") as stream:
            return stream.read()
    except OSError:
        return ""


def steps_of(name):
    """Numbers of the steps in a series: it lacks those that did not converge."""
    with open(os.path.join(here, name + ".pvd"), encoding="utf-8") as stream:
        return [int(number) for number in re.findall(r'_(\d+)\.vt\w"', stream.read())]


def points_of(source):
    points = paraview.servermanager.Fetch(source).GetPoints()
    return numpy.array([points.GetPoint(i) for i in range(points.GetNumberOfPoints())])


def quantity(value, unit):
    """0.004 N is 4 mN, 0.0003 T are 0.3 mT."""
    for factor, prefix in ((1, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n")):
        if abs(value) >= 0.1 * factor:
            return f"{value / factor:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"


# ---- Drawing -----------------------------------------------------------------------------------


def paint(display, colour):
    """One colour, of no array."""
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour


def in_front(display, diameters):
    """Moves what lies in the plane of bending to the viewer. A parallel projection does not show it."""
    display.Position = [diameters * diameter * x for x in to_viewer]


def say(text, colour):
    """The next line of the column."""
    said.append(text)
    display = Show(Text(registrationName=text, Text=text), view, "TextSourceRepresentation")
    display.WindowLocation = "Any Location"
    display.Position = [column, 0.79 - 0.032 * len(said)]
    display.FontSize, display.Color = 17, colour


def arrows(source, vector, length, name):
    """Arrows along a vector array, the longest of the given length in metres."""
    largest = source.PointData[vector].GetRange(-1)[1]
    glyph = Glyph(registrationName=name, Input=source, GlyphType="Arrow")
    glyph.OrientationArray = ["POINTS", vector]
    glyph.ScaleArray = ["POINTS", vector]
    glyph.ScaleFactor = length / largest if largest > 0 else 1.0
    glyph.GlyphMode = "All Points"
    return glyph


def show_arrow(middle, along, name, colour):
    """An arrow that shows a direction; its length says nothing."""
    length = 1.5 * diameter
    along = numpy.array(along) / numpy.linalg.norm(along)
    arrow = Transform(registrationName=name, Input=Arrow(registrationName=name + " arrow"))
    arrow.Transform.Scale = [length] * 3
    arrow.Transform.Rotate = [0, -math.degrees(math.asin(along[2])),
                              math.degrees(math.atan2(along[1], along[0]))]
    arrow.Transform.Translate = list(middle - length / 2 * along)
    display = Show(arrow, view)
    paint(display, colour)
    in_front(display, 3)


def paint_segments(display, where, array):
    """Categories, each with its name: no scale."""
    ColorBy(display, (where, array))
    display.Ambient, display.Diffuse = 0.3, 0.75  # about the key's colours
    colours = GetColorTransferFunction(array)
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [word for i, name in enumerate(segments) for word in (str(i), name)]
    colours.IndexedColors = [x for i in range(len(segments))
                             for x in segment_colours[i % len(segment_colours)]]
    key = GetScalarBar(colours, view)
    key.Title = key.ComponentTitle = ""
    key.WindowLocation = "Any Location"
    key.Position = [column, 0.8]
    key.ScalarBarLength = 0.13
    key.LabelFontSize, key.ScalarBarThickness = 17, 24
    key.TextPosition = "Ticks left/bottom, annotations right/top"
    display.SetScalarBarVisibility(view, True)


# ---- The cilium --------------------------------------------------------------------------------

said = []
case = beside("case.toml")
summary = json.loads(beside("summary.json") or "{}")
steps = summary.get("steps", [])
segments = re.findall(r"\[\[cilium\.segment\]\]\s*name = ['\"](.*)['\"]", case)
# The model that leaves out least is the last, the reference.
order = list(steps[-1]["mechanics"]) if steps else list(model_colours)
models = [name[len("centreline_") :] for name in names("centreline_")]
models.sort(key=lambda model: order.index(model) if model in order else -1)
if not models:
    sys.exit(f"error: there is no centreline_*.pvd in {here}")
reference = models[-1]

rod = PVDReader(registrationName="centreline_" + reference,
                FileName=os.path.join(here, f"centreline_{reference}.pvd"))
animation = GetAnimationScene()
animation.UpdateAnimationUsingDataTimeSteps()
animation.AnimationTime = view.ViewTime = max(rod.TimestepValues)  # the last step of the reference
rod.UpdatePipeline(view.ViewTime)
rods = {model: rod if model == reference else read("centreline_" + model) for model in models}
drawn = steps_of("centreline_" + reference)
last = steps[drawn[-1]] if steps else {}
diameter = 2 * rod.PointData["radius"].GetRange()[1]
line = points_of(rod)
segments = segments or [str(i) for i in range(int(rod.PointData["segment"].GetRange()[1]) + 1)]
deflection = max((line - line[0])[:, :2], key=numpy.linalg.norm)
if not deflection.any():
    azimuth = last.get("load", {}).get("azimuth", 0.0)
    deflection = numpy.array([math.cos(azimuth), math.sin(azimuth)])
tip = list(deflection / numpy.linalg.norm(deflection)) + [0.0]  # the direction of bending
to_viewer = [tip[1], -tip[0], 0.0]

# Programmable filters begin with this: ParaView imports its own max, min, abs, … over Python's, here too.
OWN_NAMES = """
import builtins, numpy
for name in dir(builtins):
    globals().pop(name, None)
"""

# ---- The field in the plane of bending ---------------------------------------------------------

# Permeable plates count for `potential` only: pairs of lowest and highest corner.
plates = [[[float(x) for x in re.findall(r'([-+.0-9e]+) m"', corner)] for corner in corners]
          for corners in re.findall(r"plate\]\]\s*lower = (.*)\s*upper = (.*)", case)]
plates = plates if names("field_*_potential") else []

# Input: a grid and a centreline. The filter adds how far each point is outside the body, seen along the
# normal of the plane of bending, and B, which beside the body is continued from outside: between a point outside
# and one inside, B would be neither's.
OUTSIDE = OWN_NAMES + """
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


def on_a_grid(octree, name, points):
    """Lines would end where leaves of different sizes meet, but not on a grid around some points."""
    grid = ResampleToImage(registrationName=name + " grid", Input=octree)
    grid.UseInputBounds = 0
    grid.SamplingBounds = [c + s * 2 * diameter for least, most in zip(points.min(0), points.max(0))
                           for c, s in ((least, -1), (most, 1))]
    grid.SamplingDimensions = [61, 61, 61]
    return grid


def around_the_body(grid, name):
    """A field on a grid, cut a little inside of the body, which hides the ends of lines."""
    outside = ProgrammableFilter(registrationName=name + " outside", Input=[grid, rod])
    outside.Script = OUTSIDE.replace("TIP", str(tip))
    around = Clip(registrationName=name + " around the body", Input=outside, ClipType="Scalar")
    around.Scalars = ["POINTS", "outside"]
    around.Value = -diameter / 5
    around.Invert = 0
    return around


def field_lines(around, name, magnet):
    """Lines of B in the plane of bending to the body, through points beyond both ends of the magnet
    and on both sides of its middle."""
    radius = diameter / 2
    first, *_, before, end = magnet
    up, down, middle = end - before, first - magnet[1], magnet[len(magnet) // 2]
    side = numpy.cross(end - first, to_viewer)
    side *= radius / numpy.linalg.norm(side)
    end = end + up * (1.5 * radius / numpy.linalg.norm(up))
    first = first + down * (max(1.5 * radius, first[2] + radius) / numpy.linalg.norm(down))
    seeds = {"tip": (end - 1.2 * side, end + 1.2 * side, 5),
             "base": (first - 1.2 * side, first + 1.2 * side, 5),
             "right": (middle + 1.8 * side, middle + 4.5 * side, 2),
             "left": (middle - 1.8 * side, middle - 4.5 * side, 2)}
    for place, (one, other, count) in seeds.items():
        lines = StreamTracer(registrationName=f"{name} lines, {place}", Input=around, SeedType="Line")
        lines.Vectors = ["POINTS", "B"]
        lines.MaximumStreamlineLength = 5 * rod.PointData["S"].GetRange()[1]
        lines.MaximumStepLength = 0.1  # of a cell
        lines.SeedType.Point1, lines.SeedType.Point2 = list(one), list(other)
        lines.SeedType.Resolution = count
        display = Show(lines, view)
        display.LineWidth = 2
        paint(display, [0.1, 0.1, 0.1])
        in_front(display, 0.1)


def show_strength(plane):
    """Colours of |B|, each decade from a power of ten to the next; the last three of them."""
    strength = Calculator(registrationName="strength of the field", Input=plane)
    strength.ResultArrayName, strength.Function = "B in mT", "1000*mag(B)"
    display = Show(strength, view)
    display.Ambient, display.Diffuse = 1.0, 0.0  # the colours of the scale, without light
    ColorBy(display, ("POINTS", "B in mT"))
    least, most = strength.PointData["B in mT"].GetRange()
    highest = math.ceil(math.log10(most))
    lowest = max(math.floor(math.log10(max(least, 1e-30))), highest - 3)
    colours = GetColorTransferFunction("B in mT")
    colours.UseLogScale = 0  # not before the points are positive
    colours.RGBPoints = [x for i, colour in enumerate(field_colours)
                         for x in (10 ** (lowest + (highest - lowest) * i / 4), *colour)]
    colours.UseLogScale = 1
    colours.ColorSpace = "Lab"
    colours.AutomaticRescaleRangeMode = "Never"
    return display, colours, range(lowest, highest + 1)


def show_scale(display, colours, decades):
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title = bar.ComponentTitle = ""
    bar.LabelFontSize, bar.ScalarBarThickness = 17, 24
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [column, 0.08], 0.3
    bar.AddRangeLabels, bar.AutomaticLabelFormat, bar.LabelFormat = 0, 0, "%g"
    bar.UseCustomLabels, bar.CustomLabels = 1, [10.0**decade for decade in decades]


sensors = read("sensors") if names("sensors") else None
around = line  # points that the picture shows
if sensors:
    reach = 2 * rod.PointData["S"].GetRange()[1]
    near = [p for p in points_of(sensors) if numpy.linalg.norm(line - p, axis=1).min() <= reach]
    around = numpy.vstack([line, *near])

octrees = names("field_*_potential")
grids = [name for name in names("field_") if name not in octrees]
sources = {name: read(name) for name in grids + octrees}
for source in sources.values():
    Hide(source, view)
moments = {name: read(name) for name in names("dipoles_")}
for name, source in moments.items():
    if source.GetDataInformation().GetNumberOfPoints() > 0:
        Hide(arrows(source, "moment", diameter, name + " arrows"), view)

# One field is drawn: of the most detailed deformation, and in closed form if there is one. The octree is
# fine at the sensors only, and a closed form knows no plates.
field = (grids or octrees)[-1:]
without_plates = ", without plates" if plates and grids else ""
strength = ()
extent = [around.dot(tip), around[:, 2]]
extent = [(x.min() - 2 * diameter, x.max() + 2 * diameter) for x in extent]
for name in field:
    grid = sources[name] if name in grids else on_a_grid(sources[name], name, around)
    cut = around_the_body(grid, name)
    plane = Slice(registrationName=name + " in the plane of bending", Input=cut)
    plane.SliceType.Origin = [0, 0, 0]
    plane.SliceType.Normal = to_viewer
    plane.UpdatePipeline(view.ViewTime)
    if plane.PointData["B"].GetRange(-1)[1] > 0:
        field_lines(cut, name, points_of(moments["dipoles_" + reference]))
        strength = show_strength(plane)
        in_plane = points_of(plane)
        extent = [(x.min(), x.max()) for x in (in_plane.dot(tip), in_plane[:, 2])]
(left, right), (bottom, top) = extent


def at(u, z):
    """The point of the plane of bending that is so far along the direction of bending, and so high."""
    return numpy.array([u * tip[0], u * tip[1], z])


# A pixel is so many metres. The field fills the picture up to the column and the line.
pixel = max((top - bottom) / (picture_height - line_height), (right - left) / 1200)
width = max(round((right - left) / pixel) + column_width, 860)  # room for the line
column = ((right - left) / pixel + 15) / width
if strength:
    show_scale(*strength)

# ---- Bodies, loads and sensors -----------------------------------------------------------------

for model in models:
    tube = Tube(registrationName=f"centreline_{model} tube", Input=rods[model])
    tube.Scalars = ["POINTS", "radius"]
    tube.VaryRadius = "By Absolute Scalar"
    tube.NumberofSides = 32
    Hide(tube, view)
    if model == reference:
        continue
    display = Show(rods[model], view)
    display.LineWidth = 3
    paint(display, model_colours.get(model, black))
    in_front(display, 4)
    say(f"line: {model}", model_colours.get(model, black))

for name in names("body_"):
    deformed = WarpByVector(registrationName=name + " deformed", Input=read(name))
    deformed.Vectors = ["POINTS", "displacement"]
    deformed.ScaleFactor = 1.0
    Hide(deformed, view)
if "body_" + reference in names("body_"):
    display = Show(FindSource(f"body_{reference} deformed"), view)
    display.NonlinearSubdivisionLevel = 2
    paint_segments(display, "CELLS", "MaterialIDs")
else:
    paint_segments(Show(FindSource(f"centreline_{reference} tube"), view), "POINTS", "segment")
say(f"body: {reference}", black)
for name in field if strength else []:
    say("colours: magnitude of B in mT,", black)
    say("    by " + name[len("field_") :].replace("_", "/", 1) + without_plates, black)

# Where a load acts on a centreline: a point, or five of a load all along.
LOADED = OWN_NAMES + """
rod, load, along = inputs[0], LOAD, DIRECTION
points, S, theta, radius = (numpy.array(array) for array in
                            (rod.Points, *(rod.PointData[name] for name in ("S", "theta", "radius"))))
if "height" in load:
    chosen = [numpy.argmin(numpy.abs(points[:, 2] - load["height"]))]
elif "arclength" in load:
    chosen = [numpy.argmin(numpy.abs(S - load["arclength"]))]
else:
    chosen = [numpy.argmin(numpy.abs(S - part * S[-1])) for part in (0.2, 0.4, 0.6, 0.8, 1.0)]
to_mantle = radius / numpy.maximum(numpy.cos(theta), 0.4)
output.Points = points[chosen] - to_mantle[chosen][:, None] * numpy.array(along)
"""


def load_arrows(load):
    """Arrows of one length that end where the load acts on the mantle."""
    direction = [math.cos(load["azimuth"]), math.sin(load["azimuth"]), 0.0]
    loaded = ProgrammableFilter(registrationName="loaded", Input=rod, OutputDataSetType="vtkPolyData")
    loaded.Script = LOADED.replace("LOAD", str(load)).replace("DIRECTION", str(direction))
    arrow = Glyph(registrationName="load", Input=loaded, GlyphType="Arrow", GlyphMode="All Points")
    arrow.OrientationArray = ["POINTS", "No orientation array"]
    arrow.ScaleArray = ["POINTS", "No scale array"]
    arrow.ScaleFactor = (1 if load["type"] in ("flow", "dead") else 2) * diameter
    arrow.GlyphTransform.Rotate = [0, 0, math.degrees(load["azimuth"])]
    arrow.GlyphTransform.Translate = [-x for x in direction]
    display = Show(arrow, view)
    paint(display, load_colour)
    in_front(display, 3)
    say("arrow: load", load_colour)


def show_pin(load, touched):
    """The pin of a touch where it has gone, and the direction of its force on the cilium."""
    along, up = at(1, 0), at(0, 1)
    pin, on_mantle = load["touch"]["radius"], load["touch"]["at"] == "mantle"
    centre = at(touched["touch_displacement"] - pin - on_mantle * diameter / 2, load["height"])
    if pin > 0:
        cylinder = Cylinder(registrationName="pin", Radius=pin, Height=2 * diameter, Resolution=60)
        placed = Transform(registrationName="pin in its place", Input=cylinder)
        placed.Transform.Rotate = [0, 0, math.degrees(load["azimuth"])]  # its axis lies across the load
        placed.Transform.Translate = list(centre)
        display = Show(placed, view)
        paint(display, surface_colour)
        in_front(display, 2)
        say("pin", surface_colour)
    angle = touched["tip_angle"]  # that of the contact too
    contact = centre + pin * (math.cos(angle) * along - math.sin(angle) * up)
    force = touched["applied_force"] * along - touched["vertical_force"] * up
    size = numpy.linalg.norm(force)
    if size > 0:
        show_arrow(contact - 0.75 * diameter * force / size, force, "force of the pin", load_colour)
        say("arrow: force of the pin", load_colour)


load = last.get("load", {"type": ""})
touched = last.get("mechanics", {}).get(reference, {})
if touched.get("touch_displacement") is not None:
    show_pin(load, touched)
elif load["type"] in ("contact", "probe", "section", "flow", "dead"):
    load_arrows(load)

for name in names("contact_"):
    force = arrows(read(name), "force", 2 * diameter, name + " force")
    force.GlyphTransform.Translate = [-1, 0, 0]  # it ends at the body
    display = Show(force, view)
    paint(display, load_colour)
    in_front(display, 3)
    if name == "contact_" + reference:
        say("arrow: force of contact", load_colour)
    else:
        Hide(force, view)

# The surface's section in the plane of bending, as far as the picture goes: a ribbon above the cilium.
for name in names("surface"):
    section = Slice(registrationName=name + " in the plane of bending", Input=read(name))
    section.SliceType.Origin = [0, 0, 0]
    section.SliceType.Normal = to_viewer
    for end, sign in ((left, 1), (right, -1)):
        section = Clip(registrationName=f"{name} in the picture, {sign}", Input=section)
        section.ClipType.Origin = list(at(end, 0))
        section.ClipType.Normal = [sign * x for x in tip]
        section.Invert = 0
    section = ExtractSurface(registrationName=name + " section", Input=section)
    ribbon = LinearExtrusion(registrationName=name + " ribbon", Input=section, Vector=[0, 0, 1])
    ribbon.ScaleFactor = diameter / 3
    display = Show(ribbon, view)
    paint(display, surface_colour)
    display.Ambient, display.Diffuse = 1.0, 0.0
    in_front(display, 0.2)
    say("surface, and where it goes", surface_colour)
    before = steps[drawn[-2]]["load"]["travel"] if len(drawn) > 1 and steps else 0.0
    way = at(-1 if view.ViewTime and load.get("travel", 1.0) < before else 1, 0)
    show_arrow(at(left + diameter, top - diameter / 2), way, "travel", surface_colour)

# Plates' sections in the plane of bending.
for i, (lower, upper) in enumerate(plates):
    spans = [sorted((lower[k] / tip[k], upper[k] / tip[k])) for k in (0, 1) if abs(tip[k]) > 1e-9]
    start, end = (pick(limits) for pick, limits in zip((max, min), zip(*spans, (left, right))))
    low, high = max(lower[2], bottom), min(upper[2], top)
    if start < end and low < high:
        section = Plane(registrationName=f"plate {i}", Origin=list(at(start, low)),
                        Point1=list(at(end, low)), Point2=list(at(start, high)))
        display = Show(section, view)
        paint(display, plate_colour)
        display.Ambient, display.Diffuse = 1.0, 0.0
        in_front(display, 0.2)
        say(f"plate {i + 1}", plate_colour)

corner = at(right - diameter, bottom + diameter)
for vector, said_as, unit, colour in (("uniform_field", "uniform field", "T", field_colour),
                                      ("gravity", "gravity", "m/s2", gravity_colour)):
    along = numpy.array(last.get("environment", {}).get(vector, [0.0]))
    if along.any():
        show_arrow(corner, along, said_as, colour)
        say(f"arrow: {said_as}, {quantity(numpy.linalg.norm(along), unit)}", colour)
        corner = corner + at(0, 1.6 * diameter)

pair = ""
if sensors:
    symbols = Glyph(registrationName="sensors symbols", Input=sensors, GlyphType="Box")
    symbols.ScaleArray = ["POINTS", "No scale array"]
    symbols.OrientationArray = ["POINTS", "No orientation array"]
    symbols.ScaleFactor = diameter / 4
    symbols.GlyphMode = "All Points"
    display = Show(symbols, view)
    paint(display, sensor_colour)
    in_front(display, 3)
    changes = [vector for vector in sensors.PointData.keys() if vector.startswith("dB_")]
    for vector in changes:
        display = Show(arrows(sensors, vector, diameter, vector), view)
        paint(display, sensor_colour)
        in_front(display, 3)
    # The arrows of the others lie on that of the drawn field, or of the field that knows the plates.
    drawn_pair = f"dB_{reference}_potential" if plates else "".join(field).replace("field_", "dB_", 1)
    chosen = drawn_pair if drawn_pair in changes else changes[-1] if changes else ""
    for vector in changes:
        if vector != chosen:
            Hide(FindSource(vector), view)
    if chosen:
        pair = chosen[len("dB_") :].replace("_", "/", 1)
        say("sensor, arrow: change of B", sensor_colour)

# ---- The line above, the scale of lengths, the camera ------------------------------------------

UNITS = {"velocity": "m/s", "force": "N", "force_per_height": "N/m", "force_per_length": "N/m",
         "moment": "N m", "displacement": "m", "travel": "m", "scale": ""}


def line_about(number):
    """Case, step, load and the largest change of B at a sensor."""
    step = steps[number]
    said = [f"step {number + 1} of {len(steps)}"]
    load = step["load"]
    known = [key for key in UNITS if key in load][:1]
    said += [f"{load['type']}, {key} {quantity(load[key], UNITS[key])}".replace("_", " ") for key in known]
    changes = (step["fields"].get(pair) or {}).get("dB") or []
    changes = [math.hypot(*change) for change in changes if change and None not in change]
    if changes:
        said.append(f"change of B {quantity(max(changes), 'T')} by {pair}")
    return summary["case"] + ": " + ", ".join(said)


if steps:
    text = PythonAnnotation(registrationName="line", Input=rod)
    text.Expression = f"{[line_about(number) for number in drawn]}[t_index]"
    display = Show(text, view)
    display.WindowLocation = "Any Location"
    display.Position = [10 / width, 1 - 36 / picture_height]
    display.FontSize, display.Color = 19, black

size = 10 ** math.floor(math.log10(column_width * pixel / 2))
size *= max(factor for factor in (1, 2, 5) if factor * size < column_width * pixel / 2)
start = at(right + 15 * pixel, bottom + 20 * pixel)
display = Show(Line(registrationName="length", Point1=list(start), Point2=list(start + at(size, 0))), view)
display.LineWidth = 4
paint(display, black)
said_size = Text(registrationName="length text", Text=quantity(size, "m"))
display = Show(said_size, view, "TextSourceRepresentation")
display.WindowLocation, display.Position = "Any Location", [column + size / pixel / width + 0.01, 0.008]
display.FontSize, display.Color = 17, black

view.ViewSize = [width, picture_height]
view.CameraParallelProjection = 1
view.CameraParallelScale = picture_height * pixel / 2
view.CameraFocalPoint = list(at(left + width * pixel / 2, bottom + picture_height * pixel / 2))
view.CameraPosition = [f + 100 * diameter * x for f, x in zip(view.CameraFocalPoint, to_viewer)]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.StillRender()  # Render would move the camera
if len(sys.argv) > 1 and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[width, picture_height])
