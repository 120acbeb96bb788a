"""Meshes of files and of trimesh."""

import numpy as np
import pytest

import carom

trimesh = pytest.importorskip("trimesh")


def turned(solid):
    """A solid in a position in which single precision rounds its vertices."""
    turn = trimesh.transformations.rotation_matrix(0.7, (1, 2, 3))
    return solid.apply_transform(turn)


@pytest.mark.parametrize("ending", ["stl", "obj", "ply", "off", "glb"])
def test_a_file_has_the_solid_that_was_written(tmp_path, ending):
    path = tmp_path / f"box.{ending}"
    turned(trimesh.creation.box((10, 20, 30))).export(path)
    mesh = carom.Mesh.load(path, scale=1e-3)  # millimetres
    assert mesh.volume == pytest.approx(6e-6, rel=1e-6)
    assert len(mesh.points) == 8
    assert mesh.convex
    moments = np.linalg.eigvalsh(mesh.inertia(12.0))
    assert moments == pytest.approx([5e-4, 1e-3, 1.3e-3], rel=1e-6)  # m (a^2 + b^2) / 12
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    scene.add_body(mesh, mass=1, position=(0, 0, 1), name="box")
    assert scene.add_contact("box", "floor").body.shape is mesh  # it can touch


def test_a_surface_that_is_not_convex_or_turned_inwards(tmp_path):
    ring = trimesh.creation.annulus(r_min=1.0, r_max=2.0, height=1.0)
    ring.invert()
    ring.export(tmp_path / "ring.stl")
    mesh = carom.Mesh.load(tmp_path / "ring.stl")
    assert mesh.volume == pytest.approx(abs(ring.volume), rel=1e-6)
    assert not mesh.convex
    with pytest.raises(ValueError, match="not convex and has no parts"):
        _ = mesh.pieces


def test_an_object_of_trimesh_is_a_shape():
    scene = carom.Scene()
    box = scene.add_body(trimesh.creation.box((1, 2, 3)), mass=12, name="box")
    assert isinstance(box.shape, carom.Mesh)
    assert np.diag(box.inertia) == pytest.approx([13, 10, 5], rel=1e-14)
    wall = trimesh.creation.box((1, 1, 1))
    assert scene.add_static(wall, position=(9, 0, 0)).shape.volume == pytest.approx(1, rel=1e-14)
    assert scene.replace("box", shape=wall).inertia[0, 0] == pytest.approx(2, rel=1e-14)


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="path must be a file with a mesh"):
        carom.Mesh.load(tmp_path / "none.stl")
    path = tmp_path / "text.stl"
    path.write_text("no mesh")
    with pytest.raises(ValueError, match="path must be a file with a mesh that trimesh reads"):
        carom.Mesh.load(path)
    path = tmp_path / "sheet.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n")
    with pytest.raises(ValueError, match="faces must be at least 4"):
        carom.Mesh.load(path)
