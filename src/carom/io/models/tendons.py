"""Fixed tendons: springs, dampers, limits and friction of a linear combination of joint coordinates.

What acts on one joint acts along its coordinate. For several a link without weight to speak of slides by the
length of the tendon, which a `Coupling` with the joints prescribes, and springs, stops, friction and motors act
on this slide.
"""

from __future__ import annotations

import numpy as np

from carom.io.models.build import Build
from carom.io.models.coordinates import add_stops
from carom.io.models.links import called, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.state import is_off
from carom.results.robot import Coordinate
from carom.scene import constraints, forces, joints
from carom.scene.bodies import GROUND
from carom.scene.joints import Joint

Terms = list[tuple[Coordinate, float]]
#: what acts along a tendon, in the arrays of a model
ACTING = ("stiffness", "damping", "limited", "frictionloss", "armature")


def fixed_tendon(build: Build, tendon: int) -> Terms | None:
    """Return the coordinates of a fixed tendon with their factors; None of one along a path."""
    ids = _joints(build.model, tendon)
    if not ids or not all(j in build.coordinates for j, _ in ids):
        return None
    return [(build.coordinates[j], factor) for j, factor in ids]


def _joints(m, tendon: int) -> list[tuple[int, float]]:
    """Return the joints of a fixed tendon and their factors; none of one along a path."""
    first, joint = int(m.tendon_adr[tendon]), need_mujoco().mjtWrap.mjWRAP_JOINT
    wraps = range(first, first + int(m.tendon_num[tendon]))
    if any(m.wrap_type[w] != joint for w in wraps):
        return []
    return [(int(m.wrap_objid[w]), float(m.wrap_prm[w])) for w in wraps]


def needs_link(m, tendon: int) -> bool:
    """Return whether something acts along a tendon of several joints that is no constant force."""
    if len(_joints(m, tendon)) < 2:
        return False
    on = (m.actuator_trntype == need_mujoco().mjtTrn.mjTRN_TENDON) & (
        m.actuator_trnid[:, 0] == tendon
    )
    on &= m.actuator_dyntype == need_mujoco().mjtDyn.mjDYN_NONE  # others exert no force
    bends = bool(np.any(m.actuator_biasprm[on, 1:3])) and not is_off(m, "ACTUATION")
    return bends or any(_value(m, what, tendon) > 0.0 for what in ACTING)


def _value(m, what: str, tendon: int) -> float:
    return float(getattr(m, f"tendon_{what}", np.zeros(tendon + 1))[tendon])


def add_tendons(build: Build, restitution: float, impact_law: str) -> dict[int, Terms]:
    """Add what acts along fixed tendons; return along which coordinates actuators pull them."""
    out: dict[int, Terms] = {}
    for t in range(build.model.ntendon):
        terms, what = fixed_tendon(build, t), called(build.model, "tendon", t)
        if terms is None:
            build.report.add(what, "is not along coordinates of hinges and slides", "left out")
            continue
        out[t] = (
            terms
            if len(terms) == 1 or not needs_link(build.model, t)
            else [(_link(build, t, terms), 1.0)]
        )
        if len(out[t]) == 1:
            _act(build, t, *out[t][0], restitution, impact_law)
    return out


def _link(build: Build, t: int, terms: Terms) -> Coordinate:
    """Add a link that slides by the length of a tendon."""
    m, data, name = build.model, build.data, name_of(build.model, "tendon", t)
    mass = 1.0 / sum(factor**2 / float(m.dof_M0[c.velocity]) for c, factor in terms)
    axis = np.eye(3)[int(np.argmin(np.abs(build.scene.gravity)))]
    rate = sum(factor * data.qvel[c.velocity] for c, factor in terms)
    motion = np.append(rate * axis, np.zeros(3))
    moment = mass * float(m.stat.extent) ** 2
    link = build.light_link(name, mass, moment, np.zeros(3), motion)
    kind = joints.Prismatic(axis, np.zeros(3))
    joint = build.scene.add_joint(kind, GROUND, link, name=build.names.new(name, "tendon"))
    factors: dict[Joint | str | tuple[Joint | str, int], float] = {(joint, 0): -1.0}
    for c, factor in terms:
        factors[c.joint, c.index] = factors.get((c.joint, c.index), 0.0) + factor * c.sign
    coupling = constraints.Coupling(factors)
    build.scene.add_constraint(coupling, name=build.names.new(f"{name}:length", "constraint"))
    build.report.add(
        called(m, "tendon", t),
        "acts on several joints",
        f"a link of {build.light:g} of their inertia slides by its length",
    )
    build.lines.append((joint, tuple(terms)))
    start = sum(factor * c.start for c, factor in terms)
    return Coordinate(name, joint, 0, 1.0, start, -1, 0, 0)


def _act(build: Build, t: int, c: Coordinate, factor: float, restitution: float, law: str) -> None:
    """Add what acts along a tendon of the length factor q."""
    m, names, square = build.model, build.names, factor * factor
    name, what = name_of(m, "tendon", t), called(m, "tendon", t)
    stiffness = 0.0 if is_off(m, "SPRING", "PASSIVE") else _value(m, "stiffness", t)
    damping = 0.0 if is_off(m, "DAMPER", "PASSIVE") else _value(m, "damping", t)
    low, high = np.broadcast_to(m.tendon_lengthspring[t], 2)
    if stiffness > 0.0 and low != high:
        build.report.add(what, "a spring with a dead band", "without this spring")
        stiffness = 0.0
    if stiffness + damping > 0.0:
        rest = c.sign * (float(low) / factor - c.start) if stiffness else 0.0
        spring = forces.JointSpring(c.joint, stiffness * square, damping * square, rest, c.index)
        build.scene.add_force(spring, name=names.new(f"{name}:spring", "force"))
    if _value(m, "frictionloss", t) > 0.0 and not is_off(m, "CONSTRAINT", "FRICTIONLOSS"):
        friction = forces.JointFriction(
            c.joint, _value(m, "frictionloss", t) * abs(factor), c.index
        )
        build.scene.add_force(friction, name=names.new(f"{name}:friction", "force"))
    if _value(m, "armature", t) > 0.0:
        rotor = forces.JointInertia(c.joint, _value(m, "armature", t) * square, c.index)
        build.scene.add_force(rotor, name=names.new(f"{name}:armature", "force"))
    if m.tendon_limited[t] and not is_off(m, "CONSTRAINT", "LIMIT"):
        add_stops(build, c, name, what, np.sort(m.tendon_range[t] / factor), restitution, law)
