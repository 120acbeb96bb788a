"""Six problems whose answer is known: their numbers, their answers, and what the scripts of all programs share.

A script `by_NAME.py` states the problems for one program. For each variant of the program (a solver, a scheme)
it has a table of functions: each takes a setting (a step or an accuracy), and returns a place and processor
time. It needs numpy and the program alone.
"""

from __future__ import annotations

import argparse
import json
import platform
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

G, RADIUS = 9.81, 0.1  # of all balls, which have a mass of 1 kg
#: a ball thrown along the floor without spin: speed, friction, duration
SPEED, MU, ROLLS = 2.0, 0.2, 1.0
#: a box in free fall: half edges, spin in its own axes, duration; the place of a point of it is compared
HALF, SPIN, FALLS = np.array([0.1, 0.1, 0.3]), np.array([2.0, 0.0, 5.0]), 1.0
MARK = np.array([0.1, 0.1, 0.3])
#: a ball between a floor and a ceiling without gravity: height of the ceiling, speed, restitution, duration
CEILING, THROWN, KEEPS, STOPS = 1.2, 2.0, 0.8, 2.0
#: a block on a spring: stiffness, extension at the start, duration; it rests from some time on
SPRING, DRAWN, SLIDES = 50.0, 0.5, 3.0
BLOCK = np.array([0.2, 0.2, 0.02])  # half edges
#: a ball that is dropped: height of its lowest point; restitution and duration
DROP = 0.4
BOUNCES = {0.5: 0.65, 1.0: 3.0}
#: seven stars in a plane (the Pleiades of the IVP test set); star i has mass i
STARS = np.array([[3.0, 3], [3, -3], [-1, 2], [-3, 0], [2, 0], [-2, -4], [2, 4]])
FLY = np.array([[0.0, 0], [0, 0], [0, 0], [0, -1.25], [0, 1], [1.75, 0], [-1.5, 0]])
STARS_END = np.array(
    [
        [0.3706139143970502, -3.943437585517392], [3.237284092057233, -3.271380973972550],
        [-3.222559032418324, 5.225081843456543], [0.6597091455775310, -2.590612434977470],
        [0.3425581707156584, 1.198213693392275], [1.562172101400631, -0.2429682344935824],
        [-0.7003092922212495, 1.091449240428980],
    ]
)  # fmt: skip
YEARS = 3.0
NAMES = ("rolling", "free fall", "stops", "stick-slip", "bounce e=0.5", "bounce e=1", "Pleiades")
LONG = 8.0  # seconds after which no finer setting is tried


