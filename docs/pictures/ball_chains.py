"""The picture of the page of chains of balls: velocities after the impact, and forces in it.

Run ``python docs/pictures/ball_chains.py`` to make ``docs/_static/ball_chains.png``.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import carom
from carom.visual.plots import style

DOCS = Path(__file__).parents[1]
PAGE, OUT = DOCS / "published" / "ball_chains.md", DOCS / "_static" / "ball_chains.png"
DENSITY, MODULUS = 7780.0, 203e9 / (1 - 0.3**2) / 2  # E* of steel on steel


def page() -> dict:
    """Return the names that the code of the page defines."""
    space: dict = {}
    exec(
        re.search(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)[1], space
    )
    return space


def springs(radii: np.ndarray):
    """Return the solution of the chain as springs by Hertz's law: places and velocities over time."""
    mass = DENSITY * 4 / 3 * np.pi * radii**3
    k = 4 / 3 * MODULUS * np.sqrt(radii[:-1] * radii[1:] / (radii[:-1] + radii[1:]))

    def rates(t, y):
        F = k * np.maximum(y[:9] - y[1:10], 0.0) ** 1.5
        return np.concatenate([y[10:], (np.append(0.0, F) - np.append(F, 0.0)) / mass])

    begin = np.zeros(20)
    begin[10] = 1.0
    return solve_ivp(
        rates, (0, 6e-4), begin, method="DOP853", rtol=1e-11, atol=1e-18, max_step=2e-7, dense_output=True
    ), k  # fmt: skip


def main() -> None:
    """Make the picture."""
    names = page()
    with style.style():
        figure = Figure(figsize=(style.PAGE, 4.6), layout="constrained")
        panels = figure.subplots(2, 2, width_ratios=[1, 1.4])
        for (left, right), name, radii in zip(
            panels, ("equal", "tapered"), (names["EQUAL"], names["TAPERED"]), strict=True
        ):
            run = carom.simulate(names["chain"](radii), 0.02)
            after, force = run.velocity[-1, :, 0], run.impact_forces(0)
            exact, k = springs(radii)
            number = np.arange(1, 11)
            left.plot(number, exact.y[10:, -1], color=style.GREY, label="springs over time")
            left.plot(number, after, "o", mfc="none", color=style.BLUE, label="carom")
            left.axhline(0.0, color=style.BLACK, lw=0.4)
            left.set(
                title=f"{name} balls", xlabel="ball", ylabel="velocity after [m/s]", xticks=number
            )
            left.legend(loc="upper left")
            t = np.linspace(0, 3.2e-4, 1500)
            x = exact.sol(t)[:10]
            colours = mpl_colours(9)
            for j in range(9):
                right.plot(1e6 * force.t, force.normal_force[:, j] / 1e3, color=colours[j], lw=1.2)
                F = k[j] * np.maximum(x[j] - x[j + 1], 0.0) ** 1.5
                right.plot(1e6 * t, F / 1e3, ":", color=style.BLACK, lw=0.7)
            right.set(
                xlabel=r"time [$\mathrm{\mu}$s]", ylabel="force [kN]", title="forces of the nine contacts",
                xlim=(0, 1e6 * t[-1]), ylim=(0, None),
            )  # fmt: skip
        style.write(figure, OUT)
    print(OUT)


def mpl_colours(count: int) -> list:
    """Return colours from the first contact to the last."""
    from matplotlib import colormaps

    return [colormaps["viridis"](j / count) for j in range(count)]


if __name__ == "__main__":
    main()
