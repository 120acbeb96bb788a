r"""A ball on a vibrating table doubles its period
==============================================

A motor (`Driver`) moves the table as :math:`A \sin \omega t`. A ball that strikes it once in each period does
so at the phase :math:`\cos\varphi = \pi \frac{1-e}{1+e} / \Gamma`, where :math:`\Gamma = A \omega^2 / g`, and
gives way to one of twice the period at :math:`\Gamma^2 = \pi^2 (\frac{1-e}{1+e})^2 + 4
(\frac{1+e^2}{(1+e)^2})^2` (Luo and Han, 1996). Varied is gravity: one compiled motion serves all runs.
"""

from pathlib import Path

import numba
import numpy as np

import carom
from carom.visual.plots import style

e, period, A = 0.5, 0.05, 1e-3
omega, loss = 2 * np.pi / period, np.pi * (1 - e) / (1 + e)
rough = carom.Options(energy_tolerance=0.1)  # the motor's work, in six steps a period
doubling = np.sqrt(loss**2 + (2 * (1 + e**2) / (1 + e) ** 2) ** 2)


@numba.njit
def motion(t):
    return A * np.sin(omega * t), A * omega * np.cos(omega * t), -A * omega**2 * np.sin(omega * t)


def phases(gamma):  # of the impacts in the last periods
    scene = carom.Scene(gravity=(0, 0, -(g := A * omega**2 / gamma)))
    low, high, fast, up = (0, 0, -0.01), (0, 0, 0.01), (0, 0, A * omega), (0, 0, 0.65 * g * period)
    table = scene.add_body(carom.Box(0.2, 0.2, 0.02), mass=1.0, position=low, velocity=fast)
    slide = scene.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, table)
    scene.add_constraint(carom.constraints.Driver(slide, motion=motion))
    ball = scene.add_body(carom.Sphere(0.01), mass=0.01, position=high, velocity=up)
    scene.add_contact(ball, table, restitution=e)
    s = carom.simulate(scene, 60 * period, step=period / 6, save_every=600, options=rough)
    return np.mod(omega * s.impacts.time[s.impacts.time > 36 * period], 2 * np.pi)


def main(out="out/examples"):
    gammas = np.concatenate([np.linspace(1.2, 1.5, 4), np.linspace(1.535, 2.0, 12)])
    found = [phases(gamma) for gamma in gammas]
    once = [abs(p[-1] - np.arccos(loss / gamma)) for gamma, p in zip(gammas[:3], found)]
    split = np.array([np.ptp(p[-2:]) > 0.05 for p in found])
    last, first = gammas[np.argmax(split) - 1], gammas[np.argmax(split)]
    print(f"error {max(once):.1e} rad; doubles at {last:.3f} to {first:.3f}, exact {doubling:.4f}")
    with style.style():
        figure, axes = style.new(style.PAGE, 2.8)
        for gamma, p in zip(gammas, found):
            axes.plot(0 * p + gamma, p, ".", color=style.BLUE)
        axes.plot(fine := np.linspace(loss, 2.1, 300), np.arccos(loss / fine), color=style.RED)
        axes.text(1.1, 0.8, "once a period, exact", color=style.RED)
        axes.axvline(doubling, color=style.GREY, ls="--", lw=0.8)
        axes.text(doubling - 0.01, 5.5, "period doubles, exact", ha="right", color=style.GREY)
        axes.set(xlabel=r"$\Gamma = A\omega^2/g$", ylabel="phase of impacts / rad", xlim=(1, 2.1))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "vibrating_table.png", dpi=style.DPI)
    assert max(once) < 1e-6
    assert last < doubling < first


if __name__ == "__main__":
    main()
