"""Endless belts over several wheels, by their back, with idlers and tensioners: closed forms and lengths."""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints
from files.compare import goes_on
from verified import agree, verifies

#: place, radius, side of the belt, moment of inertia
WHEELS = (
    ((0.0, 0.0), 0.10, 1, 0.02),
    ((0.5, 0.0), 0.05, 1, 0.003),
    ((0.3, 0.12), 0.04, -1, 0.001),
    ((0.25, 0.4), 0.08, 1, 0.01),
)
RADII, SIDES = (np.array([one[k] for one in WHEELS]) for k in (1, 2))
INERTIA = np.array([one[3] for one in WHEELS])


def serpentine(torque=1.0, first=0, **belt):
    """Four wheels on the ground, the third at the back of the belt; a torque on the first."""
    scene, pulleys = carom.Scene(gravity=(0, 0, 0)), []
    for k, ((x, y), r, side, inertia) in enumerate(WHEELS):
        wheel = scene.add_body(
            carom.Cylinder(r, 0.02), mass=1.0, inertia=(inertia,) * 3, position=(x, y, 0), name=f"wheel{k}"
        )  # fmt: skip
        scene.add_joint(joints.Revolute((x, y, 0), (0, 0, 1)), GROUND, wheel, name=f"hinge{k}")
        pulleys.append(carom.Pulley(wheel, r, (0, 0, side)))
    scene.add_force(forces.JointForce("hinge0", torque), name="motor")
    scene.add_belt([*pulleys[first:], *pulleys[:first]], name="belt", **belt)
    return scene


def tensions(s, first=0):
    """Return the tensions (T, 4): of the part from wheel k to the next."""
    parts = [s[f"belt.{k + 1}"].tension for k in range(4)]
    return np.stack([parts[(k - first) % 4] for k in range(4)], axis=1)


def straight():
    """Return the lengths of the four strands between circles."""
    out = []
    for k in range(4):
        (a, ra, sa, _), (b, rb, sb, _) = WHEELS[k], WHEELS[(k + 1) % 4]
        out.append(np.sqrt(np.sum(np.subtract(b, a) ** 2) - (sa * ra - sb * rb) ** 2))
    return np.array(out)


@verifies("add_belt", r"$R_k\omega_k = v$, $\dot v = (M/R_0)/\sum_k I_k/R_k^2$", "closed form")
@verifies("add_belt", r"tensions beside wheel $k$ differ by $I_k\dot v/R_k^2$", "closed form")
@pytest.mark.parametrize("torque", [1.0, -1.0])
@pytest.mark.parametrize("how", [{}, {"rtol": 1e-10}, {"step": 5e-3}])
def test_a_serpentine_belt_of_fixed_length(torque, how):
    s = carom.simulate(serpentine(torque), 0.5, **how)
    a = torque / RADII[0] / np.sum(INERTIA / RADII**2)
    for k in range(4):
        agree(s[f"hinge{k}"].rate, SIDES[k] * a * s.t / RADII[k], atol=1e-8)
    T = tensions(s)[1:]
    # the part before wheel k is k - 1; a tension behind it turns it on
    for k in (1, 2, 3):
        agree(T[:, k] - T[:, k - 1], INERTIA[k] / RADII[k] ** 2 * a, atol=1e-8)
    agree(T.min(axis=1), 0.0, atol=1e-9)  # nothing tightens it
    assert s.warnings == ()


@verifies("add_belt(stiffness=)", r"$\sum_k T_k l_k = T_0\sum_k l_k$", "closed form")
@verifies("add_belt(tension=)", "at the start in all parts", "closed form")
@pytest.mark.parametrize("first", [0, 1, 2])
def test_a_serpentine_belt_that_stretches(first):
    """Damped, it moves as one of fixed length; what one part gets longer the others get shorter."""
    scene = serpentine(1.0, first, tension=100.0, stiffness=2e4, damping=60.0)
    s = carom.simulate(scene, 0.5, rtol=1e-9)
    a = 1.0 / RADII[0] / np.sum(INERTIA / RADII**2)
    T = tensions(s, first)
    agree(T[0], 100.0, rtol=1e-10)
    for k in (1, 2, 3):
        agree(T[-1, k] - T[-1, k - 1], INERTIA[k] / RADII[k] ** 2 * a, rtol=1e-6)
    agree(T[-1] @ straight(), 100.0 * straight().sum(), rtol=1e-6)
    speeds = [SIDES[k] * s[f"hinge{k}"].rate[-1] * RADII[k] for k in range(4)]
    agree(speeds, np.mean(speeds), rtol=1e-6)
    assert abs(s.ledger.residual).max() < 1e-7


