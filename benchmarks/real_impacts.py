"""First impacts of a real cube: e and mu fitted for each law, and errors of all predictions.

The data and how they are used are those of the example `real_impacts`. An independent computation on such
impacts had medians of 0.26 m/s and 1.9 rad/s at nominal e = 0.125, mu = 0.18, of 0.105 m/s and 2.2 rad/s at
e = 0.3, and of 1.09 m/s and 8.2 rad/s without impact; its conventions are not known in every detail.
"""

from __future__ import annotations

import runpy
from functools import cache
from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style
from common import OUT, report

EXAMPLE = Path(__file__).parents[1] / "examples" / "impacts" / "real_impacts.py"
THERE = runpy.run_path(str(EXAMPLE))
MASS, INERTIA, HALF, GRAVITY = (THERE[name] for name in ("m", "J", "half", "g"))
NOMINAL, LAWS = THERE["NOMINAL"], ("newton", "poisson", "stronge")
after, errors = THERE["after"], THERE["errors"]
load = cache(THERE["load"])
after.__globals__["load"] = load  # the file is read once


def simulated(restitution: float, friction: float, law: str) -> np.ndarray:
    """Return the result of `after` by `carom.simulate` from the impact on, which includes later impacts."""
    before, _, _, attitudes, heights, flights = load()
    result = np.empty_like(before)
    for k, state in enumerate(before):
        scene = carom.Scene(gravity=(0, 0, -GRAVITY))
        table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
        cube = scene.add_body(
            carom.Box(2 * HALF, 2 * HALF, 2 * HALF), mass=MASS, inertia=np.full(3, INERTIA),
            position=(0, 0, heights[k] + 1e-9), orientation=attitudes[k], velocity=state[:3],
            angular_velocity=state[3:],
        )  # fmt: skip
        scene.add_contact(cube, table, restitution=restitution, friction=friction, impact_law=law)
        run = carom.simulate(scene, flights[k], step=1e-3, throw=False)
        result[k] = np.concatenate([run.velocity[-1, 0], run.angular_velocity[-1, 0]])
    return result


def objective(parameters, law: str) -> float:
    """Return the mean of |dv| + r |dw| [m/s], not squared; r = sqrt(J / m) is the radius of gyration."""
    e, mu = parameters
    if not (0.0 <= e <= 1.0 and mu >= 0.0):
        return np.inf
    dv, dw = errors(after(e, mu, law))
    return float(np.mean(dv + np.sqrt(INERTIA / MASS) * dw))


@cache
def fit(law: str) -> tuple[float, float]:
    """Return (e, mu) that minimise `objective` (Nelder and Mead, from the nominal values)."""
    from scipy.optimize import minimize

    start = np.array([NOMINAL, (0.35, 0.18), (0.125, 0.24)])
    options = {"initial_simplex": start, "xatol": 5e-4, "fatol": 1e-6}
    best = minimize(objective, NOMINAL, args=(law,), method="Nelder-Mead", options=options)
    return float(best.x[0]), float(best.x[1])


def medians(predicted: np.ndarray) -> tuple[float, float]:
    """Return the medians of |dv| [m/s] and |dw| [rad/s]."""
    dv, dw = errors(predicted)
    return float(np.median(dv)), float(np.median(dw))


def main() -> None:
    """Fit, report, and draw the share of impacts whose error is below a value."""
    cases = {"no impact": (*NOMINAL, None)}
    for law in LAWS:
        cases |= {f"{law}, nominal": (*NOMINAL, law), f"{law}, fitted": (*fit(law), law)}
    found = {name: after(*case) for name, case in cases.items()}
    for name in ("stronge, nominal", "stronge, fitted"):
        found[f"{name}, simulated"] = simulated(*cases[name])
        cases[f"{name}, simulated"] = cases[name]
    rows = [
        [name, *(f"{x:.3f}" for x in (*cases[name][:2], *medians(one)))]
        for name, one in found.items()
    ]
    head = ["prediction", "e", "mu", "median of dv [m/s]", "median of dw [rad/s]"]
    report("real_impacts", f"{len(load()[0])} impacts of a real cube", head, rows)
    with style.style():
        figure, axes = style.new(style.PAGE, 2.8, 1, 2)
        for name, one in found.items():
            for ax, error in zip(axes, errors(one)):
                ax.step(np.sort(error), np.linspace(0.0, 100.0, len(error)), label=name, lw=0.8)
        axes[0].set(xlabel="error of v [m/s]", ylabel="share of impacts [%]", xlim=(0, 1.6))
        axes[1].set(xlabel="error of angular velocity [rad/s]", xlim=(0, 12))
        axes[1].legend(loc="lower right")
        style.save(figure, OUT, "real_impacts")


if __name__ == "__main__":
    main()
