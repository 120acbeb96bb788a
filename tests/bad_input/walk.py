"""Each parameter of each public callable with values of every wrong kind: what is not as it should be.

``python -m bad_input.walk`` in the folder of tests tries all kinds, and prints what it finds.
"""

import inspect
import os
import random
import re
import signal
import tempfile
import time
from pathlib import Path

import numpy as np

from bad_input.kinds import NO_NUMBERS, WRONG
from bad_input.modes import modal
from bad_input.reads import read
from bad_input.runs import run
from bad_input.states import stated
from carom import MistakeWarning, SimulationError

LIMIT = 120.0  # seconds that a call may take: the first of its kind is compiled

#: errors that the documentation names, beside ValueError and TypeError
DOCUMENTED = {
    "Solution.joint_coordinates": KeyError,
    "Solution.surface_power": KeyError,
    "results.SystemState.joint_coordinates": KeyError,
    "Solution.impact_forces": IndexError,
    "Solution.impact_history": IndexError,
    "Mesh.load": FileNotFoundError,
    "Solution.load": FileNotFoundError,
    "Ensemble.load": FileNotFoundError,
    "load_model": FileNotFoundError,
    "resume": FileNotFoundError,
    "simulate": SimulationError,
    "view": FileNotFoundError,
}
#: what a message may name in the place of the argument: what that does not fit
INSTEAD = {
    ("curves.Curve", "start"): "end",
    ("Scene.add_force", "definition"): "parent",
    ("gradient.impact_derivative", "friction"): "the impact",
    ("Solution.plot", "what"): "contacts",
    ("load_model", "source"): "model file",
    ("view", "solution"): "path",
}
#: whose values may be functions, and so classes
FUNCTIONS = {
    ("forces.JointForce", "force"),
    ("forces.Wind", "velocity"),
    ("Scene.add_half_space", "surface_velocity"),
    ("Scene.add_static", "surface_velocity"),
    ("Scene.add_surface", "surface_velocity"),
}
#: values that are right, and ask for a run of hours, or for a server
LONG = {"million", "ten to the twelve", "beyond 64 bits"}
RIGHT = {"duration": LONG, "until": LONG, "export": {"none"}}


def recipes(folder):
    """Return functions of (callable, arguments that work) by name."""
    return {**stated(), **modal(folder), **run(folder), **read(folder)}


def plain(name: str) -> str:
    """Return the name of the callable of a recipe: a second recipe says in words what differs."""
    return name.split(" ")[0]


def is_number(value) -> bool:
    """Return whether an argument that works is a number or an array of numbers."""
    if isinstance(value, (bool, str)) or value is None:
        return False
    if not isinstance(value, (int, float, list, tuple, np.ndarray)):
        return False
    try:
        return np.asarray(value).dtype.kind in "if" and np.size(value) > 0
    except ValueError:  # ragged
        return False


def wrong_kinds(name: str, parameter: str, value, some: int | None = None) -> list[str]:
    """Return the kinds to try for a parameter: all, or `some`, which depend on the names alone.

    Half of the chosen are such as look like numbers, where one is asked for.
    """
    kinds = [kind for kind in WRONG if kind not in RIGHT.get(parameter, ())]
    if some is None:
        return kinds
    chance = random.Random(f"{name}.{parameter}")
    likely = chance.sample(sorted(NO_NUMBERS), some // 2) if is_number(value) else []
    return [*likely, *chance.sample([k for k in kinds if k not in likely], some - len(likely))]


class Hangs(BaseException):
    """A call has not come back in time."""


def in_time(call, arguments):
    """Return what a call gives; raise `Hangs` where it does not return within `LIMIT`."""

    def stop(*_):
        raise Hangs

    if not hasattr(signal, "setitimer"):
        return call(**arguments)
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, LIMIT)
    try:
        return call(**arguments)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def complaint(name: str, make, parameter: str, kind: str) -> str | None:
    """Return what is wrong with how one call with one wrong value ends; None if it is as it should be."""
    call, arguments = make()
    asked, value = arguments[parameter], WRONG[kind]()
    try:
        in_time(call, {**arguments, parameter: value})
    except Hangs:
        return "does not return"
    except BaseException as error:
        return _of_error(plain(name), parameter, error)
    if is_number(asked) and kind in NO_NUMBERS and (plain(name), parameter) not in FUNCTIONS:
        return "takes it for a number"
    return None


def _of_error(name: str, parameter: str, error: BaseException) -> str | None:
    notes = " ".join(getattr(error, "__notes__", ()))
    words = f"{error} {notes}"
    named = rf"(?<![A-Za-z_]){parameter}(?![A-Za-z_])"
    instead = INSTEAD.get((name, parameter))
    if re.search(rf"raised by .*{named}", notes):
        return None  # an error of the function that was given, which says so
    if isinstance(error, MistakeWarning):
        return (
            None  # the value is allowed, and the warning, an error here, says what is likely wrong
        )
    if not isinstance(error, (ValueError, TypeError, DOCUMENTED.get(name, ValueError))):
        return f"raises {type(error).__name__}: {words:.200}"
    if isinstance(error, SimulationError):
        return None
    if not re.search(named, words) and not (instead and instead in words):
        return f"is not named by {type(error).__name__}: {words:.200}"
    if len(words) > 1000:
        return f"is answered by {len(words)} characters: {words:.100}"
    return None


def complaints(name: str, make, some: int | None = None) -> list[str]:
    """Return what is wrong with the calls of one recipe."""
    found = []
    for parameter, value in make()[1].items():
        for kind in wrong_kinds(name, parameter, value, some):
            what = complaint(name, make, parameter, kind)
            if what:
                found.append(f"{name}: {parameter} = {kind} {what}")
    return found


def parameters(call) -> set[str]:
    """Return the names of all parameters of a callable but ``**options``."""
    given = inspect.signature(call).parameters.values()
    return {one.name for one in given if one.kind is not one.VAR_KEYWORD}


def main() -> None:
    """Try all kinds, or those of the recipes whose names hold a word of the command line."""
    import sys
    import warnings

    import matplotlib
    import matplotlib.pyplot as plt

    matplotlib.use("agg")
    warnings.simplefilter("error")
    folder = Path(tempfile.mkdtemp())
    os.chdir(folder)  # where a word is taken as a path
    for name, make in recipes(folder).items():
        if sys.argv[1:] and not any(word in name for word in sys.argv[1:]):
            continue
        begin = time.perf_counter()
        found = complaints(name, make)
        plt.close("all")
        print(f"{time.perf_counter() - begin:7.2f} s  {len(found):3d}  {name}", flush=True)
        for line in found:
            print("      ", line.replace("\n", " "))


if __name__ == "__main__":
    main()
