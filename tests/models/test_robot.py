"""A model in its own coordinates, against MuJoCo and closed forms."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest

import carom

G = 9.81
DATA = Path(__file__).parents[1] / "data" / "models" / "dm_control"
OFF = mujoco.mjtDisableBit
ARM = """
<mujoco><compiler angle="radian"/><option gravity="0 .5 -9.81" magnetic="0 -.5 .3"/>
<worldbody><site name="mark" pos="1 2 3" euler=".1 .2 .3"/>
 <body name="base" pos="0 0 1"><freejoint/>
  <geom name="bg" type="box" size=".2 .1 .05" pos=".03 .01 0" euler=".1 .2 .3" mass="3"/>
  <site name="imu" pos=".1 .05 .02" euler=".4 -.3 .2"/>
  <body name="arm" pos=".2 0 0">
   <joint name="shoulder" axis="0 1 0" pos=".01 0 .02" damping=".1"/>
   <joint name="roll" axis="1 0 0" pos=".01 0 .02" stiffness="3" armature=".02"/>
   <geom type="capsule" fromto="0 0 0 .3 0 0" size=".02" mass="1"/>
   <site name="elbow" pos=".02 .01 0" euler=".1 1 .1"/>
   <body name="hand" pos=".3 0 0"><joint name="wrist" type="ball" pos="0 0 .01"/>
    <geom type="box" size=".05 .03 .02" pos=".05 0 0" mass=".3"/><site name="palm" pos=".02 0 0"/>
    <body name="tip" pos=".1 .1 .1" euler=".3 0 0"><geom size=".01" mass=".1"/></body>
    <body name="finger" pos=".1 0 0"><joint name="grip" type="slide" axis="0 1 0"/>
     <joint name="twist" axis="0 1 0"/><geom type="sphere" size=".02" mass=".1"/></body>
   </body></body>
  <body name="leg" pos="-.2 0 0"><joint name="hip" axis="0 0 1" pos="0 .1 0"/>
   <joint name="knee" axis="0 1 .3" pos="0 0 .2"/>
   <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".02" mass="1"/></body>
 </body>
 <body name="puck" pos="3 0 0"><joint name="px" type="slide" axis="1 0 0"/>
  <joint name="py" type="slide" axis="0 1 0"/>
  <joint name="pt" axis="0 0 1" pos=".1 0 0"/><geom type="box" size=".2 .1 .05" mass="2"/></body>
 <body name="rod" pos="5 0 0"><joint name="swing" axis="0 1 0" pos="0 0 .4" ref=".3" actuatorfrcrange="-.1 .1"/>
  <geom type="box" size=".02 .02 .3" mass="2"/></body>
</worldbody>
<tendon><fixed name="both"><joint joint="shoulder" coef=".5"/><joint joint="swing" coef="-1"/></fixed></tendon>
<actuator>
 <position name="shoulder" joint="shoulder" kp="20" kv="1" gear="2" ctrlrange="-1 1"/>
 <position name="knee" joint="knee" kp="30" kv="2" forcerange="-2 2"/>
 <general name="grip" joint="grip" gainprm="5" biastype="affine" biasprm=".3 -100 -2"/>
 <velocity name="twist" joint="twist" kv=".5" gear="-1"/>
 <motor name="swing" joint="swing" gear="3"/>
 <motor name="both" tendon="both"/>
</actuator>
<sensor>SENSORS</sensor>
<keyframe><key name="home" qpos="0 0 1.5 1 0 0 0 .1 .2 1 0 0 0 .02 .3 .1 .2 .1 .2 .3 .4"
 ctrl=".1 .2 .3 .4 .5 .6"/></keyframe>