def turn(vector: np.ndarray) -> np.ndarray:
    """Return the matrix of a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def matrix(w: float, x: float, y: float, z: float) -> np.ndarray:
    """Return the matrix of a quaternion, which need not be of length one."""
    s = 2 / (w * w + x * x + y * y + z * z)
    return np.eye(3) - s * np.array(
        [
            [y * y + z * z, w * z - x * y, -w * y - x * z],
            [-w * z - x * y, x * x + z * z, w * x - y * z],
            [w * y - x * z, -w * x - y * z, x * x + y * y],
        ]
    )


def inertia(half: np.ndarray) -> np.ndarray:
    """Return the principal inertias of a box of 1 kg."""
    return ((half**2).sum() - half**2) / 3


def rolled() -> float:
    """Return where the ball is: friction slows it until it rolls, at 5/7 of its speed."""
    slips = 2 * SPEED / (7 * MU * G)
    return SPEED * slips - MU * G * slips**2 / 2 + 5 / 7 * SPEED * (ROLLS - slips)


def marked(position=None, R=None) -> np.ndarray:
    """Return where the marked point is: of the body given, or by the free motion of a symmetric top."""
    if position is not None:
        return np.asarray(position, float) + np.asarray(R, float) @ MARK
    a, _, c = inertia(HALF)
    momentum = np.array([a * SPIN[0], 0.0, c * SPIN[2]])
    R = turn(momentum / a * FALLS) @ turn(np.array([0, 0, (1 - c / a) * SPIN[2] * FALLS]))
    return np.array([0, 0, -G * FALLS**2 / 2]) + R @ MARK


def stopped() -> float:
    """Return the height of the ball: it flies the free height, at a speed that each stop makes less."""
    free, t, speed, at, way = CEILING - 2 * RADIUS, STOPS, THROWN, CEILING / 2, -1.0
    leg = free / 2
    while t > leg / speed:
        t -= leg / speed
        at, way, speed, leg = (RADIUS if way < 0 else CEILING - RADIUS), -way, speed * KEEPS, free
    return at + way * speed * t


def slid() -> float:
    """Return where the block stays: each half swing is shorter by twice mu m g / k."""
    dead, x = MU * G / SPRING, DRAWN
    while abs(x) > dead:
        x = -np.sign(x) * (abs(x) - 2 * dead)
    return x


def bounced(e: float) -> float:
    """Return the height of the centre of the ball."""
    speed = np.sqrt(2 * G * DROP)
    t = BOUNCES[e] - speed / G
    while True:
        speed *= e
        if t <= 2 * speed / G:
            return RADIUS + speed * t - G * t * t / 2
        t -= 2 * speed / G


def pull(x: np.ndarray) -> np.ndarray:
    """Return the forces (7, 2) on the stars at x (7, 2)."""
    mass = np.arange(1.0, 8.0)
    d = x[None] - x[:, None]
    r2 = (d**2).sum(2)
    np.fill_diagonal(r2, 1.0)
    return ((mass[:, None] * mass / r2**1.5)[..., None] * d).sum(1)


ANSWERS = {
    "rolling": rolled,
    "free fall": marked,
    "stops": stopped,
    "stick-slip": slid,
    "bounce e=0.5": lambda: bounced(0.5),
    "bounce e=1": lambda: bounced(1.0),
    "Pleiades": lambda: STARS_END,
}  # fmt: skip


def damping_ratio(e: float) -> float:
    """Return the damping ratio of a spring and damper that push only, for a rebound of e.

    The force ends at w t = pi - atan2(2 z s, 1 - 2 z z) with s = sqrt(1 - z z), at the speed exp(-z t w / s).
    """
    low, high = 0.0, 0.999
    for _ in range(60):
        z = (low + high) / 2
        s = np.sqrt(1 - z * z)
        reached = np.exp(-z / s * (np.pi - np.arctan2(2 * z * s, 1 - 2 * z * z)))
        low, high = (z, high) if reached > e else (low, z)
    return 0.0 if e >= 1 else (low + high) / 2


def hunt_crossley(e: float, speed: float) -> float:
    """Return the dissipation d of the force k x (1 + d v), for a rebound of e at an impact at this speed.

    With a = d speed, the work of both parts is equal where a (1 + e) - ln(1 + a) + ln(1 - e a) = 0.
    """
    if e >= 1:
        return 0.0
    low, high = 1e-6, (1 - 1e-12) / e
    for _ in range(200):
        a = (low + high) / 2
        over = a * (1 + e) - np.log1p(a) + np.log1p(-e * a) > 0
        low, high = (a, high) if over else (low, a)
    return (low + high) / 2 / speed


class Variant(NamedTuple):
    """A way to run a program: its settings, and the function of each problem it can state."""

    name: str
    accuracy: bool  # settings are accuracies that are asked for, not steps
    settings: tuple[float, ...]  # from coarse to fine
    solve: dict[str, Callable[[float], tuple[object, float]]]
    why: dict[str, str]  # reasons of problems that it cannot state


def stepped(step: Callable[[], object], dt: float, duration: float) -> float:
    """Take the steps, and return their processor time."""
    begin = time.process_time()
    for _ in range(round(duration / dt)):
        step()
    return time.process_time() - begin


def table(rolling, fall, stops, stick_slip, bounce, pleiades) -> dict:
    """Return the functions of a setting by the names of the problems; that of a bounce takes e too."""
    solve = (
        rolling,
        fall,
        stops,
        stick_slip,
        lambda h: bounce(h, 0.5),
        lambda h: bounce(h, 1.0),
        pleiades,
    )
    return dict(zip(NAMES, solve, strict=True))


def main(version: str, variants: list[Variant]) -> None:
    """Solve each problem at each setting, and print one line of JSON for each."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    print(json.dumps({"version": version, "python": platform.python_version()}), flush=True)
    for variant in variants:
        for name in NAMES:
            if given.only and name != given.only:
                continue
            row = {"variant": variant.name, "problem": name, "accuracy": variant.accuracy}
            if name not in variant.solve:
                print(json.dumps({**row, "why": variant.why[name]}), flush=True)
                continue
            variant.solve[name](variant.settings[0])  # loads code
            for setting in variant.settings:
                row |= {"setting": setting}
                try:
                    place, took = variant.solve[name](setting)
                except Exception as failed:  # a program may end in any way
                    row |= {"error": None, "time": None, "failed": str(failed).split("\n")[0][:120]}
                    print(json.dumps(row), flush=True)
                    continue
                off = np.asarray(place, float) - ANSWERS[name]()
                error = float(np.sqrt((off**2).sum(-1)).max()) if off.ndim else abs(float(off))
                row.pop("failed", None)
                print(json.dumps({**row, "error": error, "time": took}), flush=True)
                if took > LONG:
                    break
