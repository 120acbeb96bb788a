"""The picture of the page of the slider-crank: corners in their clearance, first impacts, rates.

Run ``python docs/pictures/slider_crank.py`` to make ``docs/_static/slider_crank.png``.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom
from carom.visual.plots import style

DOCS = Path(__file__).parents[1]
PAGE, OUT = DOCS / "published" / "slider_crank.md", DOCS / "_static" / "slider_crank.png"
COLOURS = style.BLUE, style.RED
ACCUMULATION = 0.0026925480945  # [s]


def page() -> dict:
    """Return the names that the code of the page defines."""
    space: dict = {}
    code = re.search(
        r"^```python\n(.*?)^solution = ", PAGE.read_text(encoding="utf-8"), re.M | re.S
    )
    assert code is not None
    exec(code[1], space)
    return space


def angle(solution, name: str) -> np.ndarray:
    """Return the angle of a body in the plane [rad]."""
    q = solution[name].orientation
    return np.unwrap(2 * np.arctan2(-q[:, 2], q[:, 0]))


def corners(solution, names: dict) -> np.ndarray:
    """Return the heights of the corners (4, T) above the places where they touch a guide [m]."""
    z, turn = solution["slider"].position[:, 2], angle(solution, "slider")
    places = []
    for along, up in ((-1, 1), (1, 1), (-1, -1), (1, -1)):
        height = along * names["HALF"] * np.sin(turn) + up * names["HEIGHT"] * (np.cos(turn) - 1)
        places.append(z + height)
    return np.array(places)


def main() -> None:
    """Make the picture."""
    names = page()
    scene = names["mechanism"]()
    solution = carom.simulate(scene, 0.2, rtol=1e-10, save_at=np.linspace(0, 0.2, 8001))
    turns = angle(solution, "crank") / (2 * np.pi)
    labels = ("left corners", "right corners")  # upper and lower ones differ by 1e-5 of the play
    with style.style():
        figure = Figure(figsize=(style.PAGE, 4.6), layout="constrained")
        axes = figure.subplot_mosaic([["path", "path"], ["first", "rates"]], height_ratios=[1.2, 1])
        path, first, rates = axes["path"], axes["first"], axes["rates"]
        for height, colour, label in zip(corners(solution, names), COLOURS, labels, strict=False):
            path.plot(turns, 1e3 * height, color=colour, lw=0.7, label=label)
        for side in (-1, 1):
            path.axhspan(side * 1.0, side * 1.25, color="0.85", lw=0)
        path.set(
            xlabel="turns of the crank", ylabel="corner in the clearance [mm]", xlim=(0, turns[-1])
        )
        path.set_ylim(-1.25, 1.25)
        path.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        left = np.geomspace(1e-5, 1e-9, 2000)
        near = carom.simulate(names["mechanism"](), 0.0027, rtol=1e-10, save_at=ACCUMULATION - left)
        there = np.isin(near.t, ACCUMULATION - left)
        for height, colour in zip(corners(near, names), COLOURS, strict=False):
            gap = np.maximum(names["PLAY"] - height[there], 1e-12)
            first.loglog(left[: np.sum(there)], gap, color=colour, lw=0.8)
        first.set(xlabel="time to the accumulation [s]", ylabel="gap [m]", ylim=(1e-10, 2e-5))
        first.invert_xaxis()
        for name, colour in (("crank", style.BLUE), ("rod", style.RED)):
            rates.plot(turns, -solution[name].angular_velocity[:, 1], color=colour, label=name)
        rates.set(xlabel="turns of the crank", ylabel="rate [rad/s]", xlim=(0, turns[-1]))
        rates.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        style.write(figure, OUT)
    print(OUT)


if __name__ == "__main__":
    main()
