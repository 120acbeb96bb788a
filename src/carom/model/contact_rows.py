"""The contacts of a scene, added ones and default ones, and their rows: one for each two cores."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.cores import CORE, Cores
from carom.scene.all_pairs import Defaults, PairTable, every_pair, joined_tables, no_pairs
from carom.scene.bodies import Body
from carom.scene.scene import Scene

#: number of pairs of bodies up to which all have rows from the start, in the order of the scene
FEW_PAIRS = 64 * 63 // 2


class Rows(NamedTuple):
    """R rows: the two cores that touch."""

    number: np.ndarray  # (R,) of the contact
    core: np.recarray  # (R,) CORE of the body
    other: np.recarray  # (R,) CORE of the other body, zero for a half-space


def touching_pairs(scene: Scene) -> PairTable:
    """Return the pairs of all contacts of a scene: those added, then those of `set_contact_default`."""
    return first_pairs(scene, False)[0]


def first_pairs(scene: Scene, apart: bool) -> tuple[PairTable, Defaults | None]:
    """Return the pairs that have rows from the start of a run, and those that may be added later, if any.

    If many bodies move `apart`, in islands, two bodies that touch by default get rows only when they come near
    each other.
    """
    default = scene._pairs.defaults(scene.bodies, scene.fixed)
    if default is None:
        return _added(scene, no_pairs()), None
    solid = int(np.count_nonzero(default.solid))
    if apart and solid * (solid - 1) > 2 * FEW_PAIRS:
        added = _added(scene, default.grounded)
        laws = replace(
            default.grounded, law=default.grounded.law + len(scene.contacts), laws=added.laws
        )
        return added, default._replace(grounded=laws, law=default.law + len(scene.contacts))
    return _added(scene, every_pair(default)), None


def _added(scene: Scene, rest: PairTable) -> PairTable:
    """Return the pairs of the contacts that were added to the scene, then the rest."""
    added = scene.contacts
    places = {part: h for h, part in enumerate(scene.fixed)}
    ends = [
        (c.body.index, c.other.index, -1)
        if isinstance(c.other, Body)
        else (c.body.index, -1, places[c.other])
        for c in added
    ]
    body, other, plane = np.array(ends, dtype=np.int64).reshape(-1, 3).T
    first = PairTable(body, other, plane, np.arange(len(added)), [*added, *rest.laws])
    if not len(rest.body):
        return first
    return joined_tables(first, replace(rest, law=rest.law + len(added)))


def contact_rows(pairs: PairTable, grounded: Cores, single: Cores) -> Rows:
    """Return the rows of contacts: one for each core on a half-space, and for each two pieces of bodies.

    `grounded` are the cores of bodies against half-spaces, `single` those of their pieces one by one.
    """
    between = pairs.other >= 0
    count = _lengths(grounded.first)[pairs.body]
    if between.any():
        pieces = _lengths(single.first)
        count = np.where(between, pieces[pairs.body] * pieces[pairs.other], count)
    number = np.arange(len(count)).repeat(count)
    k = np.arange(len(number)) - (count.cumsum() - count).repeat(count)
    core, other = table(CORE, len(number)), table(CORE, len(number))
    flat = ~between[number]
    core[flat] = grounded.group[grounded.first[pairs.body[number[flat]]] + k[flat]]
    if between.any():
        pair, k = number[~flat], k[~flat]
        others = pieces[pairs.other[pair]]
        core[~flat] = single.group[single.first[pairs.body[pair]] + k // others]
        other[~flat] = single.group[single.first[pairs.other[pair]] + k % others]
    return Rows(number, core, other)


def _lengths(first: np.ndarray) -> np.ndarray:
    """Return the lengths of ranges."""
    return first[1:] - first[:-1]
