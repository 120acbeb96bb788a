"""How a run ended, in sentences."""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """Why a run stopped. Each member has a `message`: the cause, and what to change."""

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

    @property
    def ended(self) -> bool:
        """Whether the run reached its end or an event that ends it, with or without the balance of energy."""
        return self in (Status.SUCCESS, Status.STOPPED, Status.INACCURATE)

    @property
    def message(self) -> str:
        """The sentence for this status."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.SUCCESS: "The run reached its end.",
    Status.NO_CONVERGENCE: (
        "The iteration of a step did not converge; take a smaller step, or raise "
        "Options.max_iterations."
    ),
    Status.STEP_CUT_TO_NOTHING: (
        "The step was cut to nothing while looking for an impact; the motion has an event that "
        "cannot be located. Take a smaller step, or raise Options.gap_tolerance."
    ),
    Status.TOO_MANY_IMPACTS: (
        "More impacts in one step than Options.max_impacts_per_step: impacts accumulate and no "
        "contact can be held. Take a smaller step, or a restitution below 1."
    ),
    Status.NOT_FINITE: (
        "A position or velocity is no longer finite: the motion diverged. Take a smaller step, or "
        "look at forces and stiffnesses."
    ),
    Status.RETURN_MAP_FAILED: (
        "The return map to the surface of contact did not converge; the penetration of one step is "
        "too deep. Take a smaller step."
    ),
    Status.IMPACT_FAILED: (
        "Something drives a pair that friction holds wedged, so that no impulse stops it, or the equations of "
        "the boundary layer were not solved; look at W, the friction and the velocity of the last impact."
    ),
    Status.CONSTRAINTS_LOST: (
        "The bilateral constraints could not be met at the end of a step: the mechanism is in a "
        "position that it cannot leave, or the step is too large. Take a smaller step."
    ),
    Status.FUNCTION_FAILED: (
        "A function given by the user raised an error, which is the cause of this one; the solution holds what "
        "was computed until then."
    ),
    Status.TOO_MANY_POINTS: (
        "More than 192 points of a group of bodies are closed at once. Give the shapes fewer vertices."
    ),
    Status.SINGULAR_METRIC: (
        "The metric is not positive definite at a position on the way: the coordinates are singular there. "
        "Take others, or a smaller step."
    ),
    Status.STEP_TOO_SMALL: (
        "The step that the tolerances ask for has become too small: a force jumps or grows without "
        "bound, or rtol and atol are below round-off. Raise them, or give a step."
    ),
    Status.INACCURATE: (
        "The run reached its end, but its energy is off by more than a hundred times "
        "Options.energy_tolerance, or a body is in what it touches by more than 1e-2 of its size, or contacts "
        "were solved to no better than a tenth of the greatest speed. The solution is whole; do not trust it "
        "before a smaller step agrees."
    ),
    Status.UNSTABLE: (
        "Each step, however short it was cut, gained as much energy as it exchanged: springs, dampers or loads "
        'are too stiff for the step. Take a smaller step, or method="implicit".'
    ),
    Status.BLOCKED: (
        "A driver moves a body into what it touches and leaves it no way to yield: no motion meets both. "
        "Change the motion that is prescribed, or join the body by a spring or a joint that lets it yield."
    ),
    Status.STOPPED: "An event ended the run, as it was asked to.",
    Status.INTERRUPTED: "The run was interrupted; the solution holds what was computed until then.",
}


class AccuracyWarning(UserWarning):
    """A run has energy without a name, or a body in a surface; `Solution.warnings` says how much."""


class MistakeWarning(UserWarning):
    """Something that is nearly always a mistake: a body that nothing can touch, a step that is far too long."""


class SimulationError(RuntimeError):
    """A run that failed.

    Attributes
    ----------
    solution : Solution or None
        Everything up to the failure; all of the run if it was inaccurate.
    """

    def __init__(self, message: str, solution=None):
        super().__init__(message)
        self.solution = solution
