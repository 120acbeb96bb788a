"""Belts between two wheels on one carrier: a relation of their angles, or two strands that pull.

With the centres c_a and c_b of the wheels, d = c_b - c_a in the plane of the belt, the axis n, and
rho = r_a - r_b (r_a + r_b of a crossed belt), the strands run from a to b along

    e_1 = (l d - rho n x d)/d^2,   e_2 = (l d + rho n x d)/d^2,   l = sqrt(d^2 - rho^2).

The stretch of strand 1 is s_1 = r_a theta_a - r_b theta_b + e_1 . (x_b - x_a), theta_b with the other sign if
the belt is crossed, and that of strand 2 is s_2 = -r_a theta_a + r_b theta_b + e_2 . (x_b - x_a). The
displacements x of the centres relative to the carrier are 0, but their rows let the strands pull at the wheels
and not at the carrier: the hinges carry what the strands pull.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import count
from typing import Any, NamedTuple

import numpy as np

from carom.fields import keep
from carom.geometry import quaternion
from carom.scene.bodies import Body, Ground
from carom.scene.constraints import Constraint, Coupling
from carom.scene.coordinates import Axial, Combination
from carom.scene.forces import AppliedForce
from carom.scene.joints import Belt, Joint
from carom.scene.stops import Stop
from carom.scene.strand_force import BeltStrand

PARALLEL = 1e-9  # cosine: of axes that count as parallel


@dataclass(frozen=True, init=False, eq=False)
class BeltStretch(Combination):
    """The stretch of a strand: a sum of the angles of both wheels and of displacements of their centres.

    Attributes
    ----------
    wheels : tuple of two bodies
    centers : (2, 3)
        Their centres in the plane of the belt, in the world at the start [m].
    axis : (3,)
        Axis about which radii are positive, in the world at the start.
    radii : (2,)
        Radii [m]; below 0 if the strand leaves its wheel on the other side of the axis.
    """

    wheels: tuple[Body, Body]
    centers: np.ndarray
    axis: np.ndarray
    radii: np.ndarray


@dataclass(frozen=True, init=False, eq=False)
class BeltRelation(Coupling):
    """The relation of two wheels that a belt makes: half the difference of the stretches of its strands is 0.

    Attributes
    ----------
    tension : float
        Tension of both strands where the belt transmits nothing [N].
    start : float
        Value of the relation at the start [m], which is kept.
    wheels, centers, axis, radii
        As of `BeltStretch`, of strand 2.
    """

    wheels: tuple[Body, Body]
    centers: np.ndarray
    axis: np.ndarray
    radii: np.ndarray
    tension: float
    start: float


class BeltDrive(NamedTuple):
    """The parts of a belt. `Scene.add_joint` makes it."""

    relation: Constraint | None  #: None if its strands pull only
    strands: tuple[Stop | AppliedForce, ...]  #: strand 1 and strand 2, none of a relation
    pretension: AppliedForce | None  #: of a relation with a tension


class _Hinge(NamedTuple):
    """A hinge of a wheel, in the world at the start."""

    joint: Joint
    wheel: Body
    carrier: Body | Ground
    anchor: np.ndarray
    axis: np.ndarray  #: about which the wheel turns on the carrier as the coordinate grows
    angle: float  #: at the start

    def axial(self, at: np.ndarray, along: np.ndarray) -> Axial:
        """Return the displacement of the centre of the wheel on its carrier."""
        return Axial(self.carrier, self.wheel, at, at, along)


def _hinges(joints, wheel: Body) -> list[_Hinge]:
    """Return the hinges of a wheel."""
    found = []
    for joint in joints:
        if joint.kind != "Revolute" or wheel not in (joint.parent, joint.child):
            continue
        anchor, axis, angle = joint.anchor(), joint.definition.axis, 0.0
        if joint.frames is not None:
            (_, q), (p, r) = joint.frames
            attitude, child = quaternion.multiply(joint.child.orientation, r), joint.child
            anchor = (
                child.position
                + quaternion.rotate(child.orientation, p)
                + quaternion.rotate(attitude, anchor)
            )
            base = q
            if isinstance(joint.parent, Body):
                base = quaternion.multiply(joint.parent.orientation, q)
            turned = quaternion.multiply(quaternion.conjugate(base), attitude)
            angle = 2.0 * math.atan2(float(turned[1:] @ axis), float(turned[0]))
            angle = math.remainder(angle, 2.0 * math.pi)
            axis = quaternion.rotate(attitude, axis)
        own = joint.child is wheel
        other = joint.parent if own else joint.child
        found.append(_Hinge(joint, wheel, other, anchor, axis if own else -axis, angle))
    return found


def _on_one_carrier(joints, parent: Body, child: Body) -> tuple[_Hinge, _Hinge]:
    """Return the hinges of both wheels on one carrier, with parallel axes."""
    for a in _hinges(joints, parent):
        for b in _hinges(joints, child):
            if a.carrier is b.carrier and abs(float(a.axis @ b.axis)) > 1.0 - PARALLEL:
                return a, b
    raise ValueError(
        "parent and child of a Belt must have Revolute joints with parallel axes on one carrier, the ground or "
        f"a body, got {parent.name!r} and {child.name!r}; a pulley that is fixed to a part is a body on a "
        "Fixed joint"
    )


class _Strands(NamedTuple):
    """Both strands of a belt: the terms of their stretches, and the stretch of the first by the angles."""

    terms: tuple[list, list]
    half: list  #: of half the difference of the stretches
    inner: list  #: of half their sum, of the displacements alone
    start: float  #: of half the difference
    where: dict[str, Any]  #: fields of `BeltStretch`, of strand 2


def _strands(d: Belt, a: _Hinge, b: _Hinge) -> _Strands:
    """Return the strands of a belt round two wheels."""
    n = a.axis
    level = d.plane if d.plane is not None else 0.5 * (a.wheel.position + b.wheel.position)
    p, q = (one.anchor + n * float((level - one.anchor) @ n) for one in (a, b))
    apart, least = q - p, d.radius_parent + d.radius_child
    apart = apart - n * float(apart @ n)
    size = float(np.linalg.norm(apart))
    if not size > least:
        raise ValueError(
            "radius_parent and radius_child must be those of wheels beside each other, with a sum below the "
            f"distance of their axes, {size:g} m, got {d.radius_parent:g} and {d.radius_child:g}"
        )
    way = -1.0 if d.crossed else 1.0
    rho = d.radius_parent - way * d.radius_child
    line, sine = apart / size, rho / size
    cosine, across = math.sqrt(1.0 - sine * sine), np.cross(n, line)
    turns = math.copysign(1.0, float(b.axis @ n))
    angles = [
        (a.joint, 0, d.radius_parent),
        (b.joint, 0, -way * turns * d.radius_child),
    ]
    back = [(joint, k, -factor) for joint, k, factor in angles]
    ends = []
    for side in (-1.0, 1.0):
        e = cosine * line + side * sine * across
        ends.append([(b.axial(q, e), 0, 1.0), (a.axial(p, e), 0, -1.0)])
    half = list(angles)
    if sine != 0.0:  # (e_1 - e_2)/2
        half += [(b.axial(q, across), 0, -sine), (a.axial(p, across), 0, sine)]
    inner = [(b.axial(q, line), 0, cosine), (a.axial(p, line), 0, -cosine)]
    start = sum(factor * one.angle for one, (_, _, factor) in zip((a, b), angles))
    where = {
        "wheels": (a.wheel, b.wheel), "centers": np.stack([p, q]), "axis": n,
        "radii": np.array([d.radius_parent, way * d.radius_child]),
    }  # fmt: skip
    return _Strands((angles + ends[0], back + ends[1]), half, inner, start, where)


def _stretches(made: _Strands) -> list[BeltStretch]:
    """Return the stretches of both strands."""
    found = []
    for terms, side in zip(made.terms, (-1.0, 1.0)):
        found.append(BeltStretch._of(terms))
        keep(found[-1], **made.where | {"radii": side * made.where["radii"]})
    return found


def add_belt(parts: Any, d: Belt, parent: Any, child: Any, name: str | None) -> BeltDrive:
    """Add the parts of a belt to those of a scene."""
    if isinstance(parent, Ground):
        raise ValueError(
            "parent of a Belt must be a body, got carom.GROUND; a pulley that is fixed to the ground is a body "
            "on a Fixed joint"
        )
    a, b = _on_one_carrier(parts.parts(Joint), parent, child)
    made = _strands(d, a, b)
    if name is None:
        name = next(
            f"belt{k}" for k in count(1) if f"belt{k}" not in parts and f"belt{k}.1" not in parts
        )

    def force(of: Combination, ending: str, tension: float, **values: Any) -> AppliedForce:
        definition = BeltStrand(of, tension, **values)
        return parts.make(
            AppliedForce, "belt", f"{name}.{ending}", False, definition=definition, parent=parent, child=child
        )  # fmt: skip

    if d.is_relation:
        relation = BeltRelation._of(made.half)
        keep(relation, tension=d.tension, start=made.start, **made.where)
        kept = parts.make(Constraint, "belt", name, False, definition=relation)
        # both strands pull with it, along half the sum of their stretches
        inner = Combination._of(made.inner)
        pull = force(inner, "pretension", 2.0 * d.tension) if d.tension > 0.0 else None
        return BeltDrive(kept, (), pull)  # pyright: ignore[reportArgumentType]
    starts = made.start, -made.start
    if d.stiffness is not None:
        tensions = (d.tension - d.stiffness * (start + 0.5 * d.slack) for start in starts)
        strands = tuple(
            force(of, str(k), tension, stiffness=d.stiffness, damping=d.damping)
            for k, (of, tension) in enumerate(zip(_stretches(made), tensions), 1)
        )
        return BeltDrive(None, strands, None)
    stops = tuple(
        parts.make(
            Stop, "belt", f"{name}.{k}", False, joint=of, coordinate=0,
            upper=start + 0.5 * d.slack, restitution=d.restitution, impact_law=d.impact_law,
        )
        for k, (of, start) in enumerate(zip(_stretches(made), starts), 1)
    )  # fmt: skip
    return BeltDrive(None, stops, None)
