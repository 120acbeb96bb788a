"""The picture of the README: the paper's planar die at two coefficients of friction.

Run ``python docs/pictures/die.py`` to make ``docs/_static/die.png``.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon

import carom

EDGE = 0.02  # [m]
BLUE, ORANGE = "#0072B2", "#D55E00"
OUT = Path(__file__).parents[1] / "_static" / "die.png"


def throw(friction: float, duration: float) -> carom.Solution:
    """Return the motion of the die of the paper, thrown flat."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    die = scene.add_body(
        carom.Box(EDGE, EDGE, EDGE), mass=0.016, position=(0, 0, 0.3),
        velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(die, ground, restitution=0.5, friction=friction)
    return carom.simulate(scene, duration, step=1e-3)


def corners(position, orientation) -> np.ndarray:
    """Return the four corners (4, 2) of the die in the plane of motion [m]."""
    angle = 2.0 * np.arctan2(orientation[2], orientation[0])  # about +y
    c, s = np.cos(angle), np.sin(angle)
    square = 0.5 * EDGE * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    return square @ np.array([[c, -s], [s, c]]) + position[[0, 2]]


def square(ax, solution, t: float, **style) -> np.ndarray:
    """Draw the die at time t; return its centre (2,)."""
    x, Q, *_ = solution.evaluate(t)
    ax.add_patch(Polygon(corners(x[0], Q[0]), **style))
    return x[0, [0, 2]]


def draw(ax, friction: float, after: list[float], duration: float, left: float, color: str) -> None:
    """Draw the arrival in grey, the die at its first impact, and where it goes from there."""
    solution = throw(friction, duration)
    first, second = solution.impacts.time[:2]
    ax.axhspan(-0.02, 0.0, color="0.9", lw=0)
    ax.axhline(0.0, color="0.3", lw=1.2)
    for begin, end, shade in ((0.0, first, "0.6"), (first, duration, color)):
        path = solution.evaluate(np.linspace(begin, end, 800))[0][:, 0]
        ax.plot(path[:, 0], path[:, 2], color=shade, lw=1.6, zorder=6)
    for t in (first - 0.0225, first - 0.0115):
        square(ax, solution, t, fc="0.97", ec="0.6", lw=1.0, zorder=1)
    for t in after:
        square(ax, solution, t, fc="none", ec=color, lw=1.0, zorder=3)
    square(ax, solution, second, fc="none", ec=color, lw=1.6, zorder=4)
    centre = square(ax, solution, first, fc=color, ec="0.1", lw=1.6, alpha=0.22, zorder=3)
    square(ax, solution, first, fc="none", ec="0.1", lw=1.6, zorder=4)
    ax.plot(*solution.impacts.point[:2, [0, 2]].T, "o", color="0.1", ms=6, zorder=8)
    v = solution.evaluate(first)[2][0, [0, 2]]
    arrow = {"arrowstyle": "-|>", "color": "0.1", "lw": 2.0, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", centre + 0.045 * v, centre, arrowprops=arrow, zorder=9)
    ax.plot(*centre, "o", color="0.1", ms=3.5, zorder=9)
    ax.set_title(f"friction $\\mu$ = {friction:.2f}:  $v_x^+ = {v[0]:+.3f}$ m/s", fontsize=11)
    ax.set_aspect("equal")
    ax.set_xlabel("$x$ [m]")
    ax.set_xlim(left, left + 0.1)
    ax.set_ylim(-0.006, 0.073)


def main() -> None:
    """Make the picture."""
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(1, 2, figsize=(9.2, 4.4), sharey=True, layout="constrained")
    draw(axes[0], 0.05, [0.221, 0.275, 0.310], 0.311, 0.064, BLUE)
    draw(axes[1], 0.20, [0.2575], 0.3209196, 0.044, ORANGE)
    axes[0].set_ylabel("$z$ [m]")
    figure.savefig(OUT, dpi=160)
    print(OUT)


if __name__ == "__main__":
    main()
