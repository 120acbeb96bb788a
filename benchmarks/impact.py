"""Time of one impact: the resolver, the layer by splines, and impacts inside a run."""

from __future__ import annotations

import numpy as np

import carom
from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.bench.problems import corner_impact
from carom.bench.problems.corner_impact import IMPACTS_TIMED
from carom.impact.layer import traverse
from carom.law.impact_laws import NEWTON, STRONGE
from carom.model.workspace import HIT
from common import ROUNDS, die_scene, report, seconds, spread

US = 1e-6


@entry
def traverse_many(hits, law, history):
    """Pass each impact through the layer; return the number of failures."""
    failed = 0
    for i in range(hits.shape[0]):
        if traverse(hits[i], law, (1e-6, 0.2, 2), history) != 0:
            failed += 1
    return failed


def through_layer(mu: float = 0.2, e: float = 0.5, law: int = NEWTON):
    """Return a function that passes all impacts through the paper's boundary layer, with two spline steps."""
    W, u = corner_impact.impacts()
    hits, history = table(HIT, len(u)), np.zeros((64, 11))
    hits["W"], hits["u"], hits["friction"], hits["restitution"] = W, u, mu, e

    def run() -> None:
        assert traverse_many(hits, law, history) == 0

    return run


def run_with_impacts() -> tuple[list[float], int, int]:
    """Return times and the number of impacts of a run that hardly does anything else."""
    scene = die_scene(0.1, (0, 0, 0), (10, 7, 3), restitution=1.0, friction=0.05, law="stronge")
    arguments = {"duration": 20.0, "step": 0.02, "save_every": 1000, "throw": False}
    solution = carom.simulate(scene, **arguments)
    times = seconds(lambda: carom.simulate(scene, **arguments))
    return times, len(solution.impacts), solution.stats["trial_steps"]


def main() -> None:
    """Measure and report."""
    rows = []
    frictions = {"no friction": 0.0, "mu = 0.2, slip bends": 0.2, "mu = 0.8, mostly stick": 0.8}
    for name, mu in frictions.items():
        for law, number in (("newton", NEWTON), ("stronge", STRONGE)):
            times = [t / IMPACTS_TIMED for t in seconds(corner_impact.ours(mu, law=number))]
            rows.append([f"resolver, {name}, {law}", spread(times, US)])
    times = [t / IMPACTS_TIMED for t in seconds(through_layer())]
    rows.append(["layer by splines, 2 steps, mu = 0.2, newton", spread(times, US)])
    times, impacts, trials = run_with_impacts()
    name = f"in a run, {impacts} impacts, {trials / impacts:.1f} trial steps each: all of it"
    rows.append([name, spread([t / impacts for t in times], US)])
    report(
        "impact", "One impact of a cube on a corner", ["", "microseconds an impact"], rows,
        f"Resolver and layer: mean over {IMPACTS_TIMED} random corners and velocities, {ROUNDS} rounds.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
