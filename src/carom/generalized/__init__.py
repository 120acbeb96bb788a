"""Systems in the user's own coordinates: metric, forces, constraints and contacts."""

from carom.generalized.system import CoordinateContact, GeneralizedSystem

__all__ = ["CoordinateContact", "GeneralizedSystem"]