</mujoco>"""
FRAMES = "framepos framequat framexaxis frameyaxis framezaxis framelinvel frameangvel framelinacc frameangacc"
OBJECTS = ("body hand", "xbody hand", "geom bg", "site palm", "body tip", "site mark")
SITES = "gyro velocimeter accelerometer magnetometer force torque"
OTHERS = (
    "jointpos joint swing|jointvel joint swing|ballquat joint wrist|ballangvel joint wrist|"
    "tendonpos tendon both|tendonvel tendon both|actuatorpos actuator shoulder|actuatorvel actuator twist|"
    "actuatorfrc actuator shoulder|actuatorfrc actuator knee|actuatorfrc actuator swing|"
    "jointactuatorfrc joint swing|jointactuatorfrc joint shoulder|subtreecom body arm|subtreecom body world|"
    "subtreelinvel body arm|subtreeangmom body arm"
)


def sensors():
    """One sensor of each kind on each object."""
    out = []
    for kind in FRAMES.split():
        for k, (what, name) in enumerate(one.split() for one in OBJECTS):
            seen = ' reftype="site" refname="imu"' if k % 2 and not kind.endswith("acc") else ""
            out.append(f'<{kind} objtype="{what}" objname="{name}"{seen}/>')
    out += [f'<{kind} site="{site}"/>' for kind in SITES.split() for site in ("imu", "palm")]
    out += [f'<{kind} {what}="{name}"/>' for kind, what, name in map(str.split, OTHERS.split("|"))]
    out += ['<jointvel name="cut" joint="pt" cutoff=".1"/>', "<clock/>", "<e_kinetic/>"]
    return "".join(out)


@pytest.fixture(scope="module")
def arm():
    """The model, started away from its default configuration."""
    rng = np.random.default_rng(2)
    start = rng.normal(size=21)
    model = carom.load_model(ARM.replace("SENSORS", sensors()), contacts=False, qpos=start)
    assert not model.report.of("sensor")
    assert not model.report.of("actuator")
    return model


def random_state(model, seed):
    """MuJoCo's data at random coordinates, velocities and controls, and a run there."""
    rng, m = np.random.default_rng(seed), model.mujoco
    data, run = mujoco.MjData(m), carom.Run(model, step=1e-3)
    data.qpos[:], data.qvel[:] = rng.normal(size=m.nq), rng.normal(size=m.nv)
    data.ctrl[:] = 2.0 * rng.normal(size=m.nu)
    run.reset(qpos=data.qpos, qvel=data.qvel)
    run.ctrl = data.ctrl
    mujoco.mj_normalizeQuat(m, data.qpos)
    mujoco.mj_forward(m, data)
    return data, run


def unlike(model, states, data):
    """The greatest differences of sensors from those of MuJoCo, by kind, relative to values above 1."""
    out, m = {}, model.mujoco
    for i in range(m.nsensor):
        name = m.sensor(i).name or f"sensor{i}"
        if name not in model.sensors:
            continue
        one = model.sensors[name]
        shown = np.asarray(one.of(states))
        mine = np.atleast_1d(shown[-1] if isinstance(states, carom.Solution) else shown)
        its = data.sensordata[m.sensor_adr[i] : m.sensor_adr[i] + m.sensor_dim[i]]
        if "quat" in one.kind and mine @ its < 0.0:
            mine = -mine
        off = abs(mine - its).max() / max(1.0, abs(its).max())
        out[one.kind] = max(out.get(one.kind, 0.0), off)
    return out


