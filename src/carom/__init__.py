"""carom: motion of multibody systems with frictional impacts.

State a `Scene`, call `simulate`, look at the `Solution`. Compiled code is loaded at the first use, not
at import.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from carom.generalized import GeneralizedSystem
from carom.options import Options
from carom.scene import (
    GROUND,
    Box,
    Capsule,
    Compound,
    Convex,
    Cylinder,
    Disc,
    Ellipsoid,
    Material,
    Mesh,
    Scene,
    Sphere,
    constraints,
    forces,
    joints,
)
from carom.simulate import simulate
from carom.solution import Solution
from carom.status import AccuracyWarning, SimulationError, Status

if TYPE_CHECKING:
    from carom import baselines, identify, models, plots
    from carom.coulomb import ContactSolution, solve_contacts
    from carom.ensembles import Ensemble, UniformOrientation, ensemble
    from carom.files.resume import resume
    from carom.films import film
    from carom.gradient import Sensitivities, contact_sequence, sensitivities
    from carom.impact import Impact, LayerHistory, impact_layer, resolve_impact
    from carom.impact.corner.api import CornerImpact, resolve_impacts
    from carom.models import Model, load_model
    from carom.viewer.api import view

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
    "GeneralizedSystem",
    "Impact",
    "LayerHistory",
    "Material",
    "Mesh",
    "Model",
    "Options",
    "Scene",
    "Sensitivities",
    "SimulationError",
    "Solution",
    "Sphere",
    "Status",
    "UniformOrientation",
    "baselines",
    "constraints",
    "contact_sequence",
    "ensemble",
    "film",
    "forces",
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
    "view",
]

_LAZY = {
    "ContactSolution": "carom.coulomb",
    "CornerImpact": "carom.impact.corner.api",
    "Ensemble": "carom.ensembles",
    "Impact": "carom.impact",
    "LayerHistory": "carom.impact",
    "Model": "carom.models",
    "load_model": "carom.models",
    "UniformOrientation": "carom.ensembles",
    "ensemble": "carom.ensembles",
    "Sensitivities": "carom.gradient",
    "contact_sequence": "carom.gradient",
    "film": "carom.films",
    "impact_layer": "carom.impact",
    "resolve_impact": "carom.impact",
    "resolve_impacts": "carom.impact.corner.api",
    "sensitivities": "carom.gradient",
    "resume": "carom.files.resume",
    "solve_contacts": "carom.coulomb",
    "view": "carom.viewer.api",
}


def __getattr__(name: str):
    if name in _LAZY:
        return getattr(importlib.import_module(_LAZY[name]), name)
    if name in ("baselines", "films", "geometry", "gradient", "identify", "models", "plots"):
        return importlib.import_module(f"carom.{name}")
    raise AttributeError(f"module 'carom' has no attribute {name!r}")
