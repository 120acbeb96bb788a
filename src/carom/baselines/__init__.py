"""Classical integrators for comparison with the methods of carom.

They are written in plain NumPy, for readers and for comparisons; they are not optimised for speed.
"""

from carom.baselines.hht_layer import (
    LayerRun,
    completing_steps,
    first_completing_steps,
    hht_alpha_layer,
)
from carom.baselines.moreau_jean import MoreauJeanRun, moreau_jean
from carom.baselines.one_contact import solve_one_contact

__all__ = [
    "LayerRun",
    "MoreauJeanRun",
    "completing_steps",
    "first_completing_steps",
    "hht_alpha_layer",
    "moreau_jean",
    "solve_one_contact",
]


def __dir__() -> list[str]:
    return __all__
