"""carom: motion of multibody systems with frictional impacts.

State a `Scene`, call `simulate`, look at the `Solution`. Compiled code is loaded at the first use, not
at import.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from carom.options import Options
from carom.scene import (
    GROUND,
    Box,
    Capsule,
    Convex,
    Cylinder,
    Scene,
    Sphere,
    forces,
    joints,
)
from carom.simulate import simulate
from carom.solution import Solution
from carom.status import SimulationError, Status

if TYPE_CHECKING:
    from carom import baselines
    from carom.coulomb import ContactSolution, solve_contacts
    from carom.impact import Impact, LayerHistory, impact_layer, resolve_impact

__version__ = "0.1.0"

__all__ = [
    "GROUND",
    "Box",
    "Capsule",
    "ContactSolution",
    "Convex",
    "Cylinder",
    "Impact",
    "LayerHistory",
    "Options",
    "Scene",
    "SimulationError",
    "Solution",
    "Sphere",
    "Status",
    "baselines",
    "forces",
    "impact_layer",
    "joints",
    "resolve_impact",
    "simulate",
    "solve_contacts",
]

_LAZY = {
    "ContactSolution": "carom.coulomb",
    "Impact": "carom.impact",
    "LayerHistory": "carom.impact",
    "impact_layer": "carom.impact",
    "resolve_impact": "carom.impact",
    "solve_contacts": "carom.coulomb",
}


def __getattr__(name: str):
    if name in _LAZY:
        return getattr(importlib.import_module(_LAZY[name]), name)
    if name in ("baselines", "geometry"):
        return importlib.import_module(f"carom.{name}")
    raise AttributeError(f"module 'carom' has no attribute {name!r}")
