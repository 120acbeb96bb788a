"""One frictional impact: the boundary layer, slip and stick, laws of restitution, the impact solver."""

from carom.impact.api import Impact, resolve_impact
from carom.impact.force import ImpactForce
from carom.impact.geometry import NormalMotion, diagonal_form
from carom.impact.history import LayerHistory, impact_layer
from carom.impact.multiple.forces import ImpactForces
from carom.impact.slip_directions import (
    InvariantDirections,
    critical_friction,
    invariant_directions,
)

__all__ = [
    "Impact",
    "ImpactForce",
    "ImpactForces",
    "InvariantDirections",
    "LayerHistory",
    "NormalMotion",
    "critical_friction",
    "diagonal_form",
    "impact_layer",
    "invariant_directions",
    "resolve_impact",
]


def __dir__() -> list[str]:
    return __all__
