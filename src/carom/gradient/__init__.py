"""Derivatives of a motion with its impacts, with respect to its start and to the numbers of its scene."""

from carom.gradient.api import sensitivities
from carom.gradient.impact import ByInputs, ImpactDerivative, impact_derivative
from carom.gradient.result import Derivative, Margin, Sensitivities
from carom.gradient.sequence import ImpactKind, contact_sequence

__all__ = [
    "ByInputs",
    "Derivative",
    "ImpactDerivative",
    "ImpactKind",
    "Margin",
    "Sensitivities",
    "contact_sequence",
    "impact_derivative",
    "sensitivities",
]
