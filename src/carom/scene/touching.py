"""The contacts of a scene: which pairs may touch, and by which law."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from carom import arguments, checks
from carom.scene.all_pairs import PairTable
from carom.scene.bodies import FIXED, Body, Ground, HalfSpace, StaticBody
from carom.scene.contacts import Contact, check_gap, check_hertz
from carom.scene.friction import FrictionLaw
from carom.scene.materials import ContactLaw, Rule
from carom.scene.pairs import Pairs
from carom.scene.restitution import Restitution
from carom.scene.stiffness import Hertz, Stiffness
from carom.scene.values import MethodsOfScene

One = Body | HalfSpace | StaticBody | str
Some = One | Sequence[One]


class SceneContacts(MethodsOfScene):
    """The methods of `Scene` for contacts."""

    _pairs: Pairs

    @arguments.known
    def add_contact(
        self,
        body: One,
        other: One,
        *,
        restitution: float | Restitution | None = None,
        friction: float | FrictionLaw | None = None,
        friction_held: float | FrictionLaw | None = None,
        impact_law: str | None = None,
        stiffness: float | Stiffness | Hertz | None = None,
        rolling_friction: float | None = None,
        pivoting_friction: float | None = None,
        tangential_restitution: float | None = None,
        multiple: str | None = None,
        adhesion: float | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Contact:
        """Add a contact: let a body touch a half-space, a static body or another body.

        A value that is not given comes from the two materials; if there are none, from `set_contact_default`;
        otherwise it is the default stated here.

        Parameters
        ----------
        body, other
            The pair, as objects or by name: a body with a shape, and a half-space, a static body or another
            body, without penetration at the start. For two bodies the order matters: the normal points from
            `other` to `body`.
        restitution
            Coefficient of restitution e, from 0 (plastic) to 1 (elastic), or its law, a function of the speed
            of approach, as ``carom.Restitution.power(0.6)``. Default 0.5.
        friction
            Coulomb's friction coefficient mu, at least 0: the tangent of the greatest slope on which the body
            rests. A large value (50) stands for a contact that does not slip. Or a law, a function of the speed
            of slip, as ``carom.Friction(static=0.4, kinetic=0.3)``, or of its direction. Default 0.
        friction_held
            mu in persistent contact, at least 0. Default: `friction`.
        impact_law : {"newton", "poisson", "stronge", "moreau"}
            Definition of e: the ratio of normal speeds (``"newton"``, default) or of normal impulses
            (``"poisson"``), or the square root of the ratio of works (``"stronge"``). ``"moreau"`` is
            Newton's with friction by the slip after the impact, in one contact problem without a path: the law
            of Moreau, Glocker and Siconos.
        stiffness
            Stiffness of the boundary layer relative to those of simultaneous contacts, above 0. Default 1.
            Or the stiffness of the bodies, `carom.Stiffness` or `carom.Hertz`: then `Solution.impacts` has the
            greatest force and the duration of each impact. A single impact does not depend on it. Where several
            contacts strike together and all pairs of the scene have Hertz's law, the moduli decide how they
            share the impact.
        rolling_friction, pivoting_friction
            Greatest moment against rolling, and about the normal, in persistent contact, divided by the
            normal force [m]. Default 0. The moments act against relative rotation until it stops; each contact
            point of a face has its own. Impacts do not use them.
        tangential_restitution
            Coefficient e_t from -1 to 1. If an impact ends in stick, the pair leaves with -e_t times the slip
            before it (1 for a super ball), as far as the friction allows, and the energy that friction took.
            Below 0 slip keeps its direction; -1 leaves it as without friction. Default 0: it leaves without
            slip, as it does in time-stepping steps.
        multiple : {"simultaneous", "sequential"}
            Multiple impact, if other contacts of these bodies are closed too: all contacts simultaneously
            (default), or this pair in an impact of its own, one impact after another, as in a row of balls with
            small gaps. See `Options.multiple`.
        adhesion
            Force [N] with which the two hold together while they touch, at least 0: that of a magnet or a
            latch. They come apart where more is needed, and friction has the normal force and this as its load.
            The points of a face share it, and once one lets go the others hold no more, until the two are
            pressed together or strike anew. It has no range: it does not act across a gap, and does not change
            impacts. Time-stepping steps are without it, and say so. Default 0.
        name
            Name in the scene. Default: the names of both, such as ``"die-ground"``.
        replace : bool
            True: a contact that has this name is replaced. Default False: it is refused.

        Raises
        ------
        ValueError
            If the two penetrate each other at the start, are the same body, already have a contact, or have
            different materials without a rule that combines them.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
        >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1), name="ball")
        >>> scene.add_contact(ball, table, restitution=0.8, friction=0.3, impact_law="stronge")
        Contact('ball-table', restitution=0.8, friction=0.3, impact_law='stronge')
        """
        body, other = self._two(body, other)
        name = f"{body.name}-{other.name}" if name is None else checks.text("name", name)
        old = self._parts.get(name) if checks.flag("replace", replace) else None
        self._pairs.check_new(body, other, old)
        index, name = self._parts.new(Contact, name, "contact", replace)
        given = {
            "restitution": restitution, "friction": friction, "friction_held": friction_held,
            "impact_law": impact_law, "stiffness": stiffness, "rolling_friction": rolling_friction,
            "pivoting_friction": pivoting_friction, "tangential_restitution": tangential_restitution,
            "multiple": multiple, "adhesion": adhesion,
        }  # fmt: skip
        check_hertz(stiffness, body, other)
        law = self._pairs.law(body, other, given)
        contact = Contact(index=index, name=name, body=body, other=other, **vars(law))
        check_gap(contact)
        contact = self._parts.add(contact)
        if old is not None:
            self._pairs.forget(old)
        self._pairs.add(body, other, given)
        return contact

    @arguments.known
    def set_contact_default(
        self,
        *,
        restitution: float | Restitution | None = None,
        friction: float | FrictionLaw | None = None,
        friction_held: float | FrictionLaw | None = None,
        impact_law: str = "newton",
        stiffness: float | Stiffness | Hertz = 1.0,
        rolling_friction: float = 0.0,
        pivoting_friction: float = 0.0,
        tangential_restitution: float = 0.0,
        multiple: str = "simultaneous",
        combine: Rule = None,
        all_pairs: bool = True,
    ) -> None:
        """Let all pairs touch, and set the values of pairs without materials and without own values.

        Parameters
        ----------
        restitution, friction, friction_held, impact_law, stiffness
            As for `add_contact`.
        rolling_friction, pivoting_friction, tangential_restitution
            As for `add_contact`.
        multiple
            As for `add_contact`.
        combine : {"average", "min", "max", "product", "geometric"} or dict, optional
            Rule that computes the value of a pair from its two materials: one rule for restitution, friction,
            friction_held, rolling_friction and pivoting_friction, or a rule for each property, as in
            ``{"friction": "geometric", "restitution": "max"}``. No rule is physically right, because these
            values are properties of pairs; so there is no default, and different materials need a rule. Two
            values of stiffness act in series: ``2 / (1 / s1 + 1 / s2)``.
        all_pairs
            True (default): every body may touch every half-space, static body and other body, except pairs
            with a joint and pairs of `ignore_contact`. False: only pairs of `add_contact` may touch.

        Notes
        -----
        Contacts that were added before keep their values.
        """
        default = ContactLaw(
            restitution=0.5 if restitution is None else restitution,
            friction=0.0 if friction is None else friction,
            friction_held=friction_held,
            impact_law=impact_law,
            stiffness=stiffness,
            rolling_friction=rolling_friction,
            pivoting_friction=pivoting_friction,
            tangential_restitution=tangential_restitution,
            multiple=multiple,
        )
        stated = restitution is not None or friction is not None
        self._pairs.set_default(default, combine, all_pairs, stated)

    @arguments.known
    def ignore_contact(self, body: Some, other: Some | None = None) -> None:
        """Exclude pairs from the contacts of `set_contact_default`: they pass through each other.

        Parameters
        ----------
        body, other
            Each is a body, half-space or static body, its name, or a sequence of these. No part of `body`
            touches a part of `other`. Without `other`, no two parts of `body` touch each other.

        Raises
        ------
        ValueError
            If a part is not of this scene, or one part is given alone or twice.

        Examples
        --------
        The links of a chain pass through each other and through a second chain:

        >>> scene = carom.Scene()
        >>> scene.set_contact_default(restitution=0, friction=0.3)
        >>> one, two = ([scene.add_body(carom.Sphere(0.1), mass=1, position=(k, y, 0)) for k in range(3)]
        ...             for y in (0, 5))
        >>> scene.ignore_contact(one)
        >>> scene.ignore_contact(one, two)
        >>> len(scene.pairs_by_default())  # of two with each other
        3
        """
        first = self._some("body", body)
        if other is None:
            pairs = list(combinations(first, 2))
        else:
            pairs = [(a, b) for a in first for b in self._some("other", other) if a is not b]
        if not pairs and isinstance(body, (str, Body, *FIXED)):
            raise ValueError(
                f"body and other must be two parts or sequences of parts, got {checks.shown(body)} alone"
            )
        for a, b in pairs:
            self._pairs.ignore(a, b)

    @arguments.known
    def contact_law(self, body: One, other: One) -> ContactLaw | None:
        """Return the default law of a pair without a contact of its own; None if the pair does not touch.

        Raises
        ------
        ValueError
            If the pair has different materials without a rule that combines them.
        """
        body, other = self._two(body, other)
        return self._pairs.default_law(body, other)

    def pairs_by_default(self) -> PairTable:
        """Return all pairs that may touch by `set_contact_default`, with their laws, as arrays.

        N bodies have N(N - 1)/2 pairs; a run only keeps those that come near each other (`Solution.pairs`).

        Raises
        ------
        ValueError
            If a pair has different materials without a rule that combines them.
        """
        fixed = (*self._parts.parts(HalfSpace), *self._parts.parts(StaticBody))
        return self._pairs.by_default(self._parts.parts(Body), fixed)

    def _two(self, body, other) -> tuple[Body, HalfSpace | StaticBody | Body]:
        """Return a pair that may touch, given as objects or by name; a part that never moves is second."""
        kinds, hint = (Body, *FIXED), "; a floor is made by scene.add_half_space(point, normal)"
        first = self._parts.member("body", body, kinds, hint if isinstance(body, Ground) else "")
        second = self._parts.member(
            "other", other, kinds, hint if isinstance(other, Ground) else ""
        )
        if isinstance(first, FIXED):
            first, second = second, first
        if isinstance(first, FIXED):
            raise ValueError(
                f"body or other must be a body that moves, got {second.name!r} and {first.name!r}"
            )
        return first, second

    def _some(self, argument: str, given) -> list:
        """Return bodies and half-spaces; one or several are given, as objects or by name."""
        single = isinstance(given, (str, Body, *FIXED))
        what = "bodies, half-spaces and static bodies"
        several = [given] if single else checks.listed(argument, given, what)
        return [self._parts.member(argument, one, (Body, *FIXED)) for one in several]

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Contacts, in the order in which they were added."""
        return self._parts.parts(Contact)

    @property
    def contact_default(self) -> ContactLaw | None:
        """Default law of pairs without a contact of their own; None if these do not touch."""
        return self._pairs.default
