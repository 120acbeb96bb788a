"""What a run is watched for: functions of time and state as in SciPy's `solve_ivp`, and conditions by name."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.results.state import SystemState
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.switches import EVENTS

Event = str | Callable[[float, SystemState], float]
AT_REST, FIRST_IMPACT = EVENTS
ALLOWED = (
    f'a function f(t, state), "{AT_REST}", "{FIRST_IMPACT}A and B" with the names of two parts, or '
    f'"{FIRST_IMPACT}S" with that of a stop'
)


class Observed:
    """A run between two steps, or at the end of a trial; its state is made when it is first asked for."""

    def __init__(self, run: Any, known: dict, struck: int, at_end: bool):
        self.run, self.known, self.struck = run, known, struck  # impacts before the step
        self.at_end = at_end  # whether it stands at the end of a step, which has found its forces
        self.t = run.reached

    @cached_property
    def state(self) -> SystemState:
        """The state of the system; the run must still stand there."""
        return self.run.state(self.known)


class Condition(NamedTuple):
    """Something that happens where `value` changes its sign."""

    name: str  # for messages
    value: Callable[[Observed], float]
    terminal: int  # the run ends when it has happened so often; 0: never
    direction: float  # above 0: the value must rise; below: fall
    #: its time, from what was written down
    when: Callable[[Observed], float | None] = lambda look: None
    rest: bool = False  # whether it must still be so a step later
    switch: Any = None  # a `Switch` that acts then
    #: whether its value follows from forces: it may be above 0 at once, after something else has happened
    breaks: bool = False


def conditions(events, scene) -> list[Condition]:
    """Return the conditions that `events` of `simulate` stand for, checked.

    Raises
    ------
    TypeError, ValueError
        Naming the event and what is allowed.
    """
    alone = isinstance(events, str) or callable(events)
    given = [events] if alone else events
    if isinstance(given, (bytes, bytearray)) or not isinstance(given, Sequence):
        raise TypeError(
            f"events must be one or a list of these: {ALLOWED}; got {checks.shown(given)}"
        )
    return [condition_of(f"events[{i}]", one, scene) for i, one in enumerate(given)]


def condition_of(name: str, event, scene) -> Condition:
    """Return the condition that an event stands for, checked."""
    if callable(event):
        return _of_function(name, event)
    if not isinstance(event, str):
        raise TypeError(f"{name} must be {ALLOWED}; got {checks.shown(event)}")
    shown = f'{name} ("{event}")'
    if event == AT_REST:
        return Condition(shown, _moves, 1, -1.0, rest=True)
    if event.startswith(FIRST_IMPACT):
        words = event.removeprefix(FIRST_IMPACT)
        stops = {stop.name: stop.index for stop in scene.stops}
        if scene._chart is not None and words not in stops:
            raise ValueError(
                f'{name} must be "{FIRST_IMPACT}C" with the name of a contact, got {words!r}; the system '
                f"has {_listed(stops) or 'none'}{checks.nearest(words, stops)}"
            )
        strikes = (
            _StopStrikes(stops[words]) if words in stops else _Strikes(*_pair(name, words, scene))
        )
        return Condition(shown, strikes, 1, 1.0, strikes.when)
    raise ValueError(f"{name} must be {ALLOWED}; got {checks.shown(event)}")


def _of_function(name: str, function) -> Condition:
    terminal = getattr(function, "terminal", None)
    if terminal is None or isinstance(terminal, (bool, np.bool_)):
        terminal = int(bool(terminal))
    else:
        terminal = checks.integer(f"terminal of {name}", terminal, least=0)
    direction = checks.number(f"direction of {name}", getattr(function, "direction", 0.0))

    def value(look: Observed) -> float:
        return checks.number(name, checks.call(name, function, look.state.t, look.state))

    called = getattr(function, "__name__", "")
    known = f" ({called})" if called.isidentifier() else ""
    return Condition(f"{name}{known}", value, terminal, direction)


def _moves(look: Observed) -> float:
    """Return 1 while something moves, -1 when nothing does."""
    return 1.0 if math.isinf(look.run.clock["still"][0]) else -1.0


class _StopStrikes:
    """1 when a stop has been struck in the present step; -1 before."""

    def __init__(self, number: int):
        self.number = number

    def __call__(self, look: Observed) -> float:
        return -1.0 if self.when(look) is None else 1.0

    def when(self, look: Observed) -> float | None:
        """Return the time of its first impact in the step, or None."""
        run = look.run
        rows = run.records.impact[look.struck : int(run.clock["struck"][0])]
        times = rows["time"][rows["contact"] == len(run.pairs.body) + self.number]
        return float(times.min()) if len(times) else None


class _Strikes:
    """1 when a body has struck another one, or what never moves, in the present step; -1 before."""

    def __init__(self, body: int, other: int, plane: int):
        self.body, self.other, self.plane = body, other, plane

    def __call__(self, look: Observed) -> float:
        return -1.0 if self.when(look) is None else 1.0

    def when(self, look: Observed) -> float | None:
        """Return the time of the first such impact in the step, or None."""
        run = look.run
        rows = run.records.impact[look.struck : int(run.clock["struck"][0])]
        if not len(rows):
            return None
        pairs = run.pairs
        rows = rows[rows["contact"] < len(pairs.body)]  # stops of joints come after
        contact = rows["contact"]
        body, other, plane = pairs.body[contact], pairs.other[contact], pairs.plane[contact]
        same = (body == self.body) & (other == self.other) & (plane == self.plane)
        if self.other >= 0:
            same |= (body == self.other) & (other == self.body)
        return float(rows["time"][same].min()) if same.any() else None


def _pair(name: str, words: str, scene) -> tuple[int, int, int]:
    """Return the body, the other body and what never moves, -1 for none, of ``"A and B"`` by their names."""
    parts = {part.name: part for part in (*scene.bodies, *scene.fixed)}
    pieces = words.split(" and ")
    splits = [(" and ".join(pieces[:i]), " and ".join(pieces[i:])) for i in range(1, len(pieces))]
    found = [pair for pair in splits if pair[0] in parts and pair[1] in parts]
    whole = f'{name} must be "{FIRST_IMPACT}A and B" with the names of two parts that touch'
    if len(found) > 1:
        raise ValueError(f"{whole}, got {words!r}, which may be {' or '.join(map(str, found))}")
    if not found:
        unknown = [one for one in (splits[0] if splits else (words,)) if one not in parts]
        near = checks.nearest(unknown[0], parts) if unknown else ""
        raise ValueError(f"{whole}, got {words!r}; the scene has {_listed(parts)}{near}")
    first, second = (parts[one] for one in found[0])
    if not isinstance(first, Body):
        first, second = second, first
    if first is second or not isinstance(first, Body):
        raise ValueError(f"{whole}, got {words!r}, of which no two move against each other")
    if isinstance(second, (HalfSpace, StaticBody)):
        return first.index, -1, scene.fixed.index(second)
    return first.index, second.index, -1


def _listed(names) -> str:
    """Return names, the first ten of them."""
    known = list(map(repr, names))
    return ", ".join([*known[:10], *(["..."] if len(known) > 10 else [])])
