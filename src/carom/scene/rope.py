"""Ropes over pulleys: strands that pull, each a stop of a sum of lengths and of angles of wheels.

A rope that stretches has springs in the place of stops. Of the length L and the stiffness k, its part i, of the
length l_i without tension, has the stiffness k L/l_i: that of the same cross-section. A part that rubs on a
guide is a stop with friction (`carom.kinematics.wrap`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import count, pairwise
from typing import Any, NamedTuple

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Integer, Number, NumberOrNone, Value, Vector, VectorOrNone, keep
from carom.geometry.frames import triad
from carom.scene.bodies import GROUND, Body, Ground
from carom.scene.coordinates import BodyTurn, Combination, Strand, Wrap
from carom.scene.forces import AppliedForce
from carom.scene.joints import Joint
from carom.scene.restitution import Restitution
from carom.scene.stops import SceneStops, Stop
from carom.scene.strand_force import BeltStrand

PARALLEL = 1e-9  # cosine: of axes that count as parallel
LENGTH_ERROR = 1e-9  # length: by which it may be shorter than at the start


def _part(name: str, value: Any) -> Any:
    checks.instance(name, value, (Body, Ground, str))
    return value


@arguments.known
@dataclass(frozen=True, eq=False)
class Pulley:
    """A wheel over which a rope goes, in the plane across its axis.

    Parameters
    ----------
    wheel : Body, str or carom.GROUND
        The wheel, or the ground for one that does not turn. If the rope does not slip, or rubs on it, it is on
        a `Revolute` joint about this axis, on the ground or on a body that carries it (the block of a tackle,
        the arm of a tensioner). It may also rub on a part that a joint on the ground keeps from turning.
    radius : float
        Radius of the rope's centre line [m], above 0.
    axis : (3,)
        Axis of the wheel, in the world: the rope goes round it by the right-hand rule, in the order in which
        `add_rope` lists what it goes over. It must keep its direction.
    friction : float, optional
        None (default): the rope does not slip, and turns the wheel (on one of the ground it slips freely). 0:
        it slips freely. Above 0: it slips where the tension at one side is exp(friction angle) times that at
        the other one, with the angle that it lies round the guide. One guide of each part of a rope may rub, or
        several of the ground with nothing that moves between them.
    center : (3,), optional
        Centre, in the world at the start [m]. Default: the mass centre of the wheel; of the ground it must be
        given.
    turns : int
        Whole turns of the rope round it, beside what it needs (a rope on a bollard). Default 0.
    """

    wheel: Value[Any, Any] = Value(_part)
    radius: Number = fields.number(above=0.0, unit="m")
    axis: Vector = fields.direction()
    friction: NumberOrNone = fields.number(None, least=0.0)
    center: VectorOrNone = fields.vector(None)
    turns: Integer = fields.integer(0, least=0)


class Rope(NamedTuple):
    """The parts of a rope, one between two wheels without slip. `Scene.add_rope` makes it."""

    stops: tuple[Stop, ...]  #: of a rope of fixed length
    springs: tuple[AppliedForce, ...] = ()  #: of a rope that stretches


class _End(NamedTuple):
    """What a rope goes over: a circle, or a point."""

    part: Any
    point: np.ndarray
    anchor: np.ndarray | None  #: the point, None for the mass centre
    radius: float = 0.0
    axis: np.ndarray | None = None
    slips: bool = True
    friction: float = 0.0
    turns: int = 0


class _Made(NamedTuple):
    """How a rope is made: with a stiffness, or a law of the jerk by which it gets taut."""

    stiffness: float | None
    damping: float
    restitution: float | Restitution
    law: str | None


class SceneRope(SceneStops):
    """The method of `Scene` for ropes."""

    @arguments.known
    def add_rope(
        self,
        over,
        length: float | None = None,
        *,
        stiffness: float | None = None,
        damping: float = 0.0,
        restitution: float | Restitution = 0.0,
        impact_law: str | None = None,
        name: str | None = None,
    ) -> Rope:
        """Add a rope without mass over points and pulleys: it pulls, and does not push.

        A rope slides freely through points, and turns wheels on which it does not slip (`carom.Pulley`), so
        that its tension changes there. One of fixed length gets taut by an impact, with restitution; with a
        stiffness it stretches, and gets taut without an impact.

        Parameters
        ----------
        over : sequence
            What it goes over, from one end to the other: a body or its name (its mass centre), a pair (body or
            `carom.GROUND`, point in the world at the start), or a `carom.Pulley`. The first and the last are
            the ends, and no pulleys.
        length : float, optional
            Length of the rope without tension [m]. Default: that at the start. On wheels without slip what is
            slack is at first in the first part. A rope that stretches may be shorter than its way at the start,
            and has then the same tension in all parts; one of fixed length may not.
        stiffness : float, optional
            Of the whole rope [N/m], above 0: its tension if it is longer by 1 m. (Of the modulus E and the
            cross-section A it is E A/length.) A part between wheels without slip is stiffer as it is
            shorter; what is laid on such wheels has a constant tension. Default: the length is fixed.
        damping : float
            Of a rope that stretches, likewise [N s/m]. Default 0.
        restitution : float or Restitution
            Of the jerk by which a rope of fixed length gets taut, from 0 (default) to 1, or its law.
        impact_law : str, optional
            As for `add_stop`. Default: ``"stronge"`` where it rubs, since Newton's law with friction may add
            energy, else ``"newton"``; without friction all laws agree.
        name : str, optional
            Default ``"rope1"``, ``"rope2"``, ... With wheels without slip its parts have the names
            ``"<name>.1"``, ``"<name>.2"``, ..., from the first end on.

        Returns
        -------
        Rope
            With its `stops`, or its `springs`.

        Raises
        ------
        ValueError
            If the rope has fewer than two ends, axes of neighbours are not parallel, a circle is inside another
            one, a wheel without slip has no `Revolute` joint about its axis, or `length` is too short.

        Examples
        --------
        >>> import carom
        >>> scene = carom.Scene()
        >>> wheel = scene.add_body(carom.Cylinder(0.1, 0.02), mass=0.5, orientation=carom.euler("x", 90))
        >>> hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, wheel)
        >>> for name, x in (("left", -0.1), ("right", 0.1)):
        ...     load = scene.add_body(carom.Sphere(0.03), mass=1.0, position=(x, 0, -1), name=name)
        >>> rope = scene.add_rope(["left", carom.Pulley(wheel, 0.1, (0, 1, 0)), "right"])
        >>> [stop.name for stop in rope.stops]
        ['rope1.1', 'rope1.2']
        """
        ends = [self._end(k, one) for k, one in enumerate(checks.listed("over", over, "Body"))]
        if len(ends) < 2 or ends[0].axis is not None or ends[-1].axis is not None:
            raise ValueError(
                "over must begin and end with a body or a point, and have two of them at least"
            )
        name = self._free_name("rope") if name is None else name
        parts, least = _parts(ends, self._wheel_terms), sum(s.length for s in _strands(ends))
        if not all(part.terms for part in parts):
            raise ValueError(
                "over must have a body in it that moves, got points of the ground alone"
            )
        if length is not None:
            length = checks.number("length", length, above=0.0, unit="m")
        made = _Made(stiffness, damping, restitution, impact_law)
        return self._laid(name, parts, (least, length), made)

    def _laid(self, name: str, parts: list[_Part], lengths, made: _Made) -> Rope:
        """Add the parts of a rope: (way at the start, length or None)."""
        least, length = lengths
        names = [name] if len(parts) == 1 else [f"{name}.{k + 1}" for k in range(len(parts))]
        c = checks.number("damping", made.damping, least=0.0, unit="N s/m")
        if made.stiffness is not None:
            k = checks.number("stiffness", made.stiffness, above=0.0, unit="N/m")
            if not (isinstance(made.restitution, (int, float)) and made.restitution == 0.0):
                raise ValueError(
                    "restitution must be left out of a rope with a stiffness, which gets taut without an "
                    f"impact, got {checks.shown(made.restitution)}"
                )
            if any(part.wrap for part in parts):
                raise ValueError("stiffness must be left out of a rope with friction on a pulley")
            return Rope((), self._springs(names, parts, (least, length or least), (k, c)))
        if c != 0.0:
            raise ValueError(f"damping must be left out of a rope without stiffness, got {c:g}")
        slack = 0.0 if length is None else length - least
        if slack < -LENGTH_ERROR * least:
            raise ValueError(
                f"length must be at least {least:.9g} m, that at the start, got {length:g}"
            )
        stops = []
        for own, part in zip(names, parts):
            of = part.wrap or (
                part.terms[0][0] if len(part.terms) == 1 else Combination._of(part.terms)
            )
            law = ("stronge" if part.wrap else "newton") if made.law is None else made.law
            stops.append(
                self._parts.make(
                    Stop, "rope", own, False, joint=of, coordinate=0, upper=part.start + max(0.0, slack),
                    restitution=made.restitution, impact_law=law,
                )
            )  # fmt: skip
            slack = 0.0
        return Rope(tuple(stops))

    def _free_name(self, word: str) -> str:
        """Return the first of the names word1, word2, ... that no rope has."""
        every = (*self.stops, *self._parts.parts(AppliedForce))
        own = {part.name.partition(".")[0] for part in every}
        return next(f"{word}{k}" for k in count(1) if f"{word}{k}" not in own)

    def _springs(self, names, parts, lengths, constants) -> tuple[AppliedForce, ...]:
        """Add the parts of a rope that stretches: (way at the start, length), (stiffness, damping)."""
        way, length = lengths
        slack, made = max(0.0, length - way), []
        for own, part in zip(names, parts):
            # without tension: all parts are stretched alike at the start, and the first has what is slack
            relaxed = part.length * min(1.0, length / way) + slack
            k, c = (value * length / relaxed for value in constants)
            of, end = Combination._of(part.terms), part.start + relaxed - part.length
            definition = BeltStrand(of, -k * end, stiffness=k, damping=c)
            first, last = of.joints[0].child, of.parent
            made.append(
                self._parts.make(
                    AppliedForce, "rope", own, False, definition=definition, parent=last, child=first
                )
            )  # fmt: skip
            slack = 0.0
        return tuple(made)

    def _end(self, k: int, one: Any) -> _End:
        """Return what a rope goes over, with parts of the scene."""
        name = f"over[{k}]"
        if isinstance(one, Pulley):
            wheel = self._member(name, one.wheel)
            if one.center is None and isinstance(wheel, Ground):
                raise ValueError(
                    f"center of {name} must be given for a pulley of the ground, got None"
                )
            center = wheel.position if one.center is None else one.center
            slips = one.friction is not None or isinstance(wheel, Ground)
            friction = one.friction or 0.0
            return _End(wheel, center, one.center, one.radius, one.axis, slips, friction, one.turns)
        if isinstance(one, tuple):
            part, point = one
            at = checks.finite_array(name, point, (3,), "m")
            return _End(self._member(name, part), at, at)
        body = self._member(name, one)
        if isinstance(body, Ground):
            raise ValueError(
                f"{name} must be a pair (carom.GROUND, point), got {checks.shown(one)}"
            )
        return _End(body, body.position, None)

    def _member(self, name: str, part: Any) -> Any:
        return part if isinstance(part, Ground) else self._parts.member(name, part, (Body,))

    def _wheel_terms(self, end: _End, factor: float) -> list[tuple[Any, int, float]]:
        """Return the angle of a wheel about its axis as a term; none for what the rope slips over."""
        if end.slips and end.friction == 0.0:
            return []
        if isinstance(end.part, Ground):
            return []
        carried = False
        for joint in self._parts.parts(Joint):
            if joint.kind != "Revolute" or end.part not in (joint.child, joint.parent):
                continue
            cosine = float(joint.definition.axis @ end.axis)  # pyright: ignore
            if abs(cosine) > 1.0 - PARALLEL and isinstance(joint.parent, Ground):
                return [(joint, 0, math.copysign(factor * end.radius, factor * cosine))]
            carried = carried or abs(cosine) > 1.0 - PARALLEL
        if carried:
            # the torque of its joint would act on the carrier, too, that of a rope on the wheel alone
            assert end.axis is not None
            turn = BodyTurn(GROUND, end.part, end.part.position, None, end.axis)
            return [(turn, 0, factor * end.radius)]
        if end.friction > 0.0 and any(
            joint.definition.turn == "rigid" and isinstance(joint.parent, Ground)
            for joint in self._parts.parts(Joint)
            if joint.child is end.part
        ):
            return []
        raise ValueError(
            f"wheel {end.part.name!r} must have a Revolute joint about its axis, on carom.GROUND or on what "
            "carries it, about which the rope turns it; else let it slip: carom.Pulley(..., friction=0)"
        )


class _Strand(NamedTuple):
    """A strand: its coordinate, None if nothing moves it, its length with arcs at the start, and its angle."""

    of: Strand | None
    length: float
    axis: np.ndarray | None  #: about which angles are measured
    angle: float | None
    arcs: tuple[float, float] = (0.0, 0.0)  #: what its length has of the arcs round both circles
    seen: float = 0.0  #: its angle from where its coordinate begins


class _Part(NamedTuple):
    """A part of a rope between wheels without slip: terms, their sum at the start, and its own length there."""

    terms: list
    start: float
    length: float
    wrap: Wrap | None = None  #: its terms, if it rubs on a guide


def _strands(ends: list[_End]) -> list[_Strand]:
    """Return the strands of a rope."""
    out: list[_Strand] = []
    for a, b in pairwise(ends):
        out.append(_strand(a, b, out[-1] if out else _Strand(None, 0.0, None, None)))
    return out


def _parts(ends: list[_End], wheel_terms) -> list[_Part]:
    """Return the parts of a rope."""
    out: list[_Part] = []
    strands, first = _strands(ends), 0
    for k in range(1, len(ends)):
        if not ends[k].slips or k == len(ends) - 1:
            out.append(_part_of(ends[first : k + 1], strands[first:k], wheel_terms))
            first = k
    return out


def _part_of(ends: list[_End], strands: list[_Strand], wheel_terms) -> _Part:
    """Return the part of a rope between its ends, which are points or wheels without slip."""
    terms = [] if ends[0].slips else wheel_terms(ends[0], -1.0)
    length = sum(strand.length for strand in strands)
    length -= 0.0 if ends[0].slips else strands[0].arcs[0]
    length -= 0.0 if ends[-1].slips else strands[-1].arcs[1]
    terms += [(strand.of, 0, 1.0) for strand in strands if strand.of is not None]
    terms += [] if ends[-1].slips else wheel_terms(ends[-1], 1.0)
    start = sum(strand.of.start for strand in strands if strand.of is not None)
    rubs = [k for k, end in enumerate(ends) if end.friction > 0.0]
    if len(rubs) > 1:
        moves = [one.of for one in strands[rubs[0] : rubs[-1]] if one.of is not None]
        if moves or not all(isinstance(ends[k].part, Ground) for k in rubs):
            raise ValueError(
                "friction must be above 0 for one pulley of each part of a rope between wheels without slip, "
                f"or for several of the ground with nothing that moves between them, got {len(rubs)}"
            )
    wrap = _wrap(ends, strands, terms, rubs, wheel_terms) if rubs else None
    return _Part(terms, start, length, wrap)


def _wrap(ends, strands: list[_Strand], terms: list, rubs: list[int], wheel_terms) -> Wrap:
    """Return the length of a part that rubs on some of its ends, with the one slip there."""
    first, last = rubs[0], rubs[-1]
    before = {id(strand.of) for strand in strands[:first]}
    behind = {id(strand.of) for strand in strands[last:]}
    slip = [0.5 * ((id(one) in behind) - (id(one) in before)) for one, _, _ in terms]
    if not ends[0].slips:
        slip[0] = -0.5 * terms[0][2]
    if not ends[-1].slips:
        slip[-1] = 0.5 * terms[-1][2]
    turned = wheel_terms(ends[first], -1.0)
    places = {id(one): n for n, (one, _, _) in enumerate(terms)}
    around = strands[first - 1], strands[last]
    guide, *others = (_guide(ends[k], strands[k - 1], strands[k]) for k in rubs)
    made: Any = Wrap._of([*terms, *((joint, at, 0.0) for joint, at, _ in turned)])
    keep(
        made, slip=(*slip, *(factor for *_, factor in turned)), way=guide[0], arc=guide[1],
        friction=guide[2], others=tuple(others),
        strands=tuple(places[id(one.of)] if one.of is not None else -1 for one in around),
        angles=tuple(one.seen for one in around),
    )  # fmt: skip
    return made


def _guide(end: _End, before: _Strand, behind: _Strand) -> tuple[int, float, float]:
    """Return way, arc and friction of a guide between two strands."""
    assert behind.axis is not None
    way = 1 if float(end.axis @ behind.axis) > 0.0 else -1
    return way, way * ((behind.angle or 0.0) - (before.angle or 0.0)), end.friction


def _strand(a: _End, b: _End, last: _Strand) -> _Strand:
    """Return the strand from a to b, after another one."""
    own = a.axis if a.axis is not None else b.axis
    if own is None:
        length = float(np.linalg.norm(b.point - a.point))
        return last._replace(
            of=_between(a, b, np.zeros(3), np.zeros(2), length), length=length, arcs=(0.0, 0.0)
        )
    axis = own if last.axis is None else last.axis
    sides = [0.0 if end.axis is None else float(end.axis @ axis) for end in (a, b)]
    for end, side in zip((a, b), sides):
        if end.axis is not None and abs(side) < 1.0 - PARALLEL:
            raise ValueError(
                f"axes of the pulleys of a rope must be parallel, got {end.axis} and {axis}"
            )
    radii = np.array([math.copysign(a.radius, sides[0]), math.copysign(b.radius, sides[1])])
    rho = float(radii[0] - radii[1])
    x, y = (b.point - a.point) @ triad(axis)[:, 1:]
    d2 = float(x * x + y * y)
    if not d2 > rho * rho:
        raise ValueError(
            f"a strand must be between circles outside each other, got a distance of {math.sqrt(d2):g} m "
            f"for radii of {a.radius:g} m and {b.radius:g} m"
        )
    length = math.sqrt(d2 - rho * rho)
    angle = math.atan2(length * y + rho * x, length * x - rho * y)
    if (
        last.angle is not None and a.axis is not None
    ):  # the arc round a is less than a turn, by its own axis
        way = math.copysign(1.0, sides[0])
        angle = last.angle + way * ((way * (angle - last.angle)) % (2.0 * math.pi))
        angle += way * 2.0 * math.pi * a.turns
    whole, arcs = length + rho * angle, (float(radii[0]) * angle, -float(radii[1]) * angle)
    of = _between(a, b, axis, radii, whole)
    back = isinstance(b.part, Ground) and of is not None
    return _Strand(of, whole, axis, angle, arcs, angle + math.pi if back else angle)


def _between(a: _End, b: _End, axis, radii: np.ndarray, start: float) -> Strand | None:
    """Return the coordinate of a strand, whose second end is a body: seen from there it has turned by pi."""
    if not isinstance(b.part, Ground):
        return Strand(a.part, b.part, a.anchor, b.anchor, axis, radii, start)
    if isinstance(a.part, Ground):
        return None
    turned = start + float(radii[0] - radii[1]) * math.pi
    return Strand(b.part, a.part, b.anchor, a.anchor, axis, -radii[::-1], turned)
