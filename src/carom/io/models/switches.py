"""A model as it acts: without what its flags switch off, and with mocap bodies at rest."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from carom.io.models.report import need_mujoco

#: arrays of the model that are 0 where one of the flags is set (not all versions have all of them)
SWITCHED = (
    (("CONSTRAINT", "LIMIT"), ("jnt_limited",)),
    (("CONSTRAINT", "EQUALITY"), ("eq_active0",)),
    (("CONSTRAINT", "FRICTIONLOSS"), ("dof_frictionloss",)),
    (("SPRING", "PASSIVE"), ("jnt_stiffness", "jnt_stiffnesspoly", "jnt_springyield")),
    (("DAMPER", "PASSIVE"), ("dof_damping", "dof_dampingpoly")),
)


def is_off(model, *flags: str) -> bool:
    """Return whether one of some flags of the model, such as ``"CONTACT"``, switches something off."""
    bits = [getattr(need_mujoco().mjtDisableBit, f"mjDSBL_{flag}", 0) for flag in flags]
    return any(int(model.opt.disableflags) & int(bit) for bit in bits)


def as_it_acts(model) -> Any:
    """Return a copy of a model without what is switched off, and with mocap bodies as parts of the world."""
    acts = copy.copy(model)
    for flags, arrays in SWITCHED:
        for name in arrays:
            if is_off(model, *flags) and hasattr(acts, name):
                getattr(acts, name)[:] = 0
    if is_off(model, "PASSIVE") or (is_off(model, "SPRING") and is_off(model, "DAMPER")):
        acts.body_gravcomp[:] = 0.0  # MuJoCo has no passive forces then
    moved = np.flatnonzero(model.body_mocapid >= 0)
    acts.body_weldid[np.isin(model.body_weldid, moved)] = 0
    return acts
