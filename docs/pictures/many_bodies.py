"""The picture of the page on many bodies: a wall, a break and a robot, each at three times.

Run ``python docs/pictures/many_bodies.py`` to make ``docs/_static/many_bodies.png``.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import carom
from carom.visual.films.stage import Stage

HERE = Path(__file__).parents[1]
OUT = HERE / "_static" / "many_bodies.png"
HUMANOID = HERE.parent / "tests" / "data" / "models" / "dm_control" / "humanoid.xml"
SIZE, G = (640, 440), 9.81


def wall():
    """Return a ball of 20 kg on a rod of 2 m that swings into twelve bricks without mortar."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for row in range(4):
        for place in range(3):
            y = (place + 0.5 * (row % 2) - 1) * 0.2001
            scene.add_body(carom.Box(0.1, 0.2, 0.1), mass=3.0, position=(0, y, (row + 0.5) * 0.1))
    ball = scene.add_body(
        carom.Sphere(0.1), mass=20.0, position=(-0.5, 0, 0.25),
        velocity=(3, 0, 0), angular_velocity=(0, -1.5, 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.Spherical(anchor=(-0.5, 0, 2.25)), carom.GROUND, ball)
    scene.set_contact_default(restitution=0.1, friction=0.6)
    return scene, 1.0, (0.08, 0.3, 1.0), ((0.2, 0, 0.15), 2.1)


def broken():
    """Return fifteen balls on a table, 10 micrometres apart, that a cue ball strikes at 8 m/s."""
    scene, r = carom.Scene(gravity=(0, 0, -G)), 0.0286
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(5):
        for j in range(i + 1):
            place = (i * np.sqrt(3) * (r + 5e-6), (2 * j - i) * (r + 5e-6), r)
            scene.add_body(carom.Sphere(r), mass=0.17, position=place)
    scene.add_body(carom.Sphere(r), mass=0.17, position=(-0.3, 0.005, r), velocity=(8, 0, 0))
    scene.set_contact_default(restitution=0.95, friction=0.1)
    return scene, 0.2, (0.0, 0.05, 0.2), ((0.05, 0, 0), 1.15)


def robot():
    """Return a humanoid of dm_control that falls."""
    scene = carom.load_model(HUMANOID, restitution=0.3).scene
    return scene, 1.0, (0.0, 0.45, 1.0), None


def main() -> None:
    """Simulate all three, and draw them."""
    fig, axes = plt.subplots(3, 3, figsize=(9.6, 6.9), layout="constrained")
    for row, make in zip(axes, (wall, broken, robot)):
        scene, duration, times, seen = make()
        solution = carom.simulate(scene, duration, step=1e-3)
        print(make.__name__, solution.message)
        stage = Stage(solution, size=SIZE, view="top" if make is broken else "oblique")
        if seen is not None:
            stage.camera = stage.camera._replace(centre=np.array(seen[0]), distance=seen[1])
        for ax, t in zip(row, times):
            ax.imshow(stage.draw(t, clock=False), interpolation="lanczos")
            ax.set_axis_off()
            ax.set_title(f"{t:g} s", fontsize=9, color="0.3", pad=2)
    fig.savefig(OUT, dpi=150)


if __name__ == "__main__":
    main()
