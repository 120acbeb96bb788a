r"""Three laws of restitution, one rod
==================================

A rod at 45 degrees strikes with its tip, and friction stops the slip in the course of the impact. In such an
impact the coefficient e of Newton, of Poisson and of Stronge means three different things. Newton's law even
*gains* energy (Kane and Levinson, 1985). All three are compared with their closed form.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

W = np.array([[2.5, -1.5, 0.0], [-1.5, 2.5, 0.0], [0.0, 0.0, 1.0]])  # uniform rod, 1 kg, 1 m
before, e = np.array([-1.0, 0.6]), 0.9  # normal velocity and slip [m/s]


def energy(u):
    return 0.5 * u @ np.linalg.solve(W[:2, :2], u)


# %%
# In the course of the impact the normal impulse p grows. With it the normal velocity grows at the rate
# :math:`k_1 = 2.5 + 1.5 \mu` until slip ends, and at another rate :math:`k_2` while the tip sticks or slips
# back (Routh, 1860). Newton's e is a ratio of velocities, Poisson's a ratio of impulses, and Stronge's the
# root of a ratio of works.


def exact(mu, law):
    slip, k1 = before[1] / (1.5 + 2.5 * mu), 2.5 + 1.5 * mu  # impulse at which slip ends; rate
    k2, t2 = (1.6, 0.0) if mu >= 0.6 else (2.5 - 1.5 * mu, 2.5 * mu - 1.5)  # stick; slip back
    at = k1 * slip - 1  # normal velocity there, still approaching
    compression = slip - at / k2
    work = 0.5 * slip * (1 - at) + at**2 / (2 * k2)
    ends = {"newton": e, "poisson": e * compression * k2, "stronge": e * np.sqrt(2 * k2 * work)}
    u_n = ends[law]
    return np.array([u_n, t2 * (compression + u_n / k2 - slip)])


# %%
# `carom.resolve_impact` resolves one impact from W, the velocity before, mu and e. We do so for 121
# coefficients of friction and draw the energy that is left (above 1 it has grown), and the velocities after
# the impact.


def main(out="out/examples"):
    friction, worst = np.linspace(0, 1.2, 121), 0.0
    with picture(f"{out}/restitution_laws.png", columns=2) as (left, right):
        for law in ("newton", "poisson", "stronge"):
            impacts = [carom.resolve_impact(W, (*before, 0), mu, e, law) for mu in friction]
            u = np.array([impact.velocity_after[:2] for impact in impacts])
            worst = max(worst, np.max(np.abs(u - [exact(mu, law) for mu in friction])))
            kept = np.array([energy(row) for row in u]) / energy(before)
            print(f"{law:8} energy after / before: {kept[80]:.6f} at mu = {friction[80]:g}")
            left.plot(friction, kept, label=law.capitalize())
            right.plot(u[:, 1], u[:, 0])
        left.axhline(1, color="0.6", lw=0.8, ls="--")
        left.set(xlabel="friction coefficient", ylabel="energy after / before", ylim=(0, 1.4))
        left.legend(loc="lower right")
        right.set(xlabel="slip after / m s$^{-1}$", ylabel="rebound / m s$^{-1}$", ylim=(0, 1))
    print(f"velocities: error {worst:.0e} m/s")
    assert worst < 1e-12


if __name__ == "__main__":
    main()
