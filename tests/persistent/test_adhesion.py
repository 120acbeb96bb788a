"""Contacts that hold together with a force: pull-off, friction under it, what catches and what lets go."""

import numpy as np
import pytest

import carom
from carom import forces
from verified import agree, verifies

G, M, SIZE = 9.81, 2.0, 0.1
TOLERANCES = 1e-6, 1e-10


def hung(adhesion, shape=None, friction=0.0, restitution=0.0, gap=0.0, speed=0.0):
    """Return a body that touches the underside of a ceiling."""
    scene = carom.Scene(gravity=(0, 0, -G))
    ceiling = scene.add_half_space((0, 0, 0), (0, 0, -1), name="ceiling")
    shape = carom.Sphere(SIZE) if shape is None else shape
    body = scene.add_body(
        shape, mass=M, position=(0, 0, -SIZE - gap), velocity=(0, 0, speed), name="body"
    )
    scene.add_contact(body, ceiling, adhesion=adhesion, friction=friction, restitution=restitution)
    return scene


BOX = carom.Box(2 * SIZE, 2 * SIZE, 2 * SIZE)


@pytest.mark.parametrize("shape", [None, BOX])
def test_what_hangs_has_a_normal_force_below_zero(shape):
    run = carom.simulate(hung(1.5 * M * G, shape), 1.0)
    assert run.success
    assert run.warnings == ()
    assert np.all(run.position == run.position[0])
    np.testing.assert_allclose(run.contact_force[-1, 0], [-M * G, 0, 0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(
        run["body-ceiling"].vector[-1], [0, 0, M * G], rtol=1e-12, atol=1e-12
    )


def test_too_little_lets_it_fall():
    run = carom.simulate(hung(0.99 * M * G), 0.5)
    np.testing.assert_allclose(run.position[-1, 0, 2], -SIZE - G * 0.5**2 / 2, rtol=1e-12)


@verifies("add_contact(adhesion=)", "lets go where $m g + s t = A$", "closed form")
@pytest.mark.parametrize("rtol", TOLERANCES)
@pytest.mark.parametrize("shape", [None, BOX])
def test_a_magnet_lets_go_at_its_force(shape, rtol):
    # a pull of s t and the weight: it lets go where m g + s t = A, and falls by both
    scene, slope, A = hung(3.0 * M * G, shape), 50.0, 3.0 * M * G
    scene.add_force(forces.UserForce(["body"], lambda t, states: [[0, 0, -slope * t, 0, 0, 0]]))
    run = carom.simulate(scene, 1.5, rtol=rtol)
    free = (A - M * G) / slope
    assert run.success
    events = run.events
    opened = events.time[events.kind == "opens"]
    agree(opened[0], free, atol=10 * rtol)
    t = 1.5 - free
    fallen = A * t**2 / (2 * M) + slope * t**3 / (6 * M)
    agree(-SIZE - run.position[-1, 0, 2], fallen, atol=30 * rtol)
    agree(run.ledger.residual, 0.0, atol=1e-4 * fallen * M * G)


@verifies("add_contact(adhesion=)", r"slows by $\mu (m g + A)/m$", "closed form")
@pytest.mark.parametrize("rtol", TOLERANCES)
def test_friction_has_the_adhesion_as_its_load(rtol):
    # a block on a floor: decelerates by mu (m g + A)/m
    mu, A, v = 0.3, 15.0, 2.0
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    block = scene.add_body(BOX, mass=M, position=(0, 0, SIZE), velocity=(v, 0, 0), name="block")
    scene.add_contact(block, floor, adhesion=A, friction=mu, restitution=0.0)
    run = carom.simulate(scene, 1.0, rtol=rtol)
    slows = mu * (M * G + A) / M
    agree(run.position[-1, 0, 0], v**2 / (2 * slows), atol=10 * rtol)
    agree(run.ledger.friction[-1], -0.5 * M * v**2, rtol=1e-6)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_a_plate_on_a_magnetic_wall(share):
    # held against its weight by friction: mu A against m g
    mu = 0.5
    scene = carom.Scene(gravity=(0, 0, -G))
    wall = scene.add_half_space((0, 0, 0), (1, 0, 0), name="wall")
    plate = scene.add_body(carom.Box(0.02, 0.2, 0.2), mass=M, position=(0.01, 0, 0), name="plate")
    scene.add_contact(plate, wall, adhesion=share * M * G / mu, friction=mu, restitution=0.0)
    run = carom.simulate(scene, 0.5)
    fallen = run.position[-1, 0, 2]
    if share > 1.0:
        assert fallen == pytest.approx(0.0, abs=1e-9)
    else:
        assert fallen == pytest.approx(-(1.0 - share) * G * 0.5**2 / 2, rel=1e-3)


def test_what_comes_up_to_a_magnet_stays():
    run = carom.simulate(hung(2.0 * M * G, gap=0.05, speed=2.0), 0.5)
    assert run.success
    assert run.position[-1, 0, 2] == pytest.approx(-SIZE, abs=1e-9)
    other = carom.simulate(hung(0.0, gap=0.05, speed=2.0), 0.5)
    assert other.position[-1, 0, 2] < -0.5


def test_two_bodies_hold_together():
    # a weight hangs on a body that is pulled up: A is more than (m2 (g + a))
    scene = carom.Scene(gravity=(0, 0, -G))
    top = scene.add_body(carom.Sphere(SIZE), mass=1.0, position=(0, 0, SIZE), name="top")
    low = scene.add_body(carom.Sphere(SIZE), mass=1.0, position=(0, 0, -SIZE), name="low")
    scene.add_contact(top, low, adhesion=16.0, restitution=0.0)
    scene.add_force(forces.Force((0, 0, 30.0)), top)
    run = carom.simulate(scene, 0.5)
    a = 15.0 - G
    np.testing.assert_allclose(run.velocity[-1, :, 2], a * 0.5, rtol=1e-9)
    stronger = carom.simulate(scene.copy(), 0.1)
    assert stronger.success
    scene.replace("top-low", adhesion=14.0)
    apart = carom.simulate(scene, 0.5)
    np.testing.assert_allclose(apart.velocity[-1, :, 2], [(30.0 - G) * 0.5, -G * 0.5], rtol=1e-9)


def test_adhesion_is_saved(tmp_path):
    run = carom.simulate(hung(1.5 * M * G), 0.2)
    run.save(tmp_path / "run.nc")
    loaded = carom.Solution.load(tmp_path / "run.nc")
    again = loaded.simulate(0.2)
    assert np.all(again.position == run.position[0])
    np.testing.assert_array_equal(loaded.contact_force, run.contact_force)


@verifies("ensemble", "$z = -g t^2/2$, or 0, by the adhesion of each run", "closed form")
def test_adhesion_varies_in_ensembles():
    scene = hung(1.0)
    runs = carom.ensemble(
        scene, vary={"body-ceiling.adhesion": [0.9 * M * G, 1.1 * M * G]}, duration=0.3
    )
    agree(runs.position[:, 0, 2], [-SIZE - G * 0.3**2 / 2, -SIZE], rtol=1e-12)


def test_a_box_peels_off_a_wall():
    # at one edge: A is shared by the corners, half of it at the far edge with an arm of 2 a
    a, A = SIZE, 100.0
    for share, holds in ((0.97, True), (1.03, False)):
        scene = carom.Scene(gravity=(0, 0, 0))
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
        box = scene.add_body(BOX, mass=M, position=(0, 0, a), name="box")
        scene.add_contact(box, floor, adhesion=A, friction=1.0, restitution=0.0)
        scene.add_force(forces.Torque((0, share * A * a, 0)), box)
        run = carom.simulate(scene, 0.2)
        turned = abs(run.orientation[-1, 0, 2])
        assert (turned < 1e-9) == holds
