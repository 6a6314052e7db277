# SPDX-License-Identifier: LGPL-2.1-or-later
# Opens every series of this folder in ParaView (5.10 or later):
#   paraview --script=open.py        to look at it
#   pvpython open.py picture.png     to draw the last step into a file
# Lengths are metres; the time of ParaView is the load in N, N/m or m (or the number of the step,
# if the load does not increase from step to step), of a sweep how far the surface has moved.
import glob
import os
import sys

from paraview.simple import *

here = os.path.dirname(os.path.abspath(globals().get("__file__", "open.py")))
LoadPalette("WhiteBackground")
view = GetActiveViewOrCreate("RenderView")
times = [0.0]


def names(prefix):
    return sorted(os.path.basename(f)[:-4] for f in glob.glob(os.path.join(here, prefix + "*.pvd")))


def read(name):
    source = PVDReader(registrationName=name, FileName=os.path.join(here, name + ".pvd"))
    times.extend(source.TimestepValues)
    source.UpdatePipeline(max(source.TimestepValues))
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


def field_lines(octree, name):
    """Lines of B through a line across the tip, in the plane of bending."""
    height = top[2]
    # Lines end where leaves of different sizes meet, but not on a grid.
    around = ResampleToImage(registrationName=name + " grid", Input=octree)
    around.UseInputBounds = 0
    around.SamplingBounds = [c + s * height for c in (0.0, 0.0, height / 2) for s in (-1.2, 1.2)]
    around.SamplingDimensions = [61, 61, 61]
    across = [diameter * x / max(abs(tip[0]), abs(tip[1])) for x in tip]
    lines = StreamTracer(registrationName=name + " lines", Input=around, SeedType="Line")
    lines.Vectors = ["POINTS", "B"]
    lines.MaximumStreamlineLength = 5 * height
    lines.SeedType.Point1 = [a - b for a, b in zip(top, across)]
    lines.SeedType.Point2 = [a + b for a, b in zip(top, across)]
    lines.SeedType.Resolution = 20
    display = Show(lines, view)
    display.LineWidth = 2
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = [0.0, 0.0, 0.0]


bodies = names("body_")
diameter = 1e-3
tip = [1.0, 0.0, 0.0]  # the direction of bending
top = [0.0, 0.0, 0.0]  # where the tip is
for name in names("centreline_"):
    rod = read(name)
    diameter = 2 * rod.PointData["radius"].GetRange()[1]
    bounds = rod.GetDataInformation().GetBounds()
    deflection = [max(bounds[0:2], key=abs), max(bounds[2:4], key=abs), 0.0]
    tip = deflection if any(deflection) else tip
    top = deflection[:2] + [bounds[5]]
    line = Show(rod, view)
    line.LineWidth = 3
    ColorBy(line, ("POINTS", "kappa"))
    tube = Tube(registrationName=name + " tube", Input=rod)
    tube.Scalars = ["POINTS", "radius"]
    tube.VaryRadius = "By Absolute Scalar"
    tube.NumberofSides = 32
    if bodies:  # the tubes would hide the body
        Hide(tube, view)
    else:
        display = Show(tube, view)
        display.Opacity = 0.4
        ColorBy(display, ("POINTS", "kappa"))

for name in names("surface"):
    surface = read(name)
    # Its border too: from the side the surface is a line.
    for shown, width in ((surface, 1), (FeatureEdges(registrationName="border", Input=surface), 3)):
        display = Show(shown, view)
        display.AmbientColor = display.DiffuseColor = [0.55, 0.45, 0.3]
        display.ColorArrayName = ["POINTS", ""]
        display.LineWidth = width

for name in names("contact_"):
    force = arrows(read(name), "force", 2 * diameter, name + " force")
    display = Show(force, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = [0.8, 0.1, 0.1]

for name in bodies:
    body = read(name)
    deformed = WarpByVector(registrationName=name + " deformed", Input=body)
    deformed.Vectors = ["POINTS", "displacement"]
    deformed.ScaleFactor = 1.0
    display = Show(deformed, view)
    display.NonlinearSubdivisionLevel = 2
    display.Opacity = 0.6
    ColorBy(display, ("CELLS", "MaterialIDs"))

for name in names("dipoles_"):
    moments = read(name)
    if moments.GetDataInformation().GetNumberOfPoints() > 0:
        Hide(arrows(moments, "moment", diameter, name + " arrows"), view)

octrees = names("field_*_potential")
for name in octrees:
    field = read(name)
    if name == octrees[-1]:  # the most detailed deformation
        field_lines(field, name)
    Hide(field, view)

for name in names("field_"):
    if name in octrees:
        continue
    field = read(name)
    valid = Threshold(registrationName=name + " valid", Input=field)
    valid.Scalars = ["POINTS", "valid"]
    valid.LowerThreshold = 1
    valid.UpperThreshold = 1
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
    bar.Title = "|B| in T, " + name[len("field_"):].replace("_", "/")
    bar.ComponentTitle = ""
    bar.TitleFontSize = 8
    bar.LabelFontSize = 8
    bar.ScalarBarLength = 0.5

for name in names("sensors"):
    points = read(name)
    Show(points, view).PointSize = 8
    changes = [vector for vector in points.PointData.keys() if vector.startswith("dB_")]
    for vector in changes:
        Show(arrows(points, vector, diameter, vector), view)
    for vector in changes[:-1]:  # the arrows of the others lie on the most detailed pair's
        Hide(FindSource(vector), view)

animation = GetAnimationScene()
animation.UpdateAnimationUsingDataTimeSteps()
animation.AnimationTime = max(times)
view.ViewTime = max(times)
view.CameraParallelProjection = 1
view.CameraPosition = [tip[1], -tip[0], 0.0]
view.CameraFocalPoint = [0.0, 0.0, 0.0]
view.CameraViewUp = [0.0, 0.0, 1.0]
ResetCamera(view)
Render(view)
if len(sys.argv) > 1 and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1200, 900])
