"""The contacts of a scene: what touches what, and how."""

from __future__ import annotations

from carom.scene.all_pairs import PairTable
from carom.scene.bodies import Body, HalfSpace
from carom.scene.contacts import Contact, make_contact
from carom.scene.materials import ContactLaw, Rule
from carom.scene.pairs import Pairs
from carom.scene.registry import Registry


class TouchingPairs:
    """The part of `Scene` that concerns contacts."""

    _parts: Registry
    _pairs: Pairs

    def add_contact(
        self,
        body: Body,
        other: HalfSpace | Body,
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
        """Let a body and a half-space, or two bodies, touch.

        A value that is not given is that of the two materials, else that of `set_contact_default`, else the
        default named here.

        Parameters
        ----------
        body
            With a shape, and not inside the other.
        other
            What it may touch: a half-space or another body.
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
        self._parts.member("body", body, (Body,))
        self._parts.member("other", other, (HalfSpace, Body))
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
        self._pairs.add(body, other)
        return contact

    def set_contact_default(
        self,
        *,
        restitution: float = 0.5,
        friction: float = 0.0,
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
            True (default): every body touches every half-space and every other body, but for those that
            a joint joins and those of `ignore_contact`. False: only pairs of `add_contact` touch.

        Notes
        -----
        Contacts that were added before keep their values.
        """
        default = ContactLaw(
            restitution=restitution,
            friction=friction,
            friction_held=friction_held,
            impact_law=impact_law,
            stiffness=stiffness,
            rolling_friction=rolling_friction,
            pivoting_friction=pivoting_friction,
            multiple=multiple,
        )
        self._pairs.set_default(default, combine, all_pairs)

    def ignore_contact(self, body: Body, other: HalfSpace | Body) -> None:
        """Let a pair pass through each other where `set_contact_default` lets all pairs touch."""
        self._parts.member("body", body, (Body,))
        self._parts.member("other", other, (HalfSpace, Body))
        self._pairs.ignore(body, other)

    def contact_law(self, body: Body, other: HalfSpace | Body) -> ContactLaw | None:
        """Return how a pair without a contact of its own touches by `set_contact_default`; None if not.

        Raises
        ------
        ValueError
            If materials are given that no rule combines.
        """
        self._parts.member("body", body, (Body,))
        self._parts.member("other", other, (HalfSpace, Body))
        return self._pairs.default_law(body, other)

    def pairs_by_default(self) -> PairTable:
        """Return all pairs that touch by `set_contact_default`, with their laws, as arrays.

        N bodies have N(N - 1)/2 pairs; a run makes rows for those that come near each other (`Solution.pairs`).

        Raises
        ------
        ValueError
            If materials are given that no rule combines.
        """
        return self._pairs.by_default(self._parts.parts(Body), self._parts.parts(HalfSpace))

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts, in the order added."""
        return self._parts.parts(Contact)

    @property
    def contact_default(self) -> ContactLaw | None:
        """Values of all pairs that may touch without a contact of their own; None where these do not."""
        return self._pairs.default
