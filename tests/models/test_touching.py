"""What touches what, and how: MuJoCo's rules, and what becomes of overlaps."""

import itertools

import mujoco
import numpy as np
import pytest

import carom
from carom.io.models.touching import Filter

RULES = """
<mujoco>
  <custom><numeric name="restitution" data="0.25"/></custom>
  <default><geom size=".1" mass="1"/></default>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" pos="0 0 -5" friction=".1 .2 .3"/>
    <geom name="wall" type="box" size=".1 .1 .1" condim="6" friction="1.5 .01 .002"/>
    <body name="a"><joint axis="0 1 0"/><geom name="a1" friction=".4 .03 .001" condim="4"/>
      <geom name="a2" type="capsule" size=".05 .1" contype="2" conaffinity="4"/>
      <body name="b"><joint axis="1 0 0"/><geom name="b" priority="2" friction=".7 .02 .004" condim="1"/>
        <body name="c"><joint axis="0 0 1"/><geom name="c" friction=".9 .005 .01" condim="6"/></body>
      </body>
    </body>
    <body name="d"><freejoint/><geom name="d" contype="4" conaffinity="2"/>
      <body name="d_tip"><geom name="e" contype="0" conaffinity="0"/></body></body>
    <body name="f"><freejoint/><geom name="f" contype="0" conaffinity="1" priority="2"/></body>
    <body name="g"><freejoint/><geom name="g"/></body>
  </worldbody>
  <contact>
    <exclude body1="a" body2="g"/>
    <pair geom1="a1" geom2="b" friction=".3 .3 .1 .01 .01" condim="3"/>
    <pair geom1="e" geom2="g" friction=".2 .2 .1 .01 .01" condim="4"/>
  </contact>
</mujoco>"""


def test_pairs_and_friction_are_those_that_mujoco_finds():
    """All geoms are in one place: what may touch does, so MuJoCo's list of contacts is the rule itself."""
    m = mujoco.MjModel.from_xml_string(RULES.replace('pos="0 0 -5"', ""))  # the floor too
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    expected = {}
    for contact in d.contact:
        sliding, _, pivoting, rolling, _ = contact.friction
        n = contact.dim
        values = (sliding * (n >= 3), pivoting * (n >= 4), rolling * (n >= 6))
        expected[frozenset(contact.geom.tolist())] = values
    rules, found = Filter(m), {}
    for a, b in itertools.combinations(range(m.ngeom), 2):
        friction = rules.friction(a, b)
        fixed = not (m.body_weldid[m.geom_bodyid[a]] or m.body_weldid[m.geom_bodyid[b]])
        if friction is not None and not fixed:
            found[frozenset((a, b))] = tuple(friction)
    assert found.keys() == expected.keys()
    for pair, values in expected.items():
        np.testing.assert_allclose(
            found[pair], values, rtol=1e-12, atol=1e-5
        )  # MuJoCo's least is 1e-5


def apart():
    """The same model with all bodies apart."""
    spec = mujoco.MjSpec.from_string(RULES)
    for k, name in enumerate("adfg"):
        spec.body(name).pos = [2.0 * k, 1.0, 0.0]
    spec.body("b").pos, spec.body("c").pos = [0.5, 0, 0], [0.5, 0, 0]
    return spec


def test_contacts_of_the_scene():
    model = carom.load_model(apart(), impact_law="poisson")
    scene = model.scene

    def law(one, other):
        own = [c for c in scene.contacts if {c.body.name, c.other.name} == {one, other}]
        return own[0] if own else scene.contact_law(scene[one], scene[other])

    assert law("a", "b").friction == 0.3  # a pair of its own, of a body and what carries it
    assert law("b", "c") is None  # carried
    assert law("a", "g") is None  # excluded
    assert law("c", "g").rolling_friction == 0.01
    assert law("a", "floor").pivoting_friction == 0.2
    assert law("b", "g").friction == 0.0  # the higher priority has one dimension
    assert law("d", "g").friction == 0.2  # by a geom of a body that is a part of d
    assert all(c.restitution == 0.25 and c.impact_law == "poisson" for c in scene.contacts)
    assert scene.contact_default.restitution == model.restitution == 0.25
    assert model.bodies["d_tip"] is scene["d"]
    assert model.geoms["a2"] is scene["a"]
    assert any("only some" in entry.what for entry in model.report)
    scene.validate()


@pytest.mark.parametrize(("given", "expected"), [(0.5, 0.5), (None, 0.25)])
def test_restitution_of_the_caller_comes_first(given, expected):
    assert carom.load_model(apart(), restitution=given).restitution == expected


def test_default_restitution_is_named():
    model = carom.load_model(RULES.replace("restitution", "other"), contacts=False)
    assert model.restitution == 0.0
    assert "restitution=0 for all" in str(model.report)


