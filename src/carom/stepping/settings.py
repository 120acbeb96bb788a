"""The settings of a run, checked and completed."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.dynamics.methods import ADAPTIVE, CARRIES, EXPLICIT, METHODS
from carom.dynamics.thresholds import RTOL
from carom.options import Options
from carom.scene.joint_friction import DryFriction
from carom.scene.more_forces import JointInertia, has_kinks
from carom.scene.remarks import check_location, remarks
from carom.scene.scene import Scene
from carom.stepping.thresholds import LEAST_RTOL, MOST_STEPS, SMOOTH_RTOL, TIGHT_RTOL

LOCATIONS = ("locate", "project", "work")
_DEFAULT = Options()


def check_handling(progress, throw, save_seconds) -> None:
    """Refuse invalid values of `progress`, `throw` and `save_seconds`."""
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise TypeError(f"progress must be True, False or a function, got {checks.shown(progress)}")
    if not isinstance(throw, bool):
        raise TypeError(f"throw must be True or False, got {checks.shown(throw)}")
    checks.number("save_seconds", save_seconds, least=0.0, unit="s")


class Settings(NamedTuple):
    """The arguments of `simulate`, checked and completed."""

    duration: float
    step: float | None  # None if tolerances choose the steps
    method: str
    impact_location: str
    save_every: int
    save_at: float | tuple[float, ...] | None
    rtol: float  # 0 if the step is given
    atol: float | None  # None: `rtol` of the size of the smallest body
    options: Options
    earlier: tuple[float, ...] = ()  # earlier durations of the run, before it was continued

    @property
    def adapts(self) -> bool:
        """Whether tolerances choose the steps."""
        return self.step is None

    @property
    def finer(self) -> str:
        """How the run gets shorter steps, by what was given: the beginning of a sentence."""
        if self.step is not None:
            return f"Take a smaller step than {self.step:g} s"
        longest = self.options.max_step
        return f"Lower rtol (it is {self.rtol:g}) or Options.max_step" + (
            f" (it is {longest:g} s)" if longest else ""
        )

    def as_dict(self) -> dict:
        """Return all settings except the options, by name; without tolerances if the step was given."""
        known = self._asdict()
        del known["options"]
        if not self.earlier:
            del known["earlier"]
        if self.step is None:
            known["step"] = "auto"
        else:
            del known["rtol"], known["atol"]
        return known


def settings_of(known: dict, options: Options) -> Settings:
    """Return the settings that `Settings.as_dict` has written."""
    given: dict[str, Any] = {name: known.get(name) for name in Settings._fields}
    given["options"], given["earlier"] = options, tuple(known.get("earlier", ()))
    if given["step"] == "auto":
        given["step"] = None
    else:
        given["rtol"] = 0.0
    return Settings(**given)


def checked_settings(
    duration, step: Any = "auto", method=None, impact_location="locate", *, save_every=1, save_at=None,
    rtol=None, atol=None, options=None, scene=None,
) -> Settings:  # fmt: skip
    """Return the settings of a run from the arguments of `simulate`, checked; `scene` chooses the method."""
    duration = checks.number("duration", duration, above=0.0, unit="s")
    if isinstance(step, str):
        if step != "auto":
            raise ValueError(f'step must be a number [s] or "auto", got {checks.shown(step)}')
        h = None
    elif step is None:
        raise ValueError(
            'step must be a number [s] or "auto", which is the default, got None; without it the tolerances '
            "choose the steps"
        )
    else:
        h = checks.number("step", step, above=0.0, unit="s")
    checks.choice("impact_location", impact_location, LOCATIONS)
    rtol, atol = check_tolerances(h is None, rtol, atol)
    if method is None:
        method = default_method(h, rtol, scene)
    checks.choice("method", method, METHODS)
    if h is None:
        check_adaptive(method, impact_location)
    save_every = checks.integer("save_every", save_every, least=1)
    save_at = check_save_at(save_at, duration)
    if save_at is not None and save_every != 1:
        raise ValueError(f"save_every must be left out with save_at, got {save_every}")
    options = _DEFAULT if options is None else options
    if not isinstance(options, Options):
        raise TypeError(f"options must be carom.Options, got {type(options).__name__}")
    longest = h or options.max_step or duration
    if not duration < MOST_STEPS * longest:
        raise ValueError(
            f"{'step' if h else 'Options.max_step'} must be above duration / 1e12 = "
            f"{duration / MOST_STEPS:g} s, got {checks.shown(longest)}"
        )
    return Settings(
        duration=duration, step=h, method=method, impact_location=impact_location, save_every=save_every,
        save_at=save_at, rtol=rtol, atol=atol, options=options,
    )  # fmt: skip


def default_method(h: float | None, rtol: float, scene) -> str:
    """Return the method of a run that names none: where no event cuts its steps order 8 costs the least.

    Where forces may have kinks it has order 8 too, since that alone sees each of them (`dynamics.adapt`).
    """
    if h is not None:
        return "rk4"
    if isinstance(scene, Scene) and has_kinks(scene):
        return "rk8"
    return "rk8" if rtol <= (SMOOTH_RTOL if is_smooth(scene) else TIGHT_RTOL) else "rk5"


def is_smooth(scene) -> bool:
    """Return whether nothing in the scene strikes, and no dry friction sticks."""
    if isinstance(scene, Scene):
        sticks = any(isinstance(f.definition, DryFriction) for f in scene.forces)
        return not (scene.contacts or scene.contact_default or scene.stops or sticks)
    # of a system in coordinates; of a function that makes scenes it is not known
    return not getattr(scene, "contacts", True)


def check_save_at(save_at, duration: float) -> float | tuple[float, ...] | None:
    """Return the spacing or the times at which states are saved, checked.

    Raises
    ------
    TypeError, ValueError
        If it is neither a spacing above 0 nor increasing times within the run.
    """
    if save_at is None:
        return None
    several = isinstance(save_at, (list, tuple, range)) or getattr(save_at, "shape", ()) != ()
    if not several:
        spacing = checks.number("save_at", save_at, above=0.0, most=duration, unit="s")
        if not duration < MOST_STEPS * spacing:
            raise ValueError(
                f"save_at must be above duration / 1e12 = {duration / MOST_STEPS:g} s, got {spacing:g}"
            )
        return spacing
    times = checks.times("save_at", save_at, 0.0, duration)
    if not (len(times) and np.all(np.diff(times) > 0.0)):
        raise ValueError(f"save_at must be increasing times, got {checks.shown(save_at)}")
    return tuple(times.tolist())


def check_scene(scene: Scene, settings: Settings) -> None:
    """Refuse a scene that cannot start, or that this method does not support."""
    scene._derived.once("valid", scene.validate)
    check_location(scene, settings.impact_location)
    check_method(scene, settings.method)


def mistakes(scene, settings: Settings) -> tuple[str, ...]:
    """Return sentences about settings and parts of the scene that are nearly always a mistake."""
    known = isinstance(scene, Scene)
    found = scene._derived.once("remarks", lambda: remarks(scene)) if known else ()
    if settings.step is not None and settings.step > settings.duration:
        said = f"step={settings.step:g} s is longer than the run of {settings.duration:g} s"
        return (*found, f"{said}, so the run is one step. Give a shorter step, or leave step out.")
    return found


def check_method(scene: Scene, method: str) -> None:
    """Refuse dry friction and inertia in joints for methods that do not support them."""
    if method not in EXPLICIT and any(isinstance(f.definition, DryFriction) for f in scene.forces):
        raise ValueError(
            f"method must be {either(EXPLICIT)} if joints have dry friction, got {method!r}"
        )
    if method not in CARRIES and any(isinstance(f.definition, JointInertia) for f in scene.forces):
        raise ValueError(
            f"method must be {either(CARRIES)} if joints have inertia, got {method!r}; or use a body on a "
            "bearing and a gear to the joint"
        )


def check_coordinates(settings: Settings) -> None:
    """Refuse settings that a system in coordinates does not take."""
    checks.choice("method of a system in coordinates", settings.method, EXPLICIT)
    checks.choice(
        "impact_location of a system in coordinates", settings.impact_location, LOCATIONS[:1]
    )


def either(names) -> str:
    """Return names as `"a", "b" or "c"`."""
    *first, last = (f'"{name}"' for name in names)
    return " or ".join([*([", ".join(first)] if first else []), last])


def check_tolerances(adapts: bool, rtol, atol) -> tuple[float, float | None]:
    """Return the tolerances; refuse them if the step is given."""
    if adapts:
        rtol = checks.number("rtol", RTOL if rtol is None else rtol, least=LEAST_RTOL, most=0.1)
        return rtol, None if atol is None else checks.number("atol", atol, least=0.0, unit="m")
    for name, value in (("rtol", rtol), ("atol", atol)):
        if value is not None:
            raise ValueError(
                f"{name} must be left out with a given step, got {checks.shown(value)}"
            )
    return 0.0, None


def check_adaptive(method: str, location: str) -> None:
    """Refuse tolerances with a method that does not estimate its error, or without located impacts."""
    if method not in ADAPTIVE:
        raise ValueError(
            f"step must be a number for method={method!r}: only {either(ADAPTIVE)} estimate their error and "
            "choose their steps"
        )
    if location != "locate":
        raise ValueError(f"step must be a number for impact_location={location!r}")
