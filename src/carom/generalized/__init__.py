"""Systems in the user's own coordinates: metric, forces, constraints and contacts."""

from carom.generalized.solution import CoordinateImpact, CoordinateImpactTable, GeneralizedSolution
from carom.generalized.state import CoordinateState
from carom.generalized.stated import CoordinateContact
from carom.generalized.system import GeneralizedSystem

__all__ = [
    "CoordinateContact",
    "CoordinateImpact",
    "CoordinateImpactTable",
    "CoordinateState",
    "GeneralizedSolution",
    "GeneralizedSystem",
]


def __dir__() -> list[str]:
    return __all__
