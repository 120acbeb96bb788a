"""A driver that moves a linkage beyond its reach: the run ends at the dead end, whose time is in closed form.

Near a dead end the remaining motion goes with the root of the remaining time, so that steps that are halved
until they succeed end within a fraction of them: 1e-4 s for steps of 1e-2 s, less by tolerances.
"""

import numpy as np
import pytest

import carom
from carom import Status, constraints, joints

Y = (0, 1, 0)


class Linkage:
    """A plane linkage of massive bars."""

    def __init__(self):
        self.scene = carom.Scene(gravity=(0, 0, 0))

    def bar(self, p, q, name):
        place = (np.array(p, dtype=float) + np.array(q)) / 2.0
        return self.scene.add_body(carom.Sphere(0.1), mass=1.0, position=place, name=name)

    def pin(self, p, parent, child, name):
        return self.scene.add_joint(joints.Revolute(p, Y), parent, child, name=name)

    def guide(self, axis, child):
        return self.scene.add_joint(joints.Prismatic(axis), carom.GROUND, child, name="guide")


def at(radius, angle):
    return radius * np.array([np.cos(angle), 0.0, np.sin(angle)])


def first_time(rate, bad):
    """The first time at which bad(angle - rate t) is above 0, to 1e-5 of a turn."""
    t = np.linspace(0.0, 2.0 * np.pi / abs(rate), 200_001)
    beyond = bad(rate * t) > 0.0
    return t[np.argmax(beyond)] if beyond.any() else None


def four_bar(rng, rate):
    """A crank that cannot turn fully: the diagonal becomes too long or too short for coupler and rocker."""
    while True:
        a, b, c, d = rng.uniform(0.5, 1.5, 4)
        angle = rng.uniform(0.0, 2.0 * np.pi)

        def beyond(turn, a=a, b=b, c=c, d=d, angle=angle):
            diagonal = np.sqrt(a * a + d * d - 2.0 * a * d * np.cos(angle - turn))
            return np.maximum(diagonal - b - c, abs(b - c) - diagonal)

        T = first_time(rate, beyond)
        if T is not None and beyond(0.0) < -0.1:
            break
    A, C = at(a, angle), np.array([d, 0.0, 0.0])
    D = np.linalg.norm(C - A)
    along = (D * D + b * b - c * c) / (2.0 * D)
    e = (C - A) / D
    B = A + along * e + np.sqrt(b * b - along**2) * np.array([-e[2], 0.0, e[0]])
    one = Linkage()
    crank, coupler, rocker = (
        one.bar((0, 0, 0), A, "crank"),
        one.bar(A, B, "bar"),
        one.bar(B, C, "rocker"),
    )
    axle = one.pin((0, 0, 0), carom.GROUND, crank, "axle")
    one.pin(A, crank, coupler, "first pin")
    one.pin(B, coupler, rocker, "second pin")
    one.pin(C, carom.GROUND, rocker, "rocker axle")
    return one.scene, axle, rate, T, {"axle", "first pin", "second pin", "rocker axle"}


def slider_crank(rng, rate):
    """A rod that is shorter than the crank: it is upright before the crank is."""
    r, angle = rng.uniform(0.5, 1.0), rng.uniform(-0.3, 0.3)
    L = rng.uniform(0.5, 0.95) * r
    A = at(r, angle)
    B = np.array([A[0] + np.sqrt(L * L - A[2] ** 2), 0.0, 0.0])
    one = Linkage()
    crank, rod = one.bar((0, 0, 0), A, "crank"), one.bar(A, B, "rod")
    slider = one.bar(B, B, "slider")
    axle = one.pin((0, 0, 0), carom.GROUND, crank, "axle")
    one.pin(A, crank, rod, "pin")
    one.pin(B, rod, slider, "wrist")
    one.guide((1, 0, 0), slider)
    T = first_time(rate, lambda turn: abs(r * np.sin(angle - turn)) - L)
    return one.scene, axle, rate, T, {"axle", "pin", "wrist"}


def pulled(rng, rate):
    """A slider that is pulled until crank and rod are in line."""
    r, angle = rng.uniform(0.5, 1.0), rng.uniform(0.3, 2.5)
    L, rate = rng.uniform(1.1, 2.0) * r, abs(rate)
    A = at(r, angle)
    B = np.array([A[0] + np.sqrt(L * L - A[2] ** 2), 0.0, 0.0])
    one = Linkage()
    crank, rod = one.bar((0, 0, 0), A, "crank"), one.bar(A, B, "rod")
    slider = one.bar(B, B, "slider")
    one.pin((0, 0, 0), carom.GROUND, crank, "axle")
    one.pin(A, crank, rod, "pin")
    one.pin(B, rod, slider, "wrist")
    return (
        one.scene,
        one.guide((1, 0, 0), slider),
        rate,
        (r + L - B[0]) / rate,
        {"axle", "pin", "wrist"},
    )


def stretched(rng, rate):
    """A chain of links in space whose end is pulled until it is straight."""
    rate, turns = abs(rate), rng.normal(size=(int(rng.integers(2, 5)), 3))
    turns *= rng.uniform(0.4, 1.0, (len(turns), 1)) / np.linalg.norm(turns, axis=1, keepdims=True)
    ends = np.concatenate([np.zeros((1, 3)), np.cumsum(turns, axis=0)])
    one, last = Linkage(), carom.GROUND
    for k in range(len(turns)):
        link = one.bar(ends[k], ends[k + 1], f"link{k}")
        one.scene.add_joint(joints.Spherical(ends[k]), last, link, name=f"ball{k}")
        last = link
    tip = one.bar(ends[-1], ends[-1], "tip")
    one.scene.add_joint(joints.Spherical(ends[-1]), last, tip, name="end")
    way = np.linalg.norm(ends[-1])
    guide = one.guide(ends[-1] / way, tip)
    T = (np.sum(np.linalg.norm(turns, axis=1)) - way) / rate
    return one.scene, guide, rate, T, {"ball0", "end"}


@pytest.mark.few(5)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", [four_bar, slider_crank, pulled, stretched])
def test_a_linkage_that_locks_says_so(kind, seed):
    rng = np.random.default_rng([seed, 7])
    rate = rng.uniform(0.3, 3.0) * rng.choice([-1, 1])
    scene, driven, rate, T, locked = kind(rng, rate)
    scene.add_constraint(constraints.Driver(driven, rate=rate), name="motor")
    step = {"step": 0.01} if seed % 2 else {}
    options = carom.Options(project_start=True)  # bars begin at rest
    a = carom.simulate(scene, T + 1.0, options=options, throw=False, **step)
    assert a.status in (Status.CONSTRAINTS_LOST, Status.STEP_TOO_SMALL)
    assert abs(a.t[-1] - T) < 1e-4
    assert a.message.startswith(
        f"The mechanism locks at t = {a.t[-1]:.9g} s: 'motor' can be followed no "
    )
    named = a.message.split("because ")[1].split(" have come")[0]
    assert locked <= set(named.replace("'", "").split(", "))
    assert "End the motion of 'motor' before it" in a.message
    assert a.warnings == ()
