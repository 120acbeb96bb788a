"""What a run computes does not depend on the times that are saved, on its parts, or on bodies far away.

Scales follow the accelerations of the contacts themselves, by applied forces too: closed forms of balls and
boxes that a force presses or drives against a wall, without gravity.
"""

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints

BALL, BOX = carom.Sphere(0.05), carom.Box(0.1, 0.1, 0.1)


def driven_ball(gravity, force, restitution=0.4, height=0.15):
    """Return a ball of 1 kg above a wall, moving along it, which gravity and a force drive to the wall."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    wall = scene.add_half_space((0, 0, 0), (0, 0, 1))
    start = (0, 0, height)
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=start, velocity=(0.2, 0, 0))
    scene.add_contact(ball, wall, restitution=restitution, friction=0.0)
    if force:
        scene.add_force(forces.Force((0, 0, -force), start), GROUND, ball)
    return scene


def lost(solution):
    """Return the energy that impacts have lost [J]."""
    return -float(np.sum(solution.impacts.energy_change))


@pytest.mark.few(3)
@pytest.mark.parametrize("duration", [1.0, 40.0])
@pytest.mark.parametrize("settings", [{}, {"rtol": 1e-10}, {"save_at": [0.7, 1.0]}])
def test_bounces_by_a_force_are_those_by_gravity(duration, settings):
    """A force of 10 N on 1 kg does what a gravity of 10 m/s^2 does, whatever is saved."""
    ends = []
    for gravity, force in ((10.0, 0.0), (0.0, 10.0), (2.0, 8.0)):
        s = carom.simulate(driven_ball(gravity, force), duration, **settings)
        assert s.success
        ends.append((s.position[-1, 0], lost(s), len(s.impacts)))
    for position, loss, impacts in ends[1:]:
        np.testing.assert_allclose(position, ends[0][0], atol=1e-8)
        np.testing.assert_allclose(loss, ends[0][1], atol=1e-6)
        assert impacts == ends[0][2]


def test_bounces_of_a_strong_force_are_dropped_by_their_height():
    """A thousand times the weight: the first bounce rises to e^2 h, and all above the tolerance are made.

    The exit speed of bounce k is e^k v, its height e^2k h. It is dropped where this is below (1 - e)^2 of the
    tolerance, 2e-9 m at rtol = 1e-8: h = 0.05 m and e = 0.4 make 10 impacts, whatever the acceleration.
    """
    counts = set()
    for gravity, force in ((10.0, 0.0), (10.0, 1e4), (0.0, 1e5)):
        s = carom.simulate(driven_ball(gravity, force), 0.5)
        speed = np.sqrt(2.0 * (gravity + force) * 0.05)
        np.testing.assert_allclose(s.impacts.relative_velocity_before[0, 0], -speed, rtol=1e-8)
        counts.add(len(s.impacts))
    assert counts == {10}


def pushed_down(force, gravity, shape, static):
    """Return a body at rest on a half-space or a static box, with a force towards it."""
    scene = carom.Scene(gravity=(0, 0, gravity))
    if static:
        floor = scene.add_static(carom.Box(1, 1, 0.1), position=(0, 0, -0.05))
    else:
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(shape, mass=1, position=(0, 0, 0.05))
    scene.add_contact(body, floor, restitution=0, friction=0.5)
    scene.add_force(forces.Force((0, 0, -force)), body)
    return scene


@pytest.mark.few(4)
@pytest.mark.parametrize("static", [False, True])
@pytest.mark.parametrize("shape", [BALL, BOX])
@pytest.mark.parametrize(("force", "gravity"), [(10.0, 0.0), (1e5, 0.0), (1e3, -9.81)])
def test_a_pressed_body_stays_at_rest(force, gravity, shape, static):
    """The contact balances the force: nothing moves, no energy is exchanged, and nothing is remarked."""
    s = carom.simulate(pushed_down(force, gravity, shape, static), 1.0)
    assert s.success
    assert not s.warnings
    assert np.abs(s.position - s.position[0]).max() < 1e-12


def vice(force, gravity=0.0, gap=0.0):
    """Return a block between a fixed plate and a plate on a slider, which a force pushes."""
    scene = carom.Scene(gravity=(0, 0, gravity))
    block = scene.add_body(BOX, mass=1)
    fixed = scene.add_static(carom.Box(0.02, 0.2, 0.2), position=(-0.06, 0, 0))
    jaw = scene.add_body(carom.Box(0.02, 0.2, 0.2), mass=0.5, position=(0.06 + gap, 0, 0))
    slider = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, jaw)
    scene.add_force(forces.JointForce(slider, -force))
    for other in (fixed, jaw):
        scene.add_contact(block, other, restitution=0, friction=0.5)
    return scene


@pytest.mark.parametrize(
    ("force", "gravity", "gap"), [(20.0, 0.0, 0.0), (1e4, 0.0, 0.0), (1e3, 0.0, 1e-4)]
)
def test_a_vice_holds_whatever_its_force(force, gravity, gap):
    """Bodies do not pass through each other: the jaw moves by the gap, and stays there."""
    s = carom.simulate(vice(force, gravity, gap), 1.0, throw=False)
    assert s.success
    np.testing.assert_allclose(
        np.abs(s.position[-1] - s.position[0]).max(), gap, atol=1e-7, rtol=0.0
    )


def two_cylinders(seed, far=False):
    """Return two cylinders that meet in free space, and a body far away that a force shakes."""
    rng = np.random.default_rng(seed)
    scene = carom.Scene(gravity=(0, 0, 0))
    for k, x in enumerate((-0.25, 0.25)):
        scene.add_body(
            carom.Cylinder(0.06, 0.2), mass=1 + k,
            position=(x, 0.01 * rng.normal(), 0.02 * rng.normal()),
            orientation=carom.euler("xyz", list(rng.uniform(0, 180, 3))),
            velocity=(-0.5 * np.sign(x), 0, 0), angular_velocity=tuple(rng.normal(size=3)),
        )  # fmt: skip
    if far:
        body = scene.add_body(carom.Sphere(0.1), mass=0.5, position=(50, 0, 0))
        scene.add_force(forces.Force((0, 0, 300.0)), body)
    scene.set_contact_default(restitution=0.1, friction=0.3)
    return scene


# ten tolerances, 1e-8 of the path and the size together (0.5 m), of each of two runs; 119 that differ by
# round-off are 2e-8 m apart at most: a contact that slides over a rim opens with its whole force
ALIKE = 1e-7


@pytest.mark.parametrize("seed", [0, 1, 2, 5, 6, 8, 10])
def test_the_end_does_not_depend_on_the_times_saved(seed):
    """Before, the scale of time without gravity was the longest step: up to 2e-3 m, with SUCCESS."""
    ends = [
        carom.simulate(two_cylinders(seed), 0.8, save_at=np.linspace(0.8 / n, 0.8, n)).position[-1]
        for n in (400, 1, 7, 50)
    ]
    for end in ends[1:]:
        np.testing.assert_allclose(end, ends[0], atol=ALIKE, rtol=0.0)


@pytest.mark.parametrize("seed", [0, 2])
def test_the_end_does_not_depend_on_the_duration_or_on_a_body_far_away(seed):
    alone = carom.simulate(two_cylinders(seed), 0.8).position[-1]
    longer = carom.simulate(two_cylinders(seed), 2.0, save_at=[0.8, 2.0]).position[-2]
    beside = carom.simulate(two_cylinders(seed, far=True), 0.8).position[-1, :2]
    np.testing.assert_allclose(longer, alone, atol=ALIKE, rtol=0.0)
    np.testing.assert_allclose(beside, alone, atol=ALIKE, rtol=0.0)


@pytest.mark.parametrize("seed", [0, 2])
def test_the_end_does_not_depend_on_the_parts_of_a_run(seed):
    whole = carom.simulate(two_cylinders(seed), 0.8).position[-1]
    parts = carom.simulate(two_cylinders(seed), 0.3).simulate(0.5).position[-1]
    np.testing.assert_allclose(parts, whole, atol=ALIKE, rtol=0.0)
