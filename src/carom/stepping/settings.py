"""The settings of a run: checked, and completed."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.dynamics.methods import ADAPTIVE, CARRIES, EXPLICIT, METHODS
from carom.options import Options
from carom.scene.limits import check_location
from carom.scene.more_forces import JointFriction, JointInertia
from carom.scene.scene import Scene

LOCATIONS = ("locate", "project", "work")
_DEFAULT = Options()


def check_handling(progress, throw, save_seconds) -> None:
    """Raise for invalid settings of how a run is watched, saved and ended."""
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise TypeError(f"progress must be True, False or a function, got {checks.shown(progress)}")
    if not isinstance(throw, bool):
        raise TypeError(f"throw must be True or False, got {checks.shown(throw)}")
    checks.number("save_seconds", save_seconds, least=0.0, unit="s")


def spacing(duration: float, step: float | str, options: Options) -> tuple[float, int]:
    """Return the step, or the longest one where steps vary, and the number of steps."""
    adapts = isinstance(step, str)
    h = min(duration, options.max_step or duration / 50.0) if adapts else float(step)
    if not duration < 1e12 * h:
        name = "duration / 50 or Options.max_step" if adapts else "step"
        raise ValueError(
            f"{name} must be above duration / 1e12 = {duration / 1e12:g} s, got {checks.shown(h)}"
        )
    return h, max(1, int(np.ceil(duration / h * (1.0 - 1e-12))))


def checked_settings(
    duration, step, method, impact_location, rtol, atol, save_every, options
) -> tuple[float, float, int, str, str, int, Options, tuple[float, float] | None]:
    """Return the settings of a `carom.run.Run`, checked: those of `simulate`, and what follows from them."""
    duration = checks.number("duration", duration, above=0.0, unit="s")
    adapts = isinstance(step, str) and step == "auto"
    if not adapts:
        if isinstance(step, str):
            raise ValueError(f'step must be a number [s] or "auto", got {checks.shown(step)}')
        step = checks.number("step", step, above=0.0, unit="s")
    method = ("rk5" if adapts else "rk4") if method is None else method
    checks.choice("method", method, METHODS)
    checks.choice("impact_location", impact_location, LOCATIONS)
    tolerances = check_tolerances(adapts, method, impact_location, rtol, atol)
    save_every = checks.integer("save_every", save_every, least=1)
    options = _DEFAULT if options is None else options
    if not isinstance(options, Options):
        raise TypeError(f"options must be carom.Options, got {type(options).__name__}")
    h, steps = spacing(duration, step, options)
    return duration, h, steps, method, impact_location, save_every, options, tolerances


def check_scene(scene: Scene, method: str, location: str) -> None:
    """Raise for a scene that cannot start, or cannot start with this method."""
    scene.validate()
    check_location(scene, location)
    check_method(scene, method)


def check_method(scene: Scene, method: str) -> None:
    """Refuse dry friction and inertia in joints for methods that do not know them."""
    if method not in EXPLICIT and any(
        isinstance(f.definition, JointFriction) for f in scene.forces
    ):
        raise ValueError(
            f"method must be {either(EXPLICIT)} where joints have dry friction, got {method!r}"
        )
    if method not in CARRIES and any(isinstance(f.definition, JointInertia) for f in scene.forces):
        raise ValueError(
            f"method must be {either(CARRIES)} where joints have inertia, got {method!r}; or use a body on a "
            "bearing, geared to the joint"
        )


def either(names) -> str:
    """Return names as `"a", "b" or "c"`."""
    *first, last = (f'"{name}"' for name in names)
    return " or ".join([*([", ".join(first)] if first else []), last])


def check_tolerances(adapts: bool, method: str, location: str, rtol, atol):
    """Return the tolerances (rtol, atol) of steps of varying length, or None for steps of one length."""
    if not adapts:
        for name, value in (("rtol", rtol), ("atol", atol)):
            if value is not None:
                raise ValueError(
                    f'{name} is for step="auto", got {checks.shown(value)} with a given step'
                )
        return None
    if method not in ADAPTIVE:
        raise ValueError(
            f'method must be {" or ".join(map(repr, ADAPTIVE))} for step="auto" (they estimate their error), '
            f"got {checks.shown(method)}"
        )
    if location != "locate":
        raise ValueError(
            f"impact_location must be 'locate' for step=\"auto\", got {checks.shown(location)}"
        )
    return (
        checks.number("rtol", 1e-6 if rtol is None else rtol, least=1e-13, most=0.1),
        checks.number("atol", 1e-9 if atol is None else atol, least=0.0, unit="m"),
    )
