r"""Painlevé's rod jams
===================

A rod that leans backwards is pushed over a rough table. With much friction there is no force at all with
which it could keep sliding: it jams, and its tip stops at once, in an impact without collision. Where this
happens, and the energy that it costs, are compared with their closed form.
"""

from itertools import product

import numpy as np

import carom
from carom.visual.plots.style import picture

g, length, m, v, radius = 9.81, 1.0, 1.0, 3.0, 1e-9
LOOK = dict(color="C0", marker="."), dict(color="C1", marker="x")

# %%
# The rod starts at the angle :math:`\theta` to the table, with the velocity v of its tip along the table. One
# short step shows what happens. `solution.warnings` says that it jams.


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


# %%
# Friction turns the rod into the table. If it does so faster than the normal force can lift the tip, no
# normal force, however large, lets the tip slide on (Painlevé, 1895). This is so for
#
# .. math:: \mu > \frac{1 + 3\cos^2\theta}{3 \sin\theta\cos\theta} \geq \frac{4}{3}.
#
# The tip then stops, and the loss of energy is :math:`\frac{1}{2} v^2 (W^{-1})_{tt}`, with the Delassus
# operator W.


def limit(theta):
    return (1 + 3 * np.cos(theta) ** 2) / (3 * np.sin(theta) * np.cos(theta))


def loss(theta):
    arm = np.array([np.cos(theta), np.sin(theta)])
    return np.linalg.inv((np.eye(2) + 3 * np.outer(arm, arm)) / m)[1, 1] * v**2 / 2


# %%
# Each point is a run: dots slide, crosses jam. The line is Painlevé's limit.


def main(out="out/examples"):
    lost = []
    with picture(f"{out}/painleve.png", columns=2, width_ratios=(1.3, 1)) as (left, right):
        for theta, mu in product(np.radians(np.arange(32, 89, 4)), np.arange(1.05, 3.0, 0.2)):
            run = slide(theta, mu)
            jams = "jams" in run.events.kind
            left.plot(np.degrees(theta), mu, **LOOK[jams])
            assert jams == (mu > limit(theta))
            if jams:
                lost.append((np.degrees(theta), -run.impacts.energy_change[0], loss(theta)))
        left.plot(fine := np.linspace(25, 87, 200), limit(np.radians(fine)), "k", lw=1)
        left.set(xlabel="angle / degrees", ylabel="friction coefficient")
        angle, found, exact = np.array(lost).T
        right.plot(angle, found, "C1x", label="carom")
        right.plot(angle, exact, "k", lw=0.8, label="closed form")
        right.set(xlabel="angle / degrees", ylabel="energy lost / J", ylim=(0, 4)), right.legend()
    print(f"{len(found)} jam; energy lost: error {(error := np.max(np.abs(found - exact))):.0e} J")
    assert error < 1e-7


if __name__ == "__main__":
    main()
