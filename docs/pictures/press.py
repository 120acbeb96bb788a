"""The picture of the tutorial of a mechanism: a drop press.

Run ``python docs/pictures/press.py`` to make ``docs/_static/press.png``.
"""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

import carom
from carom.geometry import quaternion

DOCS = Path(__file__).parents[1]
OUT = DOCS / "_static" / "press.png"


def scene_of_the_page() -> carom.Scene:
    """Return the scene that the first four steps of the page state."""
    page = (DOCS / "tutorial" / "press.md").read_text(encoding="utf-8")
    space: dict = {}
    for block in re.findall(r"^```python\n(.*?)^```", page, re.M | re.S)[:4]:
        exec(block, space)
    return space["scene"]


def draw(ax, solution: carom.Solution, t: float, color: str, lw: float) -> None:
    """Draw the press at time t."""
    x, Q, *_ = solution.evaluate(t, side="left")
    for b, body in enumerate(solution.scene.bodies[:2]):
        half = np.array([body.shape.lx / 2, 0, 0])
        ends = x[b] + np.array([quaternion.rotate(Q[b], s * half) for s in (-1, 1)])
        ax.plot(*ends[:, [0, 2]].T, "o-", color=color, lw=lw, ms=2 + lw, solid_capstyle="round")
    ax.add_patch(Rectangle(x[2, [0, 2]] - 0.04, 0.08, 0.08, ec=color, fc="none", lw=lw / 1.6))


def main() -> None:
    """Make the picture."""
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    solution = carom.simulate(scene_of_the_page(), duration=0.7, step=1e-3)
    blow = solution.impacts[0]
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9.2, 4.0), width_ratios=[1, 1.9], layout="constrained"
    )
    left.axhspan(0.04, 0.08, color="0.88", lw=0)
    left.axhline(0.08, color="0.3", lw=1.2)
    for x in (-0.044, 0.044):
        left.plot([x, x], [0.12, 0.4], color="0.8", lw=2.5)
    angle = np.linspace(0, 2 * np.pi, 100)
    left.plot(0.1 * np.sin(angle), 0.5 + 0.1 * np.cos(angle), ":", color="0.6", lw=1)
    draw(left, solution, 0.0, "0.65", 3)
    draw(left, solution, blow.time, "#0072B2", 5)
    left.set(
        aspect="equal", xlabel="$x$ [m]", ylabel="$z$ [m]", xlim=(-0.16, 0.16), ylim=(0.04, 0.63)
    )
    times = np.linspace(0, 0.7, 3000)
    height = solution.evaluate(times)[0][:, 2, 2] - 0.12
    right.axhspan(-0.012, 0, color="0.88", lw=0)
    right.axhline(0, color="0.3", lw=1.2)
    right.plot(times, height, color="#0072B2", lw=1.6)
    right.plot(
        solution.impacts.time, 0 * solution.impacts.time, "o", color="#D55E00", ms=5, label="blows"
    )
    right.set(
        xlabel="time [s]", ylabel="height of the ram above the anvil [m]", ylim=(-0.012, None)
    )
    right.legend(frameon=False)
    figure.savefig(OUT, dpi=160)
    print(OUT)


if __name__ == "__main__":
    main()
