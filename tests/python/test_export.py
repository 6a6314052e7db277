# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bent cilium for meshio and PyVista."""

import importlib.util
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import ciliaval as cv
from ciliaval import program
from test_results import quick

HAS_MESHIO = importlib.util.find_spec("meshio") is not None
HAS_PYVISTA = importlib.util.find_spec("pyvista") is not None


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        case = cls.folder / "case.toml"
        text = re.sub(r"mechanics = .*", 'mechanics = ["beam", "solid"]', quick("fig3b"))
        text = re.sub(r"force = .*", 'force = ["1 mN", "3 mN", "900 mN"]', text)
        case.write_text(text + "[models.solid]\nrefinement = 0\n")
        cls.result = program.run(case, cls.folder)

    @unittest.skipUnless(HAS_MESHIO, "meshio is not installed (python3-meshio)")
    def test_a_body_is_the_deformed_solid(self):
        mesh = self.result.to_meshio("solid", 1)
        cells = mesh.cells_dict["hexahedron27"]
        corners = mesh.points[cells[:, :8]]
        edges = [corners[:, i] - corners[:, 0] for i in (1, 3, 4)]
        volume = np.einsum("ci,ci->c", np.cross(edges[0], edges[1]), edges[2])
        self.assertTrue((volume > 0).all())
        tip = self.result.tip("solid")[1]
        self.assertLess(np.linalg.norm(mesh.points - tip, axis=1).min(), 1e-9)
        undeformed = mesh.points - mesh.point_data["displacement"]
        self.assertAlmostEqual(undeformed[:, 2].max(), 20e-3, 12)
        # Nearly incompressible, and of two materials.
        self.assertAlmostEqual(np.median(mesh.point_data["J"]), 1, 1)
        self.assertEqual(len(set(mesh.cell_data_dict["MaterialIDs"]["hexahedron27"])), 2)

    @unittest.skipUnless(HAS_MESHIO, "meshio is not installed (python3-meshio)")
    def test_a_rod_is_its_centreline(self):
        mesh = self.result.to_meshio("beam", 0)
        table = self.result.centreline("beam", 0)
        np.testing.assert_allclose(mesh.points[-1], self.result.tip("beam")[0], rtol=1e-12)
        np.testing.assert_allclose(
            np.interp(table["S"], mesh.point_data["S"], mesh.point_data["theta"]),
            table["theta"],
            atol=1e-12,
        )
        self.assertEqual(mesh.point_data["section_force"].shape, mesh.points.shape)
        lengths = np.linalg.norm(np.diff(mesh.points[mesh.cells_dict["line"]], axis=1), axis=-1)
        self.assertAlmostEqual(lengths.sum() / 20e-3, 1, 2)

    @unittest.skipUnless(HAS_MESHIO, "meshio is not installed (python3-meshio)")
    def test_other_programs_read_it(self):
        import meshio

        for model in ("solid", "beam"):
            mesh = self.result.to_meshio(model, 1)
            for name in ("mesh.vtu", "mesh.vtk"):
                mesh.write(self.folder / name)
                again = meshio.read(self.folder / name)
                np.testing.assert_array_equal(again.points, mesh.points)
                self.assertEqual(set(again.point_data), set(mesh.point_data))

    @unittest.skipUnless(HAS_MESHIO, "meshio is not installed (python3-meshio)")
    def test_faults_are_named(self):
        self.assertEqual(self.result.status("beam")[2], "slipped_off")
        with self.assertRaisesRegex(cv.FileError, "centreline_beam_0002.vtp: beam slipped_off"):
            self.result.to_meshio("beam", 2)
        with self.assertRaises(IndexError):
            self.result.to_meshio("beam", 3)
        with self.assertRaisesRegex(cv.InputError, "no model 'elastica', but beam, solid"):
            self.result.to_meshio("elastica", 0)
        case = cv.Case(self.folder / "case.toml")
        case.mechanics = ["beam"]
        with self.assertRaisesRegex(cv.FileError, "has no files"):
            case.run().to_meshio("beam", 0)
        copy = self.folder / "copy"
        shutil.copytree(self.result.folder, copy)
        file = copy / "vtk" / "centreline_beam_0000.vtp"
        good = file.read_bytes()
        for bad in (good[: len(good) // 2], good.replace(b"Points", b"Pts"), b"", good[:-600] + b"A" * 600):
            file.write_bytes(bad)
            with self.assertRaisesRegex(cv.FileError, "centreline_beam_0000.vtp: is damaged"):
                cv.load(copy).to_meshio("beam", 0)

    @unittest.skipUnless(HAS_PYVISTA, "PyVista is not installed (pip install pyvista)")
    def test_pyvista_has_the_same_points(self):
        for model in ("solid", "beam"):
            mesh = self.result.to_pyvista(model, 1)
            tip = self.result.tip(model)[1]
            self.assertLess(np.linalg.norm(np.array(mesh.points) - tip, axis=1).min(), 1e-8)

    def test_pyvista_reads_the_file_of_the_step_and_bends_a_body(self):
        """With a stand-in for PyVista, which is not among Debian's packages."""
        pyvista = mock.MagicMock()
        vtk = self.result.folder / "vtk"
        with mock.patch.dict(sys.modules, pyvista=pyvista):
            line = self.result.to_pyvista("beam", 0)
            self.assertIs(line, pyvista.read.return_value)
            pyvista.read.assert_called_with(vtk / "centreline_beam_0000.vtp")
            body = self.result.to_pyvista("solid", -2)
            pyvista.read.assert_called_with(vtk / "body_solid_0001.vtu")
            pyvista.read.return_value.warp_by_vector.assert_called_once_with("displacement")
            self.assertIs(body, pyvista.read.return_value.warp_by_vector.return_value)

    def test_without_pyvista_the_error_says_how_to_get_it(self):
        with mock.patch.dict(sys.modules, pyvista=None):
            with self.assertRaisesRegex(ImportError, "pip install pyvista"):
                self.result.to_pyvista("beam", 0)


if __name__ == "__main__":
    unittest.main()
