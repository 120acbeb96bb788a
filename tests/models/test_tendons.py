"""Tendons of models: lengths, rates and accelerations of MuJoCo; limits, dead bands, motors, equalities."""

import math

import numpy as np
import pytest

import carom
from models.agreement import accelerations, first_accelerations, jacobians, mujoco_data

mujoco = pytest.importorskip("mujoco")

ARM = """
<mujoco><option gravity="0 0 -9.81"/><compiler angle="radian"/>
<worldbody><site name="hook" pos=".1 .05 1.5"/><site name="eye" pos=".4 0 1.6"/>
<body name="upper" pos="0 0 1"><joint name="a" axis="0 1 0"/>
 <geom type="capsule" size=".04" fromto="0 0 0 .4 0 0"/>
 <site name="mid" pos=".2 .03 .05"/><site name="tip" pos=".4 0 .05"/>
 <body name="lower" pos=".4 0 0"><joint name="b" axis="0 1 0"/><joint name="c" axis="0 0 1" pos="0 0 .02"/>
  <geom type="capsule" size=".03" fromto="0 0 0 .3 0 0"/><site name="end" pos=".3 .02 .01"/></body></body>
<body name="slider" pos="1 0 .5"><joint name="s" type="slide" axis="0 0 1"/><geom type="box" size=".1 .1 .1"/>
 <site name="top" pos="0 0 .1"/></body></worldbody>
<contact><exclude body1="upper" body2="lower"/></contact>
<tendon>
<fixed name="sum" stiffness="6" damping=".4" springlength=".3">
 <joint joint="a" coef=".5"/><joint joint="b" coef="-1.2"/>
 <joint joint="s" coef="2"/></fixed>
<fixed name="dead" stiffness="9" springlength="-.1 .1">
 <joint joint="b" coef="1"/><joint joint="c" coef=".7"/></fixed>
<fixed name="alone" stiffness="9" springlength="-.1 .1"><joint joint="c" coef="-1.5"/></fixed>
<spatial name="cord" stiffness="40" damping="1.5" springlength=".2">
 <site site="hook"/><site site="mid"/><site site="tip"/>
 <site site="end"/></spatial>
<spatial name="slack" stiffness="70" springlength="0 .3"><site site="eye"/><site site="end"/></spatial>
<spatial name="tackle" stiffness="20"><site site="eye"/>
 <site site="tip"/><pulley divisor="2"/><site site="eye"/>
 <site site="top"/><pulley divisor="4"/><site site="hook"/><site site="top"/></spatial>
</tendon>
<actuator><position name="servo" tendon="sum" kp="11" kv="2" gear="1.5"/>
 <motor name="pull" tendon="cord" gear="-2"/>
<general name="winch" tendon="tackle" gainprm="3" biastype="affine" biasprm="1 -4 -.5"/></actuator>
<sensor><tendonpos name="l" tendon="sum"/><tendonvel name="v" tendon="sum"/>
 <actuatorfrc name="f" actuator="servo"/></sensor>
</mujoco>"""


@pytest.mark.parametrize("seed", range(4))
def test_as_in_mujoco(seed):
    """Lengths, rates, forces of actuators, and the accelerations of all bodies, at a random state."""
    rng = np.random.default_rng(seed)
    q, v, u = rng.normal(size=4) * 0.5, rng.normal(size=4), rng.normal(size=3)
    model = carom.load_model(ARM, qpos=q, qvel=v)
    assert "tendon" not in str(model.report)
    m, scene = model.mujoco, model.scene
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    for motor, control in zip(("servo", "pull", "winch"), u):
        scene.replace(motor, definition=_with_control(scene[motor].definition, control))
    d = mujoco_data(m, q, v)
    d.ctrl[:] = u
    mujoco.mj_forward(m, d)
    expected, chosen = accelerations(m, d, jacobians(model, d), model)
    found = first_accelerations(scene)[chosen]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    state = carom.Run(model).state
    for k, name in enumerate(("servo", "pull", "winch")):
        length, rate = model.actuators[name].length(state)
        np.testing.assert_allclose(length, d.actuator_length[k], atol=1e-12)
        np.testing.assert_allclose(rate, d.actuator_velocity[k], atol=1e-12)
    np.testing.assert_allclose(
        state["cord:spring"].coordinate, d.ten_length[3] - _fixed(m, d), atol=1e-12
    )
    np.testing.assert_allclose(state["cord:spring"].rate, d.ten_velocity[3], atol=1e-12)
    np.testing.assert_allclose(
        (state["l"], state["v"]), (d.ten_length[0], d.ten_velocity[0]), atol=1e-12
    )


def _with_control(definition, control):
    names = "gain", "bias", "gear", "control_range", "force_range", "coordinate"
    given = {name: getattr(definition, name) for name in names}
    return carom.forces.Actuator(definition.joint, **given, control=control)


def _fixed(m, d):
    """The part of the cord between two sites of one body."""
    return np.linalg.norm(d.site("mid").xpos - d.site("tip").xpos)


def test_a_motion_with_energy():
    """Springs, dampers and motors along sums and paths close the ledger."""
    s = carom.simulate(carom.load_model(ARM, contacts=False).scene, 1.0, rtol=1e-10)
    np.testing.assert_allclose(s.total_energy, s.total_energy[0] + s.ledger.loads, atol=1e-7)
    assert not s.warnings


