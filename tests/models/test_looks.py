"""What robots look like: geoms that touch nothing are seen, and change nothing else."""

import numpy as np
import pytest

import carom
from carom.io.files.scene_parts import scene_from_text, scene_to_text
from carom.io.models.hulls import with_fewer_triangles
from carom.visual.bodies import outline_of, parts_of

ARM = """
<mujoco><worldbody>
  <geom type="box" size=".1 .1 .2" contype="0" conaffinity="0" rgba="0 1 0 1"/>
  <geom type="plane" size="1 1 1" contype="0" conaffinity="0" group="{plane}"/>
  <body name="arm" pos="0 0 1"><joint axis="0 1 0"/><inertial pos=".2 0 0" mass="1" diaginertia="1 1 1"/>
    <geom type="capsule" fromto="0 0 0 .5 0 0" size=".03" contype="0" conaffinity="0" rgba="1 0 0 1"/>
    <geom pos=".5 0 0" size=".05" group="{group}"/>
  </body></worldbody></mujoco>"""
URDF = """
<robot name="r"><material name="blue"><color rgba="0 0 1 1"/></material>
  <link name="base"><visual><origin xyz="0 0 .3"/><geometry><box size=".1 .2 .3"/></geometry></visual></link>
  <link name="arm"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="open.stl"/></geometry><material name="blue"/></visual>
    <visual><geometry><mesh filename="hand.dae"/></geometry></visual>
    <visual><origin xyz=".1 0 0"/><geometry><sphere radius=".02"/></geometry></visual>
    <collision><geometry><sphere radius=".1"/></geometry></collision></link>
  <link name="tip"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size=".3 .3 .3"/></geometry></visual></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
  <joint name="k" type="continuous"><parent link="arm"/><child link="tip"/><axis xyz="0 1 0"/></joint>
</robot>"""


def drawn(scene, body: int):
    """Lowest and highest corner, and colour, of each part of a body (-1: what is fixed) that is no pin."""
    parts = [p for p in parts_of(scene, 1.0) if body in p.bodies and p.look != "joint"]
    return [(p.vertices.min(axis=0), p.vertices.max(axis=0), p.colour) for p in parts]


@pytest.mark.parametrize("group", [0, 3])
def test_geoms_that_touch_nothing_are_seen(group):
    """A capsule of .56 x .06 x .06 m from the joint to beyond the ball; groups from 3 on are not shown."""
    model = carom.load_model(ARM.format(group=group, plane=0))
    scene, arm = model.scene, model.scene["arm"]
    (low, high, colour), *others = drawn(scene, 0)
    np.testing.assert_allclose([low, high], [[-0.23, -0.03, -0.03], [0.33, 0.03, 0.03]], atol=1e-12)
    assert colour == "#ff0000"
    assert len(others) == (group == 0)  # the ball, which touches
    assert isinstance(arm.shape, carom.Compound)
    assert arm.shape.size == pytest.approx(0.35)  # the ball alone
    assert outline_of(scene, arm).radius >= 0.33
    ((low, high, colour),) = drawn(scene, -1)  # of the world
    np.testing.assert_allclose([low, high], [[-0.1, -0.1, -0.2], [0.1, 0.1, 0.2]])
    assert colour == "#00ff00"
    assert "a plane that touches nothing" in str(model.report)
    text = scene_to_text(scene)
    again, _ = scene_from_text(text)
    assert scene_to_text(again) == text
    assert [one.color for one in again["arm"].look] == [one.color for one in arm.look]
    assert len(again.look) == 1


def test_visuals_of_a_urdf_are_what_is_seen(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box((0.2, 0.4, 0.6))
    trimesh.Trimesh(box.vertices, box.faces[:-2]).export(tmp_path / "open.stl")
    (tmp_path / "arm.urdf").write_text(URDF)
    model = carom.load_model(tmp_path / "arm.urdf")
    scene = model.scene
    assert [body.name for body in scene.bodies] == ["arm", "tip"]
    (low, high, colour), (ball, _, plain) = drawn(scene, 0)
    np.testing.assert_allclose([low, high], [[-0.1, -0.2, -0.3], [0.1, 0.2, 0.3]], atol=1e-7)
    assert (colour, plain) == ("#0000ff", None)
    assert ball[0] == pytest.approx(0.08)
    assert scene["arm"].shape == carom.Sphere(0.1)  # what touches, and is not seen
    assert scene["tip"].shape is None
    assert len(drawn(scene, 1)) == 1
    ((low, high, _),) = drawn(scene, -1)
    np.testing.assert_allclose([low, high], [[-0.05, -0.1, 0.15], [0.05, 0.1, 0.45]])
    assert "visual mesh 'hand.dae' was not found; left out" in str(model.report)
    np.testing.assert_array_equal([body.mass for body in scene.bodies], 1.0)


def test_a_mesh_with_many_triangles_is_seen_with_fewer():
    """The area of a sphere stays, and no vertex is farther from it than the diagonal of a cell of the grid."""
    points, faces = carom.visual.surfaces.surface(carom.Sphere(1.0), 200)
    fewer, kept = with_fewer_triangles(points, faces, 2000)
    assert 500 < len(kept) <= 2000
    assert np.abs(np.linalg.norm(fewer[np.unique(kept)], axis=1) - 1.0).max() < 0.1
    a, b, c = fewer[kept].swapaxes(0, 1)
    area = 0.5 * np.sum(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    assert area == pytest.approx(4.0 * np.pi, rel=0.05)


def test_a_look_of_ones_own(tmp_path):
    scene, corners = carom.Scene(), [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    cup = [
        carom.Look(carom.Cylinder(0.04, 0.1)),
        carom.Look((corners, [(0, 1, 2)]), color="red"),
    ]
    ball = scene.add_body(carom.Sphere(0.05), mass=0.3, position=(0, 0, 1), look=cup)
    hidden = scene.add_body(carom.Sphere(0.05), mass=0.3, position=(1, 0, 1), look=())
    assert [p[2] for p in drawn(scene, ball.index)] == [None, "#ff0000"]
    assert drawn(scene, hidden.index) == []
    solution = carom.simulate(scene, 0.01, step=1e-3)
    solution.export(tmp_path / "cup.glb")
    carom.view(solution, export=tmp_path / "cup.html")
    scene.replace(ball, look=None)
    assert len(drawn(scene, ball.index)) == 1
    for wrong in ("red", 3, [1], ([(0, 0, 0)], [(0, 1, 2)])):
        with pytest.raises((TypeError, ValueError), match="look"):
            scene.replace(ball, look=wrong)
    with pytest.raises(
        ValueError, match="triangles of shape must be numbers of vertices from 0 to 0"
    ):
        carom.Look(([(0, 0, 0)], [(0, 1, 2)]))
