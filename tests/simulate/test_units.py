"""The same motion in any units: no tolerance, tie or threshold knows what a metre, a kilogram or a second is.

By powers of two all is the same to the last bit, but where a threshold has a unit or a root is of an odd power;
in g-mm-ms and t-km-h the numbers round otherwise, and events amplify that.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import GROUND, Scene, constraints, forces, joints

Y, Z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Units:
    """How many of its units a metre, a kilogram and a second are."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def of(self, value, length=0, mass=0, time=0):
        """Return a value in SI units in these."""
        return np.multiply(value, self.length**length * self.mass**mass * self.time**time)

    def metres(self, value):
        return self.of(value, 1)

    def inertia(self, value):
        return self.of(value, 2, 1)

    def scene(self, *gravity):
        return Scene(gravity=self.of(gravity, 1, 0, -2))


SI = Units()
ROUND = {
    "powers": Units(2.0**10, 2.0**10, 2.0**10),
    "mass": Units(mass=2.0**-40),
    "length": Units(2.0**20),
}
OTHER = {**ROUND, "g-mm-ms": Units(1e3, 1e3, 1e3), "t-km-h": Units(1e-3, 1e-3, 1.0 / 3600.0)}


def die(u):
    """A thrown die, until its bounces hang on last digits."""
    scene = u.scene(0, 0, -9.81)
    body = scene.add_body(
        carom.Box(*u.metres([0.1] * 3)), mass=u.of(0.3, 0, 1), position=u.metres([0, 0, 0.3]),
        velocity=u.of([0.5, 0.1, 0], 1, 0, -1), angular_velocity=u.of([3, 2, 1], 0, 0, -1),
    )  # fmt: skip
    floor = scene.add_half_space((0, 0, 0), Z)
    scene.add_contact(body, floor, friction=0.4, restitution=0.3)
    return scene, 0.5, 5e-3


def stack(u):
    """A box that falls on another, off its middle, and stays: what bounces there hangs on last digits."""
    scene = u.scene(0, 0, -9.81)
    floor = scene.add_half_space((0, 0, 0), Z)
    low = scene.add_body(
        carom.Box(*u.metres([0.1] * 3)), mass=u.of(0.3, 0, 1), position=u.metres([0, 0, 0.06])
    )
    high = scene.add_body(
        carom.Box(*u.metres([0.08, 0.08, 0.06])), mass=u.of(0.1, 0, 1), position=u.metres([0.01, 0.005, 0.15])
    )  # fmt: skip
    for pair in ((low, floor), (low, high)):
        scene.add_contact(*pair, friction=0.4, restitution=0.0)
    return scene, 0.5, 5e-3


def striking_pendulum(u):
    """A rod, and a ball on it that strikes the floor."""
    scene = u.scene(0, 0, -9.81)
    J = 0.5**2 / 12
    rod = scene.add_body(
        mass=u.of(1, 0, 1), inertia=u.inertia([1e-3, J, J]), position=u.metres([0.25, 0, 0])
    )
    ball = scene.add_body(
        carom.Sphere(float(u.metres(0.05))), mass=u.of(0.5, 0, 1), position=u.metres([0.7, 0, 0])
    )
    scene.add_joint(joints.Revolute((0, 0, 0), Y), GROUND, rod)
    scene.add_joint(joints.Revolute(u.metres([0.5, 0, 0]), Y), rod, ball)
    floor = scene.add_half_space(u.metres([0, 0, -0.6]), Z)
    scene.add_contact(ball, floor, friction=0.3, restitution=0.6)
    return scene, 0.6, 5e-3


def bricard(u):
    """Six hinges, one of whose rows follows from the others."""
    corners = [(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)]
    corners, scene, rods = np.array(corners, float), u.scene(0, -9.81, 0), []
    for a, b in pairwise(corners):
        along = np.abs(b - a)
        inertia = u.inertia(np.diag(along / 600 + (1 - along) * 1.01 / 12))
        rods.append(
            scene.add_body(mass=u.of(1, 0, 1), inertia=inertia, position=u.metres((a + b) / 2))
        )
    ring = [GROUND, *rods, GROUND]
    edges = [corners[k] - corners[k - 1] for k in range(6)]
    for k in range(6):
        ends = (ring[k], ring[k + 1]) if ring[k + 1] is not GROUND else (GROUND, ring[k])
        axis = np.cross(edges[k], edges[(k + 1) % 6])
        scene.add_joint(joints.Revolute(u.metres(corners[k]), axis), *ends)
    return scene, 1.0, 1e-2


