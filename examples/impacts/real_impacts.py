r"""Real impacts of a real cube
===========================

An acrylic cube was tossed 285 times, and its motion was recorded at 148 Hz (ContactNets, Pfrommer, Halm and
Posa 2020). Three laws of restitution predict the velocity after the first impact of each toss, with nominal
and with fitted restitution e and friction mu.
"""

from importlib.resources import files

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots.style import picture

m, J, half, g, dt = 0.37, 8.1e-4, 0.0524, 9.81, 1 / 148  # SI units
M_inverse = np.diag(1 / np.array([m, m, m, J, J, J]))
axes = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])  # n, t1, t2
corners = half * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T
NOMINAL = 0.125, 0.18  # e and mu by a drop test and a tilt test
FITTED = 0.335, 0.203  # by benchmarks/real_impacts.py

# %%
# Impacts with a second corner near the table are left out. Velocities are differences to the sample before,
# so they belong to a time half a sample earlier, and gravity acts all the time, also between the samples that
# are used: one before the corner is at the table, and the third after it. The corner reaches the table at the
# time that its height and its speed give; the attitude is carried on to there.


def load():
    """Return v (K, 6) at the impacts and as measured, Jacobians, attitudes, heights, times to measurement."""
    with (files("carom.paper") / "data" / "first_impacts_even.csv").open() as file:
        t = np.genfromtxt(file, delimiter=",", names=True)
    t = t[t["gap_to_2nd_corner"] > 0.015]
    states = []
    for when in ("pre", "post"):
        columns = [name for name in t.dtype.names if name.startswith(when)]
        q, v, w = np.split(np.stack([t[name] for name in columns], axis=1), [4, 7], axis=1)
        states.append((q, v, quaternion.rotate(quaternion.normalize(q), w)))
    (q, v, w), since, measured = states[0], np.full(len(t), dt), np.hstack(states[1][1:])
    for _ in range(3):  # the speed depends slightly on the corner
        now = quaternion.multiply(quaternion.exp(w * since[:, None]), quaternion.normalize(q))
        arms = np.einsum("kij,cj->kci", quaternion.matrix(now), corners)
        arm = arms[np.arange(len(t)), np.argmin(arms[:, :, 2], axis=1)]
        fall = v - np.outer(g * (since + 0.5 * dt), axes[0])
        approach = -(fall + np.cross(w, arm))[:, 2]
        since = np.clip(dt + np.minimum(t["min_corner_z"], 0) / approach, 0, dt)
    turn = np.cross(arm[:, None], axes)
    G = np.concatenate([np.broadcast_to(axes, turn.shape), turn], axis=2)
    return np.hstack([fall, w]), measured, G, now, -arm[:, 2], 3.5 * dt - since


# %%
# The Delassus operator :math:`W = G M^{-1} G^T` and the velocity :math:`u = G v` of the corner come from the
# state before. `carom.resolve_impact` gives the impulses P, and then :math:`v^+ = v + M^{-1} G^T P`.


def after(e, mu, law):
    v, _, G, *_, flight = load()
    if law is not None:
        W, u = G @ M_inverse @ G.transpose(0, 2, 1), np.einsum("kij,kj->ki", G, v)
        P = carom.resolve_impact(W, u, mu, e, law).impulse
        v = v + np.einsum("ij,krj,kr->ki", M_inverse, G, P)
    return v - np.outer(flight, [0, 0, g, 0, 0, 0])


def errors(predicted):
    dv, dw = np.split(predicted - load()[1], 2, axis=1)
    return np.linalg.norm(dv, axis=1), np.linalg.norm(dw, axis=1)


# %%
# We print the medians of the error for three laws, and, to compare, those of a prediction without any impact.


def main(out="out/examples"):
    measured = load()[1]
    print(f"{len(measured)} impacts; medians of the error after the impact")
    with picture(f"{out}/real_impacts.png", height=3.4, width=3.4) as ax:
        for law in (None, "newton", "poisson", "stronge"):
            for e, mu in (NOMINAL, FITTED):
                predicted = after(e, mu, law)
                dv, dw = np.median(errors(predicted), axis=1)
                print(f"{law!s:8} e = {e}, mu = {mu}: {dv:.3f} m/s, {dw:.2f} rad/s")
                if law == "stronge":
                    ax.plot(measured[:, 2], predicted[:, 2], ".", ms=2.5, label=f"{e = }")
        ax.axline((0, 0), slope=1, color="k", lw=0.5)
        ax.set(xlabel="measured $v_z$ / m s$^{-1}$", ylabel="predicted $v_z$ / m s$^{-1}$")
        ax.set(aspect="equal"), ax.legend(markerscale=3)
    assert (dv < 0.1) & (dw < 2.3)


if __name__ == "__main__":
    main()
