"""User-defined functions, called from compiled code through an address.

All have one form: ``f(t, x, out)`` reads a time and an array of numbers and writes an array of numbers. A
function compiled by Numba is called directly (50 ns, with a new array for the result); a plain Python
function is called through `ctypes` with the interpreter's lock (1 to 2 microseconds). The address is a number
in the data of a run, so a new function does not cause a new compile of the loop.

An error in a plain function cannot pass through compiled code: it is stored, the result is NaN, the run stops,
and then the error is raised (`Functions.failed`). A result that is not finite does not stop the run, because a
shorter step may do without it: it is noted, and named if the run then fails. A function that Numba has compiled
notes nothing. After a failure its step is taken once more with an address at which Python calls the function.
"""

from __future__ import annotations

import ctypes
import math
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import carray, cfunc  # pyright: ignore[reportPrivateImportUsage]
from numba.core import types

from carom._compiled.call_address import FORM
from carom._compiled.composed import is_compiled, once
from carom._compiled.decorators import COMPILES

if COMPILES:
    from carom._compiled.kept_code import code_of
else:  # nothing of this Numba is known but what all versions have

    def code_of(function, signature) -> Any:
        """Compile in this process."""
        return cfunc(signature)(function)


MOST_PLACES = 100  # arrays that are kept
MOST_FAULTS = 100  # that are noted: more than a trial step has stages
HUGE = 1e30  # of a state, in any unit: what overflows there, or is NaN, is a motion that diverges
_SIGNATURE = types.void(types.float64, types.CPointer(types.float64), types.CPointer(types.float64))


class Fault(NamedTuple):
    """A call of a user-defined function that raised an error, or returned a number that is not finite."""

    # or what finds it among the functions that make this one
    name: str | Callable[[float, np.ndarray], str]
    t: float
    x: np.ndarray
    what: str

    def __str__(self) -> str:
        said = self.name(self.t, self.x) if callable(self.name) else f"{self.name} {self.what}"
        return f"{said} at t = {self.t:.9g} s" if said else ""


def returned(values) -> str:
    """Return what a function returned that is not finite: the first such number; "" if all are finite."""
    values = np.ravel(values)
    wrong = values[~np.isfinite(values)]
    return f"returned {wrong[0]}" if len(wrong) else ""


def raised(error: BaseException) -> str:
    """Return which error a function has raised."""
    text = str(error)
    return f"raised {type(error).__name__}{': ' if text else ''}{text}"


class Functions:
    """The functions of one run: references to them, and the first error that one of them raised."""

    def __init__(self):
        self._kept: list[Any] = []
        self._plainly: dict[int, tuple] = {}  # of compiled ones by their address
        self.forget()

    def forget(self) -> None:
        """Forget what the functions have raised and returned."""
        self.failed: BaseException | None = None
        self.reason = ""  # which function failed, how and when
        self.calls = 0  # of plain functions
        self.faults: deque[Fault] = deque(maxlen=MOST_FAULTS)

    def fail(self, error: BaseException, reason: str) -> None:
        """Store an error, and which function raised it."""
        self.failed, self.reason = error, reason

    def blame(self, since: float) -> bool:
        """Store as an error the first result that is not finite from the time `since` on, if there is one."""
        for fault in sorted(self.faults, key=lambda fault: fault.t):
            reason = str(fault) if fault.t >= since and self.failed is None else ""
            if reason:
                self.fail(ValueError(reason), reason)
        return self.failed is not None

    def address(self, function: Callable, inside: tuple[int, ...], outside: tuple[int, ...], name):
        """Return the address of ``function(t, x) -> y``, x and y arrays of the given shapes.

        `name` is that of the function in messages, or a function that returns what is to be said about a state.
        """
        if is_compiled(function):
            made = _compiled(function, inside, outside)
            self._kept.append(made)
            # one function for several parts
            if made.address in self._plainly and not callable(name):
                name = f"{self._plainly[made.address][-1]} or {name}"
            self._plainly[made.address] = function, inside, outside, name
            return made.address
        made = FORM(self._plain(function, inside, outside, name))
        self._kept.append(made)
        return ctypes.cast(made, ctypes.c_void_p).value

    def written(
        self, function: Callable, inside: tuple[int, ...], outside: tuple[int, ...], name: str
    ):
        """Return the address of ``function(t, x, out)``, which only reads and writes numbers of its arguments.

        It is compiled without a wrapper for arrays, for code that the library itself has written.
        """

        def called(t, x):
            out = np.empty(outside)
            function(t, x, out)
            return out

        if not COMPILES:
            return self.address(called, inside, outside, name)
        made: Any = code_of(function, _SIGNATURE)
        self._kept.append(made)
        self._plainly[made.address] = called, inside, outside, name
        return made.address

    @property
    def has_compiled(self) -> bool:
        """Whether Numba has compiled some of them, which note nothing."""
        return len(self._plainly) > 0

    def call_from_python(self, columns) -> None:
        """Write into arrays other addresses of compiled functions: Python calls those, and notes faults."""
        others = {}
        for at, one in self._plainly.items():
            made = FORM(self._plain(*one))
            self._kept.append(made)
            others[at] = ctypes.cast(made, ctypes.c_void_p).value
        for column in columns:
            column[...] = [others.get(int(at), int(at)) for at in column]

    def _plain(self, function, inside, outside, name):
        inputs, outputs = Arrays(inside), Arrays(outside)
        flat, square = len(outside) == 1, np.vdot  # a tenth to a third of the time of `isfinite`

        def call(t, read, write):
            out = outputs[write]
            self.calls += 1
            if self.failed is not None:
                out[...] = np.nan
                return
            try:
                out[...] = function(t, inputs[read])
            except BaseException as error:  # errors cannot pass through the compiled loop
                out[...] = np.nan
                reason = ""
                if isinstance(error, Exception):
                    reason = str(Fault(name, t, inputs[read].copy(), raised(error)))
                    error.add_note(reason)
                self.fail(error, reason)
                return
            total = sum(out.tolist()) if flat else square(out, out)
            if not -math.inf < total < math.inf:
                note(t, inputs[read], returned(out))

        def note(t, x, what):
            if what and np.all(np.abs(x) < HUGE):
                self.faults.append(Fault(name, t, x.copy(), what))

        return call


class Arrays(dict):
    """Arrays of one shape by the address of their numbers, made once: a run has few places for them."""

    def __init__(self, shape: tuple[int, ...]):
        super().__init__()
        self.shape = shape

    def __missing__(self, address: int) -> np.ndarray:
        """Make the array."""
        if len(self) >= MOST_PLACES:
            self.clear()
        numbers = (ctypes.c_double * math.prod(self.shape)).from_address(address)
        self[address] = np.ctypeslib.as_array(numbers).reshape(self.shape)
        return self[address]


@once
def _compiled(function, inside, outside):
    """Compile the wrapper of a function that Numba has compiled."""

    def call(t, read, write):
        out, at = carray(write, outside).reshape(-1), 0
        try:  # an assignment of arrays brings the words of its error for unequal shapes: 2 s to compile
            found = np.asarray(function(t, carray(read, inside)))
            if found.size != out.size:
                raise ValueError
            for value in found.flat:
                out[at] = value
                at += 1
        except Exception:  # Numba would print each
            out[:] = math.nan

    return code_of(call, _SIGNATURE)
