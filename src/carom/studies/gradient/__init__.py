"""Derivatives of a motion with impacts, with respect to its initial state and the parameters of its scene."""

from carom.studies.gradient.api import sensitivities
from carom.studies.gradient.impact import ByInputs, ImpactDerivative, impact_derivative
from carom.studies.gradient.result import Derivative, Margin, Sensitivities
from carom.studies.gradient.sequence import ImpactKind, contact_sequence

__all__ = [
    "ByInputs",
    "Derivative",
    "ImpactDerivative",
    "ImpactKind",
    "Margin",
    "Sensitivities",
    "contact_sequence",
    "gradient",
    "impact_derivative",
    "sensitivities",
]

gradient = sensitivities  # the name that some look for
for _name in __all__:  # also found at the function: `carom.gradient.impact_derivative`
    setattr(gradient, _name, globals()[_name])


def __dir__() -> list[str]:
    return __all__
