"""Models in MJCF and URDF as scenes: read and compiled by MuJoCo, then taken from its arrays."""

from carom.models.build import Coordinate
from carom.models.load import load_model
from carom.models.model import Model
from carom.models.report import Entry, Report

__all__ = ["Coordinate", "Entry", "Model", "Report", "load_model"]
