"""What is asked for and what comes: the true error of standard problems at four tolerances."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import carom
from carom import GROUND, forces, joints
from carom.bench.problems.chain import scene as chain_scene
from carom.bench.problems.four_bar import scene as four_bar_scene
from carom.bench.problems.spatial_die import scene as die_scene
from common import FEW, OUT, report

TOLERANCES = (1e-4, 1e-6) if FEW else (1e-4, 1e-6, 1e-8, 1e-10)
FLOOR = 1e-17  # errors of zero are drawn here
FINE = {
    "rtol": 1e-13,
    "method": "rk8",
}  # the motion that errors are measured by, where no form is closed


class Problem(NamedTuple):
    """A scene, its duration, and where it is known in closed form the end of its first body."""

    title: str
    make: Callable[[], carom.Scene]
    duration: float
    end: Callable[[], np.ndarray] | None = None
    reference: dict = FINE


def ball() -> carom.Scene:
    """Return a ball that bounces 26 times, e = .8, until 2.6 s."""
    return touching(carom.Sphere(0.1), (0, 0, 0.4), restitution=0.8)


def touching(shape, position, velocity=(0, 0, 0), spin=(0, 0, 0), *, gravity=9.81, **law):
    """Return a body on a floor, or above it."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(
        shape, mass=1.0, position=position, velocity=velocity, angular_velocity=spin
    )
    scene.add_contact(body, floor, **law)
    return scene


def sliding_ball() -> carom.Scene:
    """Return a ball that slides, v = 7 m/s and mu = .2, and rolls from 1.02 s on with 5 m/s."""
    return touching(carom.Sphere(0.1), (0, 0, 0.1), (7, 0, 0), restitution=0.0, friction=0.2)


def sliding_ball_end() -> np.ndarray:
    """Return its place at 2 s: v t - mu g t^2/2 until 2 v/(7 mu g), then 5 v/7."""
    t = 2.0 * 7.0 / (7.0 * 0.2 * 9.81)
    return np.array([7.0 * t - 0.5 * 0.2 * 9.81 * t * t + 5.0 * (2.0 - t), 0.0, 0.1])


def block(spin: float) -> carom.Scene:
    """Return a block that slides on a floor, and turns."""
    return touching(
        carom.Box(0.2, 0.1, 0.1),
        (0, 0, 0.05),
        (1, 0, 0),
        (0, 0, spin),
        restitution=0.0,
        friction=0.3,
    )


def slope() -> carom.Scene:
    """Return a block on a slope of half a radian, thrown across it: the direction of its slip turns."""
    scene = carom.Scene(gravity=9.81 * np.array([np.sin(0.5), 0.0, -np.cos(0.5)]))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    one = scene.add_body(
        carom.Box(0.2, 0.1, 0.1), mass=1.0, position=(0, 0, 0.05), velocity=(0, 0.5, 0),
        angular_velocity=(0, 0, 4),
    )  # fmt: skip
    scene.add_contact(one, floor, restitution=0.0, friction=0.3)
    return scene


def block_end() -> np.ndarray:
    """Return where one that does not turn stops: v^2/(2 mu g)."""
    return np.array([0.5 / (0.3 * 9.81), 0.0, 0.05])


def top() -> carom.Scene:
    """Return a heavy top of 1 m at 150 rad/s."""
    scene, spin = carom.Scene(gravity=(0, 0, -9.81)), np.array([0.0, 150.0, -4.61538])
    body = scene.add_body(
        mass=15.0, inertia=(0.234375, 0.46875, 0.234375), position=(0, 1, 0), angular_velocity=spin,
        velocity=np.cross(spin, (0, 1, 0)),
    )  # fmt: skip
    scene.add_joint(joints.Spherical((0, 0, 0)), GROUND, body)
    return scene


def snap() -> carom.Scene:
    """Return a bar on a rod between two ball joints, let go where it falls into the rod's line."""
    scene = carom.Scene(gravity=(0, 0, -9.80665))
    body = scene.add_body(mass=1.0, inertia=(0.04, 0.1, 0.1), position=(0.5, 2, 0))
    scene.add_joint(joints.Distance((0, 0, 0), (0, 2, 0)), GROUND, body)
    return scene


def boot() -> carom.Scene:
    """Return Kane's baby boot: a plate that turns about the lower end of a rod, across its swing."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    a, side = np.pi / 2 - 0.01, np.array([0.0, 1.0, 0.0])
    down = np.array([np.sin(a), 0.0, -np.cos(a)])
    turned = (np.cos(-a / 2), 0.0, np.sin(-a / 2), 0.0)
    rod = scene.add_body(
        mass=0.01, inertia=np.array([5e-6, 5e-6, 5e-7]), position=0.075 * down, orientation=turned
    )
    plate = scene.add_body(
        mass=0.1, inertia=np.array([2.5e-5, 5e-5, 7e-5]), position=0.2 * down, orientation=turned
    )
    scene.add_joint(joints.Revolute((0, 0, 0), side), GROUND, rod)
    scene.add_joint(joints.Revolute(0.15 * down, down), rod, plate)
    scene.add_force(forces.Torque((0, 0, 1e-6)), plate)
    return scene


def car_axis() -> carom.Scene:
    """Return a mass on two stiff springs and dampers, pulled to the side."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    body = scene.add_body(
        mass=10.0, inertia=(1, 1, 1), position=(0.1, 0, 0.5), velocity=(0, 0.3, 0)
    )
    for x in (-0.5, 0.5):
        ends = (x, 0.0, 0.0), (x, 0.0, 0.0)
        scene.add_force(
            forces.Spring(1e4, ends[0], (x + 0.1, 0, 0.5), rest_length=0.5, damping=20.0),
            GROUND,
            body,
        )
    return scene


