"""The die of the paper, thrown with spin about two axes until it is at rest; a corner strikes first."""

from __future__ import annotations

from functools import cache
from time import perf_counter

import numpy as np

from carom.bench.problems import planar_die
from carom.bench.problems.task import Task, carom_task

NAME, TITLE = "spatial_die", "Spatial die, thrown to rest (2 s)"
ERROR = "error of its centre at 0.25 s [m]"
METHODS, STEPS, PEER_STEPS = ("rk4",), (5e-3, 2e-3, 1e-3), (1e-3, 1e-4, 1e-5)
SPIN, DURATION, END = (10, 10, 0), 2.0, 0.25


def scene():
    """Return the die above a table."""
    return planar_die.scene(spin=SPIN)


@cache
def centre() -> np.ndarray:
    """Return the centre at END, exact to round-off, because free flight and the impact are."""
    import carom

    return carom.simulate(scene(), END, step=1e-4).position[-1, 0]


def ours(step: float, method: str = "rk4") -> Task:
    """Return the work of carom."""
    return carom_task(scene(), DURATION, step, method, wrong, until=END)


def wrong(run) -> float:
    """Return the distance of the centre at the end from `centre`."""
    return float(np.linalg.norm(run.position[-1, 0] - centre()))


def mujoco(module, step: float, duration: float = DURATION) -> Task:
    """Return the work of MuJoCo."""
    made, data = planar_die.model(module, step, planar_die.stiffness(step))

    def run(until=duration):
        return planar_die.throw(module, made, data, round(until / step), SPIN)

    return Task(step, run, lambda: float(np.linalg.norm(run(END) - centre())))


def throws(runs: int, seed: int = 0, workers: int = 1, **how):
    """Return an ensemble of throws with random orientation; `how` has its step or its tolerance."""
    import carom

    made = planar_die.scene()
    vary = {f"{made.bodies[0].name}.orientation": carom.UniformOrientation()}
    return carom.ensemble(
        made, DURATION, vary=vary, runs=runs, seed=seed, workers=workers,
        chunk=max(1, min(25, runs // (4 * workers))), **how,
    )  # fmt: skip


def rate(runs: int, seed: int = 0, workers: int = 1, timer=perf_counter, **how) -> float:
    """Return the number of throws of carom per second, by default of wall time."""
    begin = timer()
    throws(runs, seed, workers, **how)
    return runs / (timer() - begin)


def mujoco_rate(module, step: float, runs: int, seed: int = 0, timer=perf_counter) -> float:
    """Return the same number for MuJoCo on one thread, with a contact of 500 rad/s."""
    made, data = planar_die.model(module, step, 500.0)
    turns = np.random.default_rng(seed).normal(size=(runs, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    begin = timer()
    for turn in turns:
        planar_die.throw(module, made, data, round(DURATION / step), turn=turn)
    return runs / (timer() - begin)
