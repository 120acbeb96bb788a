"""A break at pool
===============

The cue ball strikes fifteen balls that lie a tenth of a radius apart. Many impacts follow, each at its own
instant. The table is symmetric, so the two halves must stay mirror images to the end, although small errors
grow at each impact. Momentum and restitution are checked as well.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

r, m, e, size = 0.0286, 0.17, 0.95, np.array([1.27, 0.635])  # half the table

# %%
# We look at the table from above, so there is no gravity in the plane. The cushions are four half-spaces. All
# contacts have the restitution e and no friction.


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


# %%
# Three numbers are checked. The places of all balls must be the same after a reflection at the x axis. Each
# impact leaves the part e of the normal velocity. The momentum is constant until a ball reaches a cushion. In
# the picture mirror images are red and blue, at the end of their paths.


def main(out="out/examples"):
    s = carom.simulate(table(), 1.6, step=2e-3)
    y, hit = s.position[:, 1:, 1], s.impacts
    mirror = np.max(np.abs(np.sort(y, axis=1) - np.sort(-y, axis=1)))
    restitution = np.abs(hit.relative_velocity_after + e * hit.relative_velocity_before)[:, 0].max()
    p = m * s.velocity.sum(axis=1)
    n = np.argmax(np.max(np.abs(s.position[:, :, :2]) - size, axis=(1, 2)) > -2 * r)  # a cushion
    kept = np.max(np.abs(p[:n] - p[0])) / p[0, 0]
    print(
        f"{len(hit)} impacts, restitution to {restitution:.0e} m/s, mirror images to {mirror:.0e} m"
    )
    print(f"momentum kept to {kept:.0e}, until the first cushion ({s.t[n]:.2f} s)")

    with picture(f"{out}/billiard_break.png", height=3.6) as axes:
        side = np.sign(s.position[0, :, 1].round(9))
        for sign, colour in ((1, "C1"), (0, "0.6"), (-1, "C0")):
            x, y = s.position[:, side == sign, :2].T
            axes.plot(x.T, y.T, colour, lw=0.8)
            axes.plot(x[:, -1], y[:, -1], "o", color=colour, mec="k", ms=4)
        axes.set(xlabel="x / m", ylabel="y / m", aspect="equal")
        axes.set(xlim=(-size[0], size[0]), ylim=(-size[1], size[1]))
    assert max(restitution, kept, mirror) < 1e-9


if __name__ == "__main__":
    main()
