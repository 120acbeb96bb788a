"""Actuators of a model as forces along joint coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.io.models.build import Build
from carom.io.models.links import called, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.state import is_off
from carom.io.models.tendons import Tendon
from carom.results.robot import Coordinate, Motor
from carom.scene import forces

NO_FORCE = "exerts no force"
TRANSMISSIONS = {
    "SLIDERCRANK": "a slider-crank",
    "SITE": "a site",
    "BODY": "a body",
    "SO3": "a ball joint",
}


def add_actuators(build: Build, tendons: dict[int, Tendon]) -> list[Motor]:
    """Add all actuators that act on hinges, slides and tendons by an affine law; report the others.

    `tendons` has along what they pull each tendon.
    """
    out = []
    for a in range(getattr(build.model, "nactuator", build.model.nu)):
        name, gear = name_of(build.model, "actuator", a), float(build.model.actuator_gear[a, 0])
        pulled, why = _pulled(build, a, tendons)
        terms = [(c, gear * factor) for c, factor in pulled.terms]
        law, reason = _law(build, a)
        if why or reason:
            build.report.add(called(build.model, "actuator", a), why or reason, NO_FORCE)
            out.append(Motor(name, (), tuple(terms)))
            continue
        if pulled.along is None:
            part = _part(build, a, name, *terms[0], law)
        else:
            part = _along(build, name, pulled, gear, law)
        start = gear * pulled.start if pulled.along is not None and not terms else 0.0
        out.append(Motor(name, (part,), tuple(terms), law["force_range"], start))
        _rotor(build, a, terms)
    return out


def _along(build: Build, name: str, tendon: Tendon, gear: float, law: dict[str, Any]):
    """Add the force along a tendon of several joints, or along a path."""
    bias = law["bias"] + [law["bias"][1] * gear * tendon.start, 0.0, 0.0]
    made = forces.Actuator(tendon.along, **{**law, "bias": bias}, gear=gear)
    return build.scene.add_force(made, name=build.names.new(name, "actuator"))


def _part(build: Build, a: int, name: str, c: Coordinate, factor: float, law: dict[str, Any]):
    """Add the force along one coordinate; in the scene it is 0 at the start, so the length there is a bias."""
    bias = law["bias"] + [law["bias"][1] * factor * c.start, 0.0, 0.0]
    given = {
        **law,
        "bias": bias,
        "force_range": _force_range(build, a, c, factor, law["force_range"]),
    }
    made = forces.Actuator(c.joint, **given, gear=factor * c.sign, coordinate=c.index)
    return build.scene.add_force(made, name=build.names.new(name, "actuator"))


def _pulled(build: Build, a: int, tendons: dict[int, Tendon]) -> tuple[Tendon, str]:
    """Return along what an actuator acts, and why it cannot."""
    m, kinds = build.model, need_mujoco().mjtTrn
    kind, target = int(m.actuator_trntype[a]), int(m.actuator_trnid[a, 0])
    if kind in (kinds.mjTRN_JOINT, kinds.mjTRN_JOINTINPARENT):
        if target in build.coordinates:
            return Tendon([(build.coordinates[target], 1.0)]), ""
        return Tendon([]), "it acts on a ball or free joint"
    if kind == kinds.mjTRN_TENDON:
        if target in tendons:
            return tendons[target], ""
        return Tendon([]), "its tendon is not represented"
    names = {getattr(kinds, f"mjTRN_{key}", None): what for key, what in TRANSMISSIONS.items()}
    return Tendon([]), f"it acts on {names.get(kind, 'something unknown')}"


def _law(build: Build, a: int) -> tuple[dict[str, Any], str]:
    """Return the affine law of an actuator, and why it has none."""
    m, mujoco = build.model, need_mujoco()
    gain, bias = m.actuator_gainprm[a], m.actuator_biasprm[a]
    affine = m.actuator_biastype[a] == mujoco.mjtBias.mjBIAS_AFFINE
    law = {
        "gain": float(gain[0]),
        "bias": bias[:3].copy() if affine else np.zeros(3),
        "control": float(build.data.ctrl[a]),
        "control_range": m.actuator_ctrlrange[a] if _limited(build, a) else None,
        "force_range": m.actuator_forcerange[a] if m.actuator_forcelimited[a] else None,
    }
    kinds = mujoco.mjtGain.mjGAIN_FIXED, mujoco.mjtGain.mjGAIN_AFFINE
    if is_off(m, "ACTUATION") or int(m.opt.disableactuator) >> int(m.actuator_group[a]) & 1:
        return law, "it is disabled"
    several = any(
        getattr(m, name, np.ones(a + 1))[a] != 1 for name in ("actuator_ctrlnum", "actuator_outnum")
    )
    if several or m.actuator_plugin[a] >= 0:
        return law, "it has several controls, or is a plugin"
    if m.actuator_dyntype[a] != mujoco.mjtDyn.mjDYN_NONE:
        return law, "it has a state of its own (dyntype)"
    if getattr(m, "actuator_delay", np.zeros(a + 1))[a] != 0.0:
        return law, "it has a delay"
    known = affine or m.actuator_biastype[a] == mujoco.mjtBias.mjBIAS_NONE
    depends = m.actuator_gaintype[a] != kinds[0] and np.any(gain[1:3])
    if int(m.actuator_gaintype[a]) not in kinds or depends or not known:
        return law, "its force is not affine in control, length and velocity"
    return law, ""


def _limited(build: Build, a: int) -> bool:
    return bool(build.model.actuator_ctrllimited[a]) and not is_off(build.model, "CLAMPCTRL")


def _force_range(build: Build, a: int, c: Coordinate, factor: float, own):
    """Return the range of the force, also that of the joint where no other actuator acts on it."""
    m = build.model
    j = next((k for k, one in build.coordinates.items() if one is c), -1)
    if j < 0 or not m.jnt_actfrclimited[j]:
        return own
    joint, acts = need_mujoco().mjtTrn.mjTRN_JOINT, m.actuator_trntype
    if np.sum((acts == joint) & (m.actuator_trnid[:, 0] == j)) != 1 or factor == 0.0:
        what = "the range of the force of several actuators"
        build.report.add(called(m, "joint", j), what, "each has its own range only")
        return own
    ends = np.sort(m.jnt_actfrcrange[j] / factor)
    return ends if own is None else np.clip(own, *ends)


def _rotor(build: Build, a: int, terms) -> None:
    """Add the armature of an actuator, and report its damping."""
    m = build.model
    armature = float(getattr(m, "actuator_armature", np.zeros(a + 1))[a])
    if armature > 0.0 and len(terms) == 1:
        (c, factor), name = terms[0], name_of(m, "actuator", a)
        inertia = forces.JointInertia(c.joint, armature * factor**2, c.index)
        build.scene.add_force(inertia, name=build.names.new(f"{name}:armature", "force"))
    elif armature > 0.0:
        build.report.add(
            called(m, "actuator", a), "armature of a tendon of several joints", "left out"
        )
    if np.any(getattr(m, "actuator_damping", np.zeros(a + 1))[a]):
        build.report.add(called(m, "actuator", a), "damping of its own", "left out")
