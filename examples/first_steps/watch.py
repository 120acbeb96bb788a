"""A page that plays a run
=======================

A ball with backspin falls on a green, bounces, and comes back. `carom.view` writes a page that plays the run
in any browser: turn it with the mouse, stop it at an impact. The arrow of the first impulse is compared with
its closed form.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots.style import RED, picture

mass, radius, e, mu = 0.046, 0.0214, 0.7, 0.3

# %%
# The ball flies to the right, with a fast spin backwards.


def throw():
    scene = carom.Scene()
    green = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="green")
    ball = scene.add_body(
        carom.Sphere(radius), mass=mass, position=(0, 0, 0.5), velocity=(1.0, 0, 0),
        angular_velocity=(0, -400, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(ball, green, restitution=e, friction=mu)
    return carom.simulate(scene, 2.0, step=2e-3)


# %%
# A ball that slips through the whole impact gets the impulse :math:`P (n - \mu s)`. Here
# :math:`P = m (1 + e) |v_n|`, n is the normal, and s is the direction of slip. The change of momentum in the
# run must be this impulse. In the picture the impulses are red lines.


def main(out="out/examples"):
    first = (s := throw()).impacts[0]
    before, after = (s.evaluate(first.time, side)[2][0] for side in ("left", "right"))
    P = mass * (1 + e) * -before[2]
    error = np.max(np.abs(mass * (after - before) - P * np.array([-mu, 0, 1])))
    print(f"impulse {P:.6f} N s, error {error:.0e}; in the end {s.velocity[-1, 0, 0]:+.3f} m/s")

    with picture(f"{out}/watch.png") as axes:
        s.plot("trajectory", ax=axes)
        axes.set(aspect="auto", ylim=(-0.06, 0.85))
        (x, _, z), (push, along) = s.impacts.point.T, s.impacts.impulse[:, :2].T
        axes.plot([x, x + 2 * along], [z, z + 2 * push], color=RED)
    written = carom.view(s, export=Path(out) / "watch.html", title="Backspin", speed=0.5)
    print(written)
    assert error < 1e-12
    assert s.velocity[-1, 0, 0] < 0 < before[0], "it comes back"
    assert written.size < 300_000


if __name__ == "__main__":
    main()
