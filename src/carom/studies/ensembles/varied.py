"""What an ensemble varies: a scene, a system in coordinates, or a function that makes one of them for each run.

A plan asks each of them for the runs, and for the scene of one run; no other file asks which of them it has.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np

from carom import checks
from carom.generalized.run import CoordinateRun
from carom.generalized.scene import CoordinateScene
from carom.generalized.system import GeneralizedSystem
from carom.run import Run
from carom.scene.scene import Scene
from carom.stepping.settings import Settings, check_coordinates, check_scene
from carom.studies.ensembles.again import Again, row
from carom.studies.ensembles.outcome import Layout
from carom.studies.ensembles.robots import PLACED, of_scene, put, targets_of
from carom.studies.values import Target, changed, changed_system, find_targets, whole

Values: TypeAlias = dict[str, np.ndarray]
System: TypeAlias = Scene | GeneralizedSystem


class Starter(Protocol):
    """What starts the runs of a thread."""

    def start(self, values: Values, k: int) -> Run:
        """Return a run that is ready to start with row k of the values."""
        ...


class Varied(Protocol):
    """What is varied, with the destination of each value."""

    @property
    def source(self) -> Any:
        """The scene, system or function."""
        ...

    @property
    def layout(self) -> Layout:
        """What the state at the end of each run is of."""
        ...

    def starter(self, settings: Settings) -> Starter:
        """Return what starts the runs of a thread."""
        ...

    def stated(self, values: Values, k: int) -> System:
        """Return the scene or system of the run with row k of the values."""
        ...

    def new_run(self, settings: Settings, values: Values, k: int) -> Run:
        """Return a new run with row k of the values."""
        ...


def varied_of(source, settings: Settings, inputs: Values) -> tuple[Varied, Values]:
    """Return the varied scene, system or function, and its values; refuse those that are not allowed."""
    if isinstance(source, Scene):
        check_scene(source, settings)
        source = source._as_it_is()
        given = of_scene(source, inputs)
        placed = {name: given[name] for name in PLACED if name in given}
        values = whole(source, {name: one for name, one in given.items() if name not in placed})
        targets = [*find_targets(source, values), *targets_of(placed)]
        return VariedScene(source, targets), values | placed
    if isinstance(source, GeneralizedSystem):
        check_coordinates(settings)
        values = whole(source, inputs)
        source.evaluation()  # derives expressions once, not in each thread
        return VariedSystem(source._as_it_is(), find_targets(source, values)), values
    return Made(source, layout_of(_call(source, inputs, 0))), inputs


def layout_of(system: System) -> Layout:
    """Return what the state at the end of a run is of."""
    if isinstance(system, GeneralizedSystem):
        return Layout(system.coordinate_names, "coordinates")
    return Layout(tuple(body.name for body in system.bodies))


@dataclass(frozen=True)
class VariedScene:
    """A scene whose values are varied."""

    source: Scene
    targets: list[Target]

    @property
    def layout(self) -> Layout:
        """Its bodies."""
        return layout_of(self.source)

    def starter(self, settings: Settings) -> Starter:
        """Return a run that is put back before each start; if its arrays depend on values, what makes each."""
        # each run has its own projected start
        projected = settings.options.project_start and len(self.source.joints) > 0
        if all(target.light for target in self.targets) and not projected:
            return Again(self.source, settings, self.targets)
        return Afresh(self, settings)

    def stated(self, values: Values, k: int) -> Scene:
        """Return the scene of a run."""
        if all(one.light and one.field not in ("position", "orientation") for one in self.targets):
            return self.source
        return changed(self.source, self.targets, row(values, k))

    def new_run(self, settings: Settings, values: Values, k: int) -> Run:
        """Return a new run."""
        run = Run(changed(self.source, self.targets, row(values, k)), settings)
        put(run, self.targets, row(values, k))
        return run


@dataclass(frozen=True)
class VariedSystem:
    """A system in coordinates whose start and contacts are varied."""

    source: GeneralizedSystem
    targets: list[Target]

    @property
    def layout(self) -> Layout:
        """Its coordinates."""
        return layout_of(self.source)

    def starter(self, settings: Settings) -> Starter:
        """Return what makes each run; the compiled functions, which keep an error, are those of one thread."""
        return Afresh(VariedSystem(self.source._apart(), self.targets), settings)

    def stated(self, values: Values, k: int) -> GeneralizedSystem:
        """Return the system of a run."""
        return changed_system(self.source, self.targets, row(values, k))

    def new_run(self, settings: Settings, values: Values, k: int) -> Run:
        """Return a new run."""
        return run_of(self.stated(values, k), settings)


@dataclass(frozen=True)
class Made:
    """A function that makes the scene or system of each run."""

    source: Callable[..., System]
    layout: Layout

    def starter(self, settings: Settings) -> Starter:
        """Return what makes each run."""
        return Afresh(self, settings)

    def stated(self, values: Values, k: int) -> System:
        """Return the scene or system of a run."""
        system = _call(self.source, values, k)
        layout = layout_of(system)
        if layout.of != self.layout.of or len(layout.names) != len(self.layout.names):
            raise ValueError(f"scene must have {self.layout}, as in run 0, got {layout}")
        return system

    def new_run(self, settings: Settings, values: Values, k: int) -> Run:
        """Return a new run."""
        return run_of(self.stated(values, k), settings)


class Afresh:
    """What makes each run anew."""

    def __init__(self, varied: Varied, settings: Settings):
        self.varied, self.settings = varied, settings

    def start(self, values: Values, k: int) -> Run:
        """Return a new run with row k of the values."""
        return self.varied.new_run(self.settings, values, k)


def run_of(system: System, settings: Settings) -> Run:
    """Return a new run of a scene or system."""
    if isinstance(system, GeneralizedSystem):
        check_coordinates(settings)
        return CoordinateRun(CoordinateScene(system), settings)
    check_scene(system, settings)
    return Run(system, settings)


def _call(source: Callable[..., System], values: Values, k: int) -> System:
    """Return what the function of the user makes for the values of run k."""
    one = {name: np.array(rows[k]) for name, rows in values.items()}
    plain = {name: value if value.ndim else value.item() for name, value in one.items()}
    made = checks.call("scene", lambda: source(**plain))
    checks.instance("the result of the function scene", made, (Scene, GeneralizedSystem))
    return made
