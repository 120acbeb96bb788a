r"""
A ball on a vibrating table doubles its period
==============================================

A motor (`Driver`) moves the table as :math:`A \sin \omega t`. A ball that strikes it once in each period does so at
the phase :math:`\cos\varphi = \pi \frac{1-e}{1+e} / \Gamma`, where :math:`\Gamma = A \omega^2 / g`, and gives way to one of
twice the period at :math:`\Gamma^2 = \pi^2 (\frac{1-e}{1+e})^2 + 4 (\frac{1+e^2}{(1+e)^2})^2` (Luo and Han, 1996). Gravity
is what is varied here, so that one compiled motion of the table serves all runs.
"""

from pathlib import Path

import numba
import numpy as np

import carom
from carom.paper import style

e, period, A = 0.5, 0.05, 1e-3
omega, loss = 2 * np.pi / period, np.pi * (1 - e) / (1 + e)
doubling = np.sqrt(loss**2 + (2 * (1 + e**2) / (1 + e) ** 2) ** 2)


@numba.njit
def motion(t):
    s, c = A * np.sin(omega * t), A * np.cos(omega * t)
    return s, omega * c, -(omega**2) * s


def phases(gamma, count):
    """Phases of the impacts in the last `count` of 60 periods."""
    g = A * omega**2 / gamma
    scene = carom.Scene(gravity=(0, 0, -g))
    table = scene.add_body(
        carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, -0.01), velocity=(0, 0, A * omega)
    )
    slide = scene.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, table)
    scene.add_constraint(carom.constraints.Driver(slide, motion=motion))
    up = dict(position=(0, 0, 0.01), velocity=(0, 0, 1.3 * g * period / 2))
    ball = scene.add_body(carom.Sphere(0.01), mass=0.01, **up)
    scene.add_contact(ball, table, restitution=e)
    t = carom.simulate(scene, 60 * period, step=period / 6, save_every=600).impacts.time
    return np.mod(omega * t[t > (60 - count) * period], 2 * np.pi)


def main(out="out/examples"):
    gammas = np.concatenate([np.linspace(1.2, 1.5, 4), np.linspace(1.535, 2.0, 12)])
    found = [phases(gamma, 24) for gamma in gammas]
    once = [abs(p[-1] - np.arccos(loss / gamma)) for gamma, p in zip(gammas[:3], found)]
    split = np.array([np.ptp(p[-2:]) for p in found])
    first = gammas[split > 0.05][0]
    print(f"phase of the regular motion: error {max(once):.1e} rad")
    print(f"two impacts differ from Gamma = {first:.3f} on; exact {doubling:.4f}")

    with style.style():
        figure, axes = style.new(style.PAGE, 2.8)
        for gamma, p in zip(gammas, found):
            axes.plot(np.full(len(p), gamma), p, ".", color=style.BLUE, ms=3)
        fine = np.linspace(loss, 2.08, 300)
        axes.plot(fine, np.arccos(loss / fine), color=style.RED, lw=0.8)
        axes.annotate("once a period, exact", (1.25, 0.57), (1.1, 1.5), color=style.RED)
        axes.axvline(doubling, color=style.GREY, ls="--", lw=0.8)
        axes.text(doubling - 0.01, 5.5, "period doubles, exact", ha="right", color=style.GREY)
        axes.set(xlabel=r"acceleration of the table $\Gamma = A\omega^2/g$", xlim=(1.03, 2.08))
        axes.set(ylabel="phase of the impacts / rad")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "vibrating_table.png", dpi=style.DPI)
    assert max(once) < 1e-6
    assert gammas[np.flatnonzero(gammas == first)[0] - 1] < doubling < first


if __name__ == "__main__":
    main()
