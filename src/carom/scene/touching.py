"""The contacts of a scene: what touches what, and how."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from carom import arguments, checks
from carom.scene.all_pairs import PairTable
from carom.scene.bodies import FIXED, Body, Ground, HalfSpace, StaticBody
from carom.scene.contacts import Contact, make_contact
from carom.scene.materials import ContactLaw, Rule
from carom.scene.pairs import Pairs
from carom.scene.registry import Registry

One = Body | HalfSpace | StaticBody | str
Some = One | Sequence[One]


class TouchingPairs:
    """The part of `Scene` that concerns contacts."""

    _parts: Registry
    _pairs: Pairs

    @arguments.known
    def add_contact(
        self,
        body: One,
        other: One,
        *,
        restitution: float | None = None,
        friction: float | None = None,
        friction_held: float | None = None,
        impact_law: str | None = None,
        stiffness: float | None = None,
        rolling_friction: float | None = None,
        pivoting_friction: float | None = None,
        multiple: str | None = None,
        name: str | None = None,
    ) -> Contact:
        """Let a body and a half-space, a static body or another body touch.

        A value that is not given is that of the two materials, else that of `set_contact_default`, else the
        default named here.

        Parameters
        ----------
        body, other
            The two, themselves or by their names: a body with a shape, and a half-space, a static body or
            another body that it is not inside of. The order matters for two bodies alone: the normal points
            from `other` to `body`.
        restitution
            e, from 0 (plastic) to 1 (elastic). Default 0.5.
        friction
            Coulomb's mu, at least 0. Default 0.
        friction_held
            mu of contact that stays, at least 0. Default: `friction`.
        impact_law : {"newton", "poisson", "stronge"}
            What e compares: speeds, impulses or works. Default ``"newton"``.
        stiffness
            Of the boundary layer in proportion to those of contacts that strike at the same time, above
            0. Default 1.
        rolling_friction, pivoting_friction
            Greatest moment against rolling, and about the normal, of contact that stays, divided by the
            normal force [m]. Default 0. They act against relative rotation until that stops; each point of
            a face by its own force. Impacts know neither.
        multiple : {"simultaneous", "sequential"}
            How an impact goes on while other contacts of these bodies are closed, too: all together (default),
            or this pair in a blow of its own, and one blow after the other, as in a row of balls that do not
            quite touch. See `Options.multiple`.
        name
            Default: the names of both, such as ``"die-ground"``.

        Raises
        ------
        ValueError
            If the two are inside each other at the start, are one body, have a contact already, or have
            materials that no rule combines.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
        >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1), name="ball")
        >>> scene.add_contact(ball, table, restitution=0.8, friction=0.3, impact_law="stronge")
        Contact('ball-table', restitution=0.8, friction=0.3, impact_law='stronge')
        """
        body, other = self._two(body, other)
        self._pairs.check_new(body, other)
        name = f"{body.name}-{other.name}" if name is None else name
        index, name = self._parts.new(Contact, name, "contact")
        given = {
            "restitution": restitution,
            "friction": friction,
            "friction_held": friction_held,
            "impact_law": impact_law,
            "stiffness": stiffness,
            "rolling_friction": rolling_friction,
            "pivoting_friction": pivoting_friction,
            "multiple": multiple,
        }
        law = self._pairs.law(body, other, given)
        contact = self._parts.add(make_contact(index, name, body, other, law))
        self._pairs.add(body, other, given)
        return contact

    @arguments.known
    def set_contact_default(
        self,
        *,
        restitution: float | None = None,
        friction: float | None = None,
        friction_held: float | None = None,
        impact_law: str = "newton",
        stiffness: float = 1.0,
        rolling_friction: float = 0.0,
        pivoting_friction: float = 0.0,
        multiple: str = "simultaneous",
        combine: Rule = None,
        all_pairs: bool = True,
    ) -> None:
        """Let all pairs touch, and state the values of pairs that have no materials and none of their own.

        Parameters
        ----------
        restitution, friction, friction_held, impact_law, stiffness, rolling_friction, pivoting_friction
            As of `add_contact`.
        multiple
            As of `add_contact`.
        combine : {"average", "min", "max", "product", "geometric"} or dict, optional
            How two materials make one number: for all of restitution, friction, friction_held,
            rolling_friction and pivoting_friction, or by property, as in ``{"friction": "geometric",
            "restitution": "max"}``. No rule is the right one (these numbers belong to pairs), so there is
            no default: materials that differ need a rule. Stiffness is combined as of two springs in
            series, ``2 / (1 / s1 + 1 / s2)``.
        all_pairs
            True (default): every body touches every half-space, static body and other body, but for those that
            a joint joins and those of `ignore_contact`. False: only pairs of `add_contact` touch.

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
            multiple=multiple,
        )
        stated = restitution is not None or friction is not None
        self._pairs.set_default(default, combine, all_pairs, stated)

    def ignore_contact(self, body: Some, other: Some | None = None) -> None:
        """Let bodies pass through each other where `set_contact_default` lets all pairs touch.

        Parameters
        ----------
        body, other
            Each a body, half-space or static body, its name, or a sequence of these: no one of the first
            touches one of the second. Without `other` no two of the first touch each other.

        Examples
        --------
        A chain whose links pass through each other, and a second one that passes through it:

        >>> scene = carom.Scene()
        >>> scene.set_contact_default(restitution=0, friction=0.3)
        >>> one, two = ([scene.add_body(carom.Sphere(0.1), mass=1, position=(k, y, 0)) for k in range(3)]
        ...             for y in (0, 5))
        >>> scene.ignore_contact(one)
        >>> scene.ignore_contact(one, two)
        >>> len(scene.pairs_by_default().body)  # of two with each other
        3
        """
        first = self._some("body", body)
        if other is None:
            pairs = list(combinations(first, 2))
        else:
            pairs = [(a, b) for a in first for b in self._some("other", other) if a is not b]
        for a, b in pairs:
            self._pairs.ignore(a, b)

    def contact_law(self, body: One, other: One) -> ContactLaw | None:
        """Return how a pair without a contact of its own touches by `set_contact_default`; None if not.

        Raises
        ------
        ValueError
            If materials are given that no rule combines.
        """
        body, other = self._two(body, other)
        return self._pairs.default_law(body, other)

    def pairs_by_default(self) -> PairTable:
        """Return all pairs that touch by `set_contact_default`, with their laws, as arrays.

        N bodies have N(N - 1)/2 pairs; a run makes rows for those that come near each other (`Solution.pairs`).

        Raises
        ------
        ValueError
            If materials are given that no rule combines.
        """
        fixed = (*self._parts.parts(HalfSpace), *self._parts.parts(StaticBody))
        return self._pairs.by_default(self._parts.parts(Body), fixed)

    def _two(self, body, other) -> tuple[Body, HalfSpace | StaticBody | Body]:
        """Return two that may touch, given themselves or by name, what does not move as the second."""
        kinds, hint = (Body, *FIXED), "; a floor is made by scene.add_half_space(point, normal)"
        first = self._parts.member("body", body, kinds, hint if isinstance(body, Ground) else "")
        second = self._parts.member(
            "other", other, kinds, hint if isinstance(other, Ground) else ""
        )
        if isinstance(first, FIXED):
            first, second = second, first
        if isinstance(first, FIXED):
            raise ValueError(
                f"body and other must not both be what never moves, got {second.name!r} and {first.name!r}"
            )
        return first, second

    def _some(self, argument: str, given) -> list:
        """Return bodies and half-spaces, of one or several given themselves or by name."""
        single = isinstance(given, (str, Body, *FIXED))
        what = "bodies, half-spaces and static bodies"
        several = [given] if single else checks.listed(argument, given, what)
        return [self._parts.member(argument, one, (Body, *FIXED)) for one in several]

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts, in the order added."""
        return self._parts.parts(Contact)

    @property
    def contact_default(self) -> ContactLaw | None:
        """Values of all pairs that may touch without a contact of their own; None where these do not."""
        return self._pairs.default