def tensioned(torque=0.0, idler=None, on=GROUND, **arm):
    """Two wheels, and a roller on an arm with a spring that presses on the back of the belt."""
    scene = carom.Scene(gravity=(0, 0, 0))
    if on != GROUND:  # the second wheel is on a carriage with a spring
        scene.add_body(
            carom.Box(0.1, 0.1, 0.02), mass=1.0, position=(0.6, -0.2, 0), name="carriage"
        )
        scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, "carriage", name="rail")
        scene.add_force(forces.JointSpring("rail", stiffness=3e3, rest=0.03))
    for name, x, r in (("a", 0.0, 0.1), ("b", 0.6, 0.06)):
        scene.add_body(
            carom.Cylinder(r, 0.02), mass=1.0, inertia=(0.01,) * 3, position=(x, 0, 0), name=name
        )
        carrier = on if name == "b" else GROUND
        scene.add_joint(joints.Revolute((x, 0, 0), (0, 0, 1)), carrier, name, name=f"hinge {name}")
    scene.add_body(
        carom.Box(0.3, 0.02, 0.02), mass=0.5, inertia=(0.004,) * 3, position=(0.45, 0.1, 0), name="arm"
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0.6, 0.1, 0), (0, 0, 1)), GROUND, "arm", name="pivot")
    scene.add_force(forces.JointSpring("pivot", **arm), name="spring")
    scene.add_body(
        carom.Cylinder(0.03, 0.02), mass=0.2, inertia=(2e-4,) * 3, position=(0.3, 0.1, 0), name="roller"
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0.3, 0.1, 0), (0, 0, 1)), "arm", "roller", name="pin")
    scene.add_force(forces.JointForce("hinge a", torque), name="motor")
    roller = carom.Pulley("roller", 0.03, (0, 0, -1), idler)
    over = carom.Pulley("a", 0.1, (0, 0, 1)), carom.Pulley("b", 0.06, (0, 0, 1)), roller
    scene.add_belt(over, name="belt")
    return scene


def strands(s):
    """Return lengths (T, 3) and directions (T, 3, 3) of the strands a-b, b-roller, roller-a."""
    ends = [("a", "b", 0.1 - 0.06), ("b", "roller", 0.06 + 0.03), ("roller", "a", -0.03 - 0.1)]
    lengths, along = [], []
    for one, two, rho in ends:
        d = s[two].position - s[one].position
        square = np.sum(d * d, axis=1, keepdims=True)
        length = np.sqrt(square - rho * rho)
        lengths.append(length[:, 0])
        along.append((length * d + rho * np.cross((0, 0, 1), d)) / square)
    return np.stack(lengths, axis=1), np.stack(along, axis=1)


@verifies(
    "add_belt", r"a tensioner: $T\,r\times(e_2 - e_1)$ is the torque of its spring", "closed form"
)
@pytest.mark.parametrize("idler", [None, 0.0])
def test_a_tensioner_gives_the_tension(idler):
    """In balance nothing moves, whatever the wheels are turned by; the spring says the tension."""
    s = carom.simulate(tensioned(idler=idler, stiffness=20.0, rest=0.5), 0.2)
    # the arm leans on a belt of fixed length
    assert abs(s.velocity).max() < 1e-9
    _, e = strands(s)
    pull = np.cross((-0.3, 0, 0), e[-1, 2] - e[-1, 1])[2]
    for k in range(2 if idler == 0.0 else 3):
        agree(s[f"belt.{k + 1}"].tension[-1], abs(20.0 * 0.5 / pull), rtol=1e-8)


@pytest.mark.parametrize("how", [{"rtol": 1e-9}, {"step": 1e-3}])
def test_a_tensioner_moves_and_the_belt_keeps_its_length(how):
    """Its length with all arcs is kept while a torque comes and goes; the wheels turn by what the belt runs."""
    scene = tensioned(stiffness=20.0, rest=0.5, damping=0.05, on="carriage")
    motor = forces.JointForce("hinge a", lambda t, q, rate: 0.6 * np.sin(9.0 * t))
    scene.replace("motor", definition=motor)
    s = carom.simulate(scene, 1.0, **how)
    assert np.ptp(s["pivot"].coordinate) > 1e-3
    lengths, e = strands(s)
    angles = np.unwrap(np.arctan2(e[..., 1], e[..., 0]), axis=0)
    rho = np.array([0.04, 0.09, -0.13])
    whole = lengths.sum(axis=1) + angles @ rho
    taut = np.all(np.stack([s[f"belt.{k}"].tension for k in (1, 2, 3)]) > 0.0, axis=0)
    assert taut[1:].all()
    np.testing.assert_allclose(whole, whole[0], atol=1e-8)
    # each part: what both wheels bring is what its strand gets longer
    turns = [s["hinge a"].coordinate, s["hinge b"].coordinate]
    turns.append(s["pivot"].coordinate + s["pin"].coordinate)
    sides = np.array([0.1, 0.06, -0.03])
    for k in range(3):
        own = lengths[:, k] + angles[:, k] * rho[k]
        brought = sides[k] * turns[k] - sides[(k + 1) % 3] * turns[(k + 1) % 3]
        np.testing.assert_allclose(own - own[0], brought, atol=1e-8)
    assert abs(s.ledger.residual).max() < 1e-6


