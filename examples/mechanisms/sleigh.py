r"""Chaplygin's sleigh turns its spin into speed
============================================

A sleigh that stands on one blade may not go sideways there: a nonholonomic constraint. With the mass centre
ahead of the blade the spin dies out, and all of its energy becomes speed along the blade (Chaplygin, 1911):

.. math:: u = c \tanh (a c t / k^2), \quad \omega = (c / k) / \cosh (a c t / k^2), \quad k^2 = a^2 + I/m.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

m, I, a, spin = 1.0, 1.0, 1.0, 1.0


def main(out="out/examples"):
    scene = carom.Scene()  # gravity has nothing to do: it is held level
    sleigh = scene.add_body(
        mass=m, inertia=(I, I, I), position=(a, 0, 0), velocity=(0, a * spin, 0),
        angular_velocity=(0, 0, spin), name="sleigh",
    )  # fmt: skip
    scene.add_joint(carom.joints.Planar((0, 0, 1)), carom.GROUND, sleigh)
    scene.add_joint(carom.joints.KnifeEdge((0, 0, 0), (1, 0, 0)), carom.GROUND, sleigh)
    s = carom.simulate(scene, 6.0, step=0.01)

    k2 = a**2 + I / m
    c = np.sqrt(k2) * spin
    u, w = c * np.tanh(a * c * s.t / k2), c / np.sqrt(k2) / np.cosh(a * c * s.t / k2)
    heading = 2 * np.arctan2(s.orientation[:, 0, 3], s.orientation[:, 0, 0])
    along = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    speed = np.sum(s.velocity[:, 0, :2] * along, axis=1)
    error = max(np.max(np.abs(speed - u)), np.max(np.abs(s.angular_velocity[:, 0, 2] - w)))
    print(scene.check())
    print(f"speed and spin: error {error:.1e}; energy kept to {np.ptp(s.total_energy):.1e} J")

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.6, columns=2)
        blade = s.position[:, 0, :2] - a * along
        left.plot(*blade.T, color=style.BLUE)
        for i in range(0, len(s.t), 75):
            left.plot(*np.stack([blade[i], s.position[i, 0, :2]]).T, "k", lw=0.7)
            left.plot(*s.position[i, 0, :2], "o", color=style.RED)
        left.set(xlabel="x / m", ylabel="y / m", aspect="equal")
        left.text(0.4, 2.2, "blade ", color=style.BLUE, ha="right")
        spins = s.angular_velocity[:, 0, 2]
        both = ("speed / m s$^{-1}$", speed, u, "k"), ("spin / rad s$^{-1}$", spins, w, style.RED)
        for name, found, true, colour in both:
            right.plot(s.t, found, color=colour, label=name)
            right.plot(s.t[::50], true[::50], ".", color=colour)
        right.set(xlabel="time / s"), right.legend(title="lines: carom, dots: closed form")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "sleigh.png", dpi=style.DPI)
    assert error < 1e-8


if __name__ == "__main__":
    main()
