"""The page and the picture of "See it move": a die, a bar and a ball thrown into a corner.

Run ``python docs/pictures/throw.py`` to make ``docs/_static/throw.html`` and, where there is a chromium,
``docs/_static/throw.png``.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import carom

OUT = Path(__file__).parents[1] / "_static"


def throw() -> carom.Solution:
    """Return the motion."""
    scene = carom.Scene()
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    scene.add_half_space(point=(0, 0.25, 0), normal=(0, -1, 0), name="wall")
    scene.add_body(
        carom.Box(0.08, 0.08, 0.08, radius=0.008), density=600, position=(-0.15, -0.25, 0.25),
        velocity=(0.4, 1.6, 0.5), angular_velocity=(9, 4, 6), name="die",
    )  # fmt: skip
    scene.add_body(
        carom.Capsule(0.025, 0.16), density=900, position=(0.1, -0.1, 0.35),
        velocity=(-0.2, 0.8, 0), angular_velocity=(3, 7, 1), name="bar",
    )  # fmt: skip
    scene.add_body(
        carom.Sphere(0.05), density=500, position=(0.15, 0.1, 0.2), velocity=(-0.9, 0.3, 1.0),
        angular_velocity=(0, -10, 4), name="ball",
    )  # fmt: skip
    scene.set_contact_default(restitution=0.6, friction=0.3)
    return carom.simulate(scene, duration=0.8, step=2e-3)


def main() -> None:
    """Make the page and the picture."""
    solution = throw()
    print(solution)
    page = OUT / "throw.html"
    print(carom.view(solution, export=page, title="Thrown into a corner"))
    chromium = shutil.which("chromium")
    if chromium is not None:
        subprocess.run(
            [chromium, "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--window-size=1200,800", "--hide-scrollbars",
             "--virtual-time-budget=4000", f"--screenshot={OUT / 'throw.png'}",
             f"{page.as_uri()}#impact=3"],
            check=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
