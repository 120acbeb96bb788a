"""The geoms of a model that touch each other, and their friction, by MuJoCo's rules."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.io.models.report import need_mujoco
from carom.scene.materials import Material


class Friction(NamedTuple):
    """Coefficients of a pair: sliding, and moments by the normal force about it and across it [m]."""

    sliding: float
    pivoting: float
    rolling: float


class Touch(NamedTuple):
    """The contact of two groups of geoms."""

    friction: Friction | None  # the greatest of all pairs; None: nothing touches
    some: bool  # pairs that do not touch are among them
    differ: bool  # friction is not the same for all pairs
    by_material: bool  # that of each pair is the greater one of the two materials


NOTHING = Touch(None, False, False, False)


class Filter:
    """The rules by which geoms of a model touch."""

    def __init__(self, model):
        self.model = model
        self.restitution: float | None = (
            None  # of materials, if geoms of one body have different ones
        )
        flags = int(model.opt.disableflags)
        self.parents = not flags & int(need_mujoco().mjtDisableBit.mjDSBL_FILTERPARENT)
        self.excluded = {
            frozenset((int(s) >> 16, int(s) & 0xFFFF)) for s in model.exclude_signature
        }
        self.pairs = {
            frozenset((int(a), int(b))): p
            for p, (a, b) in enumerate(zip(model.pair_geom1, model.pair_geom2))
        }
        self._paired = {g for pair in self.pairs for g in pair}
        self._left_out = {b for pair in self.excluded for b in pair}
        self._known: dict = {}

    def touches_at_all(self, geom: int) -> bool:
        """Return whether a geom can touch anything."""
        m = self.model
        return bool(m.geom_contype[geom] or m.geom_conaffinity[geom]) or geom in self._paired

    def between(self, some: list[int], others: list[int]) -> Touch:
        """Return the contact of two groups of geoms on two bodies; equal groups are computed only once."""
        bodies = self.model.geom_bodyid
        special = self._paired.intersection(some) and self._paired.intersection(others)
        if special or self._left_out.intersection(int(bodies[g]) for g in some):
            return self._compare(some, others)
        if self.joined(int(bodies[some[0]]), int(bodies[others[0]])):
            return NOTHING
        key = frozenset(map(self._kind, some)), frozenset(map(self._kind, others))
        if key not in self._known:
            self._known[key] = self._compare(some, others)
        return self._known[key]

    def _kind(self, g: int) -> tuple:
        m = self.model
        friction = tuple(m.geom_friction[g].tolist())
        numbers = (m.geom_contype[g], m.geom_conaffinity[g], m.geom_condim[g], m.geom_priority[g])
        return (*map(int, numbers), friction)

    def _compare(self, some, others) -> Touch:
        found = {(a, b): self.friction(a, b) for a in some for b in others}
        touching = {pair: one for pair, one in found.items() if one is not None}
        if not touching:
            return NOTHING
        greatest = Friction(*np.max(list(touching.values()), axis=0).tolist())
        ruled = all(
            one == tuple(map(max, self.of_geom(a), self.of_geom(b)))
            for (a, b), one in touching.items()
        )
        differ = len(set(touching.values())) > 1
        return Touch(greatest, len(touching) < len(found), differ, ruled)

    def of_geom(self, geom: int) -> Friction:
        """Return the friction of a geom with its equal."""
        size, three = int(self.model.geom_condim[geom]), self.model.geom_friction[geom]
        return _friction(size, three[[0, 0, 1, 2, 2]])

    def tell_apart(self, groups: list[list[int]], restitution: float) -> None:
        """Give materials to geoms if those of one body, of some, differ in friction."""
        if any(len({self.of_geom(g) for g in geoms}) > 1 for geoms in groups):
            self.restitution = restitution

    def material(self, geom: int) -> Material | None:
        """Return the material of a geom; None if geoms have none."""
        if self.restitution is None:
            return None
        f = self.of_geom(geom)
        return Material(
            self.restitution, f.sliding, rolling_friction=f.rolling, pivoting_friction=f.pivoting
        )

    def friction(self, a: int, b: int) -> Friction | None:
        """Return the friction of two geoms; None if they do not touch."""
        m = self.model
        if frozenset((a, b)) in self.pairs:
            p = self.pairs[frozenset((a, b))]
            return _friction(int(m.pair_dim[p]), m.pair_friction[p])
        mask = (m.geom_contype[a] & m.geom_conaffinity[b]) | (
            m.geom_contype[b] & m.geom_conaffinity[a]
        )
        bodies = int(m.geom_bodyid[a]), int(m.geom_bodyid[b])
        if not mask or frozenset(bodies) in self.excluded or self.joined(*bodies):
            return None
        first, second = int(m.geom_priority[a]), int(m.geom_priority[b])
        if first != second:
            g = a if first > second else b
            three, size = m.geom_friction[g], int(m.geom_condim[g])
        else:
            three = np.maximum(m.geom_friction[a], m.geom_friction[b])
            size = max(int(m.geom_condim[a]), int(m.geom_condim[b]))
        return _friction(size, three[[0, 0, 1, 2, 2]])

    def joined(self, first: int, second: int) -> bool:
        """Return whether two bodies are one, or a moving one and the moving one that carries it."""
        weld, parent = self.model.body_weldid, self.model.body_parentid
        a, b = int(weld[first]), int(weld[second])
        if a == b:
            return True
        if not self.parents or a == 0 or b == 0:
            return False
        return a == int(weld[parent[b]]) or b == int(weld[parent[a]])


def _friction(size: int, five) -> Friction:
    """Return the coefficients that a contact of 1, 3, 4 or 6 dimensions uses."""
    return Friction(
        float(five[0]) if size >= 3 else 0.0,
        float(five[2]) if size >= 4 else 0.0,
        float(five[3]) if size >= 6 else 0.0,
    )