@pytest.mark.parametrize("seed", [0, 1])
def test_bodies_are_where_mujoco_has_them(arm, seed):
    """Positions and velocities of all bodies by `qpos` and `qvel`, and back."""
    data, run = random_state(arm, seed)
    state, m, velocity = run.state, arm.mujoco, np.zeros(6)
    for name in ("base", "arm", "hand", "finger", "leg", "puck", "rod"):
        i, body = m.body(name).id, arm.bodies[name].index
        q, p = state.orientation[body], state.position[body]
        assert 1.0 - abs(q @ data.xquat[i]) < 1e-14
        turn = carom.geometry.quaternion.rotate(q, data.xipos[i] * 0.0 + (1, 2, 3))
        assert abs(turn - data.xmat[i].reshape(3, 3) @ (1, 2, 3)).max() < 1e-14
        mujoco.mj_objectVelocity(m, data, mujoco.mjtObj.mjOBJ_XBODY, i, velocity, 0)
        w, v = velocity[:3], velocity[3:]
        centre = p - data.xpos[i]
        assert abs(state.angular_velocity[body] - w).max() < 1e-13
        assert abs(state.velocity[body] - v - np.cross(w, centre)).max() < 1e-13
    q = arm.qpos(state)
    for first in (3, 9):
        q[first : first + 4] *= np.sign(q[first : first + 4] @ data.qpos[first : first + 4])
    assert abs(q - data.qpos).max() < 1e-13
    assert abs(arm.qvel(state) - data.qvel).max() < 1e-13


def test_sensors_show_what_those_of_mujoco_do(arm, tmp_path):
    """Of a state, a solution and a file, under gravity, joints, springs and actuators.

    Two hinges of the leg have a link between them of 1e-12 of its mass, which MuJoCo has not.
    """
    data, run = random_state(arm, 5)
    assert max(unlike(arm, run.state, data).values()) < 1e-9
    run.advance(0.01)
    state, solution, m = run.state, run.solution, arm.mujoco
    data.qpos[:], data.qvel[:], data.time = arm.qpos(state), arm.qvel(state), state.t
    mujoco.mj_forward(m, data)
    solution.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    for states in (state, solution, loaded):
        assert max(unlike(arm, states, data).values()) < 1e-9
    assert np.array_equal(arm.qpos(loaded), arm.qpos(solution))
    assert np.array_equal(loaded.scene.robot.qvel(loaded), arm.qvel(solution))
    assert np.array_equal(arm.ctrl(loaded), arm.ctrl(solution))
    assert np.array_equal(arm.ctrl(solution)[-1], data.ctrl)
    name = next(name for name, one in arm.sensors.items() if one.kind == "gyro")
    assert np.array_equal(loaded[name][-1], state[name])


@pytest.mark.parametrize("name", ["cheetah", "finger", "fish", "humanoid", "walker"])
def test_published_models(name):
    """All sensors and actuators of models of dm_control in the air, at a random state."""
    read = carom.load_model(DATA / f"{name}.xml", contacts=False).mujoco
    read.opt.disableflags |= int(OFF.mjDSBL_CONTACT | OFF.mjDSBL_LIMIT | OFF.mjDSBL_FRICTIONLOSS)
    read.opt.density = read.opt.viscosity = 0.0
    model = carom.load_model(read, contacts=False)
    assert len(model.sensors) == read.nsensor
    data, run = random_state(model, 1)
    assert max(unlike(model, run.state, data).values(), default=0.0) < 1e-9
    forces = [float(one.force(run.state)) for one in model.actuators.values()]
    assert forces == pytest.approx(data.actuator_force, abs=1e-12)


def test_a_keyframe(arm):
    run = carom.Run(arm, step=1e-3)
    run.advance(0.01)
    run.reset(keyframe="home")
    key = arm.keyframes["home"]
    assert run.time == 0.0
    assert abs(arm.qpos(run.state) - key.qpos).max() < 1e-14
    assert np.array_equal(np.array(run.ctrl), key.ctrl)
    run.reset(qpos=key.qpos)
    assert np.array_equal(np.array(run.ctrl), np.zeros(6))
    with pytest.raises(KeyError, match=r"no keyframe 'hom'; it has 'home'; did you mean 'home'\?"):
        run.reset(keyframe="hom")
    with pytest.raises(ValueError, match="keyframe must be given alone"):
        run.reset(keyframe="home", qvel=np.zeros(18))
    with pytest.raises(ValueError, match=r"qpos must have shape \(21,\), got shape \(3,\)"):
        run.reset(qpos=[0, 0, 1])
    with pytest.raises(ValueError, match="qpos must have a quaternion of 'base', got 0"):
        run.set_state(qpos=np.zeros(21))