def four_bar(u, coupler=1.0):
    """A crank, a coupler and a rocker; gravity aslant."""
    scene = u.scene(3, -9.81, 0)
    at = np.array([[0, 0, 0], [0, 0.5, 0], [1.25, 0.85, 0], [1.2, -0.15, 0]], float)
    bars = []
    for (p, q), mass in zip(pairwise(at), (1.0, coupler, 1.0)):
        e = (q - p) / np.linalg.norm(q - p)
        inertia = mass * (q - p) @ (q - p) / 12 * (np.eye(3) * 1.01 - np.outer(e, e))
        bars.append(
            scene.add_body(
                mass=u.of(mass, 0, 1), inertia=u.inertia(inertia), position=u.metres((p + q) / 2)
            )
        )
    for p, *ends in zip(
        at, (GROUND, bars[0], bars[1], GROUND), (bars[0], bars[1], bars[2], bars[2])
    ):
        scene.add_joint(joints.Revolute(u.metres(p), Z), *ends)
    return scene, 1.0, 1e-2


def light_coupler(u):
    return four_bar(u, 1e-12)


def loaded(u):
    """Spring, torque and friction in a joint."""
    scene, *times = four_bar(u)
    spring = forces.Spring(
        u.of(30, 0, 1, -2), u.metres([0, 1.5, 0]), u.metres([1.25, 0.85, 0]),
        rest_length=u.metres(0.4), damping=u.of(0.5, 0, 1, -1),
    )  # fmt: skip
    scene.add_force(spring, GROUND, scene.bodies[2])
    scene.add_force(forces.Torque(u.of([0, 0, 2], 2, 1, -2)), scene.bodies[0])
    scene.add_force(forces.JointFriction(scene.joints[0], u.of(0.5, 2, 1, -2)))
    scene.add_force(forces.JointInertia(scene.joints[1], u.of(0.2, 2, 1, 0)))
    return scene, *times


def driven(u):
    """A crank that is driven to and fro."""
    scene, *times = four_bar(u)

    def motion(t):
        s = t / u.time
        rates = (0.3 * np.sin(2 * s) ** 2, 0.6 * np.sin(4 * s), 2.4 * np.cos(4 * s))
        return tuple(rate / u.time**k for k, rate in enumerate(rates))

    scene.add_constraint(constraints.Driver(scene.joints[0], motion=motion))
    return scene, *times


def stopped(u):
    """A block on a slide falls on its stop; a flap on it has two stops: they strike together, too."""
    scene = u.scene(0, 0, -9.81)
    block = scene.add_body(
        mass=u.of(1, 0, 1), inertia=u.inertia([1, 1, 1]), position=u.metres([0, 0, 1])
    )
    flap = scene.add_body(
        mass=u.of(0.5, 0, 1), inertia=u.inertia([0.01, 0.02, 0.02]), position=u.metres([0.3, 0, 1])
    )
    slide = scene.add_joint(joints.Prismatic(Z), GROUND, block)
    hinge = scene.add_joint(joints.Revolute(u.metres([0, 0, 1]), Y), block, flap)
    scene.add_stop(slide, lower=-u.metres(1.0), restitution=0.5)
    scene.add_stop(hinge, lower=-0.4, restitution=0.4)
    scene.add_stop(hinge, upper=0.7, restitution=0.4)
    return scene, 1.1, 1e-2


SCENES = (die, stack, striking_pendulum, bricard, four_bar, light_coupler, loaded, driven, stopped)


def run(make, u):
    """Return the motion in SI units, and what happened."""
    scene, duration, step = make(u)
    s = carom.simulate(scene, duration * u.time, step=step * u.time)
    numbers = (
        s.position / u.length, s.orientation, s.velocity * u.time / u.length,
        s.angular_velocity * u.time, s.ledger.residual / u.of(1.0, 2, 1, -2),
    )  # fmt: skip
    return numbers, [(kind, int(c)) for kind, c in zip(s.events.kind, s.events.contact)]


@pytest.mark.few(4)
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_same_motion_in_other_units(make):
    known, happened = run(make, SI)
    assert np.ptp(known[0], axis=0).max() > 0.01  # it does move
    for name, u in OTHER.items():
        found, events = run(make, u)
        assert events == happened, name
        for k, (a, b) in enumerate(zip(found, known)):
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-9, err_msg=f"{name} {k}")


@pytest.mark.parametrize(
    "make",
    # (the contact problem, and so dry friction in joints, is scaled by roots of 3/trace W)
    [bricard, four_bar, light_coupler, striking_pendulum],
    ids=lambda make: make.__name__,
)
def test_bit_by_bit_in_powers_of_two(make):
    known = run(make, SI)[0]
    for name in ("powers", "mass"):
        for a, b in zip(run(make, ROUND[name])[0], known):
            np.testing.assert_array_equal(a, b, err_msg=name)
