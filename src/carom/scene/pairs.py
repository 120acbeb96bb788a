"""The pairs of a scene that may touch, and their laws: contacts of their own, or the default of all pairs."""

from __future__ import annotations

from functools import partial
from typing import Any

from carom import checks
from carom.scene.all_pairs import (
    Defaults,
    PairTable,
    defaults,
    every_pair,
    near_each_other,
    near_fixed,
    no_pairs,
    that_touch,
)
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.contacts import Contact, check_overlap
from carom.scene.joints import Joint
from carom.scene.materials import ContactLaw, checked_rule, law_of, law_of_parts
from carom.scene.profile_pairs import check_profiles
from carom.scene.registry import Registry
from carom.scene.shapes import Compound, Profile


class Pairs:
    """The pairs of one scene, each as the names of its parts, which stay when a part is replaced."""

    def __init__(self, parts: Registry):
        self._parts = parts  # of the scene
        self._own: set = set()
        self._ignored: set = set()
        self._rules: dict[str, str] = {}
        self._values: ContactLaw | None = None
        self.default: ContactLaw | None = None
        self.unsaid_default = True  # whether neither restitution nor friction of it was stated
        self._unsaid: set = set()  # pairs with a contact of which neither was

    def copied(self, parts: Registry) -> Pairs:
        """Return a copy with the same pairs."""
        made = Pairs(parts)
        vars(made).update(vars(self), _parts=parts)
        for name in ("_own", "_ignored", "_unsaid"):
            setattr(made, name, set(getattr(self, name)))
        return made

    def check_new(self, body: Body, other: HalfSpace | StaticBody | Body, old: Any) -> None:
        """Refuse a pair of a body with itself, and one that has a contact besides the `old` one it replaces."""
        if body is other:
            raise ValueError(f"body and other must be two, got {body!r} for both")
        own = isinstance(old, Contact) and _key(old.body, old.other) == _key(body, other)
        if _key(body, other) in self._own and not own:
            kind = {HalfSpace: "half_space", StaticBody: "static body"}.get(type(other), "body")
            raise ValueError(
                f"body {body.name!r} and {kind} {other.name!r} must be given once, "
                "got a second contact of the two; replace=True with its name replaces the first"
            )

    def add(self, body, other, given) -> None:
        """Store a pair that has a contact of its own, and the values that were given for it."""
        self._own.add(_key(body, other))
        stated = given["restitution"] is not None or given["friction"] is not None
        if not stated and self.unsaid_default and body.material is None:
            self._unsaid.add(_key(body, other))

    def state(self, contact: Contact) -> None:
        """Note that restitution or friction of a contact is stated."""
        self._unsaid.discard(_key(contact.body, contact.other))

    def is_unsaid(self, body, other) -> bool:
        """Return whether restitution and friction of a contact are both unstated, there and as a default."""
        return _key(body, other) in self._unsaid

    def forget(self, part) -> None:
        """Forget the pairs of a part that is taken away; of a contact, its pair."""
        pair = _key(part.body, part.other) if isinstance(part, Contact) else None
        for pairs in (self._own, self._unsaid, self._ignored):
            pairs -= {one for one in pairs if part.name in one and pair is None}
        self._own.discard(pair)
        self._unsaid.discard(pair)

    def left_out(self) -> set[frozenset]:
        """Return the pairs that the default leaves out: contacts, ignored pairs, and bodies of a joint."""
        return self._parts.derived.once(
            "left_out", lambda: self._own | self._ignored | self.joined()
        )

    def joined(self) -> set[frozenset]:
        """Return the pairs of bodies with a joint."""
        joints = self._parts.parts(Joint)
        return {_key(j.parent, j.child) for j in joints if isinstance(j.parent, Body)}

    def ignore(self, body, other) -> None:
        """Let a pair pass through each other."""
        self._parts.changes()
        self._ignored.add(_key(body, other))

    def set_default(self, law: ContactLaw, combine, all_pairs: bool, stated: bool) -> None:
        """Store the default values of pairs; `stated`: restitution or friction was given."""
        all_pairs = checks.flag("all_pairs", all_pairs)
        self._parts.changes()
        self._rules = checked_rule(combine)
        self._values = law
        self.default = law if all_pairs else None
        self.unsaid_default = not stated

    def law(self, body, other, given) -> ContactLaw:
        """Return the law of a pair for which some values are given."""
        return law_of(body, other, given, self._values, self._rules)

    def law_of_parts(self, law: ContactLaw, one, two) -> ContactLaw:
        """Return the law of two parts with materials, from that of their bodies."""
        return law_of_parts(law, one, two, self._rules)

    def default_law(self, body: Body, other) -> ContactLaw | None:
        """Return the default law of a pair; None if the pair does not touch by default."""
        no_shape = any(isinstance(part, Body) and part.shape is None for part in (body, other))
        key = _key(body, other)
        if self.default is None or no_shape or body is other or key in self.left_out():
            return None
        return self.law(body, other, {})

    def defaults(self, bodies, fixed) -> Defaults | None:
        """Return the default pairs as `Defaults`, without a list of them; None if there are none."""
        if self.default is None:
            return None
        law = partial(self.law, given={})
        return self._parts.derived.once(
            "defaults", lambda: defaults(bodies, fixed, self.left_out(), law)
        )

    def by_default(self, bodies, fixed) -> PairTable:
        """Return all pairs without a contact of their own that may touch, with their laws."""
        found = self.defaults(bodies, fixed)
        return no_pairs() if found is None else every_pair(found)

    def check_all(self, bodies, fixed) -> None:
        """Refuse default pairs that overlap at the start or have no law."""
        found = self.defaults(bodies, fixed)
        if found is None:
            return
        for b in that_touch(found):
            _ = bodies[b].shape.pieces  # refused by a shape that has nothing to touch with
        if any(_has_profile(part) for part in (*bodies, *fixed)):
            _check_profiles(every_pair(found), bodies, fixed)
        pairs = found.grounded
        for k in near_fixed(pairs, bodies, fixed):
            body, plane = bodies[pairs.body[k]], fixed[pairs.plane[k]]
            check_overlap(f"{body.name!r} and {plane.name!r}", body, plane)
        for i, j in zip(*near_each_other(found, bodies)):
            check_overlap(f"{bodies[i].name!r} and {bodies[j].name!r}", bodies[i], bodies[j])


def _has_profile(part) -> bool:
    shape = None if isinstance(part, HalfSpace) else part.shape
    if isinstance(shape, Compound):
        return any(piece.kind == "profile" for piece in shape.pieces)
    return isinstance(shape, Profile)


def _check_profiles(pairs: PairTable, bodies, fixed) -> None:
    """Refuse default pairs with a profile that cannot be treated."""
    for body, other, plane in zip(pairs.body, pairs.other, pairs.plane):
        one, two = bodies[body], fixed[plane] if plane >= 0 else bodies[other]
        check_profiles(f"{one.name!r} and {two.name!r}", one, two)


def _key(first, second):
    return frozenset((first.name, second.name))
