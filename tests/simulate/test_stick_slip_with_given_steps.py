"""Stick and slip with given steps: stops and break-away are located, so that a step has its order."""

import numpy as np
import pytest
from scipy.optimize import brentq

import carom
from carom import GROUND, Friction, forces, joints

G = 9.81


class Shaken:
    """A plane whose velocity is A sin(w t + p), and a block on it that slips first."""

    def __init__(self, seed, law):
        rng = np.random.default_rng([59, seed])
        self.kinetic = rng.uniform(0.15, 0.6)
        self.static = self.kinetic * (rng.uniform(1.05, 1.6) if law else 1.0)
        self.w, self.p = rng.uniform(15.0, 60.0), rng.uniform(0.0, 2.0 * np.pi)
        self.A = self.static * G / self.w * rng.uniform(1.1, 3.0)
        self.start = self.velocity(0.0) + rng.uniform(0.05, 0.3)
        self.end = 1.7 * 2.0 * np.pi / self.w
        self.law = Friction(self.static, self.kinetic) if law else self.kinetic

    def velocity(self, t):
        return self.A * np.sin(self.w * t + self.p)

    def acceleration(self, t):
        return self.A * self.w * np.cos(self.w * t + self.p)

    def moved(self, t, end):
        return self.A / self.w * (np.cos(self.w * t + self.p) - np.cos(self.w * end + self.p))

    def place(self):
        """Return the place of the block at the end: slip has a constant acceleration, from event to event."""
        t, x, v, slips = 0.0, 0.0, self.start, -1.0
        while t < self.end:
            a = slips * self.kinetic * G
            end = self.first(
                lambda s, t=t, v=v, a=a: np.sign(a) * (self.velocity(s) - v - a * (s - t)), t
            )
            x, v, t = x + v * (end - t) + 0.5 * a * (end - t) ** 2, v + a * (end - t), end
            end = self.first(lambda s: self.static * G - abs(self.acceleration(s)), t)
            x, v, t = x + self.moved(t, end), v if end == t else self.velocity(end), end
            slips = np.sign(self.acceleration(t))
        return x

    def first(self, function, t):
        """Return the first root of a function that is positive at first, t if it is not, or the end."""
        if function(t) < -1e-9:
            return t
        times = np.append(np.arange(t + 1e-6, self.end, 1e-4), self.end)
        below = np.flatnonzero(function(times) <= 0.0)
        if not below.size:
            return self.end
        return brentq(function, times[below[0] - 1] if below[0] else t, times[below[0]], xtol=1e-15)


def on_the_plane(given):
    scene = carom.Scene(gravity=(0, 0, -G))
    block = scene.add_body(
        carom.Box(0.3, 0.2, 0.02), mass=2.0, position=(0, 0, 0.01), velocity=(given.start, 0, 0)
    )
    plane = scene.add_half_space(
        (0, 0, 0), (0, 0, 1),
        surface_velocity=lambda t: ((given.velocity(t), 0, 0), (given.acceleration(t), 0, 0)),
    )  # fmt: skip
    scene.add_contact(block, plane, restitution=0.0, friction=given.law)
    return scene


def on_a_plank(given):
    """The same on a driven body."""
    scene = carom.Scene(gravity=(0, 0, -G))
    block = scene.add_body(
        carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01), velocity=(given.start, 0, 0)
    )
    plank = scene.add_body(
        carom.Box(4, 1, 0.1), mass=5.0, position=(0, 0, -0.05), velocity=(given.velocity(0.0), 0, 0)
    )
    rail = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, plank)
    scene.add_constraint(
        carom.constraints.Driver(
            rail, motion=lambda t: (given.moved(0.0, t), given.velocity(t), given.acceleration(t))
        )
    )
    scene.add_contact(block, plank, restitution=0.0, friction=given.law)
    return scene


def in_a_joint(given, turns):
    """The same as the plane sees it: a force shakes the block, or a torque a wheel."""
    scene = carom.Scene(gravity=(0, 0, 0))
    start = (given.start - given.velocity(0.0),)
    moves = {"angular_velocity": (0, 0, *start)} if turns else {"velocity": (*start, 0, 0)}
    body = scene.add_body(mass=2.0, inertia=(2.0, 2.0, 2.0), **moves)
    joint = joints.Revolute((0, 0, 0), (0, 0, 1)) if turns else joints.Prismatic((1, 0, 0))
    joint = scene.add_joint(joint, GROUND, body, name="joint")
    scene.add_force(forces.JointForce(joint, lambda t, q, rate: -2.0 * given.acceleration(t)))
    bound = 2.0 * G * given.kinetic
    if isinstance(given.law, Friction):
        bound = Friction(2.0 * G * given.static, bound)
    scene.add_force(forces.JointFriction(joint, bound))
    return scene


@pytest.mark.parametrize("law", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_a_block_on_a_shaken_plane(seed, law):
    # slip is exact, so that the error is that of stick and of the instants; without them it was 1e-6
    given = Shaken(seed, law)
    exact = given.place()
    for steps in (100, 400):
        found = carom.simulate(on_the_plane(given), given.end, step=given.end / steps)
        assert found.position[-1, 0, 0] == pytest.approx(exact, abs=5e-8 * (100 / steps) ** 2)


def test_a_block_on_a_driven_body():
    given = Shaken(1, False)
    found = carom.simulate(on_a_plank(given), given.end, step=given.end / 100)
    assert found.position[-1, 0, 0] == pytest.approx(given.place(), abs=5e-8)


@pytest.mark.parametrize("law", [False, True])
@pytest.mark.parametrize("turns", [False, True])
def test_friction_of_a_joint_has_order_four(turns, law):
    errors = []
    for steps in (100, 400):
        worst = 0.0
        for seed in range(4):
            given = Shaken(seed, law)
            exact = given.place() - given.moved(0.0, given.end)
            found = carom.simulate(in_a_joint(given, turns), given.end, step=given.end / steps)
            worst = max(worst, abs(found.joint_coordinates("joint")[0][-1, 0] - exact))
        errors.append(worst)
    assert errors[0] < 1e-6
    assert errors[1] < errors[0] / 4.0**3.5


@pytest.mark.parametrize("law", [0.5, Friction(0.8, 0.5), Friction.table([0, 1], [0.8, 0.8])])
def test_a_joint_slips_by_its_law_from_the_start_and_after_a_blow(law):
    # at a constant deceleration a to a stop at s, there e = .5, and back: v1 = sqrt(v^2 - 2 a s)
    bound = float(law(1.0)) if isinstance(law, carom.scene.friction.FrictionLaw) else law
    m, v, s, a = 0.5, 3.0, 1.0, bound / 0.5
    scene = carom.Scene(gravity=(0, 0, 0))
    body = scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=m, velocity=(v, 0, 0))
    joint = scene.add_joint(joints.PointOnLine((0, 0, 0), (1, 0, 0)), GROUND, body)
    scene.add_stop(joint, upper=s, restitution=0.5)
    scene.add_force(forces.JointFriction(joint, law))
    v1 = np.sqrt(v * v - 2 * a * s)
    left = 0.8 - (v - v1) / a
    exact = s - 0.5 * v1 * left + 0.5 * a * left**2
    for how in ({"step": 0.05}, {"rtol": 1e-6}):
        found = carom.simulate(scene, 0.8, **how)
        assert found.position[-1, 0, 0] == pytest.approx(exact, abs=1e-11)
