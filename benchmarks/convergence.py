"""Work-precision: error against time, for the planar die and for a pendulum."""

from __future__ import annotations

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom.bench.problems import planar_die
from common import OUT, die_scene, pendulum_scene, report, seconds
from hht import hht_alpha

END_PENDULUM = 2.0
RATE = 3.0 * 9.81 / 2.0  # of a rod hinged at its end: theta'' = rate cos(theta)
STYLE = {
    "rk4": ("o-", "#0072B2"), "paper": ("s-", "#D55E00"), "paper, project": ("^--", "#D55E00"),
    "paper-ode": ("D:", "#CC79A7"), "Moreau-Jean": ("v-", "#009E73"),
    "HHT-alpha (angle)": ("v-", "#009E73"),
}  # fmt: skip


def die_error(solution) -> float:
    """Return the error of the mass centre at the end [m]."""
    x = solution.position[-1, 0]
    return planar_die.wrong(x[0], x[2])


def pendulum_exact() -> np.ndarray:
    """Return where the rod's centre is at the end, in its plane, from one angle."""
    done = solve_ivp(
        lambda t, y: [y[1], RATE * np.cos(y[0])], (0.0, END_PENDULUM), [0.0, 0.0],
        method="DOP853", rtol=1e-13, atol=1e-14,
    )  # fmt: skip
    angle = done.y[0, -1]
    return 0.5 * np.array([np.cos(angle), -np.sin(angle)])


def die_runs():
    """Return {method: [(step, function, error of its result)]} for the die."""
    scene = die_scene()

    def ours(**settings):
        return lambda h: carom.simulate(scene, planar_die.END, step=h, **settings)

    methods = {
        "rk4": ours(), "paper": ours(method="paper"),
        "paper, project": ours(method="paper", impact_location="project"),
        "Moreau-Jean": lambda h: carom.baselines.moreau_jean(scene, planar_die.END, step=h),
    }  # fmt: skip
    steps = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
    return {m: [(h, f) for h in steps] for m, f in methods.items()}, die_error


def pendulum_runs():
    """Return the same for the pendulum."""
    scene, exact = pendulum_scene(), pendulum_exact()

    def ours(method):
        return lambda h: carom.simulate(scene, END_PENDULUM, step=h, method=method)

    def hht(h):
        return hht_alpha(
            [[1.0]], lambda t, q, v: RATE * np.cos(q), [0.0], [0.0], END_PENDULUM, step=h,
            jacobian=lambda t, q, v: (np.array([[-RATE * np.sin(q[0])]]), np.zeros((1, 1))),
        )  # fmt: skip

    def error(result):
        if result.position.ndim == 2:
            angle = result.position[-1, 0]
            place = 0.5 * np.array([np.cos(angle), -np.sin(angle)])
        else:
            place = result.position[-1, 0, [0, 2]]
        return float(np.linalg.norm(place - exact))

    methods = {m: ours(m) for m in ("rk4", "paper", "paper-ode")}
    methods["HHT-alpha (angle)"] = hht
    steps = (4e-2, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3)
    return {m: [(h, f) for h in steps] for m, f in methods.items()}, error


def main() -> None:
    """Measure, draw, report."""
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4.0), layout="constrained")
    rows = []
    for ax, title, (runs, error) in (
        (axes[0], f"planar die, one impact, t = {planar_die.END} s", die_runs()),
        (axes[1], f"pendulum, t = {END_PENDULUM} s", pendulum_runs()),
    ):
        for method, cases in runs.items():
            times, errors = [], []
            for step, function in cases:
                try:
                    errors.append(max(error(function(step)), 1e-16))
                except carom.SimulationError as failure:
                    rows.append([title, method, f"{step:g}", failure.solution.status.name, ""])
                    continue
                times.append(float(np.median(seconds(lambda f=function, h=step: f(h)))))
                time, off = f"{1e3 * times[-1]:.3g}", f"{errors[-1]:.1e}"
                rows.append([title, method, f"{step:g}", off, time])
            style, color = STYLE[method]
            ax.loglog(times, errors, style, color=color, label=method, ms=5, lw=1.3)
        ax.set_title(title, fontsize=10)
        ax.set_xlabel("processor time [s]")
        ax.set_ylabel("error of the mass centre [m]")
        ax.grid(alpha=0.3)
        ax.legend(fontsize=8)
    OUT.mkdir(parents=True, exist_ok=True)
    figure.savefig(OUT / "convergence.png", dpi=150)
    report(
        "convergence", "Work and precision",
        ["problem", "method", "step [s]", "error [m]", "time [ms]"], rows,
        "Baselines are plain NumPy: their times say nothing about the methods, their errors do.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
