"""All pairs of a scene that may touch, except the ignored ones, as arrays because they are many.

N bodies have N(N - 1)/2 pairs. `Defaults` says in memory of order N which of them may touch and by which law;
a list of all pairs, or of some, is made from it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.materials import ContactLaw
from carom.scene.surfaces import SurfaceDefinition
from carom.scene.table import Table

MOST_AT_ONCE = 1 << 20  # balls whose distances are looked at in one go


@dataclass(frozen=True, eq=False, repr=False)
class PairTable(Table[dict]):
    """Table of C pairs that may touch: each a body, and a half-space, static body or another body.

    ``len`` is the number of pairs, and ``table[k]`` is pair k as a dict of all columns.
    """

    body: np.ndarray  #: (C,) index of the body
    other: np.ndarray  #: (C,) index of the other body, -1 for a half-space or static body
    #: (C,) index in `Scene.fixed` of the half-space or static body, -1 for a body
    plane: np.ndarray
    law: np.ndarray  #: (C,) index in `laws`
    laws: list[ContactLaw]  #: the different laws


class Defaults(NamedTuple):
    """The pairs that touch by default, in memory of order N: a list only for half-spaces."""

    grounded: PairTable  # bodies and half-spaces, body by body
    solid: np.ndarray  # (N,) whether a body has a shape
    left_out: np.ndarray  # (E,) pairs of bodies i < j that do not touch so, as i N + j, rising
    kind: np.ndarray  # (N,) number of the material
    law: np.ndarray  # (K, K) place in `grounded.laws`, by the materials of two bodies


def no_pairs() -> PairTable:
    """Return an empty list of pairs."""
    none = np.zeros(0, dtype=np.int64)
    return PairTable(none, none, none, none, [])


def joined_tables(first: PairTable, second: PairTable) -> PairTable:
    """Return the pairs of two tables with the same laws."""
    joined = {
        name: np.concatenate([getattr(first, name), getattr(second, name)])
        for name in ("body", "other", "plane", "law")
    }
    return PairTable(**joined, laws=first.laws)


def defaults(
    bodies: Sequence[Body],
    fixed: Sequence[HalfSpace | StaticBody],
    left_out: Iterable[frozenset],
    law: Callable[[Body, Body | HalfSpace | StaticBody], ContactLaw],
) -> Defaults:
    """Return the pairs of bodies with shapes that may touch and are not `left_out`, by names, as `Defaults`.

    `law` is asked once for each pair of materials, with the first pair that has them: first those of bodies and
    half-spaces, body by body, then those of two bodies.
    """
    solid = np.array([body.shape is not None for body in bodies], dtype=bool)
    meets, out = _open(solid, bodies, fixed, left_out)
    numbers: dict = {}
    kinds = [
        np.array([numbers.setdefault(p.material, len(numbers)) for p in parts], dtype=np.int64)
        for parts in (bodies, fixed)
    ]
    b, h = np.nonzero(meets)
    materials = kinds[0][b] * len(numbers) + kinds[1][h]
    _, first = np.unique(materials, return_index=True)
    place = np.full((len(numbers), len(numbers)), -1, dtype=np.int64)
    laws = []
    for k in np.sort(first).tolist():  # a pair that has no law is refused in the order of the pairs
        place[kinds[0][b[k]], kinds[1][h[k]]] = len(laws)
        laws.append(law(bodies[int(b[k])], fixed[int(h[k])]))
    for i, j in _first_of_kinds(kinds[0], solid, set(out.tolist())):
        if place[kinds[0][i], kinds[0][j]] < 0:
            place[kinds[0][i], kinds[0][j]] = len(laws)
            laws.append(law(bodies[i], bodies[j]))
    none = np.full(len(b), -1)
    grounded = PairTable(b, none, h, place[kinds[0][b], kinds[1][h]], laws)
    return Defaults(grounded, solid, out, kinds[0], place)


def _open(solid: np.ndarray, bodies, fixed, left_out) -> tuple[np.ndarray, np.ndarray]:
    """Return which bodies may touch which half-spaces (N, H), and the pairs of two bodies that may not (E,)."""
    meets = np.repeat(solid[:, None], len(fixed), axis=1)
    places = {part.name: h for h, part in enumerate(fixed)}
    numbers = {body.name: b for b, body in enumerate(bodies)}
    out = set()
    for pair in left_out:
        ends = sorted(numbers[name] for name in pair if name in numbers)
        planes = [places[name] for name in pair if name in places]
        if planes:
            meets[ends, planes] = False
        else:
            out.add(ends[0] * len(solid) + ends[1])
    return meets, np.array(sorted(out), dtype=np.int64)


def _first_of_kinds(kind: np.ndarray, solid: np.ndarray, left_out: set) -> list[tuple[int, int]]:
    """Return the first pair i < j that may touch of each two materials, in the order of the pairs."""
    members: dict[int, list[int]] = {}
    for b in np.flatnonzero(solid).tolist():
        members.setdefault(int(kind[b]), []).append(b)
    found = (
        _first(mine, others, left_out, len(kind))
        for mine in members.values()
        for others in members.values()
    )
    return sorted(pair for pair in found if pair is not None)


def _first(mine: list, others: list, left_out: set, count: int) -> tuple[int, int] | None:
    """Return the first pair i < j, i of some bodies and j of others, that is not left out."""
    for i in mine:
        for k in range(bisect_right(others, i), len(others)):
            if i * count + others[k] not in left_out:
                return i, others[k]
    return None


def every_pair(of: Defaults) -> PairTable:
    """Return all pairs: first those of bodies and half-spaces, body by body, then those of two bodies."""
    solid = np.flatnonzero(of.solid)
    i, j = np.triu_indices(len(solid), 1)
    i, j = solid[i], solid[j]
    may = ~np.isin(i * len(of.solid) + j, of.left_out)
    return joined_tables(of.grounded, some_pairs(of, i[may], j[may]))


def some_pairs(of: Defaults, body: np.ndarray, other: np.ndarray) -> PairTable:
    """Return these pairs of two bodies, which may touch."""
    law = of.law[of.kind[body], of.kind[other]]
    return PairTable(body, other, np.full(len(body), -1), law, of.grounded.laws)


def may_touch(of: Defaults, body: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return which of these pairs of two bodies, body < other, may touch."""
    out = np.isin(body * len(of.solid) + other, of.left_out)
    return of.solid[body] & of.solid[other] & ~out


