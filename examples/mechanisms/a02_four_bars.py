r"""A02: four-bars through their singular position
==============================================

Parallelograms of bars move with one freedom. But where all bars are in line, each loop could fold: at this
instant there are more freedoms, and a run can fail or take a wrong branch. Here it passes this position ten
times, and is compared with the motion of one coordinate.
"""

import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom.visual.plots.style import picture

g, N, z = 9.81, 2, np.array([0.0, 0.0, 1.0])

# %%
# N loops have N + 1 upright bars and N bars across. All have a mass of 1 kg and a length of 1 m.


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


# %%
# The angle of the upright bars is the one coordinate. Its equation is that of a pendulum,
#
# .. math:: \ddot\theta = g \sin\theta \; \frac{(3 N + 1) / 2}{(4 N + 1) / 3},
#
# which SciPy integrates to nearly round-off.


def lean(t):
    factor = g * ((N + 1) / 2 + N) / ((N + 1) / 3 + N)
    rates = lambda t, y: [y[1], factor * np.sin(y[0])]  # noqa: E731
    return solve_ivp(rates, t[[0, -1]], [0, 1], "DOP853", t_eval=t, rtol=1e-13, atol=1e-13).y[0]


# %%
# We compare the tip of the first bar. Grey lines are the instants at which all bars are in line; no error
# jumps there.


def main(out="out/examples"):
    print(mechanism().check())
    s = carom.simulate(mechanism(), 10.0, step=0.0025)
    theta, tip = lean(s.t), 2 * s.position[:, 0, :2]
    error = np.hypot(tip[:, 0] - np.sin(theta), tip[:, 1] - np.cos(theta))
    in_line = s.t[1:][np.diff(np.floor(theta / np.pi - 0.5)) > 0]
    energy, kept = np.abs(s.ledger.residual), np.max(s.constraint_errors)
    print(f"in line {len(in_line)} times; tip {np.max(error):.1e} m, energy {np.max(energy):.1e} J")
    print(f"constraints {kept:.1e} (m, rad, and a second)")
    with picture(f"{out}/a02_four_bars.png", columns=2) as (place, wrong):
        place.plot(s.t, tip, label=["x", "y"])
        place.set(xlabel="time / s", ylabel="tip of the first bar / m", ylim=(-1.1, 1.4))
        wrong.semilogy(s.t, np.stack([error, energy], axis=1), label=["tip / m", "energy / J"])
        wrong.set(xlabel="time / s", ylabel="error", ylim=(1e-12, 1e-6))
        for axes in (place, wrong):
            axes.vlines(in_line, *axes.get_ylim(), color="0.8", lw=0.7, zorder=0)
            axes.legend(ncols=2, loc="upper center")
    assert len(in_line) == 10
    assert np.max(error) < 1e-7
    assert kept < 1e-12


if __name__ == "__main__":
    main()
