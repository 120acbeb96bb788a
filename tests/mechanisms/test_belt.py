"""Belts against gears and closed forms: motion, tensions, bearings, jerks; elastic strands, files, errors."""

import warnings

import numpy as np
import pytest

import carom
from carom import GROUND, constraints, forces, joints
from carom.geometry import quaternion
from files.compare import goes_on
from verified import agree, verifies

RA, RB = 0.1, 0.04
CENTER = np.array([0.3, 0.1, 0.0])
Z = (0, 0, 1)


def drive(belt=None, crossed=False, load=0.01, torque=0.3, carrier=None, turned=(1, 1), **motion):
    """Return two wheels in hinges, a torque on the first and viscous friction of the second.

    `belt` are options of the belt; None for a gear of the same ratio.
    """
    scene = carom.Scene(gravity=(0, 0, 0))
    on = GROUND
    if carrier is not None:
        on = scene.add_body(carom.Box(0.5, 0.1, 0.02), mass=2.0, name="carrier", **carrier)
    places = np.zeros(3), CENTER
    hinges = []
    for name, radius, mass, at, way in zip("ab", (RA, RB), (1.0, 0.5), places, turned):
        wheel = scene.add_body(
            carom.Cylinder(radius, 0.02), mass=mass, position=at, name=name, **motion
        )
        hinge = joints.Revolute(at, (0, 0, way))
        hinges.append(scene.add_joint(hinge, on, wheel, name=f"hinge {name}"))
    scene.add_force(forces.JointForce(hinges[0], lambda t, q, rate: torque * np.cos(3 * t)))
    scene.add_force(forces.JointSpring(hinges[1], damping=load))
    way = (-1 if crossed else 1) * turned[0] * turned[1]
    if belt is None:
        scene.add_constraint(constraints.Gear(*hinges, way * RA / RB), name="gear")
    else:
        scene.add_joint(joints.Belt(RA, RB, crossed, **belt), "a", "b")
    return scene


@pytest.mark.parametrize("how", [{"rtol": 1e-10}, {"step": 5e-3}])
@pytest.mark.parametrize("turned", [(1, 1), (1, -1), (-1, 1)])
@pytest.mark.parametrize("crossed", [False, True])
def test_the_motion_is_that_of_a_gear(crossed, turned, how):
    belt, gear = (
        carom.simulate(drive(one, crossed, turned=turned), 1.0, **how)
        for one in ({"tension": 30.0}, None)
    )
    at = np.linspace(0, 1, 21)
    for one, two in zip(belt.evaluate(at), gear.evaluate(at)):
        np.testing.assert_allclose(one, two, atol=1e-10)
    np.testing.assert_allclose(belt["hinge a"].coordinate, gear["hinge a"].coordinate, atol=1e-10)
    way = (-1 if crossed else 1) * turned[0] * turned[1]
    exact = way * RA / RB * belt["hinge a"].rate
    np.testing.assert_allclose(belt["hinge b"].rate, exact, atol=1e-12 * np.max(np.abs(exact)))


def lines(crossed):
    """Return directions of both strands from the first wheel."""
    d, n = CENTER, np.array(Z)
    rho = RA + RB if crossed else RA - RB
    l = np.sqrt(d @ d - rho * rho)
    return [(l * d + side * rho * np.cross(n, d)) / (d @ d) for side in (-1, 1)]


@verifies(
    "joints.Belt",
    r"$I_b \dot\omega_b = r_b (T_1 - T_2) - c\,\omega_b$, $T_1 + T_2 = 2 T_0$",
    "closed form",
)
@pytest.mark.parametrize("crossed", [False, True])
def test_tensions_and_bearings(crossed):
    """I_b w_b' = r_b (T_1 - T_2) - c w_b, T_1 + T_2 = 2 T_0; the hinges carry T_1 e_1 + T_2 e_2."""
    s = carom.simulate(drive({"tension": 30.0}, crossed), 0.5, rtol=1e-10)
    tight, slack = s["belt1"].tension.T
    agree(tight + slack, 60.0, rtol=1e-7)
    inertia = 0.5 * 0.5 * RB**2, 0.5 * 1.0 * RA**2
    ratio = RA / RB
    whole = inertia[1] + ratio**2 * inertia[0]
    wa = s["hinge a"].rate
    rate = (0.3 * np.cos(3 * s.t) - ratio**2 * 0.01 * wa) / whole
    pull = (inertia[0] * ratio * rate + 0.01 * ratio * wa) / RB
    agree(tight - slack, pull, rtol=1e-9, atol=1e-9)
    e1, e2 = lines(crossed)
    on_a = np.outer(tight, e1) + np.outer(slack, e2)
    agree(s["hinge a"].force, -on_a, atol=1e-8)
    agree(s["hinge b"].force, on_a, atol=1e-8)
    agree(s["hinge a"].torque[:, :2], 0.0, atol=1e-8)


