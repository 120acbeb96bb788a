"""How much work a step may take for contacts, about [us]: what is not used is saved for later steps."""

from __future__ import annotations

from carom._compiled.decorators import kernel

EACH, SAVED = 1e4, 3e5  # what a step may take on the average, and one after others that took less


@kernel
def affordable(controls, clock):
    """Return how much work a step may take: more than that, and it is given up, where that can be done."""
    return max(EACH, clock.credit) if controls.retry == 1 else SAVED
