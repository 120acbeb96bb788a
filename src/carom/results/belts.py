"""A sentence about belts that transmit more than their tension allows: one of their strands would push."""

from __future__ import annotations

import numpy as np

from carom.scene.belts import BeltRelation


def pushing_belts(solution) -> tuple[str, ...]:
    """Return a sentence about the belt with a stated tension whose strand pushes most at the saved times."""
    worst, said = 0.0, ()
    for one in solution.scene.constraints:
        if not isinstance(one.definition, BeltRelation) or not one.definition.tension > 0.0:
            continue
        least = solution[one.name].tension.min(axis=1)
        k = int(np.argmin(least))
        if least[k] < worst:
            worst = float(least[k])
            said = (
                f"A strand of the belt {one.name!r} pushes with {-worst:.3g} N at t = {solution.t[k]:.6g} s: "
                f"with a tension of {one.definition.tension:g} N it transmits at most twice as much. A real "
                "belt goes slack there: state a greater tension, or one_sided=True, where strands only pull.",
            )
    return said