def test_bearings_rub_by_the_tension():
    """Friction by load: each hinge brakes with mu r 2 T_0 cos(alpha), so the drive starts above their sum."""
    mu, radius, tension = 0.2, 0.01, 50.0
    d = np.linalg.norm(CENTER)
    each = mu * radius * 2 * tension * np.sqrt(1 - ((RA - RB) / d) ** 2)
    breaks = each * (1 + RA / RB)  # at the first wheel, with the ratio
    for factor in (0.99, 1.01):
        scene = drive({"tension": tension}, torque=0.0, load=0.0)
        for name in "ab":
            scene.add_force(forces.JointFriction(f"hinge {name}", mu=mu, radius=radius))
        scene.add_force(forces.Torque((0, 0, factor * breaks)), "a")
        s = carom.simulate(scene, 0.3)
        assert (abs(s["hinge a"].coordinate[-1]) > 1e-3) == (factor > 1.0)


def test_a_carrier_that_moves():
    """A belt is within its carrier: energy and both momenta of all three are kept, in space."""
    carrier = {"velocity": (0.1, 0.3, -0.2), "angular_velocity": (0.7, -0.4, 0.5)}
    runs = []
    for belt in ({"tension": 20.0}, None):
        scene = drive(belt, load=0.0, torque=0.0, carrier=carrier)
        w = np.array(carrier["angular_velocity"])
        for body in scene.bodies:
            v = np.array(carrier["velocity"]) + np.cross(w, body.position)
            scene.replace(body, velocity=v, angular_velocity=w)
        scene.replace("a", angular_velocity=w + (0, 0, 8.0))
        scene.replace("b", angular_velocity=w + (0, 0, 8.0 * RA / RB))
        runs.append(carom.simulate(scene, 1.0, rtol=1e-11))
    belt, gear = runs
    for one, two in zip(belt.evaluate(1.0), gear.evaluate(1.0)):
        np.testing.assert_allclose(one, two, atol=1e-9)
    np.testing.assert_allclose(belt.total_energy, belt.total_energy[0], rtol=1e-9)
    # within the carrier the same force on both hinges: it pulls the wheels together
    more = belt["hinge a"].force - gear["hinge a"].force
    q = quaternion.rotate_back(belt["carrier"].orientation, more)
    np.testing.assert_allclose(q[:, 2], 0.0, atol=1e-7)
    line = CENTER / np.linalg.norm(CENTER)
    both = 40.0 * np.sqrt(1 - ((RA - RB) / np.linalg.norm(CENTER)) ** 2)
    np.testing.assert_allclose(-q @ line, both, rtol=1e-7)


def test_a_reversed_hinge_and_a_framed_one():
    """A wheel may be the parent of its hinge; a hinge with frames may begin at an angle."""
    scene = carom.Scene(gravity=(0, 0, 0))
    arm = scene.add_body(carom.Box(0.5, 0.1, 0.02), mass=2.0, position=(0.2, 0, 0), name="arm")
    base = scene.add_body(carom.Cylinder(RA, 0.02), mass=1.0, name="base")
    scene.add_joint(joints.Fixed(), GROUND, base)
    swing = scene.add_joint(joints.Revolute((0, 0, 0), Z), base, arm, name="swing")
    hand = scene.add_body(
        carom.Cylinder(RA, 0.02),
        mass=0.3,
        position=(0.4, 0, 0),
        orientation=carom.euler("z", 50),
        name="hand",
    )
    frames = {"parent_frame": ((0.2, 0, 0), (1, 0, 0, 0)), "child_frame": ((0, 0, 0), (1, 0, 0, 0))}
    scene.add_joint(joints.Revolute((0, 0, 0), Z), arm, hand, name="wrist", **frames)
    scene.add_joint(joints.Belt(RA, RA, tension=10.0), "base", hand)
    scene.add_force(forces.JointForce(swing, 0.3))
    s = carom.simulate(scene, 1.0, rtol=1e-10)
    assert s["swing"].coordinate[-1] > 0.5
    # equal radii: the hand keeps its attitude in the world
    np.testing.assert_allclose(
        s["hand"].orientation, s["hand"].orientation[:1].repeat(len(s.t), 0), atol=1e-9
    )
    np.testing.assert_allclose(s["wrist"].coordinate[0], np.radians(50.0), atol=1e-12)