def test_friction_of_the_caller_is_that_of_all():
    scene = carom.load_model(apart(), friction=0.6).scene
    assert {c.friction for c in scene.contacts} | {scene.contact_default.friction} == {0.6}


SUNK = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <geom name="block" type="box" size=".2 .2 .2" pos="1 0 .2"/>
    <body name="ball" pos="0 0 .08"><freejoint/><geom size=".1"/></body>
    <body name="box" pos="1 0 .49"><freejoint/><geom type="box" size=".1 .1 .1"/></body>
    <body name="arm" pos="3 0 0"><joint axis="0 1 0"/><geom size=".1"/></body>
  </worldbody>
</mujoco>"""


def test_what_starts_inside_is_moved_out_or_does_not_touch():
    model = carom.load_model(SUNK)
    scene = model.scene
    np.testing.assert_allclose(scene["ball"].position, (0, 0, 0.1), atol=1e-9)
    np.testing.assert_allclose(scene["box"].position, (1, 0, 0.5), atol=1e-9)
    assert scene.contact_law(scene["arm"], scene["floor"]) is None
    assert len(model.report.of("ball")) == len(model.report.of("arm")) == 1
    scene.validate()
    with pytest.raises(ValueError, match=r"'ball' starts 0.02 m inside 'floor'"):
        carom.load_model(SUNK, overlaps="refuse")


BALL = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="ball" pos="0 0 .5"><freejoint/><geom size=".1"/></body>
  </worldbody>
</mujoco>"""


def test_a_ball_bounces_off_its_floor_as_high_as_restitution_says():
    """Falls from .4 m to the floor at e = .5: up again with e^2 of the height, .1 m."""
    model = carom.load_model(BALL, restitution=0.5, friction=0.3)
    solution = carom.simulate(model.scene, 0.6, step=1e-3)
    after = solution.impacts.time[0]
    ball = solution.position[solution.t > after, model.scene["ball"].index, 2]
    assert ball.max() == pytest.approx(0.1 + 0.1, abs=1e-5)  # between saved steps: g h^2 / 8


LIMITED = """
<mujoco>
  <worldbody>
    <body name="rod" pos="0 0 1">
      <joint name="hinge" axis="0 -1 0" range="-40 20" damping="0"/>
      <geom type="capsule" fromto="0 0 0 1 0 0" size=".02" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <keyframe><key name="raised" qpos=".2"/><key name="beyond" qpos="-1"/></keyframe>
</mujoco>"""


def test_limits_are_where_the_model_counts_them():
    model = carom.load_model(LIMITED, keyframe="raised", limit_restitution=0.4)
    solution = carom.simulate(model.scene, 1.0, step=1e-3)
    q, _ = model.joints["hinge"].of(solution)
    assert q[0] == pytest.approx(0.2)
    assert q.min() == pytest.approx(np.radians(-40), abs=1e-3)  # between saved steps
    hit = solution.impacts[0]
    assert hit.relative_velocity_after[0] == pytest.approx(-0.4 * hit.relative_velocity_before[0])


def test_a_limit_that_the_start_is_beyond_is_moved():
    model = carom.load_model(LIMITED, keyframe=1)
    assert model.scene["hinge:lower"].lower == 0.0
    assert "starts beyond its lower limit, by 0.302" in str(model.report)


TWO_SOLES = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 1" friction=".1"/>
    <body name="slides" pos="0 0 .05"><freejoint/>
      <geom type="box" size=".05 .05 .05" pos="-.05 0 0" friction=".1" mass=".5"/>
      <geom type="box" size=".05 .05 .05" pos=".05 0 0" friction=".5" mass=".5"/></body>
    <body name="other" pos="0 2 .05"><freejoint/>
      <geom type="box" size=".05 .05 .05" friction=".3"/></body>
  </worldbody>{more}
</mujoco>"""


def test_geoms_keep_their_friction():
    model = carom.load_model(TWO_SOLES.format(more=""))
    frictions = [piece.material.friction for piece in model.scene["slides"].shape.pieces]
    assert frictions == [0.1, 0.5]
    assert model.scene.contact_law("other", "floor").friction == 0.3
    assert not any("differs" in entry.what for entry in model.report)
    model.scene.validate()


def test_a_pair_of_geoms_overrides_their_materials():
    more = '<contact><pair geom1="front" geom2="floor" friction=".2 .2 .01 .01 .01"/></contact>'
    text = TWO_SOLES.format(more=more).replace('pos=".05 0 0"', 'pos=".05 0 0" name="front"')
    model = carom.load_model(text)
    law = next(c for c in model.scene.contacts if c.other.name == "floor")
    assert (law.body.name, law.friction) == ("slides", 0.2)
    assert any("differs" in entry.what for entry in model.report)


def test_friction_of_the_caller_is_that_of_all_geoms():
    scene = carom.load_model(TWO_SOLES.format(more=""), friction=0.6).scene
    assert scene.contact_law("slides", "floor").friction == 0.6
    assert scene["slides"].material is None
