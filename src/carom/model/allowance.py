"""Limit of the work of a step for contacts, about [us]; work that is not used is saved for later steps."""

from __future__ import annotations

from carom._compiled.decorators import kernel

EACH, SAVED = 1e4, 3e5  # limits of the average step, and of a step after others that took less
STEPS = 200.0  # of a run, if it has fewer: where few states are saved a step takes more work


@kernel
def affordable(controls, clock):
    """Return the limit of the work of a step; with `retry`, a step that needs more is given up."""
    return max(of_step(controls), clock.credit) if controls.retry == 1 else SAVED


@kernel
def of_step(controls):
    """Return the limit of the average step."""
    return EACH * max(1.0, STEPS * controls.interval / controls.duration)
