"""The page of a run in the tutorial "Many bodies": a ball strikes a wall.

Run ``python docs/pictures/wall.py`` to make ``docs/_static/wall.html``.
"""

from __future__ import annotations

from pathlib import Path

import carom

OUT = Path(__file__).parents[1] / "_static"


def wall() -> carom.Scene:
    """Return twelve bricks, and a ball of 20 kg that flies towards them."""
    scene = carom.Scene()
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    for row in range(4):
        for place in range(3):
            x = 0.2 * (place - 1 + 0.5 * (row % 2))
            scene.add_body(carom.Box(0.2, 0.1, 0.1), mass=3, position=(x, 0, 0.1 * (row + 0.5)))
    scene.set_contact_default(restitution=0.1, friction=0.6)
    scene.add_body(
        carom.Sphere(0.12), mass=20, position=(0.05, -0.6, 0.3), velocity=(0, 4, 0.5), name="ball"
    )
    return scene


def main() -> None:
    """Make the page."""
    solution = carom.simulate(wall(), duration=0.8, step=2e-3, save_at=0.01)
    print(solution)
    print(carom.view(solution, export=OUT / "wall.html", title="A ball strikes a wall"))


if __name__ == "__main__":
    main()
