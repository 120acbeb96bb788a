"""Sources, errors, the report, and shapes."""

import sys

import mujoco
import numpy as np
import pytest

import carom
from carom.io.models.links import possible_inertia

from .agreement import DATA

BALL = """<mujoco><worldbody><body name="ball"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
URDF = """
<robot name="r">
  <link name="base"><inertial><mass value="2"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <link name="arm"><inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".3" ixy="0" ixz="0" iyz="0"/>
  </inertial>
    <collision><geometry><mesh filename="package://r/arm.stl"/></geometry></collision>
    <collision><geometry><sphere radius=".1"/></geometry></collision></link>
  <link name="virtual"/>
  <link name="hand"><inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <link name="frame"/>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="wrist1" type="continuous"><parent link="arm"/><child link="virtual"/><axis xyz="1 0 0"/></joint>
  <joint name="wrist2" type="continuous"><parent link="virtual"/><child link="hand"/><axis xyz="0 0 1"/></joint>
  <joint name="glued" type="fixed"><parent link="hand"/><child link="frame"/></joint>
</robot>"""


def test_sources(tmp_path):
    path = tmp_path / "ball.xml"
    path.write_text(BALL)
    spec = mujoco.MjSpec.from_string(BALL)
    for source in (path, str(path), BALL, spec, spec.compile()):
        assert carom.load_model(source).scene["ball"].mass == pytest.approx(
            4 / 3 * np.pi, rel=1e-12
        )


@pytest.mark.parametrize(
    ("source", "error", "message"),
    [
        ("no/such.xml", FileNotFoundError, "no model file 'no/such.xml'"),
        ("<mujoco><worldbody>", ValueError, "not valid XML"),
        ("<sdf/>", ValueError, "root <sdf>"),
        ("<mujoco colour='red'/>", ValueError, "unrecognized attribute: 'colour'"),
        (
            "<mujoco><worldbody><body><joint/></body></worldbody></mujoco>",
            ValueError,
            "mass and inertia",
        ),
        ("<mujoco/>", ValueError, "a body that moves"),
        (3, TypeError, "source must be a path"),
    ],
)
def test_what_cannot_be_read(source, error, message):
    with pytest.raises(error, match=message) as caught:
        carom.load_model(source)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "arguments",
    [{"restitution": 2}, {"friction": -1}, {"impact_law": "x"}, {"keyframe": "x"}, {"qpos": [1]},
     {"overlaps": "x"}, {"contacts": 1}, {"free_root": True}],
)  # fmt: skip
def test_arguments_are_checked(arguments):
    with pytest.raises((ValueError, TypeError), match=next(iter(arguments))):
        carom.load_model(BALL, **arguments)


def test_without_mujoco(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(ModuleNotFoundError, match=r'pip install "carom\[models\]"'):
        carom.load_model(BALL)


def test_urdf():
    model = carom.load_model(URDF, friction=0.5)
    assert [b.name for b in model.scene.bodies] == ["arm", "virtual", "hand"]
    assert model.bodies["base"] is carom.GROUND
    assert model.bodies["frame"] is model.scene["hand"]
    assert model.scene["virtual"].mass == pytest.approx(4e-9)
    said = str(model.report)
    assert "'package://r/arm.stl' was not found; left out" in said
    assert "link 'arm': its inertia is impossible for a rigid body" in said
    assert "link 'virtual': moves and has no mass" in said
    assert model.scene["elbow:upper"].upper == 1.0
    floats = carom.load_model(URDF, free_root=True)
    assert [b.name for b in floats.scene.bodies] == ["base", "arm", "virtual", "hand"]
    assert len(floats.scene.joints) == 3


def test_what_other_programs_do_not_look_at():
    """Empty lines before the declaration, commas, a fourth number, a second axis, a shape without a kind."""
    text = """

