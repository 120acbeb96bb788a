"""A run as those see it who take it to its end: how far it is, and why it stops."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from carom.model.records import PAUSE
from carom.status import Status

if TYPE_CHECKING:
    from carom._compiled.user_functions import Functions
    from carom.stepping.grid import Grid


class Running(ABC):
    """Base class of runs of scenes and of systems in coordinates."""

    #: is asked at pauses; True interrupts the run
    to_stop: Callable[[], bool] = staticmethod(lambda: False)
    clock: Any  # (1,) with the time `now` and the number `step` of finished steps
    grid: Grid
    functions: Functions  # of the user

    @property
    def steps(self) -> int:
        """Number of steps to the end."""
        return self.grid.last

    @property
    def steps_done(self) -> int:
        """Number of finished steps."""
        return int(self.clock["step"][0])

    @property
    def reached(self) -> float:
        """Time that the run has reached [s]."""
        return float(self.clock["now"][0])

    @property
    def failure(self) -> BaseException | None:
        """The error that a user-defined function has raised, or None."""
        return self.functions.failed

    @abstractmethod
    def take_steps(self, until: int) -> int:
        """Continue to step number `until`; return a status, or PAUSE."""

    @abstractmethod
    def blame_compiled(self) -> None:
        """Take the failed step once more, with compiled functions called from Python, which notes faults."""

    def begin(self) -> float:
        """Return the time from which on the result of a function may have ended the run."""
        return self.reached

    def go_on(self, until: int) -> Status:
        """Continue to step number `until`, or to a failure."""
        while True:
            code = self.take_steps(int(until))
            if code == PAUSE and self.failure is None:
                if self.to_stop():  # here Ctrl-C is raised
                    return Status.INTERRUPTED
            elif isinstance(self.failure, KeyboardInterrupt):  # while a plain function ran
                self.functions.forget()
                return Status.INTERRUPTED
            elif self.failure is not None or self.is_to_blame(code):
                return Status.FUNCTION_FAILED
            else:
                return Status(code)

    def is_to_blame(self, code: int) -> bool:
        """Return whether a user-defined function without a finite result has ended the run."""
        functions, begin = self.functions, self.begin()
        if code == Status.SUCCESS or functions.blame(begin) or not functions.has_compiled:
            return self.failure is not None
        self.blame_compiled()
        return functions.blame(begin)
