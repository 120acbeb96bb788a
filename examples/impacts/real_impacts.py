r"""Real impacts of a real cube
===========================

A cube was tossed many times, and its motion was measured. For the first impact of each toss, three laws of
restitution predict the velocity after it. The errors of these predictions are shown, with nominal and with
fitted restitution e and friction mu.
"""

import numpy as np

import carom
from carom.paper import real
from carom.visual.plots.style import picture

m, J, g = real.MASS, real.INERTIA, real.GRAVITY
M_inverse = np.diag(1 / np.array([m, m, m, J, J, J]))

# %%
# In each of these impacts one corner strikes. The Delassus operator :math:`W = G M^{-1} G^T` and the velocity
# :math:`u = G v` of the corner come from the measured state before. `carom.resolve_impact` gives the impulse
# P, and then :math:`v^+ = v + M^{-1} G^T P`. Gravity acts until the next measured sample.


def after(tosses, e, mu, law):
    v = tosses.before.copy()
    for k, G in enumerate(tosses.jacobian):
        W, u = G @ M_inverse @ G.T, G @ v[k]
        v[k] += M_inverse @ G.T @ carom.resolve_impact(W, u, mu, e, law).impulse
    v[:, 2] -= g * tosses.flight
    return v


# %%
# We print the medians of the error for three laws, and, to compare, those of a prediction without any impact.
# How the measured data are prepared is written in `carom.paper.real`.


def main(out="out/examples"):
    tosses = real.load()
    print(f"{len(tosses.toss)} impacts; medians of the error after the impact")
    with picture(f"{out}/real_impacts.png", height=3.4, width=3.4) as axes:
        for law in ("newton", "poisson", "stronge"):
            for name, (e, mu) in (("nominal", real.NOMINAL), ("fitted", real.fit(law))):
                predicted = after(tosses, e, mu, law)
                dv, dw = real.medians(predicted)
                print(f"{law:8} {name:8} e = {e:.3f}, mu = {mu:.3f}: {dv:.3f} m/s, {dw:.2f} rad/s")
                if law == "stronge":
                    axes.plot(tosses.after[:, 2], predicted[:, 2], ".", ms=2.5, label=name)
        axes.axline((0, 0), slope=1, color="k", lw=0.5)
        axes.set(xlabel="measured $v_z$ / m s$^{-1}$", ylabel="predicted $v_z$ / m s$^{-1}$")
        axes.set(aspect="equal"), axes.legend(markerscale=3)
    print("none     : {:.3f} m/s, {:.2f} rad/s".format(*real.medians(real.no_impact())))
    assert dv < 0.1
    assert dw < 2.3


if __name__ == "__main__":
    main()
