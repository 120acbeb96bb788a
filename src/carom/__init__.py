"""carom: motion of multibody systems with frictional impacts.

State a `Scene`, call `simulate`, look at the `Solution`. Compiled code is loaded at the first use, not
at import.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from carom.generalized import GeneralizedSystem
from carom.geometry.attitude import axis_angle, euler
from carom.hints import ending
from carom.options import Options
from carom.results.solution import Solution
from carom.scene import (
    GROUND,
    Box,
    Capsule,
    Compound,
    Convex,
    Cylinder,
    Disc,
    Ellipsoid,
    Friction,
    Hertz,
    Look,
    Material,
    Mesh,
    Part,
    Profile,
    Pulley,
    Restitution,
    Scene,
    Sphere,
    Stiffness,
    constraints,
    curves,
    forces,
    joints,
    surfaces,
)
from carom.scene import shapes as _shapes
from carom.simulate import simulate
from carom.status import AccuracyWarning, MistakeWarning, SimulationError, Status

if TYPE_CHECKING:
    from carom import baselines, flexible, geometry
    from carom.control.live import Run
    from carom.dynamics.contact_mass import contact_inverse_mass
    from carom.flexible import Modes
    from carom.friction import ContactSolution, solve_contacts
    from carom.impact import Impact, LayerHistory, impact_layer, resolve_impact
    from carom.impact.multiple.api import CornerImpact, resolve_impacts
    from carom.io import models
    from carom.io.files.resume import resume
    from carom.io.models import Model, load_model
    from carom.studies.ensembles import Ensemble, Grid, UniformOrientation, ensemble
    from carom.studies.gradient import Sensitivities, contact_sequence, gradient, sensitivities
    from carom.studies.identify import identify
    from carom.visual import films, plots
    from carom.visual.films import film
    from carom.visual.viewer.api import view

__version__ = "0.1.0"

__all__ = [
    "GROUND",
    "AccuracyWarning",
    "Box",
    "Capsule",
    "Compound",
    "ContactSolution",
    "Convex",
    "CornerImpact",
    "Cylinder",
    "Disc",
    "Ellipsoid",
    "Ensemble",
    "Friction",
    "GeneralizedSystem",
    "Grid",
    "Hertz",
    "Impact",
    "LayerHistory",
    "Look",
    "Material",
    "Mesh",
    "MistakeWarning",
    "Model",
    "Modes",
    "Options",
    "Part",
    "Profile",
    "Pulley",
    "Restitution",
    "Run",
    "Scene",
    "Sensitivities",
    "SimulationError",
    "Solution",
    "Sphere",
    "Status",
    "Stiffness",
    "UniformOrientation",
    "axis_angle",
    "baselines",
    "constraints",
    "contact_inverse_mass",
    "contact_sequence",
    "curves",
    "ensemble",
    "euler",
    "film",
    "films",
    "flexible",
    "forces",
    "geometry",
    "gradient",
    "identify",
    "impact_layer",
    "joints",
    "load_model",
    "models",
    "plots",
    "resolve_impact",
    "resolve_impacts",
    "resume",
    "sensitivities",
    "simulate",
    "solve_contacts",
    "surfaces",
    "view",
]

_LAZY = {
    "ContactSolution": "carom.friction",
    "CornerImpact": "carom.impact.multiple.api",
    "Ensemble": "carom.studies.ensembles",
    "Grid": "carom.studies.ensembles",
    "Impact": "carom.impact",
    "LayerHistory": "carom.impact",
    "Model": "carom.io.models",
    "Modes": "carom.flexible.modes",
    "Run": "carom.control.live",
    "load_model": "carom.io.models",
    "UniformOrientation": "carom.studies.ensembles",
    "ensemble": "carom.studies.ensembles",
    "Sensitivities": "carom.studies.gradient",
    "contact_inverse_mass": "carom.dynamics.contact_mass",
    "contact_sequence": "carom.studies.gradient",
    "film": "carom.visual.films",
    "gradient": "carom.studies.gradient",
    "identify": "carom.studies.identify",
    "impact_layer": "carom.impact",
    "resolve_impact": "carom.impact",
    "resolve_impacts": "carom.impact.multiple.api",
    "sensitivities": "carom.studies.gradient",
    "resume": "carom.io.files.resume",
    "solve_contacts": "carom.friction",
    "view": "carom.visual.viewer.api",
}

#: packages that users reach by a short name: `carom.plots.energy`
_PACKAGES = {
    "baselines": "carom.baselines",
    "films": "carom.visual.films",
    "flexible": "carom.flexible",
    "geometry": "carom.geometry",
    "models": "carom.io.models",
    "plots": "carom.visual.plots",
}


def __getattr__(name: str):
    if name in _LAZY:
        return getattr(importlib.import_module(_LAZY[name]), name)
    if name in {shape.__name__ for shape in _shapes.SHAPES}:  # one that is not named above
        return getattr(_shapes, name)
    if name in _PACKAGES:
        return importlib.import_module(_PACKAGES[name])
    hint = ending("carom", name, __all__) if name[:1] != "_" else ""
    raise AttributeError(f"module 'carom' has no attribute {name!r}{hint}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
