"""Limit of the work of a step for contacts, about [us]; work that is not used is saved for later steps."""

from __future__ import annotations

from carom._compiled.decorators import kernel

EACH, SAVED = 1e4, 3e5  # limits of the average step, and of a step after others that took less


@kernel
def affordable(controls, clock):
    """Return the limit of the work of a step; with `retry`, a step that needs more is given up."""
    return max(EACH, clock.credit) if controls.retry == 1 else SAVED
