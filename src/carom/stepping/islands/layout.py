"""Arrays of the islands of a step: made before the loop, and enlarged when a step needs more room."""

from __future__ import annotations

from functools import cache, partial
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.collision.sweep import SweepWork, new_sweep_work
from carom.model.arrays import BODY, CONTACT, STATE, System
from carom.model.clusters import connected
from carom.model.contact_kinds import is_of_joint
from carom.model.memory import ACTIVE_POINT, TURN_OF_JOINT
from carom.model.records import CLOCK
from carom.model.workspace import BODY_WORK, CONTACT_STATE, ActiveSet
from carom.scene.all_pairs import Defaults
from carom.stepping.islands.joined import (
    Joined,
    clusters_that_meet,
    joined_bodies,
    no_bodies,
)

#: state of a body in a step: asleep, in free flight, or in an island
ASLEEP, FLIES, IN_ISLAND = range(3)

PLAN = [
    ("count", "i8"),  # islands in this step
    ("at", "i8"),  # the island that is being moved
    ("entered", "i8"),  # 1 while its bodies are copied out
    ("planned", "i8"),  # 1 during a step
    ("widen", "f8"),  # factor of the room around bodies
    ("pairs", "i8"),  # pairs of balls that overlap
    ("used", "i8"),  # contacts in all islands
    ("kept", "i8"),  # active points so far of the state after the step
    ("open", "i8"),  # 1 if bodies that are no partners get a contact when they may touch
    ("fixed", "i8"),  # contacts from the start, in their order; others follow by their bodies
    ("noted", "i8"),  # pairs of bodies, at the beginning of `pair`, that need contacts
    ("pieces", "i8"),  # finished pieces of steps (`carom.stepping.islands.pieces`)
    ("piece", "f8"),  # longest length of the next piece, 0 for the whole step
    ("done", "f8"),  # time of the present step in finished pieces
    ("busy", "i8"),  # most trial steps in this piece of an island of several groups
    ("trials", "i8"),  # trial steps of the run before the present island was entered
]

#: a body during the search for islands
MEMBER = [
    ("parent", "i8"),  # in the union-find; the root is the lowest body of its set
    ("awake", "i8"),  # of a root: 1 if a body of the set moves
    ("bodies", "i8"),  # of a root: number of bodies in the set
    ("speed", "f8"),  # of a root: greatest speed in the set,
    ("swing", "f8"),  # and greatest speed of a point of its bodies
    ("island", "i8"),  # of a root: number of the island, -1 for none
    ("kind", "i8"),
    ("place", "i8"),  # slot of the body
]


class SingleIsland(NamedTuple):
    """The start of a step with all bodies in one island: a single body, or only joined bodies.

    Without contacts and dry friction the step is never repeated in another way, and no state is stored.
    """

    begun: np.ndarray  # (1,) 1 during a step
    state: np.recarray  # (N,) STATE
    contact_states: np.recarray  # (M,) CONTACT_STATE
    points: np.recarray  # (P,) ACTIVE_POINT
    count: np.ndarray  # (1,) number of active points
    turns: np.recarray  # TURN_OF_JOINT
    frictions: np.recarray  # ACTIVE_POINT, of dry friction in joints
    clock: np.recarray  # (1,) CLOCK


