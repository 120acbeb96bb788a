r"""A02: four-bars through their singular position
==============================================

One freedom, :math:`\ddot\theta = g \sin\theta \, (3 N + 1) / 2 \, / \, ((4 N + 1) / 3)`, N = 2. Where all bars
are in line each loop could fold, with N + 1 freedoms there (grey): the motion must pass it.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import carom

g, N, z = 9.81, 2, np.array([0.0, 0.0, 1.0])


def mechanism():
    scene, hinge = carom.Scene(gravity=(0, -g, 0)), carom.joints.Revolute
    bar = dict(mass=1.0, inertia=np.full(3, 1 / 12))
    swing = dict(velocity=(0.5, 0, 0), angular_velocity=-z)
    ups = [scene.add_body(position=(k, 0.5, 0), **swing, **bar) for k in range(N + 1)]
    for k in range(N + 1):
        scene.add_joint(hinge((k, 0, 0), z), carom.GROUND, ups[k])
    for k in range(N):
        across = scene.add_body(position=(k + 0.5, 1, 0), velocity=(1, 0, 0), **bar)
        scene.add_joint(hinge((k, 1, 0), z), ups[k], across)
        scene.add_joint(hinge((k + 1, 1, 0), z), ups[k + 1], across)
    return scene


def lean(t):
    factor = g * ((N + 1) / 2 + N) / ((N + 1) / 3 + N)
    rates = lambda t, y: [y[1], factor * np.sin(y[0])]  # noqa: E731
    return solve_ivp(rates, t[[0, -1]], [0, 1], "DOP853", t_eval=t, rtol=1e-13, atol=1e-13).y[0]


def main(out="out/examples"):
    print(mechanism().check())
    s = carom.simulate(mechanism(), 10.0, step=0.0025)
    theta, tip = lean(s.t), 2 * s.position[:, 0, :2]
    error = np.hypot(tip[:, 0] - np.sin(theta), tip[:, 1] - np.cos(theta))
    in_line = s.t[1:][np.diff(np.floor(theta / np.pi - 0.5)) > 0]
    energy, kept = np.abs(s.ledger.residual), np.max(s.constraint_errors)
    print(f"in line {len(in_line)} times; tip {np.max(error):.1e} m, energy {np.max(energy):.1e} J")
    print(f"constraints {kept:.1e} (m, rad, and a second)")
    figure = Figure(figsize=(6.5, 3), layout="constrained")
    place, wrong = figure.subplots(1, 2)
    place.plot(s.t, tip, label=["x", "y"], lw=1)
    place.set(xlabel="time [s]", ylabel="tip of the first bar [m]", ylim=(-1.1, 1.4))
    wrong.semilogy(s.t, np.stack([error, energy], axis=1), label=["tip [m]", "energy [J]"], lw=1)
    wrong.set(xlabel="time [s]", ylabel="error", ylim=(1e-12, 1e-6))
    for axes, top in ((place, 1.1), (wrong, 1e-7)):
        axes.vlines(in_line, axes.get_ylim()[0], top, color="0.8", lw=0.7, zorder=0)
        axes.legend(ncols=2, loc="upper center", frameon=False)
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "a02_four_bars.png", dpi=150)
    assert len(in_line) == 10
    assert np.max(error) < 1e-7
    assert kept < 1e-12


if __name__ == "__main__":
    main()
