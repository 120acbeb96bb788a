"""Steps that are taken whole by bodies with joints, stops, springs and loads."""

import numpy as np
import pytest

import carom

pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

G = 9.81
#: each step with more than one impact or event is taken whole
SOON = carom.Options(max_impacts_per_step=1)


def chain(e, mu, count=3):
    """Return a scene of boxes in a row, joined by ball joints, that fall on a floor as they turn."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    turn, bodies = np.array([0.4, 3.0, 0.3]), []
    for k in range(count):
        place = np.array([0.16 * k, 0.0, 0.3])
        body = scene.add_body(
            carom.Box(0.12, 0.06, 0.04), mass=0.5, position=place, angular_velocity=turn,
            velocity=np.cross(turn, place - (0, 0, 0.3)),
        )  # fmt: skip
        if bodies:
            joint = carom.joints.Spherical(anchor=(0.16 * k - 0.08, 0, 0.3))
            scene.add_joint(joint, bodies[-1], body)
        bodies.append(body)
    # an impact that is located may give energy by Newton's law with friction; by Stronge's it never does
    scene.set_contact_default(restitution=e, friction=mu, impact_law="stronge")
    return scene


@pytest.mark.parametrize(("e", "mu"), [(0.0, 0.5), (0.5, 0.3), (1.0, 0.0), (1.0, 0.6)])
def test_joined_bodies_give_no_energy(e, mu):
    """T + V = E_0 + what impacts, friction and contact take: none of them rises; joints hold to round-off."""
    s = carom.simulate(chain(e, mu), 0.6, step=0.01, options=SOON)
    assert s.stats["whole_steps"] > 0
    exchanged = np.ptp(s.potential_energy)
    assert np.max(np.diff(s.total_energy)) <= 1e-6 * exchanged
    for line in (s.ledger.impacts, s.ledger.friction, s.ledger.bounces):
        assert np.max(np.diff(line)) <= 1e-6 * exchanged
    assert np.max(np.abs(s.constraint_errors[0])) <= 1e-12


def test_a_joined_pair_comes_to_rest():
    """Two plastic boxes on a joint lie still in the end, to the last digit, on the floor."""
    s = carom.simulate(chain(0.0, 0.8, 2), 2.0, step=2e-3, options=SOON)
    assert not s.velocity[-1].any()
    assert not s.angular_velocity[-1].any()
    np.testing.assert_allclose(s.position[-1, :, 2], 0.02, atol=1e-3)


def test_momentum_of_a_pair_that_is_struck():
    """A ball strikes one of two joined boxes in space, in a step that is taken whole: momenta are kept."""
    scene = carom.Scene(gravity=(0, 0, 0))
    boxes = [
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0.12 * k, 0, 0))
        for k in range(2)
    ]
    scene.add_joint(carom.joints.Revolute((0.06, 0, 0), (0, 1, 0)), *boxes)
    ball = scene.add_body(
        carom.Sphere(0.03), mass=0.2, position=(0.01, 0.02, 0.1), velocity=(0, 0, -3.0)
    )
    for box in boxes:
        scene.add_contact(ball, box, restitution=0.5, friction=0.4)
    s = carom.simulate(scene, 0.05, step=1e-3, options=carom.Options(max_impacts_per_step=1))
    masses = np.array([1.0, 1.0, 0.2])
    momentum = np.einsum("b,tbi->ti", masses, s.velocity)
    np.testing.assert_allclose(momentum[-1], momentum[0], atol=1e-12)


def test_stops_in_a_step_that_is_taken_whole():
    """A knee that falls onto its stop with the floor struck in the same step: it does not go beyond."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    upper = scene.add_body(carom.Box(0.04, 0.04, 0.3), mass=1.0, position=(0, 0, 0.65))
    lower = scene.add_body(carom.Box(0.04, 0.04, 0.3), mass=0.6, position=(0, 0, 0.35))
    knee = scene.add_joint(carom.joints.Revolute((0, 0, 0.5), (0, 1, 0)), upper, lower)
    scene.add_stop(knee, upper=0.02, restitution=0.2)
    scene.add_stop(knee, lower=-0.5, restitution=0.2)
    scene.set_contact_default(restitution=0.2, friction=0.5)
    s = carom.simulate(scene, 1.0, step=1e-3, options=SOON)
    angle = s.joint_coordinates(knee)[0][:, 0]
    assert np.max(angle) <= 0.02 + 1e-6
    assert np.min(angle) >= -0.5 - 1e-6