@verifies(
    "add_belt(slack=)", r"plastic jerks: $v\sum_k I_k/R_k^2 = I_0\omega_0/R_0$", "closed form"
)
def test_a_slack_chain_gets_taut_by_jerks():
    """All energy is kept with e = 1; with e = 0 the wheels end at one speed."""
    for e in (0.0, 1.0):
        scene = serpentine(0.0, slack=0.02, restitution=e)
        scene.replace("wheel0", angular_velocity=(0, 0, 3.0))
        s = carom.simulate(scene, 1.5)
        assert len(s.impacts) > 2
        assert abs(s.ledger.residual).max() < 1e-9
        if e == 1.0:
            agree(s.kinetic_energy, s.kinetic_energy[0], rtol=1e-10)
        else:
            v = INERTIA[0] * 3.0 / RADII[0] / np.sum(INERTIA / RADII**2)
            speeds = [SIDES[k] * s[f"hinge{k}"].rate[-1] * RADII[k] for k in range(4)]
            agree(speeds, v, rtol=1e-9)


@verifies("add_belt(damping=)", "two wheels: the motion with `joints.Belt(damping=)`", "invariant")
def test_two_wheels_are_those_of_a_belt():
    def drive(new):
        scene = carom.Scene(gravity=(0, 0, 0))
        for name, x, r in (("a", 0.0, 0.1), ("b", 0.4, 0.05)):
            scene.add_body(carom.Cylinder(r, 0.02), mass=1.0, position=(x, 0, 0), name=name)
            scene.add_joint(
                joints.Revolute((x, 0, 0), (0, 0, 1)), GROUND, name, name=f"hinge {name}"
            )
        scene.add_force(forces.JointForce("hinge a", lambda t, q, rate: np.cos(5 * t)))
        k = 5e3
        if new:
            pulleys = [carom.Pulley(name, r, (0, 0, 1)) for name, r in (("a", 0.1), ("b", 0.05))]
            strand, lean = np.sqrt(0.4**2 - 0.05**2), np.arcsin(0.05 / 0.4)
            arcs = 0.1 * (np.pi + 2 * lean) + 0.05 * (np.pi - 2 * lean)
            whole = k * strand / (2 * strand + arcs)
            scene.add_belt(
                pulleys, tension=40.0, stiffness=whole, damping=whole / k * 2.0, name="belt"
            )
        else:
            scene.add_joint(
                joints.Belt(0.1, 0.05, tension=40.0, stiffness=k, damping=2.0),
                "a",
                "b",
                name="belt",
            )
        return carom.simulate(scene, 1.0, rtol=1e-10)

    new, old = drive(True), drive(False)
    at = np.linspace(0, 1, 21)
    agree(new.evaluate(at)[3], old.evaluate(at)[3], atol=1e-8)
    for one in (new, old):
        assert one["belt.1"].tension[0] == pytest.approx(40.0, abs=1e-9)


@pytest.mark.bits
def test_files_and_changes(tmp_path):
    scene = serpentine(1.0, tension=20.0, stiffness=1e4, damping=5.0)
    whole = goes_on(scene, 0.3, tmp_path / "run.h5", step=5e-3)
    again = carom.Solution.load(tmp_path / "run.h5").scene
    np.testing.assert_array_equal(carom.simulate(again, 0.3, step=5e-3).position, whole.position)
    moved = tensioned(stiffness=20.0, rest=0.5)
    whole = goes_on(moved, 0.2, tmp_path / "moved.h5", step=5e-3)
    again = carom.Solution.load(tmp_path / "moved.h5").scene
    np.testing.assert_array_equal(carom.simulate(again, 0.2, step=5e-3).position, whole.position)


@pytest.mark.parametrize(
    ("over", "more", "message"),
    [
        (1, {}, "over must have two wheels or more"),
        ("posts", {}, "over must have two wheels or more"),
        (4, {"tension": 10.0}, "tension must be left out of a belt of fixed length"),
        (4, {"tension": 1e9, "stiffness": 10.0}, "tension must be below"),
        (4, {"tension": -1.0, "stiffness": 10.0}, "tension must be"),
        (4, {"slack": 0.1, "stiffness": 10.0}, "slack must be left out"),
        (4, {"slack": -0.1}, "slack must be"),
        (4, {"damping": 1.0}, "damping must be left out"),
        ("body", {}, r"over\[0\] must be a Pulley"),
    ],
)
def test_wrong_input(over, more, message):
    scene = serpentine()
    pulleys = [
        carom.Pulley(f"wheel{k}", r, (0, 0, side)) for k, (_, r, side, _) in enumerate(WHEELS)
    ]
    if over == "posts":
        posts = [carom.Pulley(GROUND, 0.1, (0, 0, 1), center=(x, 0, 0)) for x in (0.0, 1.0)]
        given = [*posts, pulleys[0]]
    else:
        given = ["wheel0", "wheel1"] if over == "body" else pulleys[:over]
    with pytest.raises((ValueError, TypeError), match=message):
        scene.add_belt(given, name="other", **more)