WHEEL = """
<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="axle" axis="0 1 0"/>
<inertial pos="0 0 0" mass="1" diaginertia=".5 .5 .5"/></body></worldbody><actuator>%s</actuator></mujoco>"""


def wheel(actuator, rtol=1e-11):
    """A wheel of .5 kg m^2 without weight, and its run."""
    model = carom.load_model(WHEEL % actuator)
    return model, carom.Run(model, rtol=rtol)


def test_whole_turns():
    """A wheel that turns freely: q = 7 t, also beyond half a turn, in the state and in the solution."""
    model, run = wheel("")
    run.reset(qpos=[0.5], qvel=[7.0])
    for _ in range(30):
        run.advance(0.1)
    assert model.joints["axle"].of(run.state)[0] == pytest.approx(21.5, abs=1e-11)
    assert model.qpos(run.solution)[-1, 0] == pytest.approx(21.5, abs=1e-11)
    run.set_state(qvel=[7.0])
    assert model.joints["axle"].of(run.state)[0] == pytest.approx(21.5, abs=1e-11)
    run.set_state(qpos=[40.0])
    run.advance(0.1)
    assert model.qpos(run.state)[0] == pytest.approx(40.7, abs=1e-11)
    assert model.qpos(run.solution)[-1, 0] == pytest.approx(40.7, abs=1e-11)


def test_a_position_servo_swings():
    """J q'' = gear (k (u - gear q) - c gear q'): a damped oscillation about u / gear, to the tolerance.

    Beyond its range a control acts as the end of it, and the work of the servo is in the ledger.
    """
    model, run = wheel(
        '<position name="a" joint="axle" kp="2" kv=".1" gear="3" ctrlrange="-1 .6"/>'
    )
    assert not model.report.of("actuator")
    run.ctrl["a"] = 5.0
    assert run.ctrl["a"] == 5.0
    decay, square = 9 * 0.1 / (2 * 0.5), 9 * 2 / 0.5
    w, aim = math.sqrt(square - decay**2), 0.2
    for _ in range(10):
        run.advance(0.1)
        t, q = run.time, model.qpos(run.state)[0]
        wave = math.cos(w * t) + decay / w * math.sin(w * t)
        assert q == pytest.approx(aim * (1.0 - math.exp(-decay * t) * wave), abs=1e-9)
    solution = run.solution
    assert solution.warnings == ()
    assert abs(solution.ledger.residual).max() < 1e-10
    assert np.array_equal(model.ctrl(solution)[:, 0], [0.0, *[5.0] * 10])
    length = 3 * model.qpos(solution)[:, 0]
    rate = 3 * model.qvel(solution)[:, 0]
    force = 2 * np.array([0.0, *[0.6] * 10]) - 2 * length - 0.1 * rate
    assert model.actuators["a"].force(solution) == pytest.approx(force, abs=1e-12)


def test_a_servo_whose_force_is_limited():
    """Far from its target the torque is the limit, q = F t^2/(2 J); near it the law is linear."""
    model, run = wheel(
        '<position name="a" joint="axle" kp="100" kv="20" forcerange="-.3 .3"/>', 1e-8
    )
    run.ctrl["a"] = 1.0
    run.advance(0.7)
    assert model.qpos(run.state)[0] == pytest.approx(0.3 * 0.7**2, abs=1e-9)
    assert model.actuators["a"].force(run.state) == pytest.approx(0.3, abs=1e-15)
    run.advance(12.0)
    assert model.qpos(run.state)[0] == pytest.approx(1.0, abs=1e-8)
    assert run.solution.status is carom.Status.SUCCESS
    kept = run.ctrl
    run.reset()
    assert kept["a"] == 0.0
    run.advance(0.5)
    assert model.qpos(run.state)[0] == 0.0


