r"""Painleve's rod jams
===================

A rod that is pushed over a rough table, leaning backwards, may have no force at all that keeps it sliding:
friction turns it into the table faster than the normal force can lift it. That is so for :math:`\mu > (1 +
3\cos^2\theta)/(3 \sin\theta\cos\theta)` (Painleve, 1895), at least 4/3. What then happens is an impact without
collision: the tip stops dead, at a loss of :math:`\frac{1}{2} v^2 (W^{-1})_{tt}`. Each point is a run.
"""

from itertools import product
from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

g, length, m, v, radius = 9.81, 1.0, 1.0, 3.0, 1e-9
LOOK = dict(color=style.BLUE, marker="."), dict(color=style.RED, marker="x")


def limit(theta):
    return (1 + 3 * np.cos(theta) ** 2) / (3 * np.sin(theta) * np.cos(theta))


def slide(theta, mu):
    scene, half = carom.Scene(gravity=(0, 0, -g)), (np.pi / 2 - theta) / 2
    table = scene.add_half_space(point=(0, 0, -radius), normal=(0, 0, 1))
    rod = scene.add_body(
        carom.Capsule(radius, length), mass=m, inertia=3 * [m * length**2 / 12],
        position=length / 2 * np.array([np.cos(theta), 0, np.sin(theta)]), velocity=(-v, 0, 0),
        orientation=(np.cos(half), 0, np.sin(half), 0),
    )  # fmt: skip
    scene.add_contact(rod, table, restitution=0.0, friction=mu)
    return carom.simulate(scene, 1e-4, step=1e-4)


def main(out="out/examples"):
    loss = []
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.8, columns=2, width_ratios=(1.3, 1))
        for theta, mu in product(np.radians(np.arange(32, 89, 4)), np.arange(1.05, 3.0, 0.2)):
            jams = "jams" in (run := slide(theta, mu)).events.kind
            left.plot(np.degrees(theta), mu, **LOOK[jams])
            assert jams == (mu > limit(theta))
            if jams:
                W = (np.eye(2) + 3 * np.outer(arm := [np.cos(theta), np.sin(theta)], arm)) / m
                exact = np.linalg.inv(W)[1, 1] * v**2 / 2
                loss.append((np.degrees(theta), -run.impacts.energy_change[0], exact))
        left.plot(fine := np.linspace(25, 87, 200), limit(np.radians(fine)), "k", lw=1)
        left.set(
            xlabel="angle / degrees", ylabel="friction coefficient", title="dots slide, crosses jam"
        )
        theta, found, exact = np.array(loss).T
        right.plot(theta, found, "x", color=style.RED, label="carom")
        right.plot(theta, exact, "k", lw=0.8, label="closed form")
        right.set(xlabel="angle / degrees", ylabel="energy lost / J", ylim=(0, 4)), right.legend()
    print(f"{len(found)} jam; energy lost: error {(error := np.max(np.abs(found - exact))):.0e} J")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "painleve.png", dpi=style.DPI)
    assert error < 1e-7


if __name__ == "__main__":
    main()
