r"""A01: the simple pendulum, and the order of each method
======================================================

A point mass on a rod without mass falls from the horizontal. Its motion is known in closed form, so the error
of every method and of every step can be measured. On logarithmic axes the slope of the error is the order of
the method.
"""

import numpy as np
from scipy.special import ellipj

import carom
from carom.visual.plots.style import picture

g, length = 9.81, 1.0
STEPS = 0.02 / 2.0 ** np.arange(6)

# %%
# The rod is a `Distance` joint. The second-order method is not accurate with the longest steps, and the
# option says that we accept this.


def pendulum(step, method):
    scene = carom.Scene(gravity=(0, -g, 0))
    bob = scene.add_body(mass=1.0, inertia=[1, 1, 1], position=(-length, 0, 0), name="bob")
    rod = carom.joints.Distance((0, 0, 0), (-length, 0, 0))
    scene.add_joint(rod, carom.GROUND, bob, name="rod")
    rough = carom.Options(energy_tolerance=0.01)
    return carom.simulate(scene, 10.0, step=step, method=method, options=rough)


# %%
# From rest at :math:`\theta_0` the angle of the pendulum is an elliptic function of time:
#
# .. math:: \sin(\theta/2) = k \, \mathrm{cd}(\sqrt{g/l}\, t;\, k), \quad k = \sin(\theta_0/2).


def exact(t):
    k = np.sin(np.pi / 4)
    _, cn, dn, _ = ellipj(np.sqrt(g / length) * t, k**2)
    theta = 2 * np.arcsin(k * cn / dn)
    return length * np.stack([-np.sin(theta), -np.cos(theta)], axis=-1)


# %%
# Four methods, six steps each. The last two errors give the order, as long as they are above round-off. The
# rod keeps its length to round-off with every step.


def main(out="out/examples"):
    with picture(f"{out}/a01_pendulum.png", height=3.2) as axes:
        for method, mark in (("paper", "v"), ("rk4", "o"), ("rk5", "s"), ("rk8", "^")):
            runs = [pendulum(h, method) for h in STEPS]
            errors = [np.max(np.abs(s.position[:, 0, :2] - exact(s.t))) for s in runs]
            axes.loglog(STEPS, errors, f"-{mark}", label=method)
            order = np.log2(errors[-2] / errors[-1]) if errors[-1] > 1e-12 else np.nan
            drift = np.max(np.abs(runs[-1].ledger.residual))
            kept = max(np.max(e) for e in runs[-1].constraint_errors)
            print(f"{method:5} with {STEPS[-1] * 1e3} ms: error {errors[-1]:.1e} m, order {order:.2f}, "
                  f"energy {drift:.1e} J, rod {kept:.1e} m and m/s")  # fmt: skip
            if method == "rk4":
                assert kept < 1e-12
                assert abs(order - 4.0) < 0.1
                assert errors[-1] < 1e-10
        axes.set(xlabel="step / s", ylabel="greatest error in 10 s / m"), axes.legend()


if __name__ == "__main__":
    main()
