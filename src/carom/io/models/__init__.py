"""Models in MJCF and URDF as scenes: read and compiled by MuJoCo, then taken from its arrays."""

from carom.io.models.load import load_model
from carom.io.models.model import Model
from carom.io.models.report import Entry, Report
from carom.results.robot import Coordinate, Keyframe, Motor, Robot
from carom.results.sensors import Sensor

__all__ = [
    "Coordinate",
    "Entry",
    "Keyframe",
    "Model",
    "Motor",
    "Report",
    "Robot",
    "Sensor",
    "load_model",
]


def __dir__() -> list[str]:
    return __all__
