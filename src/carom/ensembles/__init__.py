"""Many runs of a scene with some of its values varied: `carom.ensemble`."""

from carom.ensembles.api import ensemble
from carom.ensembles.result import Ensemble
from carom.ensembles.sampling import UniformOrientation

__all__ = ["Ensemble", "UniformOrientation", "ensemble"]