def on_a_wall() -> carom.Scene:
    """Return a double pendulum that swings against a wall, three impacts in 2.5 s."""
    scene = carom.Scene()
    wall, above = scene.add_half_space((-0.1, 0, 0), (1, 0, 0)), GROUND
    for k in range(2):
        one = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0.5 * (k + 1), 0, 0))
        scene.add_joint(joints.Revolute((0.5 * k, 0, 0), (0, 1, 0)), above, one)
        scene.add_contact(one, wall, restitution=0.6, friction=0.2)
        above = one
    return scene


def egg() -> carom.Scene:
    """Return an ellipsoid that rolls and wobbles on a floor, held at one point."""
    w = np.array([0.0, 12.0, 1.5])
    return touching(
        carom.Ellipsoid(0.1, 0.07, 0.1), (0, 0, 0.1), np.cross(w, (0, 0, 0.1)), w, restitution=0.0,
        friction=0.8,
    )  # fmt: skip


PROBLEMS = (
    Problem("ball that bounces", ball, 2.0),
    Problem("die, to its second impact", die_scene, 0.25),
    Problem("rod, swinging", lambda: chain_scene(1), 5.0),
    Problem("three rods, chaotic", lambda: chain_scene(3), 2.0),
    Problem("heavy top, 150 rad/s", top, 0.2),
    Problem("snap of a rod", snap, 2.0),
    Problem("baby boot", boot, 2.0),
    Problem("mass on stiff springs", car_axis, 2.0),
    Problem("four-bars in line", four_bar_scene, 3.0),
    Problem("two rods and a wall", on_a_wall, 2.5),
    Problem("ball that slides, rolls", sliding_ball, 2.0, sliding_ball_end),
    Problem("ellipsoid that rolls", egg, 1.0),
    Problem("block that slides", lambda: block(0.0), 0.5, block_end),
    Problem("block that slides, turns", lambda: block(5.0), 0.2, None, {"step": 1e-6}),
    Problem("block thrown across a slope", slope, 0.5, None, {"step": 2e-6}),
)


def known_end(problem: Problem) -> np.ndarray:
    """Return where the bodies are at the end, the first or all."""
    if problem.end is not None:
        return problem.end()[None]
    return run(problem, **problem.reference).position[-1]


def run(problem: Problem, **how) -> carom.Solution:
    """Return a run of a problem, its end saved alone."""
    save = {"save_every": 10**9} if "step" in how else {"save_at": problem.duration}
    return carom.simulate(problem.make(), problem.duration, **save, **how)


def missed(problem: Problem, rtol: float, known: np.ndarray, **how) -> tuple[float, float]:
    """Return the error of the places at the end, as a part of what was asked for, and in sizes."""
    s = run(problem, rtol=rtol, **how)
    way = np.linalg.norm(s.position[-1, : len(known)] - known, axis=-1)
    size = s._run.bodies["extent"]  # what `rtol` is of
    asked = rtol * (size[: len(known)] + np.min(size))
    return float(np.max(way / asked)), float(np.max(way / size[: len(known)]))


def measured(**how) -> dict[str, list[tuple[float, float]]]:
    """Return for each problem its errors at the tolerances."""
    found = {}
    for problem in PROBLEMS:
        known = known_end(problem)
        found[problem.title] = [missed(problem, rtol, known, **how) for rtol in TOLERANCES]
    return found


def draw(found: dict[str, list[tuple[float, float]]]) -> None:
    """Draw errors against the tolerance: what is on the line is what was asked for."""
    from carom.visual.plots import style as look

    colours = (look.BLUE, look.SKY, look.GREEN, look.ORANGE, look.RED, look.PURPLE, look.BLACK)
    with look.style():
        figure, ax = look.new(look.PAGE, 3.2)
        asked = np.array(TOLERANCES)
        ax.fill_between(asked, asked, 10.0 * asked, color="#eeeeee", lw=0, zorder=0)
        ax.plot(asked, asked, color=look.GREY, lw=0.8, ls="--", zorder=1)
        for i, (title, errors) in enumerate(found.items()):
            parts = np.maximum([part for part, _ in errors], FLOOR / asked)
            mark = "osv"[i // len(colours)]
            colour = colours[i % len(colours)]
            ax.plot(asked, parts * asked, f"{mark}-", color=colour, lw=0.8, ms=3, label=title)
        ax.set(xscale="log", yscale="log", xlabel="rtol", ylabel="error / size of the body")
        ax.grid(alpha=0.25, lw=0.4)
        figure.legend(loc="outside right center", fontsize=7)
        OUT.mkdir(parents=True, exist_ok=True)
        figure.savefig(OUT / "accuracy.png", dpi=220)


def main() -> None:
    """Measure and report."""
    found = measured()
    rows = [
        [title, *(f"{part:.2g}" for part, _ in errors)] for title, errors in found.items()
    ]  # fmt: skip
    report(
        "accuracy", "True errors, as parts of what was asked for",
        ["problem", *(f"rtol {rtol:.0e}" for rtol in TOLERANCES)], rows,
        "Greatest error of a place at the end, divided by atol + rtol of the body's size, by default settings.",
    )  # fmt: skip
    draw(found)


if __name__ == "__main__":
    main()