class Islands(NamedTuple):
    """N bodies in slots, island by island, and M contacts that may act in the step.

    If all bodies move together, the slots are empty.
    """

    apart: int  # 1 if bodies may move in separate islands
    single: SingleIsland
    joined: Joined  # the bodies with joints and loads
    others: Joined  # the same for islands of other bodies: empty

    united: np.ndarray  # the cluster of each component, of two or more
    parted: (
        np.ndarray
    )  # (2,) steps in a row in which a cluster could be divided; 1 if one can in this step
    cluster: np.ndarray  # (N,) the cluster in an island, -1 for none

    plan: np.recarray  # (1,) PLAN
    member: np.recarray  # (N,) MEMBER
    first: np.ndarray  # (3, N + 1) ranges of an island: bodies, contacts, active points
    body_of: np.ndarray  # (N,) body in a slot
    bodies: np.recarray  # (N,) BODY, numbered by their place in the island
    state: np.recarray  # (N,) STATE
    memory: np.recarray  # (N,) BODY_WORK
    which: np.ndarray  # (M,) contact in a slot
    contacts: np.recarray  # (M,) CONTACT, with bodies numbered by their place in the island
    contact_states: np.recarray  # (M,) CONTACT_STATE
    active_of: np.ndarray  # (P,) active points, island by island
    points: np.recarray  # (2, P) ACTIVE_POINT: of the present island; of all after the step
    carried: np.ndarray  # (1,) number of active points of the present island
    clock: np.recarray  # (1,) CLOCK at the start of the step
    centre: np.ndarray  # (N, 3)
    radius: np.ndarray  # (N,)
    pair: np.ndarray  # (2, M, 2): pairs of balls that overlap; workspace to sort them
    pair_first: np.ndarray  # (N + 1,) workspace to sort them
    sweep: SweepWork
    # (2, P) other body and contact, sorted, body by body; contact -1 if the two never touch
    partner: np.ndarray
    partner_first: np.ndarray  # (N + 1,)
    gap: np.ndarray  # (P,) lower bound of the distance of these bodies at the start of the step
    known: np.ndarray  # (P,) 1 if it is known
    plane: np.ndarray  # (Q,) contacts with half-spaces, body by body
    plane_first: np.ndarray  # (N + 1,)


def has_events(system: System, more: bool = False) -> bool:
    """Return whether steps may have events, from contacts or dry friction, which may follow too fast.

    with `more` contacts may be added.
    """
    return more or system.contacts.size > 0 or system.relations.frictions.size > 0


def new_single_island(system: System, active: ActiveSet) -> SingleIsland:
    """Return the workspace for bodies that move together."""
    bodies = system.bodies.size if has_events(system) else 0
    turns, frictions = system.relations.memory.coordinates, system.relations.memory.frictions
    sizes = len(active.contact_states), len(active.points), len(turns), len(frictions)
    return _single(bodies, *sizes)


def _single(bodies: int, contacts: int, points: int, turns: int, frictions: int) -> SingleIsland:
    state, clock = table(STATE, bodies), table(CLOCK, 1)
    contact_states, actives = table(CONTACT_STATE, contacts), table(ACTIVE_POINT, points)
    begun, count = np.zeros((2, 1), dtype=np.int64)
    kept = table(TURN_OF_JOINT, turns), table(ACTIVE_POINT, frictions)
    return SingleIsland(begun, state, contact_states, actives, count, *kept, clock)


_NOWHERE = _single(0, 0, 0, 0, 0)


def no_islands(system: System, active: ActiveSet) -> Islands:
    """Return the workspace for bodies that move together."""
    return together()._replace(single=new_single_island(system, active))


@cache
def together() -> Islands:
    """Return islands of no bodies: nothing is written to them."""
    none = np.zeros(0, dtype=np.int64)
    return _islands(0, (none, none, none), (none, none), 0, 0)


def new_islands(system: System, active: ActiveSet, later: Defaults | None = None) -> Islands:
    """Return the workspace for a scene whose bodies may move in separate islands.

    If `later` is given, its pairs of bodies get contacts when they come near each other (`with_partners`).
    """
    n = system.bodies.size
    if n == 1:
        return no_islands(system, active)
    known = None if system.bodies["ballistic"].all() else connected(system)
    united = np.arange(0) if known is None else known.first
    if not (united.size or system.bodies["ballistic"].any()):
        return no_islands(system, active)
    contacts = system.contacts
    rows = np.arange(contacts.size)
    planes = rows[(contacts.other < 0) & ~is_of_joint(contacts)]
    planes = planes[np.argsort(contacts.body[planes], kind="stable")]
    room = 8 * n + 64 if later is not None else min(rows.size, 8 * n + 64)
    grounded = contacts.body[planes], planes
    islands = _islands(n, _partners(system, later), grounded, room, len(active.points))
    parted = np.zeros(2 if united.size else 0, dtype=np.int64)
    joined = joined_bodies(system, united, known)
    islands = islands._replace(joined=joined, united=united, parted=parted)
    islands.plan["open"], islands.plan["fixed"] = int(later is not None), rows.size
    return islands