def test_a_velocity_servo_and_a_motor():
    """J q'' = c (u - q') + F: q' = (u + F/c) (1 - exp(-c t/J)); the motor is cut at its range."""
    model, run = wheel(
        '<velocity name="v" joint="axle" kv=".8"/><motor name="m" joint="axle" gear="2" forcerange="-1 .1"/>'
    )
    run.ctrl = [1.5, 4.0]
    run.advance(0.9)
    speed = (1.5 + 0.2 / 0.8) * (1.0 - math.exp(-0.8 * 0.9 / 0.5))
    assert model.qvel(run.state)[0] == pytest.approx(speed, abs=1e-10)


def test_an_actuator_of_a_scene_with_the_implicit_method(tmp_path):
    """A stiff servo with a step a hundred times its period: the cart is at its target, as in a file."""
    scene = carom.Scene(gravity=(0, 0, 0))
    cart = scene.add_body(carom.Box(0.4, 0.2, 0.1), mass=2.0, name="cart")
    rail = scene.add_joint(carom.joints.Prismatic((1, 0, 0)), carom.GROUND, cart, name="rail")
    servo = carom.forces.Actuator(rail, gain=1e6, bias=(0.0, -1e6, -2e4), control=0.1)
    scene.add_force(servo, name="servo")
    run = carom.Run(scene, step=0.1, method="implicit")
    assert run.ctrl["servo"] == 0.1
    run.advance(1.0)
    run.ctrl["servo"] = 0.3
    run.advance(1.0)
    assert run.state["cart"].position[0] == pytest.approx(0.3, abs=1e-6)
    run.solution.save(tmp_path / "run.nc")
    again = carom.Run(carom.Solution.load(tmp_path / "run.nc"))
    assert again.ctrl["servo"] == 0.3
    again.advance(1.0)
    assert again.state["cart"].position[0] == pytest.approx(0.3, abs=1e-9)


def test_controls_that_are_wrong(arm):
    run = carom.Run(arm, step=1e-3)
    names = "'shoulder', 'knee', 'grip', 'twist', 'swing', 'both'"
    with pytest.raises(
        KeyError, match=f"the run has no actuator 'gripper'; it has {names}; did you mean 'grip'"
    ):
        run.ctrl["gripper"] = 1.0
    with pytest.raises(ValueError, match=r"ctrl\['grip'\] must be finite"):
        run.ctrl["grip"] = math.nan
    for key in (None, 1.5, (1, 2), {}, b"grip", True, slice("a", "b"), np.zeros((2, 2), bool)):
        with pytest.raises(ValueError, match=r"the key of ctrl must be the name or the number of"):
            run.ctrl[key]
        with pytest.raises(ValueError, match=r"the key of ctrl must be the name or the number of"):
            run.ctrl[key] = 0.0
    with pytest.raises(IndexError, match="the run has 6 actuators, got the number 6"):
        run.ctrl[6]
    assert len(list(run.ctrl)) == 6
    with pytest.raises(ValueError, match=r"ctrl\[slice\(None, 2, None\)\] must be 2 controls"):
        run.ctrl[:2] = [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match=r"ctrl must have shape \(6,\), got shape \(2,\)"):
        run.ctrl = [1.0, 2.0]
    with pytest.raises(
        ValueError, match=r"a Actuator, whose control is run\.ctrl\['knee \(actuator\)'\]"
    ):
        run.set_force("knee (actuator)", 1.0)
    with pytest.raises(ValueError, match=r"force_range must be \(least, greatest\)"):
        carom.forces.Actuator(arm.joints["knee"].joint, force_range=(1.0, -1.0))
    with pytest.raises(KeyError, match="the model has no sensor 'gyr'"):
        arm.sensors["gyr"]


