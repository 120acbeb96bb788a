"""Models in MJCF and URDF as scenes: read and compiled by MuJoCo, then taken from its arrays."""

from carom.io.models.build import Coordinate
from carom.io.models.load import load_model
from carom.io.models.model import Model
from carom.io.models.report import Entry, Report

__all__ = ["Coordinate", "Entry", "Model", "Report", "load_model"]


def __dir__() -> list[str]:
    return __all__