PENDULUM = """
<mujoco><option gravity="0 0 -9.81"/><worldbody><site name="hook" pos="0 0 2"/>
<body name="bob" pos="0 0 1.5"><freejoint/><geom size=".05" mass="1"/><site name="eye"/></body></worldbody>
<tendon><spatial name="cord" range="%s" limited="true">
 <site site="hook"/><site site="eye"/></spatial></tendon>
</mujoco>"""


def test_a_limit_along_a_path_is_a_tether():
    """It falls freely through .5 m, and is stopped, or thrown back."""
    model = carom.load_model(PENDULUM % "0 1", limit_restitution=0.5)
    assert [stop.name for stop in model.scene.stops] == ["cord:upper"]
    s = carom.simulate(model.scene, 0.4, rtol=1e-10)
    t = math.sqrt(1.0 / 9.81)
    np.testing.assert_allclose(s.impacts.time[0], t, atol=1e-10)
    np.testing.assert_allclose(s.impacts.impulse[0, 0], 1.5 * 9.81 * t, rtol=1e-9)
    s = carom.simulate(carom.load_model(PENDULUM % "0 1").scene, 1.0, step=1e-2)
    np.testing.assert_allclose(s["cord:upper"].tension[-1], 9.81, rtol=1e-9)


def test_limits_that_the_start_exceeds():
    model = carom.load_model(PENDULUM % ".7 1")
    assert "starts beyond its lower limit, by 0.2" in str(model.report)
    assert [stop.end for stop in model.scene.stops] == pytest.approx([0.5, 1.0])


def test_dry_friction_along_a_path():
    """A load on a cord through an eye, m a = m g - f, or at rest."""
    text = (PENDULUM % "0 9").replace('limited="true"', 'limited="false" frictionloss="%g"')
    for bound in (4.0, 20.0):
        s = carom.simulate(carom.load_model(text % bound).scene, 0.3, rtol=1e-10)
        a = max(9.81 - bound, 0.0)
        np.testing.assert_allclose(s["bob"].position[:, 2], 1.5 - 0.5 * a * s.t**2, atol=1e-10)


def test_what_is_left_out_is_said():
    round_geom = (
        PENDULUM.replace('<site site="hook"/>', '<site site="hook"/><geom geom="g"/>') % "0 1"
    )
    round_geom = round_geom.replace(
        "<worldbody>", '<worldbody><geom name="g" type="sphere" size=".1" pos="1 0 2"/>'
    )
    report = str(carom.load_model(round_geom).report)
    assert "goes round a geom" in report
    still = (
        (PENDULUM % "0 1")
        .replace('<site name="hook" pos="0 0 2"/>', "")
        .replace('<site name="eye"/>', '<site name="eye"/><site name="hook" pos=".1 0 0"/>')
    )
    assert "has a length that does not change" in str(carom.load_model(still).report)


COUPLED = """
<mujoco><option gravity="0 0 0"/><worldbody>
<body pos="0 0 1"><joint name="a" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia=".5 .5 .5"/></body>
<body pos="0 1 1"><joint name="b" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia=".2 .2 .2"/></body>
<body pos="0 2 1"><joint name="c" type="slide" axis="1 0 0"/>
 <inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body>
</worldbody>
<tendon><fixed name="one"><joint joint="a" coef="1"/><joint joint="b" coef="2"/></fixed>
<fixed name="two"><joint joint="b" coef="-1"/><joint joint="c" coef="3"/></fixed></tendon>
<equality><tendon tendon1="one" tendon2="two" polycoef="0 .5 0 0 0"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"""


def test_lengths_that_are_equal():
    """a + 2 b = (3 c - b)/2, moved by a torque: q'' = M^-1 (f + row l)."""
    model = carom.load_model(COUPLED)
    run = carom.Run(model, rtol=1e-10)
    run.ctrl[0] = 1.0
    run.advance(1.0)
    row, M, f = np.array([1.0, 2.5, -1.5]), np.diag([0.5, 0.2, 2.0]), np.array([1.0, 0, 0])
    free = np.linalg.solve(M, f)
    a = free - np.linalg.solve(M, row) * (row @ free) / (row @ np.linalg.solve(M, row))
    np.testing.assert_allclose(model.qpos(run.state), 0.5 * a, atol=1e-9)


def test_a_range_of_a_sum_is_backlash():
    """The first wheel turns freely, takes the second along after .1 rad, e = 0, and keeps the momentum."""
    text = COUPLED.replace("<equality>", "<!--").replace("</equality>", "-->")
    text = text.replace('<fixed name="one">', '<fixed name="one" limited="true" range="-.1 .1">')
    text = text.replace('joint="b" coef="2"', 'joint="b" coef="-2"')
    model = carom.load_model(text)
    run = carom.Run(model, rtol=1e-10)
    run.reset(qvel=[1.0, 0.0, 0.0])
    run.advance(0.3)
    a, b, _ = model.qvel(run.state)
    np.testing.assert_allclose(a, 2 * b, atol=1e-10)
    np.testing.assert_allclose(a * 0.5 + b * 0.2 / 2, 0.5, atol=1e-10)
