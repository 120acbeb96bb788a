"""Classical integrators for comparison with the methods of carom.

They are written in plain NumPy, for readers and for comparisons; they are not optimised for speed.
"""

from carom.baselines.hht import HHTRun, hht_alpha
from carom.baselines.hht_layer import (
    LayerRun,
    completing_steps,
    first_completing_steps,
    hht_alpha_layer,
)
from carom.baselines.layer_exact import layer_motion
from carom.baselines.moreau_jean import MoreauJeanRun, moreau_jean
from carom.baselines.one_contact import cone_residual, solve_one_contact

__all__ = [
    "HHTRun",
    "LayerRun",
    "MoreauJeanRun",
    "completing_steps",
    "cone_residual",
    "first_completing_steps",
    "hht_alpha",
    "hht_alpha_layer",
    "layer_motion",
    "moreau_jean",
    "solve_one_contact",
]


def __dir__() -> list[str]:
    return __all__
