r"""Three laws of restitution, one rod
==================================

A rod at 45 degrees strikes with its tip, and friction stops the slip in the course of the impact. From there on
the normal velocity grows at another rate, and e means three different things: a ratio of speeds (Newton), of
impulses (Poisson), of works (Stronge). Newton's law then *gains* energy (Kane and Levinson, 1985). All is known
in closed form, with the rates :math:`\mathrm{d}u_n/\mathrm{d}p` before and after slip ends (Routh, 1860).
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

W = np.array([[2.5, -1.5, 0.0], [-1.5, 2.5, 0.0], [0.0, 0.0, 1.0]])  # uniform rod, 1 kg, 1 m
before, e = np.array([-1.0, 0.6]), 0.9
LAWS = {"newton": style.RED, "poisson": style.GREEN, "stronge": style.BLUE}


def energy(u):
    return 0.5 * u @ np.linalg.solve(W[:2, :2], u)


def exact(mu, law):
    slip, k1 = before[1] / (1.5 + 2.5 * mu), 2.5 + 1.5 * mu  # impulse at which slip ends; rate
    k2, t2 = (1.6, 0.0) if mu >= 0.6 else (2.5 - 1.5 * mu, 2.5 * mu - 1.5)  # stick; slip back
    at = k1 * slip - 1  # normal velocity there, still approaching
    compression = slip - at / k2
    work = 0.5 * slip * (1 - at) + at**2 / (2 * k2)
    ends = {"newton": e, "poisson": e * compression * k2, "stronge": e * np.sqrt(2 * k2 * work)}
    u_n = ends[law]
    return np.array([u_n, t2 * (compression + u_n / k2 - slip)])


def main(out="out/examples"):
    friction, worst = np.linspace(0, 1.2, 121), 0.0
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.6, columns=2)
        for law, colour in LAWS.items():
            impacts = [carom.resolve_impact(W, (*before, 0), mu, e, law) for mu in friction]
            u = np.array([impact.velocity_after[:2] for impact in impacts])
            true = np.array([exact(mu, law) for mu in friction])
            worst = max(worst, np.max(np.abs(u - true)))
            kept = np.array([energy(row) for row in u]) / energy(before)
            print(f"{law:8} energy after / before: {kept[80]:.6f} at mu = {friction[80]:g}")
            left.plot(friction, kept, color=colour, label=law.capitalize())
            right.plot(u[:, 1], u[:, 0], color=colour)
            right.plot(*u[[0, -1], ::-1].T, "o", color=colour)
        left.axhline(1, color=style.GREY, lw=0.8, ls="--")
        left.text(0.02, 1.02, "gain", color=style.GREY)
        left.set(xlabel="friction coefficient", ylabel="energy after / before", ylim=(0, 1.4))
        left.legend(loc="lower right")
        right.set(xlabel="slip after / m s$^{-1}$", ylabel="rebound / m s$^{-1}$", ylim=(0, 1))
    print(f"velocities: error {worst:.0e} m/s")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "restitution_laws.png", dpi=style.DPI)
    assert worst < 1e-12


if __name__ == "__main__":
    main()
