r"""Chaplygin's sleigh turns its spin into speed
============================================

A sleigh stands on one blade, which may not move sideways: a nonholonomic constraint. With the mass centre in
front of the blade the spin dies out, and all of its energy becomes velocity along the blade. Both are
compared with their closed form (Chaplygin, 1911).
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

m, I, a, spin = 1.0, 1.0, 1.0, 1.0

# %%
# A `Planar` joint keeps the sleigh level. A `KnifeEdge` is the blade, at the distance a behind the mass
# centre. The sleigh starts with spin alone.


def slide():
    scene = carom.Scene()
    sleigh = scene.add_body(
        carom.Box(2.0, 0.5, 0.1), mass=m, inertia=(I, I, I), position=(a, 0, 0),
        velocity=(0, a * spin, 0), angular_velocity=(0, 0, spin), name="sleigh",
    )  # fmt: skip
    scene.add_joint(carom.joints.Planar((0, 0, 1)), carom.GROUND, sleigh)
    scene.add_joint(carom.joints.KnifeEdge((0, 0, 0), (1, 0, 0)), carom.GROUND, sleigh)
    print(scene.check())
    return carom.simulate(scene, 6.0, step=0.01)


# %%
# With :math:`k^2 = a^2 + I/m` and c = k times the first spin, velocity along the blade and spin are
#
# .. math:: u = c \tanh (a c t / k^2), \quad \omega = (c / k) / \cosh (a c t / k^2).


def exact(t):
    k2 = a**2 + I / m
    c = np.sqrt(k2) * spin
    return c * np.tanh(a * c * t / k2), c / np.sqrt(k2) / np.cosh(a * c * t / k2)


# %%
# The velocity along the blade follows from the velocity of the mass centre and the heading.


def main(out="out/examples"):
    s = slide()
    heading = 2 * np.arctan2(s.orientation[:, 0, 3], s.orientation[:, 0, 0])
    speed = np.cos(heading) * s.velocity[:, 0, 0] + np.sin(heading) * s.velocity[:, 0, 1]
    found = np.stack([speed, s.angular_velocity[:, 0, 2]], axis=1)
    true = np.stack(exact(s.t), axis=1)
    error = np.max(np.abs(found - true))
    print(f"velocity and spin: error {error:.1e}; energy kept to {np.ptp(s.total_energy):.1e} J")

    with picture(f"{out}/sleigh.png", columns=2, width_ratios=(1.1, 1)) as (left, right):
        s.plot("trajectory", plane="xy", outlines=7, ax=left)
        right.plot(s.t, found, label=["velocity / m s$^{-1}$", "spin / rad s$^{-1}$"])
        right.plot(s.t[::50], true[::50], "k.")
        right.set(xlabel="time / s"), right.legend(title="lines: carom, dots: closed form")
    assert error < 1e-8


if __name__ == "__main__":
    main()
