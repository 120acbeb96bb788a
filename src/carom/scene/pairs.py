"""Which pairs of a scene touch, and by which law: their own contacts, or the default of all pairs."""

from __future__ import annotations

import numpy as np

from carom.scene.bodies import Body, HalfSpace
from carom.scene.contacts import check_overlap
from carom.scene.materials import ContactLaw, checked_rule, law_of


class Pairs:
    """The pairs of one scene."""

    def __init__(self):
        self._own: set = set()
        self._ignored: set = set()
        self._rules: dict[str, str] = {}
        self._values: ContactLaw | None = None
        self.default: ContactLaw | None = None

    def check_new(self, body: Body, other: HalfSpace | Body) -> None:
        """Refuse a body with itself, and a pair that has a contact already."""
        if body is other:
            raise ValueError(f"body and other must be two, got {body!r} for both")
        if _key(body, other) in self._own:
            kind = "half_space" if isinstance(other, HalfSpace) else "body"
            raise ValueError(
                f"body {body.name!r} and {kind} {other.name!r} must be given once, "
                "got a second contact of the two"
            )

    def add(self, body, other) -> None:
        """Keep a pair as one with a contact of its own."""
        self._own.add(_key(body, other))

    def ignore(self, body, other) -> None:
        """Let a pair pass through each other."""
        self._ignored.add(_key(body, other))

    def join(self, parent, child) -> None:
        """Two bodies with a joint do not touch by default."""
        self._ignored.add(_key(parent, child))

    def set_default(self, law: ContactLaw, combine, all_pairs: bool) -> None:
        """Keep the values of pairs that have none of their own."""
        self._rules = checked_rule(combine)
        self._values = law
        self.default = law if all_pairs else None

    def law(self, body, other, given) -> ContactLaw:
        """Return the law of a pair with some values given."""
        return law_of(body, other, given, self._values, self._rules)

    def default_law(self, body: Body, other) -> ContactLaw | None:
        """Return the law by which a pair touches without a contact of its own; None if it does not."""
        no_shape = any(isinstance(part, Body) and part.shape is None for part in (body, other))
        key = _key(body, other)
        if self.default is None or no_shape or body is other or key in self._own | self._ignored:
            return None
        return self.law(body, other, {})

    def check_all(self, bodies, half_spaces) -> None:
        """Refuse pairs that touch by default and start inside each other, or have no law."""
        if self.default is None:
            return
        solid = [body for body in bodies if body.shape is not None]
        for body in solid:
            for plane in half_spaces:
                if self.default_law(body, plane) is not None:
                    check_overlap(f"{body.name!r} and {plane.name!r}", body, plane)
        for i, j in _near(solid):
            if self.default_law(solid[i], solid[j]) is not None:
                names = f"{solid[i].name!r} and {solid[j].name!r}"
                check_overlap(names, solid[i], solid[j])
        self._check_materials([*solid, *half_spaces])

    def _check_materials(self, parts) -> None:
        """Refuse materials that no rule combines, also of pairs that are still apart."""
        kinds: dict = {}
        for part in parts:
            kinds.setdefault((part.material, isinstance(part, HalfSpace)), []).append(part)
        chosen = [part for same in kinds.values() for part in same[:2]]
        for k, first in enumerate(chosen):
            for second in chosen[:k]:
                if isinstance(first, HalfSpace) and isinstance(second, HalfSpace):
                    continue
                body, other = (second, first) if isinstance(first, HalfSpace) else (first, second)
                self.default_law(body, other)


def _key(first, second):
    return frozenset((first, second))


def _near(bodies) -> np.ndarray:
    """Return the pairs (m,2) of bodies whose bounding balls overlap."""
    if len(bodies) < 2:
        return np.zeros((0, 2), dtype=np.int64)
    from scipy.spatial import KDTree

    centres = np.array([body.position for body in bodies])
    sizes = np.array([body.shape.size for body in bodies])
    tree, found = KDTree(centres), []
    for i, (centre, size) in enumerate(zip(centres, sizes)):
        for j in tree.query_ball_point(centre, size + sizes.max()):
            if j > i and np.linalg.norm(centres[j] - centre) <= size + sizes[j]:
                found.append((i, j))
    return np.array(found, dtype=np.int64).reshape(-1, 2)
