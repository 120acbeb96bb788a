"""Gradients: measure a bounce, aim a throw
========================================

How must a die be thrown so that it reaches a target after two bounces? And which restitution and which
friction did a measured bounce have? Both need the derivatives of a run, the times of its impacts included.
With them, a few runs are enough. The first answer is checked against the noise of the measurement, the second
to round-off.
"""

import numpy as np
from scipy.optimize import least_squares

import carom
from carom.visual.plots.style import picture


def throw(velocity, e, mu, duration):
    scene = carom.Scene()
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.2), velocity=velocity,
        orientation=np.array([1, -1, 4, -1]) / np.sqrt(19), angular_velocity=(-4, 0, -12), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=e, friction=mu)
    return carom.simulate(scene, duration, step=1e-3)


# %%
# The "measured" bounce is a run with e = 0.5 and mu = 0.2, with noise of half a millimetre.
# `carom.sensitivities` gives the derivatives of all places by e and mu, and the least squares of SciPy use
# them.


def measure(v, axes, noise=5e-4):
    t = np.linspace(0, 0.2, 41)
    seen = throw(v, 0.5, 0.2, 0.2).evaluate(t)[0][:, 0]
    seen += noise * np.random.default_rng(0).normal(size=seen.shape)

    def misses(p):
        return (throw(v, *p, 0.2).evaluate(t)[0][:, 0] - seen).ravel()

    def jacobian(p):
        found = carom.sensitivities(throw(v, *p, 0.2), ("restitution", "friction"))
        return found.evaluate(t).position[:, 0].reshape(-1, 2)

    fit = least_squares(misses, (0.8, 0.05), jacobian, bounds=([0, 0], [1, 2]))
    (e, mu), error = fit.x, noise * np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))
    print(f"e = {e:.3f} +- {error[0]:.3f}, mu = {mu:.3f} +- {error[1]:.3f}, after {fit.nfev} runs")
    axes.plot(*seen[:, [0, 2]].T, "k.", label="measured")
    for name, p in (("start of the fit", (0.8, 0.05)), ("fitted", fit.x)):
        axes.plot(*throw(v, *p, 0.2).position[:, 0, [0, 2]].T, label=name)
    assert np.all(np.abs(fit.x - [0.5, 0.2]) < 4 * error)


# %%
# To aim, Newton's method changes the velocity of the throw by the derivatives of the last place. The target
# is reached 0.258 s after the throw.


def aim(v, axes):
    target = np.array([0.22, 0.05, 0.03])
    for k in range(5):
        run = throw(v, 0.5, 0.2, 0.258)
        miss = target - run.position[-1, 0]
        print(f"throw {k}: v = {v.round(4)} m/s, misses by {np.linalg.norm(miss):.1e} m")
        axes.plot(*run.position[:, 0, [0, 2]].T, zorder=-k, label=f"throw {k}" if k < 3 else None)
        v = v + np.linalg.solve(carom.sensitivities(run, "die.velocity").final.position[0], miss)
    axes.plot(*target[[0, 2]], "k+", ms=12, label="target")
    assert np.linalg.norm(miss) < 1e-12


# %%
# Left the measured bounce and the fit, right the throws. The third throw already hits.


def main(out="out/examples"):
    with picture(f"{out}/aim_a_throw.png", columns=2) as panels:
        for axes, task in zip(panels, (measure, aim)):
            task(np.array([0.5, 0.0, -0.5]), axes)
            axes.set(xlabel="x / m", ylabel="z / m"), axes.legend()


if __name__ == "__main__":
    main()
