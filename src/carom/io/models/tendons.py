"""Tendons: springs, dampers, limits, friction and motors along sums of joint coordinates, or of distances.

A fixed tendon is a sum of coordinates of joints, one along a path a sum of the distances of its sites, with
the divisors of its pulleys. What acts on one joint acts along its coordinate. A tendon of several joints with
inertia of its own (armature) has a link without weight to speak of, which slides by its length.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.io.models.build import Build
from carom.io.models.coordinates import Limited, add_stops
from carom.io.models.links import called, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.state import is_off
from carom.results.robot import Coordinate
from carom.scene import constraints, forces, joints
from carom.scene.bodies import GROUND, Ground
from carom.scene.coordinates import Combination, Strand
from carom.scene.joints import Joint

Terms = list[tuple[Coordinate, float]]


class Tendon(NamedTuple):
    """What actuators pull: coordinates with their factors, or a sum, whose length is `start` where it is 0."""

    terms: Terms
    along: Combination | None = None
    start: float = 0.0


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
    """Return whether a tendon of several joints has inertia."""
    return len(_joints(m, tendon)) > 1 and _value(m, "armature", tendon) > 0.0


def _value(m, what: str, tendon: int) -> float:
    return float(getattr(m, f"tendon_{what}", np.zeros(tendon + 1))[tendon])


def add_tendons(build: Build, restitution: float, impact_law: str) -> dict[int, Tendon]:
    """Add what acts along tendons; return along what actuators pull them."""
    out: dict[int, Tendon] = {}
    for t in range(build.model.ntendon):
        terms = fixed_tendon(build, t)
        if terms is None:
            made = _along_path(build, t)
            if made is None:
                continue
        elif len(terms) == 1:
            made = Tendon(terms)
        elif needs_link(build.model, t):
            made = Tendon([(_link(build, t, terms), 1.0)])
        else:
            made = Tendon(terms, _sum(terms), sum(factor * c.start for c, factor in terms))
        out[t] = made
        if made.along is None:
            (c, factor), *_ = made.terms
            _act(build, t, c, factor, restitution, impact_law)
        else:
            _act_along(build, t, made.along, made.start, (restitution, impact_law))
    return out


def _sum(terms: Terms, factor: float = 1.0) -> Combination:
    """Return a sum of coordinates, in the scene."""
    found: dict[tuple[Joint, int], float] = {}
    for c, own in terms:
        key = c.joint, c.index
        found[key] = found.get(key, 0.0) + factor * own * c.sign
    return Combination._of((joint, k, own) for (joint, k), own in found.items() if own != 0.0)


def _along_path(build: Build, t: int) -> Tendon | None:
    """Return the sum of the distances of the sites of a tendon; None with an entry in the report."""
    m, kinds, what = build.model, need_mujoco().mjtWrap, called(build.model, "tendon", t)
    first, constant, terms, last, divisor = int(m.tendon_adr[t]), 0.0, [], None, 1.0
    for w in range(first, first + int(m.tendon_num[t])):
        kind, number = m.wrap_type[w], int(m.wrap_objid[w])
        if kind == kinds.mjWRAP_PULLEY:
            divisor, last = float(m.wrap_prm[w]), None
        elif kind != kinds.mjWRAP_SITE:
            reason = "goes round a geom"
            if kind == kinds.mjWRAP_JOINT:
                reason = "is not along coordinates of hinges and slides"
            build.report.add(what, reason, "left out")
            return None
        else:
            here = build.carrier(int(m.site_bodyid[number])), build.data.site_xpos[number].copy()
            if last is not None and last[0] is here[0]:
                constant += float(np.linalg.norm(here[1] - last[1])) / divisor
            elif last is not None:
                terms.append((_strand(last, here), 0, 1.0 / divisor))
            last = here
    if not terms:
        build.report.add(what, "has a length that does not change", "left out")
        return None
    if _value(m, "armature", t) > 0.0:
        build.report.add(what, "armature of a tendon along a path", "left out")
    return Tendon([], Combination._of(terms), constant)


def _strand(one, two) -> Strand:
    """Return the distance of two points of bodies, of which the second is not the ground."""
    (a, p), (b, q) = (two, one) if isinstance(two[0], Ground) else (one, two)
    return Strand(a, b, p, q, np.zeros(3), np.zeros(2), float(np.linalg.norm(q - p)))


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
    stiffness, damping, low, high = _spring(m, t)
    if stiffness > 0.0 and low != high:
        _dead_band(build, t, _sum([(c, factor)]), factor * c.start, (stiffness, low, high))
        stiffness = 0.0
    if stiffness + damping > 0.0:
        rest = c.sign * (low / factor - c.start) if stiffness else 0.0
        spring = forces.JointSpring(c.joint, stiffness * square, damping * square, rest, c.index)
        build.scene.add_force(spring, name=names.new(f"{name}:spring", "force"))
    bound = _friction(m, t)
    if bound > 0.0:
        friction = forces.JointFriction(c.joint, bound * abs(factor), c.index)
        build.scene.add_force(friction, name=names.new(f"{name}:friction", "force"))
    if _value(m, "armature", t) > 0.0:
        rotor = forces.JointInertia(c.joint, _value(m, "armature", t) * square, c.index)
        build.scene.add_force(rotor, name=names.new(f"{name}:armature", "force"))
    if _is_limited(m, t):
        add_stops(build, c, name, what, np.sort(m.tendon_range[t] / factor), restitution, law)


def _act_along(build: Build, t: int, of: Combination, start: float, law: tuple[float, str]) -> None:
    """Add what acts along a tendon of the length `start` and that of a sum."""
    m, names = build.model, build.names
    name, what = name_of(m, "tendon", t), called(m, "tendon", t)
    stiffness, damping, low, high = _spring(m, t)
    if stiffness > 0.0 and low != high:
        _dead_band(build, t, of, start, (stiffness, low, high))
        stiffness = 0.0
    if stiffness + damping > 0.0:
        spring = forces.JointSpring(of, stiffness, damping, low - start if stiffness else 0.0)
        build.scene.add_force(spring, name=names.new(f"{name}:spring", "force"))
    bound = _friction(m, t)
    if bound > 0.0:
        friction = forces.JointFriction(of, bound)
        build.scene.add_force(friction, name=names.new(f"{name}:friction", "force"))
    if _is_limited(m, t):
        ends = m.tendon_range[t].copy()
        # of coordinates of joints 0; distances are not below 0
        now = sum(factor * one.start for one, _, factor in of.terms if isinstance(one, Strand))
        if now > 0.0:
            ends[0] = ends[0] if ends[0] > 0.0 else -np.inf
        add_stops(build, Limited(of, start, now), name, what, ends, *law)


def _dead_band(build: Build, t: int, of: Combination, start: float, spring) -> None:
    """Add springs that act beyond the lengths `low` and `high` of a tendon alone."""
    stiffness, low, high = spring
    name = name_of(build.model, "tendon", t)
    less = Combination._of((joint, k, -factor) for joint, k, factor in of.terms)
    for along, end in ((of, high - start), (less, start - low)):
        if not isinstance(of.joints[0], Joint) and along is less and low <= 0.0:
            continue
        pulls = forces.BeltStrand(along, -stiffness * end, stiffness)
        build.scene.add_force(pulls, name=build.names.new(f"{name}:spring", "force"))


def _spring(m, t: int) -> tuple[float, float, float, float]:
    """Return stiffness and damping of a tendon, and the lengths between which its spring does not act."""
    stiffness = 0.0 if is_off(m, "SPRING", "PASSIVE") else _value(m, "stiffness", t)
    damping = 0.0 if is_off(m, "DAMPER", "PASSIVE") else _value(m, "damping", t)
    low, high = np.broadcast_to(m.tendon_lengthspring[t], 2)
    return stiffness, damping, float(low), float(high)


def _friction(m, t: int) -> float:
    return 0.0 if is_off(m, "CONSTRAINT", "FRICTIONLOSS") else _value(m, "frictionloss", t)


def _is_limited(m, t: int) -> bool:
    return bool(m.tendon_limited[t]) and not is_off(m, "CONSTRAINT", "LIMIT")
