r"""A ball on a vibrating table doubles its period
==============================================

A ball bounces on a table that moves up and down. At small accelerations it strikes the table once in each
period. At a larger one its period doubles: the first step towards chaos. The phase of the impacts and the
acceleration of the doubling are compared with their closed forms.
"""

import numba
import numpy as np

import carom
from carom.visual.plots.style import picture

e, period, A = 0.5, 0.05, 1e-3
omega, loss = 2 * np.pi / period, np.pi * (1 - e) / (1 + e)
rough = carom.Options(energy_tolerance=0.1)  # the motor's work, in six steps a period

# %%
# A motor (`Driver`) moves the table as :math:`A \sin \omega t`. The function returns place, velocity and
# acceleration.


@numba.njit
def motion(t):
    return A * np.sin(omega * t), A * omega * np.cos(omega * t), -A * omega**2 * np.sin(omega * t)


# %%
# The ratio :math:`\Gamma = A \omega^2 / g` is varied by gravity, so that one compiled motion serves all runs.
# We return the phases of the impacts in the last periods, after the ball has settled.


def phases(gamma):
    scene = carom.Scene(gravity=(0, 0, -(g := A * omega**2 / gamma)))
    low, high, fast, up = (0, 0, -0.01), (0, 0, 0.01), (0, 0, A * omega), (0, 0, 0.65 * g * period)
    table = scene.add_body(carom.Box(0.2, 0.2, 0.02), mass=1.0, position=low, velocity=fast)
    slide = scene.add_joint(carom.joints.Prismatic((0, 0, 1)), carom.GROUND, table)
    scene.add_constraint(carom.constraints.Driver(slide, motion=motion))
    ball = scene.add_body(carom.Sphere(0.01), mass=0.01, position=high, velocity=up)
    scene.add_contact(ball, table, restitution=e)
    s = carom.simulate(scene, 60 * period, step=period / 6, save_every=600, options=rough)
    return np.mod(omega * s.impacts.time[s.impacts.time > 36 * period], 2 * np.pi)


# %%
# A ball that strikes once in each period does so at the phase
# :math:`\cos\varphi = \pi \frac{1-e}{1+e} / \Gamma`. This motion loses its stability (Luo and Han, 1996) at
#
# .. math:: \Gamma^2 = \pi^2 \left(\frac{1-e}{1+e}\right)^2 + 4 \left(\frac{1+e^2}{(1+e)^2}\right)^2 .

doubling = np.sqrt(loss**2 + (2 * (1 + e**2) / (1 + e) ** 2) ** 2)

# %%
# Each dot is an impact. Where one branch becomes two, the period has doubled.


def main(out="out/examples"):
    gammas = np.concatenate([np.linspace(1.2, 1.5, 4), np.linspace(1.535, 2.0, 12)])
    found = [phases(gamma) for gamma in gammas]
    once = [abs(p[-1] - np.arccos(loss / gamma)) for gamma, p in zip(gammas[:3], found)]
    split = np.array([np.ptp(p[-2:]) > 0.05 for p in found])
    last, first = gammas[np.argmax(split) - 1], gammas[np.argmax(split)]
    print(f"error {max(once):.1e} rad; doubles at {last:.3f} to {first:.3f}, exact {doubling:.4f}")
    with picture(f"{out}/vibrating_table.png", height=2.8) as axes:
        for gamma, p in zip(gammas, found):
            axes.plot(0 * p + gamma, p, "C0.")
        axes.plot(fine := np.linspace(loss, 2.1, 300), np.arccos(loss / fine), "C1", label="once")
        axes.axvline(doubling, color="0.6", ls="--", label="doubling")
        axes.set(xlabel=r"$\Gamma = A\omega^2/g$", ylabel="phase of impacts / rad", xlim=(1, 2.1))
        axes.legend(title="closed form")
    assert max(once) < 1e-6
    assert last < doubling < first


if __name__ == "__main__":
    main()