def meeting(of: Defaults) -> np.ndarray:
    """Return which bodies (N,) may touch another one."""
    out = np.divmod(of.left_out, max(1, len(of.solid)))
    kept = of.solid[out[0]] & of.solid[out[1]]
    partners = np.full(len(of.solid), np.count_nonzero(of.solid) - 1)
    for side in out:
        np.subtract.at(partners, side[kept], 1)
    return of.solid & (partners > 0)


def that_touch(of: Defaults) -> list[int]:
    """Return the bodies, by number, that may touch another one, a half-space or a static body."""
    touches = meeting(of)
    touches[of.grounded.body] = True
    return np.flatnonzero(touches).tolist()


def near_fixed(
    pairs: PairTable, bodies: Sequence[Body], fixed: Sequence[HalfSpace | StaticBody]
) -> np.ndarray:
    """Return the pairs of bodies and half-spaces, by number, where the ball around the body reaches it."""
    places, sizes = balls(bodies)
    reach = np.zeros(len(pairs.body), dtype=bool)
    for h, plane in enumerate(fixed):
        rows = np.flatnonzero(pairs.plane == h)
        body = pairs.body[rows]
        if isinstance(plane, StaticBody) and isinstance(plane.shape, SurfaceDefinition):
            reach[rows] = True  # it has no end
            continue
        if isinstance(plane, StaticBody):
            distance = np.linalg.norm(places[body] - plane.position, axis=1)
            reach[rows] = distance <= sizes[body] + plane.shape.size
            continue
        reach[rows] = (places[body] - plane.point) @ plane.normal <= sizes[body]
    return np.flatnonzero(reach)


def near_each_other(of: Defaults, bodies: Sequence[Body]) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs i < j of bodies that may touch whose balls overlap, in their order.

    Balls are sorted by their lower ends along the axis with the largest spread; a ball is compared with those
    that begin before it ends.
    """
    solid = np.flatnonzero(of.solid)
    if len(solid) < 2:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    places, sizes = (a[solid] for a in balls(bodies))
    along = places[:, np.argmax(np.ptp(places, axis=0))]
    order = np.argsort(along - sizes, kind="stable")
    low, high = (along - sizes)[order], (along + sizes)[order]
    count = np.searchsorted(low, high, side="right") - np.arange(len(low)) - 1
    count = np.maximum(count, 0)
    total, keys = np.cumsum(count), []
    first = 0
    while first < len(low):
        before = total[first] - count[first]
        last = max(first + 1, int(np.searchsorted(total, before + MOST_AT_ONCE)))
        own = count[first:last]
        a = np.repeat(np.arange(first, first + len(own)), own)
        b = a + 1 + np.arange(len(a)) - np.repeat(np.cumsum(own) - own, own)
        a, b = order[a], order[b]
        meet = np.linalg.norm(places[a] - places[b], axis=1) <= sizes[a] + sizes[b]
        a, b = solid[a[meet]], solid[b[meet]]
        keys.append(np.minimum(a, b) * len(of.solid) + np.maximum(a, b))
        first = last
    body, other = np.divmod(np.sort(np.concatenate(keys)), len(of.solid))
    may = may_touch(of, body, other)
    return body[may], other[may]


def balls(bodies: Sequence[Body]) -> tuple[np.ndarray, np.ndarray]:
    """Return the centres (N, 3) and radii (N,) of the bounding balls of bodies; radius 0 without a shape."""
    places = np.array([body.position for body in bodies]).reshape(-1, 3)
    sizes = np.array([0.0 if body.shape is None else body.shape.size for body in bodies])
    return places, sizes
