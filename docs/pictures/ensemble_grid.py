"""The heat map of the page about ensembles: how far a die comes, over friction and speed.

Run ``python docs/pictures/ensemble_grid.py`` to make ``docs/_static/ensemble_grid.png``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots.style import picture

OUT = Path(__file__).parents[1] / "_static" / "ensemble_grid.png"


def main() -> None:
    """Draw the picture."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.1), name="die")
    scene.add_contact(die, table, restitution=0.5, friction=0.2)
    vary = {
        "die-table.friction": carom.Grid(np.linspace(0, 0.6, 31)),
        "die.velocity": [carom.Grid(np.linspace(0, 2, 31)), 0.0, -0.5],
        "die.angular_velocity": [(0, 10, 0)] * 31**2,
    }
    mapped = carom.ensemble(scene, 1.0, vary=vary)
    with picture(OUT, width=3.6) as axes:
        mapped.plot("die.x", ax=axes, label="die.x after 1 s [m]")


if __name__ == "__main__":
    main()
