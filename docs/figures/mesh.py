# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws docs/figures/mesh.png, the built-in mesh with its parameters (Debian: python3-matplotlib):

    ciliaval mesh cases/paper/fig3b.toml -o mesh.msh
    python3 docs/figures/mesh.py mesh.msh docs/figures/mesh.png

Left the section, right the cut Y = 0 through the cilium, as they are in the file (Gmsh 4.1, text).
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path

DIAMETER = 3.0  # of the case, mm
SQUARE_CELLS, RINGS = 2, 3  # of the default refinement
COLOURS = {1: "#f2d196", 2: "#b8cfe6"}  # by segment
MARK = "#b01818"
QUAD_9, HEXAHEDRON_27 = 10, 12  # Gmsh's element types
TIP = 3  # physical surface
# Edges of Gmsh's 9-node quadrilateral: corner, middle, corner.
QUAD_EDGES = [(0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0)]
# Faces of Gmsh's hexahedron by their corners.
HEXAHEDRON_FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                    (3, 0, 4, 7)]


def sections(path):
    """Lines of the file's sections by name."""
    result, name = {}, None
    with open(path, encoding="ascii") as file:
        for line in map(str.strip, file):
            if line.startswith("$"):
                name = None if line.startswith("$End") else line[1:]
                continue
            result.setdefault(name, []).append(line)
    return result


def read(path):
    """Nodes in mm by tag, and (dimension, entity, type, nodes) of each element."""
    parts = sections(path)
    nodes, elements = {}, []
    lines = iter(parts["Nodes"][1:])
    for header in lines:
        count = int(header.split()[3])
        tags = [int(next(lines)) for _ in range(count)]
        for tag in tags:
            nodes[tag] = [1e3 * float(x) for x in next(lines).split()[:3]]
    lines = iter(parts["Elements"][1:])
    for header in lines:
        dimension, entity, kind, count = map(int, header.split())
        for _ in range(count):
            elements.append((dimension, entity, kind, [int(n) for n in next(lines).split()[1:]]))
    return nodes, elements


def curve(a, m, b, **style):
    """The parabola through a, m, b as a Bézier curve."""
    control = [2 * m[i] - (a[i] + b[i]) / 2 for i in (0, 1)]
    path = Path([a[:2], control, b[:2]], [Path.MOVETO, Path.CURVE3, Path.CURVE3])
    return PathPatch(path, fill=False, **style)


def dimension(axes, a, b, words, at, **style):
    arrow = {"arrowstyle": "<->", "color": MARK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", a, b, arrowprops=arrow)
    note(axes, words, at, **style)


def note(axes, words, at, to=None, **style):
    arrow = {"arrowstyle": "-", "color": MARK} if to else None
    axes.annotate(words, to or at, at, arrowprops=arrow, color=MARK, fontsize=11, **style)


def draw_section(axes, nodes, elements):
    for dim, entity, kind, n in elements:
        if (dim, entity, kind) == (2, TIP, QUAD_9):
            for a, m, b in QUAD_EDGES:
                axes.add_patch(curve(nodes[n[a]], nodes[n[m]], nodes[n[b]], lw=1.2, ec="0.2"))
    axes.set(xlim=(-2.5, 2.7), ylim=(-2.15, 2.15), aspect="equal", title="Section")
    axis = sorted({round(nodes[n[c]][0], 9) for dim, entity, kind, n in elements if
                   (dim, entity) == (2, TIP) for c in range(4)
                   if abs(nodes[n[c]][1]) < 1e-9 and nodes[n[c]][0] > -1e-9})
    half, rim = axis[SQUARE_CELLS // 2], axis[-1]
    dimension(axes, (-half, 0), (half, 0), "", (0, 0))
    note(axes, f"square_cells n = {SQUARE_CELLS}:\ncells along a side", (-2.45, 1.5), to=(-half / 2, 0.02))
    dimension(axes, (half, 0), (rim, 0), f"rings m = {RINGS}", (1.6, -0.06))
    note(axes, "each ring_ratio times\nas wide as the one inside", (0.55, -2.05), to=(1.28, -0.02))
    note(axes, "n² + 4nm cells; equal_area\nputs the corners outside R", (0.85, 1.6),
         to=(rim * 0.7071, rim * 0.7071))
    note(axes, "symmetry: only Y ≥ 0\nis solved", (-2.45, -2.05), to=(-1.3, -0.02))


def draw_cut(axes, nodes, elements):
    planes = set()
    for dim, entity, kind, n in elements:
        if kind != HEXAHEDRON_27:
            continue
        for face in HEXAHEDRON_FACES:
            corners = [nodes[n[c]] for c in face]
            if max(abs(x[1]) for x in corners) < 1e-9:
                outline = [(x[2], x[0]) for x in corners]
                axes.add_patch(Polygon(outline, fc=COLOURS[entity], ec="0.2", lw=0.8))
        planes.update(round(nodes[n[c]][2], 6) for c in range(8))
    planes = sorted(planes)
    axes.set(xlim=(-0.6, 20.6), ylim=(-3.6, 3.6), aspect="equal", title="Cut along the axis")
    interface = 3.0
    for z, words, ha in ((0, "clamped end", "left"), (interface, "interface of the segments", "left"),
                         (20, "tip: free, not graded", "right")):
        axes.annotate(words, (z, 1.55), (z, 2.35), ha=ha, fontsize=11,
                      arrowprops={"arrowstyle": "-", "color": "0.2"})
    i = planes.index(interface)
    note(axes, "finest_layer (times d): the first layer at these planes", (0.0, -2.95))
    for j in (0, i - 1, i):
        middle = (planes[j] + planes[j + 1]) / 2
        axes.plot([middle, middle], [-1.52, -2.6], color=MARK, lw=0.9)
    axes.annotate("", (9.0, -1.75), (3.6, -1.75), arrowprops={"arrowstyle": "->", "color": MARK})
    note(axes, "+ growth × distance", (3.7, -2.25))
    k = max(j for j in range(len(planes) - 1) if planes[j] < 15)
    dimension(axes, (planes[k], -1.75), (planes[k + 1], -1.75), "coarsest_layer (times d)\nat most",
              (planes[k] - 0.9, -2.85))
    axes.plot([17, 17], [-1.75, 1.75], color=MARK, ls="--")
    note(axes, "planes: a loaded section\nbecomes a mesh plane", (12.3, 1.85), to=(17, 1.7))


def main():
    nodes, elements = read(sys.argv[1])
    figure, (left, right) = plt.subplots(1, 2, figsize=(17, 5.4), dpi=100, width_ratios=(1.0, 2.3))
    draw_section(left, nodes, elements)
    draw_cut(right, nodes, elements)
    for axes in (left, right):
        axes.axis("off")
    figure.tight_layout()
    figure.savefig(sys.argv[2])


main()
