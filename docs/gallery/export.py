# SPDX-License-Identifier: LGPL-2.1-or-later
"""
How do I take the bent solid to another program?
================================================

You see the outside of the solid's mesh under 4 mN, coloured by the displacement, after a way through a Gmsh file.
meshio writes some thirty formats (Abaqus, Gmsh, XDMF and others); ``result.to_pyvista`` does the same for PyVista.
"""
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import meshio
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import ciliaval as cv

CASE = """
[case]
name = "bent"
[cilium]
diameter = "3 mm"
segment = [
  { name = "base", length = "3 mm", young_modulus = "0.1 MPa", poisson_ratio = 0.49 },
  { name = "magnet", length = "17 mm", young_modulus = "3 MPa", poisson_ratio = 0.49, magnetization = "75 kA/m" },
]
[load]
type = "contact"
force = "4 mN"
height = "16 mm"
[models]
mechanics = ["solid"]
"""
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "bent.toml").write_text(CASE)
    result = cv.run(Path(folder, "bent.toml"), folder)
    mesh = result.to_meshio("solid", 0)
    mesh.point_data = {"displacement": mesh.point_data["displacement"]}  # a Gmsh file knows no stress
    mesh.write(Path(folder, "bent.msh"), file_format="gmsh")
    mesh = meshio.read(Path(folder, "bent.msh"))

size = 1e3 * np.linalg.norm(mesh.point_data["displacement"], axis=1)
print(f"{len(mesh.points)} points, {len(mesh.cells[0].data)} cells, displacement up to {size.max():.3f} mm")

sides = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]  # of a hexahedron
faces = np.concatenate([mesh.cells[0].data[:, side] for side in sides])
centres = np.round(mesh.points[faces].mean(axis=1), 9)
_, first, count = np.unique(centres, axis=0, return_index=True, return_counts=True)
outer = faces[first[count == 1]]  # an inner face belongs to two cells

figure = plt.figure(figsize=(5.5, 5))
axes = figure.add_subplot(projection="3d", box_aspect=(12, 6, 20))
body = Poly3DCollection(1e3 * mesh.points[outer], edgecolor="k", linewidth=0.2, cmap="viridis")
body.set_array(size[outer].mean(axis=1))
axes.add_collection3d(body)
axes.set(xlim=(-2, 10), ylim=(-3, 3), zlim=(0, 20), xlabel="x in mm", zlabel="z in mm", yticks=())
axes.zaxis.labelpad = 10
axes.view_init(elev=15, azim=-70)
figure.colorbar(body, label="displacement in mm", shrink=0.7)
figure.savefig("export.png", dpi=100)