@verifies("joints.Belt", r"$P = (1 + e)\,r_a\omega_a/(r_a^2/I_a + r_b^2/I_b)$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_a_slack_belt_gets_taut(e):
    """Half of the slack runs out: P = (1 + e) r_a w_a/(r_a^2/I_a + r_b^2/I_b), and the hinges take P e_1."""
    slack, spin = 0.02, 5.0
    scene = drive({"one_sided": True, "slack": slack, "restitution": e}, load=0.0, torque=0.0)
    scene.replace("a", angular_velocity=(0, 0, spin))
    s = carom.simulate(scene, 0.05, rtol=1e-10)
    agree(s.impacts.time[0], 0.5 * slack / (RA * spin), rtol=1e-12)
    ia, ib = 0.5 * RA**2, 0.25 * RB**2
    impulse = (1 + e) * RA * spin / (RA**2 / ia + RB**2 / ib)
    agree(s.impacts.impulse[0, 0], impulse, rtol=1e-10)
    own = s.joint_impulses
    by = {str(name): vector for name, vector in zip(own.name, own.impulse)}
    e1 = lines(False)[0]
    agree(by["hinge a"], -impulse * e1, atol=1e-9)
    agree(by["hinge b"], impulse * e1, atol=1e-9)
    if e == 0.0:
        wa = spin - impulse * RA / ia
        agree(s["hinge b"].rate[-1], wa * RA / RB, rtol=1e-10)
    assert np.all(s["belt1.1"].gap > -1e-12)
    assert np.all(s["belt1.2"].gap > -1e-12)


def test_one_sided_strands_without_slack():
    """Only one strand carries, and it changes as the torque turns round; the motion is that of a gear."""
    belt, gear = (
        carom.simulate(drive(one, load=0.0), 2.0, rtol=1e-10) for one in ({"one_sided": True}, None)
    )
    np.testing.assert_allclose(
        belt["hinge a"].coordinate[-1], gear["hinge a"].coordinate[-1], atol=1e-9
    )
    one, two = belt["belt1.1"].tension, belt["belt1.2"].tension
    assert np.max(one) > 0.1
    assert np.max(two) > 0.1
    assert np.all(np.minimum(one, two) == 0.0)
    pull = -gear["gear"].multipliers / RB  # a gear acts with torques
    np.testing.assert_allclose((one - two)[1:-1], pull[1:-1], atol=1e-7)


@verifies("forces.BeltStrand", r"$\omega^2 = 2 k (r_a^2/I_a + r_b^2/I_b)$", "closed form")
def test_elastic_strands():
    """Two springs in tension: the wheels swing against each other with w^2 = 2 k (r_a^2/I_a + r_b^2/I_b)."""
    k, spin = 2000.0, 0.5
    scene = drive({"stiffness": k, "tension": 20.0}, load=0.0, torque=0.0)
    scene.replace("a", angular_velocity=(0, 0, spin))
    s = carom.simulate(scene, 0.3, rtol=1e-10)
    ia, ib = 0.5 * RA**2, 0.25 * RB**2
    both = RA**2 / ia + RB**2 / ib
    w = np.sqrt(2 * k * both)
    stretch = RA * spin / w * np.sin(w * s.t)
    agree(s["belt1.1"].tension, 20.0 + k * stretch, atol=1e-6)
    agree(s["belt1.2"].tension, 20.0 - k * stretch, atol=1e-6)
    agree(s["belt1.1"].coordinate, stretch, atol=1e-9)
    agree(s.total_energy, s.total_energy[0], rtol=1e-8)


@verifies(
    "forces.BeltStrand", "the same with one strand at a time, which pulls only", "closed form"
)
def test_an_elastic_strand_hangs_slack():
    """Without tension one spring acts at a time: half the stiffness, the same energy; it pulls only."""
    k, spin = 2000.0, 0.5
    scene = drive({"stiffness": k}, load=0.0, torque=0.0)
    scene.replace("a", angular_velocity=(0, 0, spin))
    s = carom.simulate(scene, 0.3, rtol=1e-10)
    ia, ib = 0.5 * RA**2, 0.25 * RB**2
    w = np.sqrt(k * (RA**2 / ia + RB**2 / ib))
    stretch = RA * spin / w * np.sin(w * s.t)
    agree(s["belt1.1"].tension, np.maximum(0.0, k * stretch), atol=1e-6)
    agree(s["belt1.2"].tension, np.maximum(0.0, -k * stretch), atol=1e-6)
    agree(s.total_energy, s.total_energy[0], rtol=1e-8)


@pytest.mark.parametrize(
    "belt",
    [{"tension": 10.0}, {"one_sided": True, "slack": 0.01}, {"stiffness": 1e3, "slack": 0.01}],
)
def test_files(belt, tmp_path):
    scene = drive(belt, load=0.0)
    scene.replace(scene.forces[0], force=0.3)
    path = tmp_path / "run.h5"
    goes_on(scene, 0.4, path, step=1e-2)
    again = carom.Solution.load(path)
    assert repr(again.scene) == repr(scene)
    for name in ("belt1",) if "tension" in belt else ("belt1.1", "belt1.2"):
        np.testing.assert_array_equal(
            again[name].tension, carom.resume(path)[name].tension[: len(again.t)]
        )


def test_changes():
    """A wheel that is replaced is that of the belt; one that is removed takes the belt with it."""
    for belt in ({"tension": 10.0}, {"one_sided": True}, {"stiffness": 1e3}):
        scene = drive(belt)
        scene.replace("b", mass=5.0)
        s = carom.simulate(scene, 0.1)
        off = RB * s["hinge b"].coordinate[-1] - RA * s["hinge a"].coordinate[-1]
        assert abs(off) < (0.01 if "stiffness" in belt else 1e-12)
        with pytest.raises(ValueError, match="belt1"):
            scene.remove("b")


def test_pictures(tmp_path):
    from carom.visual.bodies import links_of

    for belt in ({"tension": 10.0}, {"one_sided": True}, {"stiffness": 1e3}):
        first, second = [one for one in links_of(drive(belt)) if one.kind == "cord"]
        np.testing.assert_array_equal(first.radii, -second.radii)


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"damping": 1.0}, "damping must be left out"),
        ({"slack": 0.1}, "slack must be left out"),
        ({"stiffness": 1.0, "slack": 0.1, "tension": 1.0}, "slack must be left out"),
        ({"one_sided": True, "tension": 1.0}, "tension must be left out"),
        ({"one_sided": True, "restitution": 1.0}, "restitution must be left out"),
    ],
)
def test_definitions_that_contradict_themselves(given, match):
    with pytest.raises(ValueError, match=match):
        joints.Belt(0.1, 0.1, **given)


