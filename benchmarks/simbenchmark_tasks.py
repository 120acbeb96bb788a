"""The tasks of SimBenchmark (Kang and Hwangbo, 2018), each with its error as they define it.

Rolling balls on a plate, balls that bounce, a cube of 216 balls that fall without bouncing or elastically, and
the energy and the momentum of a robot with four legs. The error is a mean over samples: of the squared error of
the velocities of plate and first ball, of the squared error of the energy, of the sum of the squared
penetrations, of the squared error of the momentum.

The robot has thirteen links, with the masses and lengths of ANYmal rounded and inertias of plain shapes,
because the file of the robot has a licence of its own. All else is as published.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from carom.bench.many import block, plate

GRAVITY = 9.81
BALL, RADIUS = 10.0, 0.1  # mass and radius of bouncing balls [kg], [m]


class Published(NamedTuple):
    """A task: its scene, how long it takes, and the error of a solution."""

    name: str
    title: str
    unit: str  # of the error
    scene: Callable[[], Any]
    duration: float  # [s]
    error: Callable[[Any], float]
    sample: float  # time between samples [s]


def rolling_accelerations() -> tuple[float, float]:
    """Return the exact accelerations of the plate and of the balls that roll on it [m/s^2].

    The floor slows the plate by mu (M + n m) g. Each ball is driven by the force m a of rolling at its lowest
    point, which is 3.5 times as fast as its centre: a_plate = 3.5 a_ball.
    """
    M, m, n, F = 10.0, 1.0, 25, 150.0
    ball = (F - 0.4 * (M + n * m) * GRAVITY) / (3.5 * M + n * m)
    return 3.5 * ball, ball


def _rolling_error(solution: Any) -> float:
    along = np.array([0.5, 0.75**0.5, 0.0])
    t = solution.t[:, None]
    wrong = [solution.velocity[:, k] - a * t * along for k, a in enumerate(rolling_accelerations())]
    return float(sum((one**2).sum(axis=1) for one in wrong).mean())


def bouncing(count: int = 7) -> Any:
    """Return balls that bounce elastically from 5 m."""
    import carom

    made = carom.Scene(gravity=(0, 0, -GRAVITY))
    made.add_half_space((0, 0, 0), (0, 0, 1))
    made.set_contact_default(friction=0.0, restitution=1.0)
    for i, j in itertools.product(range(count), repeat=2):
        made.add_body(carom.Sphere(RADIUS), mass=BALL, position=(2 * i, 2 * j, 5.0))
    return made


def balls(side: int = 6, restitution: float = 0.0) -> Any:
    """Return a cube of balls .01 m apart: above the floor, or a metre higher if they are elastic."""
    import carom

    made = carom.Scene(gravity=(0, 0, -GRAVITY))
    made.add_half_space((0, 0, 0), (0, 0, 1))
    made.set_contact_default(friction=0.0, restitution=restitution)
    places = itertools.product(range(6), repeat=3)
    for place, part in zip(places, block().bodies, strict=True):
        if max(place) < side:
            x = np.add(part.position, (0.0, 0.0, 1.0 if restitution else 0.0))
            made.add_body(carom.Sphere(RADIUS), mass=BALL, position=x)
    return made


def penetration(position: np.ndarray) -> tuple[float, float]:
    """Return the sum of the squared penetrations of balls (N, 3) [m^2], and the greatest one [m]."""
    i, j = np.triu_indices(len(position), 1)
    between = 2.0 * RADIUS - np.linalg.norm(position[i] - position[j], axis=1)
    deep = np.maximum(np.concatenate([between, RADIUS - position[:, 2]]), 0.0)
    return float((deep**2).sum()), float(deep.max())


def robot(ball: bool = False) -> Any:
    """Return a robot of four legs, each of hip, thigh and shank, that floats.

    It is pulled upwards by twice its weight for a second, and falls then; or, without gravity, a ball of 10 kg
    strikes its trunk at 5 m/s.
    """
    import carom

    made = carom.Scene(gravity=(0, 0, 0 if ball else -GRAVITY))
    made.set_contact_default(restitution=0.0, friction=0.8)
    trunk = carom.Box(0.53, 0.23, 0.26)
    base = made.add_body(trunk, mass=21.4, position=(0, 0, 2), name="trunk")
    for front, left in itertools.product((1, -1), repeat=2):
        _add_leg(made, base, front, left)
    if ball:
        made.add_body(
            carom.Sphere(0.2), mass=10.0, position=(0, -5, 2), velocity=(0, 5, 0), name="ball"
        )
        return made
    total = sum(one.mass for one in made.bodies)
    pull = made.add_force(carom.forces.Force((0, 0, 2 * total * GRAVITY)), base, name="pull")
    made.switch(pull, at=1.0)
    return made


def _add_leg(made: Any, base: Any, front: int, left: int) -> None:
    """Add a leg: axes along x, y and y; thigh and shank lean by 23 degrees, one forward, the other back."""
    from carom import axis_angle, joints

    name = ("left" if left > 0 else "right") + (" front" if front > 0 else " hind")
    hip = np.array((0.26 * front, 0.115 * left, 2.0))
    swing = hip + (0.06 * front, 0.03 * left, 0.0)
    lean = np.radians(23.0) * front
    knee = swing + (-0.25 * np.sin(lean), 0.1 * left, -0.25 * np.cos(lean))
    foot = knee + (0.3 * np.sin(lean), 0.0, -0.3 * np.cos(lean))
    parent = base
    for part, mass, here, there, axis in (
        ("hip", 1.1, hip, swing, (1, 0, 0)), ("thigh", 1.5, swing, knee, (0, 1, 0)),
        ("shank", 0.55, knee, foot, (0, 1, 0)),
    ):  # fmt: skip
        length, along = np.linalg.norm(there - here), there - here
        turn = np.cross((0, 0, 1), along)
        angle = np.degrees(np.arctan2(np.linalg.norm(turn), along[2]))
        radius = 0.02 if part == "shank" else 0.04
        across = mass * (length**2 / 12 + radius**2 / 4)
        body = made.add_body(
            mass=mass, inertia=(across, across, mass * radius**2 / 2), position=(here + there) / 2,
            orientation=axis_angle(turn, angle), name=f"{name} {part}",
        )  # fmt: skip
        made.add_joint(joints.Revolute(here, axis), parent, body, name=f"{name} {part} joint")
        parent = body


def _energy_error(solution: Any) -> float:
    falls = solution.t >= 1.0 if "pull" in solution.scene else solution.t >= 0.0
    energy = solution.total_energy[falls]
    return float(((energy - energy[0]) ** 2).mean())


def _momentum_error(solution: Any) -> float:
    masses = np.array([one.mass for one in solution.scene.bodies])
    momentum = np.einsum("b,tbi->ti", masses, solution.velocity)
    return float(((momentum - (0.0, 50.0, 0.0)) ** 2).sum(axis=1).mean())


def _penetration_error(solution: Any) -> float:
    return float(np.mean([penetration(x)[0] for x in solution.position]))


TASKS = (
    Published("rolling", "Rolling", "m^2/s^2", plate().scene, 4.0, _rolling_error, 0.02),
    Published("bouncing", "Bouncing", "J^2", bouncing, 20.0, _energy_error, 0.02),
    Published("balls", "666 balls", "m^2", balls, 10.0, _penetration_error, 0.05),
    Published(
        "elastic balls",
        "Elastic 666 balls",
        "J^2",
        lambda: balls(6, 1.0),
        10.0,
        _energy_error,
        0.02,
    ),
    Published("energy", "Energy of a robot", "J^2", robot, 3.0, _energy_error, 0.01),
    Published(
        "momentum",
        "Momentum of a robot",
        "(N s)^2",
        lambda: robot(True),
        10.0,
        _momentum_error,
        0.02,
    ),
)
