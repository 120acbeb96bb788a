"""Identification of parameters of a scene from recorded motion, and of initial states from free flight.

Make a `Recording`, fit its initial state to its free flight (`fit_free_flight`), and fit restitution, friction
and other parameters to the motion after that (`identify`).
"""

from carom.studies.identify.curvature import Curvature
from carom.studies.identify.errors import (
    TrajectoryError,
    face_up,
    mean_error,
    squared_error,
    trajectory_error,
)
from carom.studies.identify.fit import identify
from carom.studies.identify.flight import FreeFlight, fit_free_flight, free_samples
from carom.studies.identify.parameters import Parameter
from carom.studies.identify.recording import Recording, State
from carom.studies.identify.result import Identification
from carom.studies.identify.rollout import RollOut, roll_out, roll_outs
from carom.studies.identify.uncertainty import Uncertainty
from carom.studies.identify.varied import varied

__all__ = [
    "Curvature",
    "FreeFlight",
    "Identification",
    "Parameter",
    "Recording",
    "RollOut",
    "State",
    "TrajectoryError",
    "Uncertainty",
    "face_up",
    "fit_free_flight",
    "free_samples",
    "identify",
    "mean_error",
    "roll_out",
    "roll_outs",
    "squared_error",
    "trajectory_error",
    "varied",
]

for _name in (
    __all__
):  # `carom.identify` is the function, and these are also found at it: `carom.identify.Recording`
    setattr(identify, _name, globals()[_name])


def __dir__() -> list[str]:
    return __all__
