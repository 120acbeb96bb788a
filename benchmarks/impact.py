"""Time of one impact: the resolver, the layer by splines, and impacts inside a run."""

from __future__ import annotations

import numba
import numpy as np

import carom
from common import ROUNDS, die_scene, report, seconds, spread

US = 1e-6
COUNT = 2000


def corner_impacts(count: int, seed: int = 1):
    """Return W (count, 3, 3) and u (count, 3) of a cube that strikes with one corner, at random."""
    random = np.random.default_rng(seed)
    m, a = 0.016, 0.02
    J = m * a * a / 6.0
    W, u = np.empty((count, 3, 3)), np.empty((count, 3))
    for i in range(count):
        r = random.normal(size=3)
        r *= 0.5 * a * np.sqrt(3.0) / np.linalg.norm(r)
        hat = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
        W[i] = np.eye(3) / m - hat @ hat / J
        u[i] = random.normal(size=3)
        u[i, 0] = -abs(u[i, 0]) - 0.1
    return np.ascontiguousarray(W), u


def batches():
    """Return compiled loops over many impacts: by the resolver and through the layer."""
    from carom.impact import layout
    from carom.impact.layer import traverse
    from carom.impact.resolve import resolve

    size = layout.SIZE

    @numba.njit
    def by_resolver(W, u, mu, e, law):
        out, failed = np.zeros(size), 0
        for i in range(len(u)):
            failed += resolve(W[i], u[i], mu, e, law, out) != 0
        return failed

    @numba.njit
    def by_layer(W, u, mu, e, law):
        out, history, failed = np.zeros(size), np.zeros((64, 11)), 0
        for i in range(len(u)):
            failed += traverse(W[i], u[i], mu, e, law, 1e-6, 0.2, 2, history, out) != 0
        return failed

    return by_resolver, by_layer


def run_with_impacts() -> tuple[list[float], int, int]:
    """Return times and the number of impacts of a run that hardly does anything else."""
    scene = die_scene(0.1, (0, 0, 0), (10, 7, 3), restitution=1.0, friction=0.05, law="stronge")
    arguments = {"duration": 20.0, "step": 0.02, "save_every": 1000, "throw": False}
    solution = carom.simulate(scene, **arguments)
    times = seconds(lambda: carom.simulate(scene, **arguments))
    return times, len(solution.impacts), solution.stats["trial_steps"]


def main() -> None:
    """Measure and report."""
    by_resolver, by_layer = batches()
    W, u = corner_impacts(COUNT)
    rows = []
    frictions = {"no friction": 0.0, "mu = 0.2, slip bends": 0.2, "mu = 0.8, mostly stick": 0.8}
    for name, mu in frictions.items():
        for law, number in (("newton", 0), ("stronge", 2)):
            arguments = (W, u, mu, 0.5, number)
            assert by_resolver(*arguments) == 0
            times = seconds(lambda a=arguments: by_resolver(*a))
            rows.append([f"resolver, {name}, {law}", spread([t / COUNT for t in times], US)])
    assert by_layer(W, u, 0.2, 0.5, 0) == 0
    times = [t / COUNT for t in seconds(lambda: by_layer(W, u, 0.2, 0.5, 0))]
    rows.append(["layer by splines, 2 steps, mu = 0.2, newton", spread(times, US)])
    times, impacts, trials = run_with_impacts()
    name = f"in a run, {impacts} impacts, {trials / impacts:.1f} trial steps each: all of it"
    rows.append([name, spread([t / impacts for t in times], US)])
    report(
        "impact", "One impact of a cube on a corner", ["", "microseconds an impact"], rows,
        f"Resolver and layer: mean over {COUNT} random corners and velocities, {ROUNDS} rounds.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
