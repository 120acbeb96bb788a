"""Bodies on several points, by the method of the run as long as modes stay: errors as asked for, orders."""

import itertools

import numpy as np
import pytest

import carom


def floor(gravity=(0.0, 0.0, -9.81)):
    scene = carom.Scene(gravity=gravity)
    return scene, scene.add_half_space((0, 0, 0), (0, 0, 1))


def slides(spin):
    """A block that slides on a floor, and turns."""
    scene, ground = floor()
    block = scene.add_body(
        carom.Box(0.2, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05), velocity=(1, 0, 0),
        angular_velocity=(0, 0, spin),
    )  # fmt: skip
    scene.add_contact(block, ground, restitution=0.0, friction=0.3)
    return scene


def incline():
    """The same on a slope of half a radian, thrown across it: the direction of slip turns all the time."""
    scene, ground = floor(9.81 * np.array([np.sin(0.5), 0.0, -np.cos(0.5)]))
    block = scene.add_body(
        carom.Box(0.2, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05), velocity=(0, 0.5, 0),
        angular_velocity=(0, 0, 4),
    )  # fmt: skip
    scene.add_contact(block, ground, restitution=0.0, friction=0.3)
    return scene


def tips():
    """A cube that tips over an edge, which sticks."""
    scene, ground = floor()
    a, w = 0.3, np.array([0.0, 1.0, 0.0])
    edge = 0.05 * np.array([np.cos(a) - np.sin(a), 0.0, -np.sin(a) - np.cos(a)])  # the lower one
    cube = scene.add_body(
        carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, -edge[2]), velocity=-np.cross(w, edge),
        angular_velocity=w, orientation=(np.cos(a / 2), 0, np.sin(a / 2), 0),
    )  # fmt: skip
    scene.add_contact(cube, ground, restitution=0.0, friction=0.8)
    return scene


def coin(rolling, pivoting):
    """A coin that rolls in a curve on its rim, against rolling and pivoting friction."""
    scene, ground = floor()
    r, h, a, w = 0.05, 0.01, 0.9, np.array([3.0, 8.0, 1.0])
    # the lowest point, with the axis of the coin along (0, -sin a, cos a)
    point = np.array([0.0, -r * np.cos(a) + h / 2 * np.sin(a), -r * np.sin(a) - h / 2 * np.cos(a)])
    body = scene.add_body(
        carom.Cylinder(r, h), mass=0.1, position=(0, 0, -point[2]), angular_velocity=w,
        velocity=-np.cross(w, point), orientation=carom.euler("x", np.degrees(a)),
    )  # fmt: skip
    scene.add_contact(
        body, ground, restitution=0.0, friction=0.8, rolling_friction=rolling,
        pivoting_friction=pivoting,
    )  # fmt: skip
    return scene


def carries_a_pendulum():
    """A box that slides on a floor, with a pendulum on a spring and a damper."""
    scene, ground = floor()
    box = scene.add_body(
        carom.Box(0.3, 0.2, 0.1), mass=2.0, position=(0, 0, 0.05), velocity=(1, 0.3, 0)
    )
    bob = scene.add_body(carom.Sphere(0.02), mass=0.2, position=(0, 0, 0.25), velocity=(1, 0.3, 0))
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0.1), (0, 1, 0)), box, bob)
    scene.add_force(carom.forces.JointSpring(hinge, stiffness=2.0, damping=0.02, rest=0.5))
    scene.add_contact(box, ground, restitution=0.0, friction=0.2)
    return scene


CASES = {  # and by how much errors grow until then: what tips is an inverted pendulum
    "slides": (lambda: slides(5.0), 0.2, 2e-4, 1.0),
    "incline": (incline, 0.5, 2e-4, 1.0),
    "tips": (tips, 0.1, 1e-4, 3.0),
    "coin": (lambda: coin(1e-4, 1e-4), 0.2, 1e-4, 1.0),
    "carries a pendulum": (carries_a_pendulum, 0.3, 2e-4, 1.0),
    "coin that does not pivot": (lambda: coin(1e-4, 0.02), 0.2, 1e-4, 5.0),
}


