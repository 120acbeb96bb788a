r"""A01: the simple pendulum, and the order of each method
======================================================

A point mass on a rod without mass, released from the horizontal. Its angle is known in elliptic functions,
:math:`\sin(\theta/2) = k \, \mathrm{cd}(\sqrt{g/l}\, t;\, k)` with :math:`k = \sin(\theta_0/2)`, so the error
of every method and step can be measured: its slope is the order.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.special import ellipj

import carom

g, length = 9.81, 1.0
STEPS = 0.02 / 2.0 ** np.arange(6)


def exact(t):
    k = np.sin(np.pi / 4)
    _, cn, dn, _ = ellipj(np.sqrt(g / length) * t, k**2)
    theta = 2 * np.arcsin(k * cn / dn)
    return length * np.stack([-np.sin(theta), -np.cos(theta)], axis=-1)


def pendulum(step, method):
    scene = carom.Scene(gravity=(0, -g, 0))
    bob = scene.add_body(mass=1.0, inertia=[1, 1, 1], position=(-length, 0, 0), name="bob")
    rod = carom.joints.Distance((0, 0, 0), (-length, 0, 0))
    scene.add_joint(rod, carom.GROUND, bob, name="rod")
    rough = carom.Options(energy_tolerance=0.01)  # the longest steps of order 2
    return carom.simulate(scene, 10.0, step=step, method=method, options=rough)


def main(out="out/examples"):
    figure = Figure(figsize=(6.5, 3), layout="constrained")
    along, slopes = figure.subplots(1, 2)
    for method, mark in (("paper", "v"), ("rk4", "o"), ("rk5", "s"), ("rk8", "^")):
        runs = [pendulum(h, method) for h in STEPS]
        errors = [np.max(np.abs(s.position[:, 0, :2] - exact(s.t))) for s in runs]
        slopes.loglog(STEPS, errors, f"-{mark}", ms=4, lw=1, label=method)
        order = np.log2(errors[-2] / errors[-1]) if errors[-1] > 1e-12 else np.nan  # round-off
        drift = np.max(np.abs(runs[-1].ledger.residual))
        kept = max(np.max(e) for e in runs[-1].constraint_errors)
        print(f"{method:5} with {STEPS[-1] * 1e3} ms: error {errors[-1]:.1e} m, order {order:.2f}, "
              f"energy {drift:.1e} J, rod {kept:.1e} m and m/s")  # fmt: skip
        if method == "rk4":
            assert kept < 1e-12
            assert abs(order - 4.0) < 0.1
            assert errors[-1] < 1e-10
    along.plot(runs[-1].t, runs[-1].position[:, 0, :2], lw=1, label=["x", "y"])
    along.set(xlabel="time [s]", ylabel="place of the mass [m]")
    along.legend(ncols=2, loc="upper center", frameon=False)
    along.set_ylim(-1.1, 1.4)
    slopes.set(xlabel="step [s]", ylabel="greatest error in 10 s [m]")
    slopes.set_ylim(1e-14, 10)
    slopes.legend(ncols=4, loc="upper center", frameon=False, fontsize=7, columnspacing=0.8)
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "a01_pendulum.png", dpi=150)


if __name__ == "__main__":
    main()
