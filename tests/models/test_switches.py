"""Flags that switch parts of a model off, bodies moved from outside, and parts that other programs read."""

import mujoco
import numpy as np
import pytest

import carom

BALL = '<body name="ball" pos="0 0 1"><freejoint/><geom size=".1" mass="1" {}/></body>'
ARMS = """<mujoco><option>{}</option><worldbody><geom type="plane" size="1 1 .1"/>
<body name="a" pos="0 0 1"><joint name="j" range="-10 10" frictionloss="1" damping="1" stiffness="1"/>
<geom size=".1" pos=".3 0 0"/></body>
<body gravcomp="1" pos="1 0 1"><joint name="k"/><geom size=".1" pos=".3 0 0"/></body></worldbody>
<equality><joint joint1="j" joint2="k"/></equality></mujoco>"""
LINK = (
    '<link name="{}"><inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" '
    'iyz="0"/></inertial>{}</link>'
)


def mjcf(inner, before=""):
    return (
        f'<mujoco>{before}<worldbody><geom type="plane" size="1 1 .1"/>{inner}</worldbody></mujoco>'
    )


def urdf(limit=3, more=""):
    return (
        f'<robot name="r">{LINK.format("base", more)}{LINK.format("arm", "")}<joint name="j" type="revolute">'
        '<parent link="base"/><child link="arm"/><origin xyz="0 0 .5"/><axis xyz="0 1 0"/>'
        f'<limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/></joint></robot>'
    )


def parts(*off):
    """What the scene of two arms has: forces, stops, constraints, contacts, gravity."""
    flags = " ".join(f'{flag}="disable"' for flag in off)
    scene = carom.load_model(ARMS.format(f"<flag {flags}/>")).scene
    forces = sorted(force.name for force in scene.forces)
    touch = scene._pairs.default is not None
    return forces, len(scene.stops), len(scene.constraints), touch, bool(np.any(scene.gravity))


@pytest.mark.parametrize(
    ("off", "left"),
    [
        ((), (["body2:gravcomp", "j:friction", "j:spring"], 2, 1, True, True)),
        (("constraint",), (["body2:gravcomp", "j:spring"], 0, 0, False, True)),
        (("contact",), (["body2:gravcomp", "j:friction", "j:spring"], 2, 1, False, True)),
        (("limit",), (["body2:gravcomp", "j:friction", "j:spring"], 0, 1, True, True)),
        (("equality",), (["body2:gravcomp", "j:friction", "j:spring"], 2, 0, True, True)),
        (("frictionloss",), (["body2:gravcomp", "j:spring"], 2, 1, True, True)),
        (("gravity",), (["j:friction", "j:spring"], 2, 1, True, False)),
        (("spring", "damper"), (["j:friction"], 2, 1, True, True)),
    ],
)  # fmt: skip
def test_flags_switch_off(off, left):
    assert parts(*off) == left


def test_a_spring_and_its_damper_are_switched_off_one_by_one():
    for flag, stiffness, damping in (("spring", 0.0, 1.0), ("damper", 1.0, 0.0)):
        scene = carom.load_model(ARMS.format(f'<flag {flag}="disable"/>')).scene
        spring = scene["j:spring"].definition
        assert (spring.stiffness, spring.damping) == (stiffness, damping)


def test_a_mocap_body_is_fixed_where_the_file_puts_it():
    """Its children with joints move about it, and do not touch it, as in MuJoCo."""
    inner = (
        BALL.format("")
        + """<body name="hand" mocap="true" pos="1 0 2"><geom name="palm" size=".1"/>
    <body name="finger"><joint/><geom size=".05" pos=".1 0 0"/></body>
    <body name="nail" pos="0 0 1"><geom name="tip" size=".02"/></body></body><body mocap="true"/>"""
    )
    keys = '<keyframe><key name="there" mpos="3 0 2 0 0 0"/></keyframe>'
    text = mjcf(inner).replace("</mujoco>", keys + "</mujoco>")
    for keyframe, x in ((None, 1.0), ("there", 3.0)):
        model = carom.load_model(text, keyframe=keyframe)
        assert model.bodies["hand"] is model.bodies["nail"] is carom.GROUND
        assert model.scene["palm"].position.tolist() == [x, 0.0, 2.0]
        assert model.scene["tip"].position.tolist() == [x, 0.0, 3.0]
        assert "mocap" in model.report.of("hand")[0].what
        assert not model.report.of("pair")  # the finger starts inside the palm
        assert model.mujoco.body_weldid[2] != 0  # the user's model is as it was