@pytest.mark.parametrize("e", [0.9, 1.0])
def test_impacts_of_balls_that_touch_give_no_energy(e):
    """A triangle of fifteen balls on a rough table is struck: with e = 1 and friction, too, no energy comes."""
    R, scene = 0.0286, carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(carom.Sphere(R), mass=0.17, position=(-0.2, 0.001, R), velocity=(8.0, 0, 0))
    d = 2 * R + 1e-5
    for i in range(5):
        for j in range(i + 1):
            place = (i * d * np.sqrt(0.75), (j - i / 2) * d, R)
            scene.add_body(carom.Sphere(R), mass=0.17, position=place)
    scene.set_contact_default(restitution=e, friction=0.1)
    s = carom.simulate(scene, 0.1, step=1e-3, throw=False)
    assert np.max(np.diff(s.total_energy)) <= 1e-9 * s.kinetic_energy[0]
    assert np.max(np.diff(s.ledger.bounces)) <= 1e-9 * s.kinetic_energy[0]


@pytest.mark.parametrize("count", [3, 5])
def test_rolling_friction_of_joined_balls(count):
    """Bounds of its torques follow in sweeps only, and these know of the joints: velocities fit the impulses.

    With the masses of single bodies in the sweeps they are 4.7 m/s off.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    balls = []
    for k in range(count):
        ball = scene.add_body(
            carom.Sphere(0.05),
            mass=0.5,
            position=(0.12 * k, 0, 0.06 + 1e-3 * k),
            velocity=(0.5, 0.2, 0),
        )
        if balls:
            joint = carom.joints.Spherical(anchor=(0.12 * k - 0.06, 0, 0.06))
            scene.add_joint(joint, balls[-1], ball)
        balls.append(ball)
    scene.set_contact_default(restitution=0.0, friction=0.5, rolling_friction=1e-3)
    s = carom.simulate(scene, 0.5, step=0.01, options=SOON)
    assert s.stats["whole_steps"] > 0
    assert np.max(s.held_residual) < 1e-4
    assert np.max(np.abs(s.ledger.residual)) < 1e-4 * s.total_energy[0]


def test_a_ball_on_a_joint_goes_through_a_wall():
    """What energy is lost has its name, and joints hold.

    A swing of a ball on a spherical joint into nine bricks that lie on each other. The balance closes to 1e-3
    of what is lost, and velocities after a step fit its impulses to 1e-3 of the speed of the ball, though
    bricks are wedged when it strikes, with impulses a hundred times those of a free impact.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(3):
        for j in range(3):
            place = (0, (j + 0.5 * (i % 2) - 1) * 0.2001, (i + 0.5) * 0.1)
            scene.add_body(carom.Box(0.1, 0.2, 0.1), mass=3.0, position=place)
    ball = scene.add_body(
        carom.Sphere(0.1), mass=20.0, position=(-0.2, 0, 0.25), velocity=(3, 0, 0),
        angular_velocity=(0, -1.5, 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.Spherical(anchor=(-0.2, 0, 2.25)), carom.GROUND, ball)
    scene.set_contact_default(restitution=0.1, friction=0.6)
    s = carom.simulate(scene, 0.1, step=2e-3, throw=False)
    assert s.status is carom.Status.SUCCESS
    assert s.stats["whole_steps"] > 0
    lost = s.total_energy[0] - s.total_energy[-1]
    assert lost > 10.0
    assert np.max(np.abs(s.ledger.residual)) < 1e-3 * lost
    assert np.max(s.held_residual) < 3e-3
    assert np.max(np.abs(s.constraint_errors[0])) <= 1e-12


def test_a_motor_that_starts_late_moves_what_a_crowd_has_stopped():
    """Two boxes on a hinge fall on a floor, in a step that is taken whole, and lie; later a motor turns.

    What a crowd had stopped was at rest then, and 1 N m did nothing. Here it lifts an edge, and the loads'
    work is energy: T + V = E_0 + loads + impacts + friction + bounces, to what pieces of
    steps may gain: some 1e-6 each, 8e-5 in all at 1 ms and at half of that.
    """
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    arm, base = (
        scene.add_body(carom.Box(0.1, 0.1, 0.05), mass=0.5, position=(x, 0, 0.026))
        for x in (0, 0.11)
    )
    hinge = scene.add_joint(
        carom.joints.Revolute(anchor=(0.055, 0, 0.026), axis=(0, 1, 0)), base, arm
    )
    scene.ignore_contact(base, arm)
    scene.add_force(carom.forces.JointForce(hinge, lambda t, q, rate: 1.0 if t > 0.5 else 0.0))
    scene.set_contact_default(restitution=0.3, friction=0.5)
    s = carom.simulate(scene, 0.55, step=1e-3, options=SOON)
    assert s.stats["whole_steps"] > 0
    at = np.searchsorted(s.t, 0.49)
    assert not s.velocity[at].any()
    assert s.position[-1, 0, 2] > s.position[at, 0, 2] + 0.005
    assert np.max(np.abs(s.ledger.residual)) < 2e-4 * s.ledger.loads[-1]
