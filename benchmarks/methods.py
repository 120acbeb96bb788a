"""All methods beside each other: what an error costs, and energy over a long time."""

from __future__ import annotations

import warnings

import numpy as np

import carom
from carom.bench.measure import TOLERANCE, saving
from common import pendulum_scene, report, seconds, spread

LINKS, DURATION, ALLOWED = 3, 2.0, 1e-6
STEPPED = ("rk4", "rk5", "rk8", "rattle", "rattle4", "rattle6", "paper")
LONG, STEP = 1000.0, 0.01


def error_of(method: str, known: np.ndarray, step: float) -> float:
    """Return the error of the last centres [m] with a step, or a tolerance; infinite where the run fails."""
    how = saving(step, method, DURATION)
    end = carom.simulate(pendulum_scene(LINKS), DURATION, throw=False, **how)
    return float(np.max(np.abs(end.position[-1] - known))) if end.t[-1] == DURATION else np.inf


def cost(method: str, step: float) -> str:
    """Return the time of a run in ms."""
    scene, how = pendulum_scene(LINKS), saving(step, method, DURATION)

    def run():
        carom.simulate(scene, DURATION, **how)

    return spread(seconds(run), 1e-3)


def errors() -> list[list[str]]:
    """Return for each method the longest step whose error is below ALLOWED, and its cost."""
    rows = []
    known = carom.simulate(pendulum_scene(LINKS), DURATION, step=5e-4, method="rk8").position[-1]
    for method in STEPPED:
        step = 0.04
        while not (error := error_of(method, known, step)) < ALLOWED and step > 1e-6:
            step *= 0.5
        rows.append([method, f"{1e3 * step:.3g} ms", f"{error:.1e}", cost(method, step)])
    decades = (float(f"1e-{k}") for k in range(3, 15))  # exactly: the order depends on it
    rtol = next(rtol for rtol in decades if error_of(TOLERANCE, known, rtol) < ALLOWED)
    error = error_of(TOLERANCE, known, rtol)
    chosen = carom.simulate(pendulum_scene(LINKS), DURATION, **saving(rtol, TOLERANCE, DURATION))
    name = f"default ({chosen.settings['method']})"
    rows.append([name, f"rtol {rtol:.0e}", f"{error:.1e}", cost(TOLERANCE, rtol)])
    return rows


def energies() -> list[list[str]]:
    """Return trend and greatest error of the energy of a pendulum."""
    rows = []
    for method in STEPPED[:-1]:
        s = carom.simulate(pendulum_scene(1), LONG, step=STEP, method=method)
        error = s.ledger.residual
        trend = LONG * np.polyfit(s.t, error, 1)[0]
        rows.append([method, f"{trend:.1e}", f"{np.max(np.abs(error)):.1e}"])
    return rows


def main() -> None:
    """Measure and report."""
    warnings.simplefilter("ignore", carom.AccuracyWarning)  # of steps that are too long
    report(
        "methods", f"Methods: {LINKS} rods released horizontal, {DURATION:g} s",
        ["method", "step", "error [m]", "time of the run [ms]"], errors(),
        f"Longest step (halved from 40 ms), or greatest rtol, whose error is below {ALLOWED:g} m; ends saved.",
    )  # fmt: skip
    report(
        "methods_long", f"One rod, {LONG:g} s in steps of {1e3 * STEP:g} ms",
        ["method", "trend of energy [J in all]", "greatest error [J]"], energies(),
        "Energy of the swing: 4.9 J. The trend is that of a straight line fitted to all steps.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