<?xml version="1.0"?><robot name="r"><link name="base"/><link name="arm">
  <inertial><origin xyz="0, 0, -.3" rpy="0 0 0 0"/><mass value="1"/>
  <inertia ixx=".03" iyy=".03" izz=".001" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry/></collision></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="arm"/>
  <axis xyz="0 1 0"/><axis xyz="1 0 0"/></joint></robot>"""
    model = carom.load_model(text)
    np.testing.assert_allclose(model.scene["arm"].position, (0.0, 0.0, -0.3), atol=1e-15)
    assert model.scene["j"].definition.axis.tolist() == [0.0, 1.0, 0.0]
    assert "more than one axis; the first" in str(model.report)
    assert "'0 0 0 0' has more than three" in str(model.report)
    assert "a shape of it is empty" in str(model.report)


def test_meshes_of_packages_are_found(tmp_path):
    folder = tmp_path / "r"
    folder.mkdir()
    corners = [(0, 0, 0), (0.3, 0, 0), (0, 0.2, 0), (0, 0, 0.1)]
    faces = [(1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4)]
    text = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a} {b} {c}" for a, b, c in faces]
    (folder / "arm.obj").write_text("\n".join(text))
    xml = URDF.replace("arm.stl", "arm.obj")
    for arguments in ({"package_dirs": [tmp_path]}, {"package_dirs": [folder]}):
        model = carom.load_model(xml, **arguments)
        shape = model.scene["arm"].shape
        assert [type(part).__name__ for part, _, _ in shape.parts] == ["Convex", "Sphere"]
        hull, place, turn = shape.parts[0]
        found = carom.geometry.quaternion.rotate(turn, hull.vertices) + place
        far = np.max(np.abs(np.sort(found, axis=0) - np.sort(corners, axis=0)))
        assert far < 1e-7  # MuJoCo keeps vertices as float32


def test_shapes_weigh_what_mujoco_says():
    """A body of one geom has the mass and the inertia of its shape: the shapes are the same, and lie alike."""
    kinds = {
        "sphere": ".2", "capsule": ".1 .3", "cylinder": ".1 .3", "ellipsoid": ".1 .2 .3", "box": ".1 .2 .3",
    }  # fmt: skip
    for kind, size in kinds.items():
        xml = BALL.replace(
            'size=".1"', f'type="{kind}" size="{size}" pos=".3 .2 .1" euler="20 30 40"'
        )
        body = carom.load_model(xml).scene["ball"]
        parts = getattr(body.shape, "parts", [(body.shape, np.zeros(3), np.array([1.0, 0, 0, 0]))])
        shape, place, turn = parts[0]
        axes = carom.geometry.quaternion.matrix(turn)
        np.testing.assert_allclose(place, 0.0, atol=1e-12)
        assert shape.volume * 1000 == pytest.approx(body.mass, rel=1e-12)
        expected = axes @ shape.inertia(body.mass) @ axes.T
        np.testing.assert_allclose(body.inertia, expected, rtol=0, atol=1e-12 * np.max(expected))


def test_everything_left_out_is_reported():
    model = carom.load_model(DATA / "dm_control" / "quadruped.xml")
    told = {entry.element for entry in model.report.of("actuator ")}
    assert len(told) == model.mujoco.nu == len(model.actuators) > 0
    told = {entry.element for entry in model.report.of("sensor ")}
    assert len(told) + len(model.sensors) == model.mujoco.nsensor > len(model.sensors)
    assert "a height field of triangles" in str(model.report)
    assert "more: a scene has none of this kind; left out" in str(model.report)


def test_names_that_bodies_and_joints_share():
    xml = BALL.replace("<freejoint/>", '<joint name="ball"/>')
    model = carom.load_model(xml)
    assert model.joints["ball"].joint.name == "ball (joint)"
    assert model.scene["ball"].mass > 4


def test_a_scene_of_a_model_goes_to_a_file_and_back(tmp_path):
    model = carom.load_model(DATA / "own" / "loops.xml")
    solution = carom.simulate(model.scene, 2e-3, step=1e-3)
    solution.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    np.testing.assert_array_equal(again.position, solution.position)


def test_inertias_are_mended_as_little_as_possible():
    flat = np.diag([1.0, 2.0, 3.0])
    assert possible_inertia(flat) == (pytest.approx(flat), 0.0)
    better, change = possible_inertia(np.diag([1.0, 1.0, 3.0]))
    np.testing.assert_allclose(np.linalg.eigvalsh(better), [1.5, 1.5, 3.0])
    assert change == pytest.approx(1 / 6)
    better, _ = possible_inertia(np.diag([0.0, 2.0, 2.0]))
    assert np.linalg.eigvalsh(better)[0] > 0.0


def test_flags_of_the_model():
    off = '<option><flag contact="disable" gravity="disable" limit="disable"/></option><worldbody>'
    floor = '<geom type="plane" size="1 1 1"/>'
    model = carom.load_model(BALL.replace("<worldbody>", off + floor))
    assert not np.any(model.scene.gravity)
    assert model.scene.contact_default is None
    assert not model.scene.half_spaces
    assert not model.report.of("flag")


def test_a_joint_whose_damper_lets_nothing_move_is_held():
    """A base of 1 kg on a damper c falls m g t/c: 1e-10 m in a second at 1e11 N s/m."""
    text = """<mujoco><worldbody><body name="base"><joint name="lift" type="slide" axis="0 0 1" damping="{}"
      range="0 1" limited="true"/><geom size=".1" mass="1"/></body></worldbody></mujoco>"""
    model = carom.load_model(text.format("1e11"))
    assert "a damping of 1e+11" in str(model.report)
    assert "held where it starts" in str(model.report)
    assert not model.scene.stops
    solution = carom.simulate(model.scene, 1.0)
    assert solution.stats["trial_steps"] < 1000
    np.testing.assert_allclose(model.qpos(solution)[-1], 0.0, atol=1e-12)
    slow = carom.load_model(text.format("1e3").replace('limited="true"', 'limited="false"'))
    assert "held" not in str(slow.report)
    drop = 9.81e-3 * (1.0 - 1e-3)  # v = v_end (1 - e^{-t c/m}), v_end = m g/c
    np.testing.assert_allclose(slow.qpos(carom.simulate(slow.scene, 1.0))[-1], -drop, rtol=1e-5)
    # a light part of a model whose damper ends its own motion within 1e-9 s can still be pushed by the others
    light = """<mujoco><worldbody><body><freejoint/><geom size=".1" mass="1"/><body><joint type="slide"
      damping="1"/><geom size=".01" mass="1e-9"/></body></body></worldbody></mujoco>"""
    assert "held" not in str(carom.load_model(light).report)
    sprung = text.format("1e11").replace("range=", 'stiffness="1e11" springref=".1" range=')
    assert "held" not in str(carom.load_model(sprung).report)
