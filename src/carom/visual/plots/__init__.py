"""Plots of the results of a run; needs ``carom[plot]``.

Each function draws one plot of a `Solution` or a `GeneralizedSolution` into given axes or a new figure, and
returns the axes; `ensemble` draws the runs of an `Ensemble`.
"""

from carom.visual.plots.balance import energy
from carom.visual.plots.coefficients import e_mu
from carom.visual.plots.ensembles import ensemble
from carom.visual.plots.errors import constraint_errors
from carom.visual.plots.force_of_impact import impact_force
from carom.visual.plots.glance import overview
from carom.visual.plots.impacts_over_time import impacts
from carom.visual.plots.joint_motion import joints
from carom.visual.plots.layer import impact_inside
from carom.visual.plots.loads import forces
from carom.visual.plots.paths import trajectory
from carom.visual.plots.plane import phase
from carom.visual.plots.precision import work_precision
from carom.visual.plots.slip import hodograph
from carom.visual.plots.timeline import contacts

__all__ = [
    "constraint_errors",
    "contacts",
    "e_mu",
    "energy",
    "ensemble",
    "forces",
    "hodograph",
    "impact_force",
    "impact_inside",
    "impacts",
    "joints",
    "overview",
    "phase",
    "trajectory",
    "work_precision",
]


def __dir__() -> list[str]:
    return __all__