def test_a_picture_that_is_missing_is_left_out(tmp_path):
    (tmp_path / "bad.png").write_text("no picture")
    assets = """<asset><texture name="t" type="2d" file="missing.png"/>
    <texture name="c" type="cube" fileup="m.png"/>
    <texture name="b" type="2d" file="bad.png"/><material name="m" texture="t"/></asset>"""
    path = tmp_path / "model.xml"
    path.write_text(mjcf(BALL.format('material="m"'), assets))
    model = carom.load_model(path)
    assert [entry.element for entry in model.report.of("texture")] == [
        f"texture {name!r}" for name in "tcb"
    ]
    assets = '<asset><mesh name="t" file="missing.stl"/></asset>'
    with pytest.raises(ValueError, match=r"does not compile: .*missing.stl"):
        carom.load_model(mjcf(BALL.format('type="mesh" mesh="t"'), assets))


@pytest.mark.parametrize(
    "shape",
    ['sphere radius="0"', 'box size="1 0 1"', 'cylinder radius="0" length="1"',
     'cylinder radius="1" length="0"'],
)  # fmt: skip
def test_a_size_of_0_touches_nothing(shape):
    model = carom.load_model(urdf(more=f"<collision><geometry><{shape}/></geometry></collision>"))
    assert "has a size of 0" in model.report.of("link 'base'")[0].what
    bad = f"<collision><geometry><{shape.replace('0', '-1')}/></geometry></collision>"
    with pytest.raises(ValueError, match=r"cannot be read|does not compile"):
        carom.load_model(urdf(more=bad))


def test_limits_of_a_file_are_in_radians():
    scene = carom.load_model(urdf(10)).scene
    assert scene["j:upper"].upper == 10.0
    assert not scene.check().remarks
    scene.add_stop("j", upper=90)  # the user's own
    assert "If you mean degrees" in scene.check().remarks[0]


def test_the_refusal_of_a_drone_names_free_root():
    drone = f'<robot name="r">{LINK.format("drone", "")}</robot>'
    with pytest.raises(ValueError, match="free_root=True"):
        carom.load_model(drone)
    assert len(carom.load_model(drone, free_root=True).scene.bodies) == 1


@pytest.mark.parametrize(
    "given", ['mass="nan"', 'pos="0 NaN 0"', 'friction="-nan"', 'rgba="1 nan 0 1"']
)
def test_nan_is_refused_by_the_name_of_its_attribute(given, capfd, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = given.split("=")[0]
    text = mjcf(BALL.format(given).replace('mass="1" mass', "mass"))
    with pytest.raises(ValueError, match=f"<geom> {name} must not be NaN, got"):
        carom.load_model(text)
    (tmp_path / "part.xml").write_text(
        f"<mujocoinclude>{BALL.format('')}</mujocoinclude>".replace('"1"', '"nan"')
    )
    (tmp_path / "model.xml").write_text(mjcf('<include file="part.xml"/>'))
    with pytest.raises(ValueError, match="<geom> mass must not be NaN"):
        carom.load_model("model.xml")
    assert carom.load_model(mjcf(BALL.replace('"ball"', '"nan"').format(""))).scene["nan"]
    assert capfd.readouterr().err == ""
    assert sorted(path.name for path in tmp_path.iterdir()) == ["model.xml", "part.xml"]


def test_what_is_not_finite_is_refused_in_models_of_mujoco_too():
    spec = mujoco.MjSpec.from_string(mjcf(BALL.format("")))
    model = spec.compile()
    model.body_mass[1] = np.nan
    with pytest.raises(ValueError, match="must be finite, got nan in body_mass"):
        carom.load_model(model)
    spec.bodies[1].pos = [0, 0, np.nan]
    with pytest.raises(ValueError, match="must be finite, got nan in body_pos"):
        carom.load_model(spec)
    with pytest.raises(ValueError, match="must be finite, got inf in body_"):
        carom.load_model(mjcf(BALL.replace('mass="1"', 'mass="inf"').format("")))


def test_the_call_for_warnings_of_mujoco_is_the_user_s_again():
    heard = []
    mujoco.set_mju_user_warning(heard.append)
    try:
        carom.load_model(mjcf(BALL.format("")))
        assert mujoco.get_mju_user_warning() is not None
    finally:
        mujoco.set_mju_user_warning(None)
    assert not heard
