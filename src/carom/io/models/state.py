"""A model as it acts: without what its flags switch off, and its initial state."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from carom import checks
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


def as_it_acts(model, driven) -> Any:
    """Return a copy of a model without what is switched off, and with mocap bodies as parts of the world.

    Those with the numbers `driven` stay bodies; one without mass gets 1 kg and 1 kg m^2: its motion is given.
    """
    acts = copy.copy(model)
    for flags, arrays in SWITCHED:
        for name in arrays:
            if is_off(model, *flags) and hasattr(acts, name):
                getattr(acts, name)[:] = 0
    if is_off(model, "PASSIVE") or (is_off(model, "SPRING") and is_off(model, "DAMPER")):
        acts.body_gravcomp[:] = 0.0  # MuJoCo has no passive forces then
    fixed = [b for b in np.flatnonzero(model.body_mocapid >= 0) if b not in driven]
    acts.body_weldid[np.isin(model.body_weldid, fixed)] = 0
    for b in driven:
        if not np.any(model.body_mass[model.body_weldid == b]):
            acts.body_mass[b], acts.body_inertia[b] = 1.0, 1.0
    return acts


def starting_data(model, keyframe, qpos, qvel) -> Any:
    """Return ``mujoco.MjData`` of a model at its start, with the poses of all bodies.

    Parameters
    ----------
    model : mujoco.MjModel
    keyframe : int, str or None
        Number or name; None is the default configuration at rest.
    qpos : (nq,) or None
    qvel : (nv,) or None
        In place of those of the keyframe.
    """
    mujoco = need_mujoco()
    data = mujoco.MjData(model)
    if keyframe is not None:
        k = key_number(model, keyframe)
        mujoco.mj_resetDataKeyframe(model, data, k)
    if qpos is not None:
        data.qpos[:] = checks.finite_array("qpos", qpos, (model.nq,))
    if qvel is not None:
        data.qvel[:] = checks.finite_array("qvel", qvel, (model.nv,))
    place(model, data)
    return data


def place(model, data) -> None:
    """Compute the poses of all bodies and joints from the coordinates."""
    mujoco = need_mujoco()
    mujoco.mj_normalizeQuat(model, data.qpos)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)


def key_number(model, keyframe) -> int:
    """Return the number of a keyframe given by number or name."""
    names = [model.key(k).name for k in range(model.nkey)]
    if isinstance(keyframe, str):
        if keyframe in names:
            return names.index(keyframe)
    elif isinstance(keyframe, (int, np.integer)) and not isinstance(keyframe, bool):
        if 0 <= keyframe < model.nkey:
            return int(keyframe)
    named = ", ".join(repr(name) for name in names if name) or "without names"
    raise ValueError(
        f"keyframe must be a name or a number below {model.nkey}, the number of keyframes of the model "
        f"({named}), got {checks.shown(keyframe)}"
    )


def point_velocity(model, data, body: int, point: np.ndarray, without=()) -> np.ndarray:
    """Return velocity and angular velocity (6,), world axes, of a point that is fixed in a body.

    Parameters
    ----------
    without
        Numbers of velocities that are taken as 0: those of the later joints of a body, for a link between two.
    """
    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    need_mujoco().mj_jac(model, data, linear, angular, np.array(point, dtype=float), body)
    rates = data.qvel.copy()
    rates[list(without)] = 0.0
    return np.concatenate([linear @ rates, angular @ rates])
