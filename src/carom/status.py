"""`Status`: how a run ended, with a message for each status; warnings and errors of a run."""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """How a run ended. Each member has a `message` with the cause and a remedy."""

    SUCCESS = 0
    NO_CONVERGENCE = 1
    STEP_CUT_TO_NOTHING = 2
    TOO_MANY_IMPACTS = 3
    NOT_FINITE = 4
    RETURN_MAP_FAILED = 5
    IMPACT_FAILED = 6
    CONSTRAINTS_LOST = 7
    FUNCTION_FAILED = 8
    INTERRUPTED = 9
    TOO_MANY_POINTS = 10
    SINGULAR_METRIC = 11
    STEP_TOO_SMALL = 12
    INACCURATE = 13
    UNSTABLE = 14
    BLOCKED = 15
    STOPPED = 16
    LEFT_CURVE = 17
    OUT_OF_PLANE = 18

    @property
    def ended(self) -> bool:
        """Whether the run reached its end, or an event that ends it, whatever its energy balance."""
        return self in (Status.SUCCESS, Status.STOPPED, Status.INACCURATE)

    @property
    def message(self) -> str:
        """The cause of this status and a remedy, in sentences."""
        return self.advice("Take a smaller step, or lower the tolerances")

    @property
    def cause(self) -> str:
        """The cause of this status, in sentences."""
        return _MESSAGES[self][0]

    def advice(self, finer: str) -> str:
        """Return cause and remedy; `finer` says how this run gets shorter steps (`Settings.finer`)."""
        return " ".join(filter(None, _MESSAGES[self])).format(finer=finer)


#: the same as plain integers, which kernels return
(
    SUCCESS, NO_CONVERGENCE, STEP_CUT_TO_NOTHING, TOO_MANY_IMPACTS, NOT_FINITE, RETURN_MAP_FAILED,
    IMPACT_FAILED, CONSTRAINTS_LOST, FUNCTION_FAILED, INTERRUPTED, TOO_MANY_POINTS, SINGULAR_METRIC,
    STEP_TOO_SMALL, INACCURATE, UNSTABLE, BLOCKED, STOPPED, LEFT_CURVE, OUT_OF_PLANE,
) = map(int, Status)  # fmt: skip

#: cause and remedy; {finer} says how a run gets shorter steps
_MESSAGES: dict[Status, tuple[str, str]] = {
    Status.SUCCESS: ("The run reached its end.", ""),
    Status.NO_CONVERGENCE: (
        "The iteration of a step did not converge.",
        "{finer}, or raise Options.max_iterations.",
    ),
    Status.STEP_CUT_TO_NOTHING: (
        "The step was halved Options.max_cuts times, but an impact in it could not be located.",
        "{finer}, or raise Options.gap_tolerance.",
    ),
    Status.TOO_MANY_IMPACTS: (
        "One step has more impacts than Options.max_impacts_per_step: impacts accumulate, and no contact "
        "becomes persistent.",
        "{finer}, or take a restitution below 1.",
    ),
    Status.NOT_FINITE: (
        "A position or velocity is not finite: the motion diverged.",
        "{finer}, or check the forces and stiffnesses.",
    ),
    Status.RETURN_MAP_FAILED: (
        "The return map to the contact surface did not converge: a body penetrates too deeply in one step.",
        "{finer}.",
    ),
    Status.IMPACT_FAILED: (
        "An impact has no solution: a driver moves a pair that is wedged by friction, so that no impulse stops "
        "it, or the equations of the boundary layer could not be solved.",
        "Check W (the Delassus operator), the friction and the velocity of the last impact.",
    ),
    Status.CONSTRAINTS_LOST: (
        "The bilateral constraints could not be satisfied at the end of a step: the mechanism is locked, or "
        "the step is too large.",
        "{finer}.",
    ),
    Status.FUNCTION_FAILED: (
        "A function given by the user raised an error, or returned a number that is not finite (the cause of "
        "this error).",
        "The solution has all results up to then.",
    ),
    Status.TOO_MANY_POINTS: (
        "A group of bodies has more closed contact points at once than there is room for: 192 with joints or "
        "in an impact.",
        "Give the shapes fewer vertices.",
    ),
    Status.SINGULAR_METRIC: (
        "The metric is not positive definite at a position of the motion: the coordinates are singular there.",
        "Use other coordinates. {finer}.",
    ),
    Status.STEP_TOO_SMALL: (
        "The tolerances need steps that are too small: a force jumps or grows without bound, rtol and atol are "
        "below round-off, or the motion is so fast that the rest of the run would take more than 3e7 steps.",
        "Raise rtol and atol, give a step, or make the run shorter.",
    ),
    Status.INACCURATE: (
        "The run reached its end, but it is inaccurate.",
        "The solution is complete; do not trust it before the reason is removed.",
    ),
    Status.UNSTABLE: (
        "The steps gained as much energy as they exchanged, even after they were shortened: springs, dampers "
        "or loads are too stiff for the step.",
        '{finer}, or use method="implicit" with a step.',
    ),
    Status.BLOCKED: (
        "A driver presses a body against another one, a half-space or a stop, and what lies between cannot "
        "move away: no motion satisfies both the driver and the contacts.",
        "Change the prescribed motion, give the driver a limit (Driver(..., limit=)), or attach the body by a "
        "spring, or by a joint that lets it move away.",
    ),
    Status.STOPPED: ("An event ended the run, as requested.", ""),
    Status.LEFT_CURVE: (
        "A point has passed an end of its curve, which is open.",
        "Add stops at its ends (Scene.add_stop), make the curve longer, or close it.",
    ),
    Status.OUT_OF_PLANE: (
        "A body near a Profile has tipped by more than a degree out of the plane in which a Profile touches.",
        "Hold both in its plane by joints (Planar, Revolute, Prismatic).",
    ),
    Status.INTERRUPTED: (
        "The run was interrupted.", "The solution has all results up to then.",
    ),
}  # fmt: skip


class AccuracyWarning(UserWarning):
    """A run changes energy without an explanation, or a body penetrates a surface; see `Solution.warnings`."""


class MistakeWarning(UserWarning):
    """The input is nearly always a mistake, for example a body that cannot touch anything, or a huge step."""


class SimulationError(RuntimeError):
    """A run failed.

    Attributes
    ----------
    solution : Solution or None
        The results up to the failure; those of the whole run if its status is `Status.INACCURATE`.
    """

    def __init__(self, message: str, solution=None):
        super().__init__(message)
        self.solution = solution


class Remark(str):
    """A sentence about the laws that a scene states, not about the accuracy of a run: no Python warning."""

    __slots__ = ()


class Advice(Remark):
    """A remark on what a user will want to change in scene or settings: `simulate` says a `MistakeWarning`."""

    __slots__ = ()
