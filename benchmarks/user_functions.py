"""What a call of a function of the user costs: plain Python, and compiled with Numba."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

import carom
from carom import constraints, forces
from common import per_step, report, stepper

STEP = 1e-3
MICRO = 1e-6


def spring(t, states):
    """Return the force of a spring on the first body."""
    result = np.zeros((1, 6))
    for k in range(3):
        result[0, k] = -10.0 * states[0, k]
    return result


def circle(t, poses):
    """Return the row of a bead on a circle in the plane of x and z."""
    rows = np.zeros((1, 7))
    rows[0, 0], rows[0, 2] = poses[0, 0], poses[0, 2]
    return rows


def bead() -> tuple[carom.Scene, object]:
    """Return a scene with a ball, and the ball."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    return scene, scene.add_body(carom.Sphere(0.1), mass=1.0, position=(1, 0, 0))


def pushed(function: Callable) -> carom.Scene:
    """Return a ball with a force by a function."""
    scene, ball = bead()
    scene.add_force(forces.UserForce(ball, function))
    return scene


def led(function: Callable) -> carom.Scene:
    """Return a ball with a row by a function."""
    scene, ball = bead()
    scene.add_constraint(constraints.Rows(ball, function, 1))
    return scene


def calls(make: Callable[[Callable], carom.Scene], function: Callable) -> float:
    """Return the number of calls in a step."""
    count = [0]

    def counted(t, states):
        count[0] += 1
        return function(t, states)

    scene, steps = make(counted), []
    for many in (100, 200):
        count[0] = 0
        stepper(scene, STEP)(many)
        steps.append(count[0])
    return (steps[1] - steps[0]) / 100


def main() -> None:
    """Measure and report."""
    rows = []
    for name, make, function in (("UserForce", pushed, spring), ("Rows", led, circle)):
        many = calls(make, function)
        plain = float(np.median(per_step(stepper(make(function), STEP), 100, 2100)))
        quick = float(np.median(per_step(stepper(make(numba.njit(function)), STEP), 100, 20100)))
        rows.append([
            name, f"{many:.0f}", f"{plain / MICRO:.3g}", f"{quick / MICRO:.3g}",
            f"{plain / MICRO / many:.2g}", f"{quick / MICRO / many:.2g}", f"{plain / quick:.2g}",
        ])  # fmt: skip
    report(
        "user_functions", "Functions of the user",
        ["", "calls a step", "a step, plain / us", "a step, compiled / us", "a call, plain / us",
         "a call, compiled / us", "ratio"],
        rows, "A call: the time of a step, everything included, by the number of calls. rk4, one body.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