def known_end(make, duration, step):
    """Two runs of order 4 with given steps, extrapolated: the error is some 1e-12."""
    coarse, fine = (
        carom.simulate(make(), duration, step=h, save_every=10**9).position[-1, 0]
        for h in (step, step / 2)
    )
    return fine + (fine - coarse) / 15.0


@pytest.mark.few(3)
@pytest.mark.parametrize("case", CASES)
def test_errors_are_those_asked_for(case):
    make, duration, step, grows = CASES[case]
    known = known_end(make, duration, step)
    for rtol in (1e-6, 1e-8, 1e-10):
        s = carom.simulate(make(), duration, rtol=rtol, save_at=duration)
        asked = rtol * 2.0 * s._run.bodies["extent"][0]
        assert np.linalg.norm(s.position[-1, 0] - known) < 10.0 * grows * asked + 1e-11, rtol
        assert s.stats["whole_steps"] == 0
        z = s.position[-1, 0, 2]
        if case in ("slides", "incline", "carries a pendulum"):
            assert z == pytest.approx(0.05, abs=1e-15)  # on the floor to round-off


@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
def test_error_where_a_corner_turns_its_slip(rtol):
    # The pole of the motion of this slab passes near a corner, whose slip turns by 180 degrees in a moment.
    scene, ground = floor()
    slab = scene.add_body(
        carom.Box(0.265, 0.262, 0.07), mass=1.0, position=(0, 0, 0.035), velocity=(0.858, 0.942, 0),
        angular_velocity=(0, 0, 6.995),
    )  # fmt: skip
    scene.add_contact(slab, ground, restitution=0.0, friction=0.257)
    exact = carom.simulate(scene, 1.0, rtol=1e-12, save_at=1.0).position[-1, 0]
    s = carom.simulate(scene, 1.0, rtol=rtol, save_at=1.0)
    assert np.linalg.norm(s.position[-1, 0] - exact) < rtol * 2.0 * 0.38


def test_few_steps():
    """A hundredth of the tolerance, some 2.5 times the steps: order 5. (Order 2 would need 4.6 times.)"""
    steps = [
        carom.simulate(incline(), 0.5, rtol=rtol, save_at=0.5).stats["trial_steps"]
        for rtol in (1e-6, 1e-8)
    ]
    assert steps[1] < 3.5 * steps[0]
    assert steps[1] < 120


@pytest.mark.parametrize(
    ("make", "step"), [(lambda: coin(1e-4, 1e-4), 2e-3), (carries_a_pendulum, 2.5e-3)]
)
def test_order_of_what_rolls_and_of_what_is_joined(make, step):
    """Rolling and pivoting friction, joints and springs do not lower the order of rk4."""
    ends = [
        carom.simulate(make(), 0.2, step=h, save_every=10**9).position[-1].ravel()
        for h in (step, step / 2, step / 4)
    ]
    coarse, fine = (np.linalg.norm(a - b) for a, b in itertools.pairwise(ends))
    assert np.log2(coarse / fine) > 3.5


@pytest.mark.parametrize(
    ("method", "order", "step"), [("rk4", 4.0, 5e-3), ("rk5", 5.0, 5e-3), ("rk8", 8.0, 0.01)]
)
def test_order_is_that_of_the_method(method, order, step):
    """A block thrown across a slope: the direction of slip turns; steps that lose too little to be cut."""
    ends = [
        carom.simulate(incline(), 0.3, step=h, method=method, save_every=10**9).position[-1, 0]
        for h in (step, step / 2, 0.3 / 512)
    ]
    coarse, fine = (np.linalg.norm(x - ends[-1]) for x in ends[:2])
    assert np.log2(coarse / fine) > order - 0.7


def test_energy_is_that_of_friction():
    """The ledger names all that a turning block loses, to the tolerance."""
    s = carom.simulate(slides(30.0), 0.8)
    assert s.kinetic_energy[-1] == 0.0
    assert np.max(np.abs(s.ledger.residual)) < 1e-7 * s.kinetic_energy[0]
    assert s.ledger.friction[-1] == pytest.approx(-s.kinetic_energy[0], rel=1e-6)
