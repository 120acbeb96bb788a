"""Parameters of a scene from recorded motion, and initial states from recorded free flight.

Read a recording, fit its start to its free flight (`fit_free_flight`), and fit restitution, friction and
the like to what happens then (`identify`).
"""

from carom.identify.errors import (
    TrajectoryError,
    face_up,
    mean_error,
    squared_error,
    trajectory_error,
)
from carom.identify.fit import identify
from carom.identify.flight import FreeFlight, fit_free_flight, free_samples
from carom.identify.parameters import Parameter
from carom.identify.recording import Recording, State
from carom.identify.result import Identification
from carom.identify.rollout import RollOut, roll_out, roll_outs
from carom.identify.uncertainty import Uncertainty
from carom.identify.varied import varied

__all__ = [
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
