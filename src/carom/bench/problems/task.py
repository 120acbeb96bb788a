"""The solution of one problem by one tool: the work to time, and the error of its result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from carom.bench.measure import ROUNDS, TOLERANCE, per_step, saving, seconds, stepper


class Task(NamedTuple):
    """A problem solved by a tool with a step.

    ``run()`` is the whole work. If preparation is not to be measured, ``steps(n)`` makes n steps, and `count`
    is the number of steps of the work.
    """

    step: float
    run: Callable[[], Any]
    error: Callable[[], float]
    steps: Callable[[int], Any] | None = None
    count: int = 0

    def times(self, rounds: int = ROUNDS) -> list[float]:
        """Return the times of the work [s]."""
        if self.steps is None:
            return seconds(self.run, rounds)
        few, many = max(1, self.count // 20), self.count
        return [self.count * t for t in per_step(self.steps, few, max(many, few + 50), rounds)]


def carom_task(
    scene, duration: float, step: float, method: str, wrong: Callable, *, until=None, saves=1,
    by_steps=False,
) -> Task:  # fmt: skip
    """Return the work of carom: a run of a scene; `wrong` is the error of a solution at its end or `until`.

    By steps, what precedes the first of them is not measured.
    """
    import carom

    def run(end=duration):
        return carom.simulate(scene, end, **saving(step, method, end, saves))

    def error() -> float:
        return float(wrong(run(until or duration)))

    if not by_steps or method == TOLERANCE:
        return Task(step, run, error)
    return Task(step, run, error, stepper(scene, step, method=method), round(duration / step))


#: contact of MuJoCo as a spring and damper of a frequency: it has no coefficient of restitution, but a damping
#: ratio that gives one in a flat impact (0: e = 1, 0.2155: e = 0.5), found by integration for one free mass
def solref(frequency: float, ratio: float) -> str:
    """Return stiffness and damping in MuJoCo's form."""
    return f"{-(frequency**2)} {-2 * ratio * frequency}"
