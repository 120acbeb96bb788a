r"""
Painleve's rod jams
===================

A rod that is pushed over a rough table, leaning backwards, may have no force at all that keeps it sliding: friction turns
it into the table faster than the normal force can lift it. That is so for :math:`\mu > (1 + 3\cos^2\theta)/(3 \sin\theta\cos\theta)`
(Painleve, 1895), at least 4/3. What then happens is an impact without collision: the tip stops dead, at a loss of
:math:`\frac{1}{2} v^2 (W^{-1})_{tt}`. Each point below is a run.
"""

from pathlib import Path

import numpy as np

import carom
from carom.paper import style

g, length, m, v, radius = 9.81, 1.0, 1.0, 3.0, 1e-9


def limit(theta):
    return (1 + 3 * np.cos(theta) ** 2) / (3 * np.sin(theta) * np.cos(theta))


def slide(theta, mu):
    scene = carom.Scene(gravity=(0, 0, -g))
    table = scene.add_half_space(point=(0, 0, -radius), normal=(0, 0, 1), name="table")
    half = (np.pi / 2 - theta) / 2
    rod = scene.add_body(
        carom.Capsule(radius, length), mass=m, inertia=3 * [m * length**2 / 12],
        position=length / 2 * np.array([np.cos(theta), 0, np.sin(theta)]), velocity=(-v, 0, 0),
        orientation=(np.cos(half), 0, np.sin(half), 0), name="rod",
    )  # fmt: skip
    scene.add_contact(rod, table, restitution=0.0, friction=mu)
    return carom.simulate(scene, 1e-4, step=1e-4)


def main(out="out/examples"):
    angles, loss = np.radians(np.arange(32, 89, 4)), []
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.8, columns=2, width_ratios=(1.3, 1))
        for theta in angles:
            c, s = length / 2 * np.cos(theta), length / 2 * np.sin(theta)
            I = m * length**2 / 12
            W = np.array([[1 / m + c * c / I, s * c / I], [s * c / I, 1 / m + s * s / I]])
            for mu in np.arange(1.05, 3.0, 0.2):
                run = slide(theta, mu)
                jams = "jams" in run.events.kind
                left.plot(
                    np.degrees(theta),
                    mu,
                    "x" if jams else "o",
                    ms=3,
                    color=style.RED if jams else style.BLUE,
                )
                assert jams == (mu > limit(theta))
                if jams:
                    loss.append(
                        (theta, -run.impacts.energy_change[0], v**2 * np.linalg.inv(W)[1, 1] / 2)
                    )
        fine = np.radians(np.linspace(25, 88, 200))
        left.plot(np.degrees(fine), limit(fine), "k", lw=1)
        left.set(
            xlabel="angle of the rod / degrees", ylabel="friction coefficient", ylim=(0.9, 3.1)
        )
        left.text(60, 2.32, "jams", color=style.RED, ha="center", backgroundcolor="w")
        left.text(60, 1.12, "slides", color=style.BLUE, ha="center", backgroundcolor="w")
        theta, found, exact = np.array(loss).T
        right.plot(np.degrees(theta), found, "x", color=style.RED, label="carom")
        right.plot(np.degrees(theta), exact, "k", lw=0.8, label="closed form")
        right.set(
            xlabel="angle of the rod / degrees", ylabel="energy lost in the jam / J", ylim=(0, 4)
        )
        right.legend()
    error = np.max(np.abs(found - exact))
    print(f"{len(found)} runs jam, those that must; energy lost: error {error:.0e} J")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "painleve.png", dpi=style.DPI)
    assert error < 1e-7


if __name__ == "__main__":
    main()
