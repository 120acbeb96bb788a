"""Derivatives of a motion with its impacts, with respect to its start and to the numbers of its scene."""

from carom.gradient.api import sensitivities
from carom.gradient.result import Derivative, Margin, Sensitivities
from carom.gradient.sequence import ImpactKind, contact_sequence

__all__ = [
    "Derivative",
    "ImpactKind",
    "Margin",
    "Sensitivities",
    "contact_sequence",
    "sensitivities",
]
