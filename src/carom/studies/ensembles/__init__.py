"""`carom.ensemble`: many runs of a scene with varied values."""

from carom.studies.ensembles.api import ensemble
from carom.studies.ensembles.result import Ensemble
from carom.studies.ensembles.sampling import Grid, UniformOrientation

__all__ = ["Ensemble", "Grid", "UniformOrientation", "ensemble"]
