"""The plan of an ensemble, and the runs of a part of it; results are independent of worker and order."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from carom.run import Run
from carom.scene.scene import Scene
from carom.stepping.settings import Settings, check_scene
from carom.studies.ensembles.again import Again
from carom.studies.ensembles.outcome import REFUSED, End, end_of, no_outcomes, write
from carom.studies.ensembles.targets import Target


@dataclass(frozen=True)
class Plan:
    """The plan of an ensemble: its scene, or the function that makes the scene of a run, and its settings."""

    scene: Scene | Callable[..., Scene]
    settings: Settings
    targets: list[Target]
    bodies: int
    observe: Callable | None
    token: str = field(default_factory=lambda: uuid.uuid4().hex)


class Part(NamedTuple):
    """Outcomes of some consecutive runs."""

    first: int
    outcomes: np.ndarray
    failures: dict[int, str]  # message of each run that did not reach its end
    observed: dict[str, np.ndarray]


_here = threading.local()


def do(plan: Plan, first: int, values: dict[str, np.ndarray]) -> Part:
    """Make the runs with the given values; the first of them has the number `first`."""
    runs = len(next(iter(values.values())))
    part, ends, failures = Part(first, no_outcomes(runs, plan.bodies), {}, {}), {}, {}
    part.outcomes["status"] = REFUSED
    for k in range(runs):
        try:
            ends[k] = one(plan, values, k, part)
        except Exception as error:  # after any error the other runs continue
            failures[k] = f"{type(error).__name__}: {error}"
    if ends:
        failures.update(write(ends, part.outcomes))
    part.failures.update({first + k: failures[k] for k in sorted(failures)})
    return part


def one(plan: Plan, values: dict[str, np.ndarray], k: int, part: Part) -> End:
    """Make run k of a part, and write what is observed of it."""
    run = begin(plan, values, k)
    if len(run.now) != plan.bodies:
        raise ValueError(f"scene must have {plan.bodies} bodies, as in run 0, got {len(run.now)}")
    status = run.go_on(run.steps)
    end = end_of(run, status)
    if plan.observe is None:
        return end
    for name, value in plan.observe(run.solution(status)).items():
        value = np.asarray(value)
        if name not in part.observed:
            empty = np.nan if value.dtype.kind == "f" else np.zeros((), value.dtype)
            part.observed[name] = np.full((len(part.outcomes), *value.shape), empty, value.dtype)
        part.observed[name][k] = value
    return end


def begin(plan: Plan, values: dict[str, np.ndarray], k: int) -> Run:
    """Return a run that is ready to start with the values of run k of a part."""
    if not isinstance(plan.scene, Scene):
        scene = plan.scene(**{name: _plain(rows[k]) for name, rows in values.items()})
        if not isinstance(scene, Scene):
            raise TypeError(f"scene must return a carom.Scene, got {type(scene).__name__}")
        check_scene(scene, plan.settings)
        return Run(scene, plan.settings)
    if getattr(_here, "token", None) != plan.token:
        _here.again, _here.token = Again(plan.scene, plan.settings, plan.targets), plan.token
    return _here.again.start(values, k)


def _plain(value):
    return float(value) if np.ndim(value) == 0 else np.array(value)
