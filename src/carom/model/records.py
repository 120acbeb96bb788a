"""Records and clock of a run: arrays that are made before the loop."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.collision.layout import new_pair_work, new_points
from carom.model import workspace
from carom.model.arrays import STATE, System
from carom.model.contact_kinds import is_found
from carom.model.memory import ACTIVE_POINT
from carom.model.tableaus import KENNEDY_CARPENTER

#: kinds of events, by code
EVENTS = ("impact", "held", "slips", "sticks", "opens", "jams")
IMPACT, PERSISTS, SLIPS, STICKS, OPENS, JAMS = range(6)

#: present energies, and energies summed since the start
ENERGIES = [("kinetic", "f8"), ("potential", "f8")]
LEDGER = [("loads", "f8"), ("impacts", "f8"), ("friction", "f8"), ("bounces", "f8")]

#: progress of a run: what is kept of it between two steps, and written to a checkpoint
CLOCK = [
    ("now", "f8"),
    *ENERGIES,
    *LEDGER,
    ("step", "i8"),  # finished steps
    ("saved", "i8"),
    ("struck", "i8"),
    ("event", "i8"),
    ("snapped", "i8"),  # rows of snapshots
    ("touched", "i8"),  # rows of touches
    ("in_moment", "i8"),  # impacts and events since `moment`, a time less than `Controls.step` ago
    ("moment", "f8"),
    ("at_once", "i8"),  # impacts and events at the present time
    ("cuts", "i8"),
    ("trials", "i8"),
    ("rejected", "i8"),  # trial steps with too large an error
    ("parts", "i8"),  # additional parts of steps in which bodies turned far
    ("fallen", "i8"),  # steps of a symplectic method that the explicit method took instead
    ("slow", "i8"),  # trial steps so short that the run would not end (`carom.dynamics.adapt`)
    ("located", "i8"),
    ("holds", "i8"),
    ("contact_steps", "i8"),  # steps, and trial steps, of groups in contact at several points
    ("rounds", "i8"),  # iterations in these steps
    ("whole", "i8"),  # steps in which touching bodies moved as a crowd
    ("residual", "f8"),  # greatest of persistent contacts since the last saved row
    # greatest energy exchanged so far, besides changes of potential energy, which the step adds at its end
    ("exchanged", "f8"),
    ("still", "f8"),  # end of the step after which nothing has moved; infinite while bodies move
]

SERIES = [("t", "f8"), *ENERGIES, *LEDGER, ("residual", "f8")]
#: a coordinate at a saved time: an angle with whole turns, or an arc length with laps
TURN = [("angle", "f8")]
#: an active point at a saved time; moments about the mass centres (world axes)
TOUCH = [
    ("saved", "i8"),
    ("contact", "i8"),
    ("feature", "i8"),
    ("body", "i8"),
    ("other", "i8"),
    ("mode", "i8"),
    ("point", "f8", 3),  # world
    ("force", "f8", 3),  # contact axes
    ("push", "f8", 3),  # the same in world axes
    ("moment", "f8", 3),
    ("other_moment", "f8", 3),  # about the mass centre of the other body
    ("power", "f8"),  # of the drive of a surface that moves in itself
]

IMPACTS = [
    ("time", "f8"),
    ("contact", "i8"),
    ("point", "f8", 3),
    ("normal", "f8", 3),
    ("W", "f8", (3, 3)),
    ("before", "f8", 3),
    ("after", "f8", 3),
    ("impulse", "f8", 3),
    ("energy_change", "f8"),
    ("duration", "f8"),
    ("together", "i8"),  # closed points that were resolved together
    ("compression_work", "f8"),
    ("restitution_work", "f8"),
    ("friction_loss", "f8"),
    ("phases", "i8"),
]

EVENT = [
    ("time", "f8"),
    ("kind", "i8"),
    ("contact", "i8"),
    ("feature", "i8"),
    ("saved", "i8"),  # rows that were saved before
    ("first", "i8"),  # first of its snapshots, which end at that of the next event
    ("mode", "i8"),  # of a point that is active from now on
]

#: a body that takes part in an event, with the velocities before and after
SNAPSHOT = [
    ("event", "i8"),
    ("body", "i8"),
    ("x", "f8", 3),
    ("Q", "f8", 4),
    ("v0", "f8", 3),
    ("w0", "f8", 3),
    ("v1", "f8", 3),
    ("w1", "f8", 3),
]

MARGIN = 260  # impacts, or events, that one pass of the loop may write
# codes that are not in `Status`. The loop returns these, and continues when it is called again:
GROW = 100  # arrays are full (`step.grow` tells which): the caller makes longer ones
PAUSE = 101  # much work was done: the caller checks for Ctrl-C
# a code within the loop:
LEFT_BALL = 102  # a body has left the ball that its island gave it

# values of `step.grow`: records of impacts and events, pairs of islands, points of a crowd, points of an
# impact; contacts, because bodies have come near each other; tables of mechanisms that may meet, or have parted
FULL_EVENTS, FULL_PAIRS, FULL_SPOTS, FULL_MULTIPLE, NEW_PAIRS, CLUSTERS_MEET, CLUSTERS_PART = range(
    7
)

# value of `step.since` at which the loop pauses, so that an interrupt is seen: no result depends on it
LONG = 5e4


class Records(NamedTuple):
    """T saved steps, K impacts, E events, S snapshots, H touches; C coordinates whose turns are counted."""

    series: np.recarray  # (T,) SERIES
    state: np.recarray  # (T, N) STATE
    turn: np.recarray  # (T, C) TURN; files of earlier versions have none: C = 0
    touch: np.recarray  # (H,) TOUCH
    impact: np.recarray  # (K,) IMPACTS
    event: np.recarray  # (E,) EVENT
    snapshot: np.recarray  # (S,) SNAPSHOT


def new_clock() -> np.recarray:
    """Return the clock of a run that has not begun, (1,)."""
    clock = table(CLOCK, 1)
    clock["still"] = np.inf
    return clock


def new_active_set(system: System) -> workspace.ActiveSet:
    """Return an empty active set: all contacts are to be checked first."""
    contacts = system.contacts
    grounded = int(np.count_nonzero(is_found(contacts) & (contacts["other"] < 0)))
    between = max(len(system.bodies), len(system.solids))  # bodies, or pieces of them
    points = len(system.vertices) + 24 * between + 8 * grounded + len(contacts)
    active = workspace.ActiveSet(
        points=table(ACTIVE_POINT, points),
        contact_states=table(workspace.CONTACT_STATE, len(contacts)),
        carries=np.zeros(len(system.vertices), dtype=np.int64),
        count=np.zeros(1, dtype=np.int64),
    )
    active.contact_states["near"] = 1
    return active


def with_contacts(active: workspace.ActiveSet, count: int) -> workspace.ActiveSet:
    """Return the active set with the states of `count` contacts: new ones are to be checked first."""
    states = table(workspace.CONTACT_STATE, count)
    known = len(active.contact_states)
    states[:known], states["near"][known:] = active.contact_states, 1
    return active._replace(contact_states=states)


def new_work(system: System, stages: int) -> workspace.Work:
    """Return the workspace of one run."""
    n, w = system.bodies.size, workspace
    stage, trial, part, middle, iterate, mean, beside, origin = table(STATE, 8, n)
    struck, placed = table(w.POINT, 2, 1)
    body = table(w.BODY_WORK, n)
    body["room"] = body["reach"] = np.inf
    return w.Work(
        body=body, joint=table(w.JOINT_WORK, max(1, system.joints.size)),  # stops use the first
        stages=table(w.STAGE, max(stages, len(KENNEDY_CARPENTER.b)) + 1, n), known=table(w.KNOWN, n),
        stage=stage, trial=trial, part=part, middle=middle, iterate=iterate, mean=mean, beside=beside,
        origin=origin, struck=struck, placed=placed, pair=new_pair_work(), touches=new_points(),
        solid_pose=np.zeros((2, 7)), hit=table(w.HIT, 1), moment=table(w.MOMENT, 1),
        step=table(w.STEP, 1), search=table(w.SEARCH, 1), history=np.zeros((0, 16)),
    )  # fmt: skip


def new_records(system: System, saves: int, events: int, points: int = 0) -> Records:
    """Return empty records for `saves` saved steps, `events` impacts and events, and more active `points`.

    Raises
    ------
    MemoryError
        If there is too little memory for the saved states.
    """
    n, counted = system.bodies.size, system.relations.counted
    try:
        saved = table(SERIES, saves), table(STATE, saves, n), table(TURN, saves, counted)
    except MemoryError:
        size = saves * n * np.dtype(STATE, align=True).itemsize / 2**30
        raise MemoryError(
            f"{saves} saved states of {n} bodies need {size:.3g} GiB of memory, more than there is: "
            "save fewer, by save_every= or save_at="
        ) from None
    return Records(
        *saved, table(TOUCH, events + points), table(IMPACTS, events), table(EVENT, events),
        table(SNAPSHOT, 2 * events + 2 * n),
    )  # fmt: skip


def one_row(bodies: int, counted: int) -> Records:
    """Return records of one saved time, and of nothing that happened."""
    saved = table(SERIES, 1), table(STATE, 1, bodies), table(TURN, 1, counted)
    return Records(*saved, *(table(kind, 0) for kind in (TOUCH, IMPACTS, EVENT, SNAPSHOT)))


def longer(records: Records, clock: np.recarray, more: int = 0) -> Records:
    """Return the records with room for twice as many impacts, events and active points.

    One pass of the loop may write `MARGIN` rows and `more`. Zeros that were never written take no memory.
    """
    ends, out = ends_of(clock), {}
    for name in ("touch", "impact", "event", "snapshot"):
        rows = getattr(records, name)
        longer, end = (
            np.zeros((2 * len(rows), *rows.shape[1:]), rows.dtype),
            ends[name] + MARGIN + more,
        )
        longer[:end][: len(rows)] = rows[:end]
        out[name] = longer.view(Columns)
    return records._replace(**out)


def with_room(records: Records, saved: int, rows: int = 1) -> Records:
    """Return the records with room for more saved steps after the first `saved` ones."""
    known, need = len(records.series), saved + rows
    if need <= known:
        return records
    more = {}
    for name in ("series", "state", "turn"):
        old = getattr(records, name)
        new = np.zeros((need if rows == 1 else max(2 * known, need), *old.shape[1:]), old.dtype)
        new[:saved] = old[:saved]
        more[name] = new.view(Columns)
    return records._replace(**more)


def trimmed(records: Records, clock: np.recarray) -> Records:
    """Return copies of the rows that were written."""
    return Records(*(rows.copy() for rows in written(records, clock)))


def written(records: Records, clock: np.recarray) -> Records:
    """Return views of the rows that were written; a run that continues may write to them."""
    return Records._make(rows[:end] for rows, end in zip(records, ends_of(clock).values()))


def ends_of(clock: np.recarray) -> dict[str, int]:
    """Return how many rows of each table were written, by its name."""
    names = "saved", "saved", "saved", "touched", "struck", "event", "snapped"
    return {table: int(clock[name][0]) for table, name in zip(Records._fields, names)}


def as_numbers(row: np.recarray) -> dict:
    """Return the fields of the clock, or of another table of one row, as Python numbers, by name."""
    return dict(zip(row.dtype.names or (), row.item()))