FOOT = """
<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/>
<body name="leg" pos="0 0 .3"><joint name="lift" type="slide" axis="0 0 1"/>
 <geom type="capsule" fromto="0 0 -.2 0 0 .2" size=".1" mass="4"/>
 <site name="toe" pos="0 0 -.3" size=".02"/><site name="head" pos="0 0 .3" size=".02"/>
 <body name="load" pos="0 .5 0"><joint name="pin" axis="0 1 0"/><geom size=".05" mass="1.5" pos="0 .1 0"/>
 <site name="cell" euler="90 0 0"/></body></body></worldbody>
<actuator><motor name="lift" joint="lift"/></actuator>
<sensor><touch name="toe" site="toe"/><touch name="head" site="head"/><accelerometer name="up" site="toe"/>
<force name="f" site="cell"/><torque name="t" site="cell"/></sensor></mujoco>"""


def test_a_foot_on_the_floor():
    """At rest: the foot feels the weight less the lift, accelerometers feel g, the cell carries its load.

    Lifted by more than the weight it feels nothing, and accelerometers feel F/m.
    """
    run = carom.Run(carom.load_model(FOOT, restitution=0.0), step=1e-3)
    run.ctrl["lift"] = 10.0
    run.advance(0.1)
    state, solution = run.state, run.solution
    for read in (state.__getitem__, lambda name: solution[name][-1]):
        assert read("toe") == pytest.approx(5.5 * G - 10.0, abs=1e-9)
        assert read("head") == 0.0
        assert read("up") == pytest.approx([0.0, 0.0, G], abs=1e-9)
        assert read("f") == pytest.approx([0.0, 1.5 * G, 0.0], abs=1e-9)
        assert read("t") == pytest.approx([1.5 * G * 0.1, 0.0, 0.0], abs=1e-9)
    run.ctrl["lift"] = 5.5 * (G + 2.0)
    run.advance(0.1)
    assert run.state["toe"] == 0.0
    assert run.state["up"] == pytest.approx([0.0, 0.0, G + 2.0], abs=1e-9)
    assert solution["toe"].shape == solution.t.shape


WHEELS = """
<mujoco><option gravity="0 0 0"/><worldbody>
<body pos="0 0 1"><joint name="a" axis="0 1 0"/><inertial pos="0 0 0" mass="1" diaginertia=".5 .5 .5"/></body>
<body pos="0 2 1"><joint name="b" type="slide" axis="1 0 0"/>
<inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body>
</worldbody>
<tendon><fixed name="t" %s><joint joint="a" coef=".3"/><joint joint="b" coef="-1.5"/></fixed></tendon>
<actuator>%s</actuator>
<sensor><tendonpos name="l" tendon="t"/><tendonvel name="v" tendon="t"/></sensor></mujoco>"""
#: 1/inertia of the length: .3^2/.5 + 1.5^2/2; the link that slides by it has 1e-6 of the inertia
EASE = 0.09 / 0.5 + 2.25 / 2.0


def test_a_spring_along_a_tendon():
    """l'' = -k c (l - rest): a cosine, from the state that a run is put to; the joints share it as c_k/m_k."""
    model = carom.load_model(WHEELS % ('stiffness="7" springlength=".2"', ""), qpos=[0.4, 0.1])
    run = carom.Run(model, rtol=1e-10)
    run.reset(qpos=[1.0, -0.5])
    begin = 0.3 * 1.0 + 1.5 * 0.5
    run.advance(1.3)
    length = 0.2 + (begin - 0.2) * math.cos(math.sqrt(7 * EASE) * 1.3)
    assert run.state["l"] == pytest.approx(length, abs=1e-5)
    a, b = model.qpos(run.state) - (1.0, -0.5)
    assert a / b == pytest.approx((0.3 / 0.5) / (-1.5 / 2.0), abs=1e-9)