def test_wheels_that_a_belt_cannot_join():
    scene = drive({})
    with pytest.raises(ValueError, match="beside each other"):
        scene.add_joint(joints.Belt(0.3, 0.2), "a", "b")
    with pytest.raises(ValueError, match="must be a body"):
        scene.add_joint(joints.Belt(0.1, 0.1), GROUND, "b")
    loose = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(1, 0, 0), name="loose")
    with pytest.raises(ValueError, match="one carrier"):
        scene.add_joint(joints.Belt(0.1, 0.1), "a", loose)
    with pytest.raises(ValueError, match="replace"):
        scene.add_joint(joints.Belt(0.1, 0.1), "a", "b", name="belt1", replace=True)
    with pytest.raises(AttributeError, match="no Belt"):
        _ = carom.simulate(drive(None), 0.01)["gear"].tension


@pytest.mark.parametrize(("tension", "pushes"), [(0.0, False), (1.0, True), (100.0, False)])
def test_a_belt_whose_strand_pushes_is_said(tension, pushes):
    scene, wheels = carom.Scene(gravity=(0, 0, 0)), []
    for k in range(2):
        wheel = scene.add_body(carom.Cylinder(0.1, 0.02), mass=1.0, position=(0.5 * k, 0, 0))
        wheels.append(wheel)
        scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 0, 1)), GROUND, wheel, name=f"axle{k}")
    scene.add_joint(joints.Belt(0.1, 0.1, tension=tension), *wheels, name="belt")
    scene.add_force(forces.JointForce("axle0", 1.0))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        carom.simulate(scene, 0.2)
    # it transmits 5 N, half of which each strand takes
    assert [("pushes with 1.5 N" in str(one.message)) for one in said] == [True] * pushes
