"""The parameters of a fit: start, step and bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom import checks
from carom.fields import keep
from carom.scene.friction import Friction
from carom.scene.scene import Scene
from carom.scene.speed_law import SpeedLaw
from carom.studies.identify.varied import KNOWN
from carom.studies.values import Found, components, find, split

LEAST_PART = 1e-6  # of a number of a law that must be above 0


@dataclass(frozen=True)
class Parameter:
    """A parameter of a fit.

    Parameters
    ----------
    start : float
        Initial value of the search, within the bounds.
    step : float
        Size of the first simplex, above 0. Impacts on corners make the motion chaotic and the objective rough:
        the step must be large compared with the roughness.
    lower, upper : float
        Bounds; the bounds themselves are allowed. Default: none.
    """

    start: float
    step: float
    lower: float = -np.inf
    upper: float = np.inf

    def __post_init__(self):
        lower, upper = _bound("lower", self.lower), _bound("upper", self.upper)
        keep(self, lower=lower, upper=upper)
        if not lower < upper:
            raise ValueError(f"lower must be below upper, got {lower!r} and {upper!r}")
        start = checks.number("start", self.start)
        if not lower <= start <= upper:
            raise ValueError(
                f"start must be at least {lower:g} and at most {upper:g} (lower and upper), got {start!r}"
            )
        step = checks.number("step", self.step, above=0.0)
        if not step <= upper - lower:
            raise ValueError(
                f"step must be at most upper - lower = {upper - lower:g}, got {step!r}"
            )
        keep(self, start=start, step=step)


def _bound(name: str, value) -> float:
    """Return a bound, a finite or infinite number."""
    infinite = isinstance(value, (float, np.floating)) and np.isinf(value)
    return float(value) if infinite else checks.number(name, value)


class Space:
    """All parameters of a fit in order: starts, steps and bounds."""

    def __init__(self, parameters: Mapping, scene: Scene | None):
        if not isinstance(parameters, Mapping) or not parameters:
            raise ValueError(
                f"parameters must be a dict of names and Parameters, got {checks.shown(parameters)}"
            )
        self.names = tuple(parameters)
        all_of_them = [_parameter(name, parameters, scene) for name in self.names]
        stems = [n[: -len(".static")] for n in self.names if str(n).endswith(".static")]
        places: dict[str, int] = {
            name: i for i, name in enumerate(self.names if scene is not None else ())
        }
        #: places of both coefficients of laws of friction
        self.pairs = [(places[f"{stem}.static"], places[f"{stem}.kinetic"]) for stem in stems
                      if {f"{stem}.static", f"{stem}.kinetic"} <= places.keys()]  # fmt: skip
        self.start = np.array([p.start for p in all_of_them])
        self.step = np.array([p.step for p in all_of_them])
        self.lower = np.array([p.lower for p in all_of_them])
        self.upper = np.array([p.upper for p in all_of_them])

    def clip(self, values: np.ndarray) -> np.ndarray:
        """Return the values moved inside the bounds, static coefficients up to kinetic ones."""
        values = np.clip(values, self.lower, self.upper)
        for static, kinetic in self.pairs:
            values[static] = max(values[static], values[kinetic])
        return values

    def named(self, values) -> dict[str, float]:
        """Return values by name."""
        return dict(zip(self.names, map(float, values)))


def _bounds(name: str, given: Mapping, scene: Scene | None) -> tuple[float, float, float]:
    """Return the bounds of a parameter, and a step for the start of a search, or 0 if none is known."""
    if scene is None:
        return -np.inf, np.inf, 0.0
    if name in KNOWN or not isinstance(name, str) or not ("." in name or name == "gravity"):
        return KNOWN[checks.choice("a name in parameters", name, KNOWN)]
    stem, component = split(scene, name, "parameters")
    found = find(scene, stem)
    assert found is not None
    value: Any = found.value
    if not component and (np.ndim(value) > 0 or isinstance(value, (str, SpeedLaw))):
        label = next(iter(components(found)), "x")
        raise ValueError(
            f"parameters must be numbers, got {name!r}, which is none; of a vector give components, like "
            f"{f'{name}.{label}'!r}"
        )
    if isinstance(value, SpeedLaw):  # a number of a law
        low, high = Found(found.owner, found.field, component).bounds
        if isinstance(law := value, Friction):  # 0 is none of its numbers
            low = max(low, LEAST_PART * getattr(law, component))
            if component == "kinetic" and f"{stem}.static" not in given:
                high = law.static
            elif component == "static" and f"{stem}.kinetic" not in given:
                low = law.kinetic
        return low, high, 0.0
    if component:
        return -np.inf, np.inf, 0.0
    return (*found.bounds, 0.0)


def _parameter(name: str, given: Mapping, scene: Scene | None) -> Parameter:
    bounds, value = _bounds(name, given, scene), given[name]
    if isinstance(value, Parameter):
        low, high = max(value.lower, bounds[0]), min(value.upper, bounds[1])
        return Parameter(value.start, value.step, low, high)
    if isinstance(value, tuple) and len(value) == 2:
        return Parameter(value[0], value[1], bounds[0], bounds[1])
    if not isinstance(value, bool) and isinstance(value, (int, float)) and bounds[2] > 0.0:
        return Parameter(value, bounds[2], bounds[0], bounds[1])
    raise ValueError(
        f"parameters[{name!r}] must be a Parameter or (start, step)"
        + (", or a number to start from" if bounds[2] > 0.0 else "")
        + f", got {checks.shown(value)}"
    )
