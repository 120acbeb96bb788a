"""A break at pool
===============

The cue ball strikes fifteen balls that lie a tenth of a radius apart. Each impact that follows has its own
instant, and those of mirror images the same one: so the two halves of the table stay mirror images, momentum is
kept until the first cushion, and each impact leaves 95 % of the speed at which it came.
"""

from pathlib import Path

import numpy as np
from matplotlib.patches import Circle

import carom
from carom.visual.plots import style

r, m, e, size = 0.0286, 0.17, 0.95, np.array([1.27, 0.635])  # half the table


def table():
    scene, apart = carom.Scene(gravity=(0, 0, 0)), 2.1 * r
    scene.add_body(carom.Sphere(r), mass=m, position=(-0.6, 0, 0), velocity=(7, 0, 0), name="cue")
    for row in range(5):
        for k in range(row + 1):
            place = (0.6 + row * apart * np.sqrt(3) / 2, (k - row / 2) * apart, 0)
            scene.add_body(carom.Sphere(r), mass=m, position=place)
    for k, half in enumerate(size):
        for side in (-1, 1):
            scene.add_half_space(side * half * np.eye(3)[k], -side * np.eye(3)[k])
    scene.set_contact_default(restitution=e)
    return scene


def main(out="out/examples"):
    s = carom.simulate(table(), 1.6, step=2e-3)
    y = s.position[:, 1:, 1]
    mirror = np.max(np.abs(np.sort(y, axis=1) - np.sort(-y, axis=1)))
    hit = s.impacts
    restitution = np.abs(hit.relative_velocity_after + e * hit.relative_velocity_before)[:, 0].max()
    p = m * s.velocity.sum(axis=1)
    n = np.argmax(np.max(np.abs(s.position[:, :, :2]) - size, axis=(1, 2)) > -2 * r)  # a cushion
    kept = np.max(np.abs(p[:n] - p[0])) / p[0, 0]
    print(
        f"{len(hit)} impacts, each with e = {e} to {restitution:.0e} m/s; mirror images to {mirror:.0e} m"
    )
    print(f"momentum kept to {kept:.0e}, until the first cushion ({s.t[n]:.2f} s)")

    with style.style():
        figure, axes = style.new(style.PAGE, 3.6)
        for k in range(16):
            side = np.sign(s.position[0, k, 1].round(9)) if k else 2
            colour = {2: "k", 1: style.RED, 0: style.GREY, -1: style.BLUE}[side]
            axes.plot(*s.position[:, k, :2].T, color=colour, lw=0.8)
            axes.add_patch(Circle(s.position[0, k, :2], r, fc="w", ec="0.7", lw=0.6))
            axes.add_patch(Circle(s.position[-1, k, :2], r, fc=colour, ec="k", lw=0.6, zorder=3))
        axes.set(xlim=(-size[0], size[0]), ylim=(-size[1], size[1]))
        axes.set(aspect="equal", xlabel="x / m", ylabel="y / m")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "billiard_break.png", dpi=style.DPI)
    assert max(restitution, kept, mirror) < 1e-9


if __name__ == "__main__":
    main()
