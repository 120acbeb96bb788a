"""The plan of an ensemble, and the runs of a part of it; results are independent of worker and order."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from carom.results.accuracy import sentences
from carom.run import Run
from carom.scene.scene import Scene
from carom.stepping.settings import Settings, check_scene
from carom.studies.ensembles.again import Again
from carom.studies.ensembles.outcome import REFUSED, no_outcomes, outcome
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
    runs = len(next(iter(values.values()))) if values else 1
    part = Part(first, no_outcomes(runs, plan.bodies), {}, {})
    for k in range(runs):
        own = {name: array[k] for name, array in values.items()}
        try:
            one(plan, own, k, part)
        except Exception as error:  # after any error the other runs continue
            part.outcomes[k] = no_outcomes(1, plan.bodies)[0]
            part.outcomes[k]["status"] = REFUSED
            part.failures[first + k] = f"{type(error).__name__}: {error}"
    return part


def one(plan: Plan, values: dict[str, np.ndarray], k: int, part: Part) -> None:
    """Make one run, and write its outcome."""
    run = begin(plan, values)
    if len(run.now) != plan.bodies:
        raise ValueError(f"scene must have {plan.bodies} bodies, as in run 0, got {len(run.now)}")
    status = run.judged(run.go_on(run.steps))
    part.outcomes[k] = outcome(run, status)
    if status != 0:
        part.failures[part.first + k] = f"{status.message} (reached t = {run.reached:.9g} s)"
        if status.ended:
            part.failures[part.first + k] = " ".join(
                (status.message, *sentences(run.watch[0], run.scene, run.pairs))
            )
    if plan.observe is None:
        return
    for name, value in plan.observe(run.solution(status)).items():
        value = np.asarray(value)
        if name not in part.observed:
            empty = np.nan if value.dtype.kind == "f" else np.zeros((), value.dtype)
            part.observed[name] = np.full((len(part.outcomes), *value.shape), empty, value.dtype)
        part.observed[name][k] = value


def begin(plan: Plan, values: dict[str, np.ndarray]) -> Run:
    """Return a run that is ready to start with these values."""
    if not isinstance(plan.scene, Scene):
        scene = plan.scene(**{name: _plain(value) for name, value in values.items()})
        if not isinstance(scene, Scene):
            raise TypeError(f"scene must return a carom.Scene, got {type(scene).__name__}")
        check_scene(scene, plan.settings)
        return Run(scene, plan.settings)
    if getattr(_here, "token", None) != plan.token:
        _here.again, _here.token = Again(plan.scene, plan.settings, plan.targets), plan.token
    return _here.again.start(values)


def _plain(value):
    return float(value) if np.ndim(value) == 0 else np.array(value)
