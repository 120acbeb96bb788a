"""Belts and chains over any number of wheels, idlers and tensioners: ropes without ends."""

from __future__ import annotations

import math

from carom import arguments, checks
from carom.scene.restitution import Restitution
from carom.scene.rope import Pulley, Rope, SceneRope, _Made, _part_of, _strands


class SceneBelts(SceneRope):
    """The method of `Scene` for belts over several wheels."""

    @arguments.known
    def add_belt(
        self,
        over,
        *,
        tension: float = 0.0,
        stiffness: float | None = None,
        damping: float = 0.0,
        slack: float = 0.0,
        restitution: float | Restitution = 0.0,
        impact_law: str | None = None,
        name: str | None = None,
    ) -> Rope:
        """Add an endless belt or chain over pulleys: a rope without ends, whose strands pull only.

        It turns wheels on which it does not slip, each as fast as its radius says, in the direction in which it
        goes round them (a serpentine belt touches some by its back). Between two of these is a part of it, with
        a tension of its own. Wheels may move: a tensioner is a pulley on an arm with a spring. (A belt of two
        wheels on one carrier that is always taut is a `carom.joints.Belt`.)

        Parameters
        ----------
        over : sequence of Pulley
            What it goes over, in the order of its run; the axis of each says round which side, by the
            right-hand rule. Two or more do not slip.
        tension : float
            Of a belt that stretches, in all parts at the start [N], at least 0. Default 0. One of fixed length
            has the tension that what it goes over gives it, such as a tensioner.
        stiffness : float, optional
            Of the whole belt, as for `add_rope` [N/m]. Default: the length is fixed.
        damping : float
            Of a belt that stretches, likewise [N s/m]. Default 0.
        slack : float
            By which one of fixed length is longer than its way at the start [m], at least 0, at first in the
            first part. Default 0.
        restitution, impact_law
            Of the jerk by which a part of fixed length gets taut, as for `add_rope`.
        name : str, optional
            Default ``"belt1"``, ``"belt2"``, ... Its parts have the names ``"<name>.1"``, ..., the first from
            the first wheel without slip on.

        Returns
        -------
        Rope
            With its `stops`, or its `springs`.

        Raises
        ------
        ValueError
            If fewer than two pulleys do not slip, or as for `add_rope`.

        Examples
        --------
        >>> import carom
        >>> scene = carom.Scene(gravity=(0, 0, 0))
        >>> pulleys = []
        >>> for x, y, radius, side in ((0, 0, 0.1, 1), (0.5, 0, 0.05, 1), (0.25, 0.1, 0.04, -1)):
        ...     wheel = scene.add_body(carom.Cylinder(radius, 0.02), mass=1.0, position=(x, y, 0))
        ...     hinge = carom.joints.Revolute((x, y, 0), (0, 0, 1))
        ...     hinge = scene.add_joint(hinge, carom.GROUND, wheel)
        ...     pulleys.append(carom.Pulley(wheel, radius, (0, 0, side)))
        >>> belt = scene.add_belt(pulleys, tension=50.0, stiffness=1e5, name="belt")
        >>> [spring.name for spring in belt.springs]
        ['belt.1', 'belt.2', 'belt.3']
        """
        given = checks.listed("over", over, "Pulley")
        for k, one in enumerate(given):
            checks.instance(f"over[{k}]", one, (Pulley,))
        ends = [self._end(k, one) for k, one in enumerate(given)]
        fixed = [k for k, end in enumerate(ends) if not end.slips]
        if len(fixed) < 2:
            raise ValueError(
                f"over must have two wheels or more on which the belt does not slip, got {len(fixed)}"
            )
        ends = [
            *ends[fixed[0] :],
            *ends[: fixed[0] + 1],
        ]  # round, from the first of these to itself
        strands, first, parts = _strands(ends), 0, []
        for k in range(1, len(ends)):
            if not ends[k].slips:
                part = _part_of(ends[first : k + 1], strands[first:k], self._wheel_terms)
                parts, first = [*parts, part], k
        # with the arc on the wheel where it begins, of less than a turn
        assert ends[0].axis is not None
        assert strands[0].axis is not None
        way = math.copysign(1.0, float(ends[0].axis @ strands[0].axis))
        turned = (strands[0].angle or 0.0) - (strands[-1].angle or 0.0)
        least = sum(strand.length for strand in strands) - strands[0].arcs[0] - strands[-1].arcs[1]
        least += ends[0].radius * ((way * turned) % (2.0 * math.pi))
        tension = checks.number("tension", tension, least=0.0, unit="N")
        slack = checks.number("slack", slack, least=0.0, unit="m")
        length = least + slack
        if stiffness is not None:
            stiffness = checks.number("stiffness", stiffness, above=0.0, unit="N/m")
            if slack > 0.0:
                raise ValueError(
                    f"slack must be left out of a belt with a stiffness, got {slack:g}"
                )
            if not tension < stiffness * least:
                raise ValueError(
                    f"tension must be below {stiffness * least:.6g} N, by which a belt of this stiffness is as "
                    f"long as its way from nothing, got {tension:g}"
                )
            length = least - tension / stiffness
        elif tension > 0.0:
            raise ValueError(
                f"tension must be left out of a belt of fixed length, got {tension:g}; give it a stiffness, or "
                "a tensioner: a pulley on an arm with a spring"
            )
        made = _Made(stiffness, damping, restitution, impact_law)
        name = self._free_name("belt") if name is None else name
        return self._laid(name, parts, (least, length), made)