def test_a_tendon_with_a_limit_and_a_servo():
    """It strikes its limit with restitution .5; a servo along it brings it to its target."""
    limited = WHEELS % ('range="-1 .4" limited="true"', "")
    run = carom.Run(carom.load_model(limited, limit_restitution=0.5), step=1e-2)
    run.reset(qvel=[0.0, -1.0], qpos=[0.0, 0.0])
    run.advance(1.0)
    hit = 0.4 / 1.5
    assert run.state["v"] == pytest.approx(-0.75, abs=1e-5)
    assert run.state["l"] == pytest.approx(0.4 - 0.75 * (1.0 - hit), abs=1e-5)
    servo = '<position name="m" tendon="t" kp="50" kv="12"/>'
    model = carom.load_model(WHEELS % ("", servo))
    run = carom.Run(model, step=1e-3)
    run.ctrl["m"] = 0.7
    run.advance(5.0)
    assert run.state["l"] == pytest.approx(0.7, abs=1e-9)
    assert model.actuators["m"].force(run.state) == pytest.approx(0.0, abs=1e-7)


def test_a_scene_of_a_model_that_changes():
    """A replaced body is the one that coordinates read; the model ends with one of its joints."""
    model = carom.load_model(FOOT, restitution=0.0)
    model.scene.replace("leg", mass=2.0)
    run = carom.Run(model, step=1e-3)
    run.reset(qpos=[0.5, 0.0])
    run.ctrl["lift"] = 0.0
    run.advance(0.1)
    assert model.qpos(run.state)[0] == pytest.approx(0.5 - 0.5 * G * 0.1**2, abs=1e-12)
    assert run.state["f"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    model.scene.remove("pin", dependents=True)
    assert model.scene.robot is None


CART = """<mujoco><worldbody><body name="cart" pos="0 0 1"><joint name="rail" type="slide" axis="1 0 0"
 frictionloss="3"/><geom type="box" size=".2 .1 .1" mass="2"/>
<site name="imu" euler="0 0 90"/></body></worldbody>
<actuator><motor name="push" joint="rail" gear="2" RANGE/></actuator>
<sensor><accelerometer name="shown" site="imu"/><force name="carried" site="imu"/></sensor></mujoco>"""


@pytest.mark.parametrize("limit", [math.inf, 3.0])
def test_sensors_and_motors_of_a_joint_with_dry_friction(limit):
    """m a = F - 3 N while the cart slips, 0 while it sticks; with the control of each time, also later."""
    text = "" if math.isinf(limit) else f'forcerange="-{limit} {limit}"'
    run = carom.Run(carom.load_model(CART.replace("RANGE", text)), step=0.01)
    states, aims = [run.state], (0.0, 1.0, 4.0, -1.0, 0.0, 5.0)
    for aim in aims[1:]:
        run.ctrl["push"] = aim
        run.advance(0.1)
        states.append(run.state)
    push = 2.0 * np.clip(aims, -limit, limit)
    a = np.maximum(push - 3.0, 0.0) / 2.0
    solution = run.solution
    rows = np.searchsorted(solution.t, [one.t for one in states])
    for name, exact in {
        "shown": np.stack([0 * a, -a, 0 * a + G], axis=1),
        "carried": 2.0 * np.stack([0 * a, -a, 0 * a + G], axis=1),
    }.items():
        np.testing.assert_allclose([one[name] for one in states], exact, atol=1e-9)
        np.testing.assert_allclose(solution[name][rows], exact, atol=1e-9)
    np.testing.assert_allclose([one["push"].force for one in states], push)
    np.testing.assert_allclose(solution["push"].force[rows], push)


DRY_WHEEL = """<mujoco><option gravity="0 0 0"/><worldbody><body name="wheel">
<joint name="axle" axis="0 0 1" frictionloss="LOSS"/>
<geom type="box" size=".2 .1 .1" mass="2"/></body></worldbody>
<actuator><position name="servo" joint="axle" kp="2" kv=".1" RANGE/></actuator>
<sensor><frameangacc name="shown" objtype="body" objname="wheel"/></sensor></mujoco>"""


@pytest.mark.parametrize("text", ["", 'forcerange="-100 100"'])
@pytest.mark.parametrize("loss", [5.0, 50.0])
def test_forces_of_a_state_have_whole_turns(loss, text):
    """A servo from 10 rad to 1 rad: -18 N m at the start, against friction that slips or sticks."""
    model = carom.load_model(DRY_WHEEL.replace("LOSS", str(loss)).replace("RANGE", text))
    run = carom.Run(model, step=1e-3)
    run.reset(qpos=[10.0])
    run.ctrl["servo"] = 1.0
    state = run.state
    run.ctrl["servo"] = 0.0
    run.advance(0.01)
    assert state["servo"].torque == pytest.approx(-18.0, rel=1e-12)
    assert state["servo"].coordinate == state["axle"].coordinate == pytest.approx(10.0, rel=1e-12)
    assert run.solution["axle"].coordinate[0] == pytest.approx(10.0, rel=1e-12)
    (dry,) = (one.name for one in model.scene.forces if one.name != "servo")
    inertia = 2.0 * (0.4**2 + 0.2**2) / 12.0
    assert state[dry].torque == pytest.approx(min(loss, 18.0), rel=1e-9)
    assert state["shown"][2] == pytest.approx(-max(18.0 - loss, 0.0) / inertia, rel=1e-9, abs=1e-9)


def test_a_wheel_that_sticks_after_whole_turns():
    """Friction of 5 N m holds a spring of 0.2 N m/rad that was wound up to 3 turns: in state and solution."""
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(mass=2.0, inertia=(1, 1, 1), angular_velocity=(0, 0, 14), name="wheel")
    axle = carom.joints.Revolute((0, 0, 0), (0, 0, 1))
    scene.add_joint(axle, carom.GROUND, "wheel", name="axle")
    scene.add_force(carom.forces.JointSpring("axle", 0.2), name="spring")
    scene.add_force(carom.forces.JointFriction("axle", 5.0), name="dry")
    run = carom.Run(scene, step=0.01)
    run.advance(5.0)
    q = 25.0 * (math.sqrt(1.0 + 0.2 * 14.0**2 / 25.0) - 1.0)  # k q^2 / 2 + 5 q = 14^2 / 2
    for view, k in ((run.state, ...), (run.solution, -1)):
        assert view["axle"].coordinate[k] == pytest.approx(q, rel=1e-6)
        assert view["spring"].torque[k] == pytest.approx(-0.2 * q, rel=1e-6)
        assert view["dry"].torque[k] == pytest.approx(0.2 * q, rel=1e-6)


def test_a_state_with_friction_that_sticks_beside_a_motor_that_was_set():
    """A motor of 5 N m on a free axle, and friction that holds another axle against 1 N m."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for k, name in enumerate(("free", "held")):
        scene.add_body(mass=1.0, inertia=(1, 1, 1), position=(k, 0, 0), name=name)
        axle = carom.joints.Revolute((k, 0, 0), (0, 0, 1))
        scene.add_joint(axle, carom.GROUND, name, name=f"{name} axle")
        scene.add_force(carom.forces.JointForce(f"{name} axle", 0.0), name=f"{name} motor")
    scene.add_force(carom.forces.Torque((0, 2, 0)), "held", name="tilt")
    scene.add_force(carom.forces.JointFriction("held axle", 3.0), name="dry")
    run = carom.Run(scene, step=0.01)
    run.set_force("free motor", 5.0)
    run.set_force("held motor", 1.0)
    run.advance(0.1)
    state = run.state
    run.set_force("held motor", -2.0)
    run.set_force("tilt", (0, 0, 0))
    assert state["dry"].torque == pytest.approx(-1.0, rel=1e-12)
    assert state["held axle"].torque == pytest.approx([0, -2, 0], abs=1e-12)
    assert run.state["dry"].torque == pytest.approx(2.0, rel=1e-12)
    assert run.state["held axle"].torque == pytest.approx([0, 0, 0], abs=1e-12)