def with_partners(islands: Islands, system: System, later: Defaults) -> Islands:
    """Return the workspace for a scene with new contacts between further bodies."""
    low, high, rows = _partners(system, later)
    return islands._replace(
        partner=np.stack([high, rows]),
        partner_first=np.searchsorted(low, np.arange(system.bodies.size + 1)),
        gap=np.zeros(len(rows)),
        known=np.zeros(len(rows), dtype=np.int64),
    )


def with_clusters(islands: Islands, system: System) -> Islands:
    """Return the workspace for the clusters that `united` says."""
    if islands.apart == 0:
        return islands
    return islands._replace(joined=joined_bodies(system, islands.united))


def with_united(islands: Islands, system: System, part: bool = False) -> Islands:
    """Return the workspace for the sets that the plan of a step has found: clusters that may meet are one.

    With `part`, those are divided that need not be one.
    """
    before = np.arange(len(islands.united)) if part else islands.united
    united = clusters_that_meet(islands.joined, before, islands.member["parent"])
    parted = np.zeros_like(islands.parted)
    return with_clusters(islands._replace(united=united, parted=parted), system)


def _partners(system: System, later: Defaults | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs i < j and their contacts, sorted; contact -1 for pairs of `later` that never touch."""
    n, contacts = system.bodies.size, system.contacts
    rows = np.flatnonzero((contacts["other"] >= 0) & ~is_of_joint(contacts))
    body, other = contacts["body"][rows], contacts["other"][rows]
    keys = np.minimum(body, other) * n + np.maximum(body, other)
    if later is not None:
        never = np.setdiff1d(later.left_out, keys)
        keys, rows = np.append(keys, never), np.append(rows, np.full(len(never), -1))
    order = np.argsort(keys, kind="stable")
    low, high = np.divmod(keys[order], n)
    return low, high, rows[order]


def _islands(n: int, partners: tuple, grounded: tuple, room: int, points: int) -> Islands:
    """Return islands of `n` free bodies.

    `partners` are pairs of bodies and their contacts; `grounded`: bodies and their contacts with half-spaces.
    """
    (low, high, pairs), (body, planes) = partners, grounded
    whole, numbers = partial(np.zeros, dtype=np.int64), np.arange(n + 1)
    return Islands(
        apart=int(n > 0), single=_NOWHERE, joined=no_bodies(), others=no_bodies(),
        united=whole(0), parted=whole(0), cluster=whole(n), plan=table(PLAN, 1), member=table(MEMBER, n),
        first=whole((3, n + 1)), body_of=whole(n),
        bodies=table(BODY, n), state=table(STATE, n), memory=table(BODY_WORK, n), which=whole(room),
        contacts=table(CONTACT, room), contact_states=table(CONTACT_STATE, room),
        active_of=whole(points), points=table(ACTIVE_POINT, 2, points), carried=whole(1),
        clock=table(CLOCK, 1), centre=np.zeros((n, 3)), radius=np.zeros(n),
        pair=whole((2, 8 * n + 64, 2)), pair_first=whole(n + 1), sweep=new_sweep_work(n),
        partner=np.stack([high, pairs]), partner_first=np.searchsorted(low, numbers),
        gap=np.zeros(len(pairs)), known=whole(len(pairs)),
        plane=planes, plane_first=np.searchsorted(body, numbers),
    )  # fmt: skip


def roomier(islands: Islands) -> Islands:
    """Return the workspace with room for twice as many pairs and contacts in a step."""
    m, p = 2 * len(islands.which), 2 * islands.pair.shape[1]
    return islands._replace(
        which=np.zeros(m, dtype=np.int64),
        contacts=table(CONTACT, m),
        contact_states=table(CONTACT_STATE, m),
        pair=np.zeros((2, p, 2), dtype=np.int64),
    )
