"""All pairs of a scene that may touch, but for those left out: as arrays, for they are many."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from carom.scene.bodies import Body, HalfSpace
from carom.scene.materials import ContactLaw


class PairTable(NamedTuple):
    """C pairs that may touch: a body, and a half-space or another body."""

    body: np.ndarray  # (C,) its index
    other: np.ndarray  # (C,) index of the other body, -1 for a half-space
    plane: np.ndarray  # (C,) index of the half-space, -1 for a body
    law: np.ndarray  # (C,) place in `laws`
    laws: list[ContactLaw]


def no_pairs() -> PairTable:
    """Return an empty list of pairs."""
    none = np.zeros(0, dtype=np.int64)
    return PairTable(none, none, none, none, [])


def all_pairs(
    bodies: Sequence[Body],
    half_spaces: Sequence[HalfSpace],
    left_out: Iterable[frozenset],
    law: Callable[[Body, Body | HalfSpace], ContactLaw],
) -> PairTable:
    """Return all pairs of bodies with shapes that are not `left_out`.

    First those of bodies and half-spaces, body by body, then those of two bodies. `law` is asked once for each
    pair of materials, with the first pair that has them.
    """
    grounded, joined = _open(bodies, half_spaces, left_out)
    (b, h), (i, j) = np.nonzero(grounded), np.nonzero(joined)
    body, other = np.concatenate([b, i]), np.concatenate([np.full_like(b, -1), j])
    plane = np.concatenate([h, np.full_like(i, -1)])
    numbers: dict = {}
    kinds = [
        np.array([numbers.setdefault(p.material, len(numbers)) for p in parts], dtype=np.int64)
        for parts in (bodies, half_spaces)
    ]
    materials = kinds[0][body] * len(numbers) + np.concatenate([kinds[1][h], kinds[0][j]])
    _, first, which = np.unique(materials, return_index=True, return_inverse=True)
    order = np.argsort(first)  # a pair that has no law is refused in the order of the pairs
    laws = [
        law(bodies[b], half_spaces[h] if j < 0 else bodies[j])
        for b, j, h in np.stack([body, other, plane], axis=1)[first[order]].tolist()
    ]
    return PairTable(body, other, plane, np.argsort(order)[which], laws)


def _open(bodies, half_spaces, left_out) -> tuple[np.ndarray, np.ndarray]:
    """Return which bodies may touch which half-spaces (N, H), and which others (N, N), i < j."""
    solid = np.array([body.shape is not None for body in bodies], dtype=bool)
    grounded = np.repeat(solid[:, None], len(half_spaces), axis=1)
    joined = np.triu(solid[:, None] & solid, 1)
    for pair in left_out:
        ends = sorted(part.index for part in pair if isinstance(part, Body))
        planes = [part.index for part in pair if isinstance(part, HalfSpace)]
        if planes:
            grounded[ends, planes] = False
        elif len(ends) == 2:  # else one of them is the ground
            joined[ends[0], ends[1]] = False
    return grounded, joined


def near(pairs: PairTable, bodies: Sequence[Body], half_spaces: Sequence[HalfSpace]) -> np.ndarray:
    """Return the pairs, by number, where the balls around the bodies reach the other."""
    places = np.array([body.position for body in bodies]).reshape(-1, 3)
    sizes = np.array([0.0 if body.shape is None else body.shape.size for body in bodies])
    between = pairs.other >= 0
    body, other = pairs.body[between], pairs.other[between]
    reach = np.zeros(len(pairs.body), dtype=bool)
    distance = np.linalg.norm(places[other] - places[body], axis=1)
    reach[between] = distance <= sizes[body] + sizes[other]
    for h, plane in enumerate(half_spaces):
        rows = np.flatnonzero(pairs.plane == h)
        body = pairs.body[rows]
        reach[rows] = (places[body] - plane.point) @ plane.normal <= sizes[body]
    return np.flatnonzero(reach)
