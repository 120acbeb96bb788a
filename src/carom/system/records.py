"""What a run writes down, and where it stands: arrays made before the loop."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.system.arrays import Held, State, System, Work

#: columns of a row of `Records.impact`
TIME, CONTACT, POINT, INVERSE_MASS, BEFORE, AFTER, IMPULSE = 0, 1, 2, 5, 14, 17, 20
ENERGY, DURATION, WORK_C, WORK_R, FRICTION_LOSS, PHASES = 23, 24, 25, 26, 27, 28
IMPACT_COLUMNS = 29

#: columns of the ledger
LOADS, IMPACTS, FRICTION, HANDOVER = range(4)
LEDGER_COLUMNS = 4

#: places in `Clock.count`
STEP, SAVED, STRUCK, IN_STEP, AT_ONCE, CUTS, TRIALS, LOCATED, HOLDS, STATUS = range(10)
#: places in `Clock.time`
NOW, SPENT = 0, 1

FULL = 100  # a record is full: the caller makes it longer and goes on


class Records(NamedTuple):
    """Saved steps (T rows) and impacts (K rows)."""

    t: np.ndarray  # (T,)
    x: np.ndarray  # (T, N, 3)
    Q: np.ndarray  # (T, N, 4)
    v: np.ndarray  # (T, N, 3)
    w: np.ndarray  # (T, N, 3)
    ledger: np.ndarray  # (T, 4) work of loads, of impacts, of friction in held contacts, bounces dropped
    mode: np.ndarray  # (T, C) 0 open, 1 slipping, 2 sticking
    force: np.ndarray  # (T, C, 3) force of held contacts, contact axes [N]
    impact: np.ndarray  # (K, 29)
    impact_pose: np.ndarray  # (K, N, 7) x, Q
    impact_speed: np.ndarray  # (K, N, 12) v, w before; v, w after


class Clock(NamedTuple):
    """Where a run stands; kept between calls of the loop."""

    time: np.ndarray  # (2,) time, time spent in the present step
    count: np.ndarray  # (10,)
    ledger: np.ndarray  # (4,)


def new_clock() -> Clock:
    """Return the clock of a run that has not begun."""
    return Clock(np.zeros(2), np.zeros(10, dtype=np.int64), np.zeros(LEDGER_COLUMNS))


def new_state(count: int) -> State:
    """Return a state of `count` bodies, all zero."""
    return State(*(np.zeros((count, n)) for n in (3, 4, 3, 3)))


def new_held(count: int) -> Held:
    """Return the record of `count` contacts, all open, to be looked at before the first step."""
    whole = dict.fromkeys(("mode", "rest", "near", "leaving"))
    arrays = {name: np.zeros(count, dtype=np.int64) for name in whole}
    arrays["near"][:] = 1
    return Held(
        point=np.zeros((count, 3)), anchor=np.zeros((count, 3)), force=np.zeros((count, 3)), **arrays
    )


def new_work(system: System, stages: int) -> Work:
    """Return the scratch arrays of one run."""
    n, j, c = system.bodies.mass.size, system.joints.kind.size, system.contacts.body.size
    return Work(
        wrench=np.zeros((n, 6)),
        bias=np.zeros((j, 6)),
        delta=np.zeros((n, 6)),
        zero=np.zeros((j, 6)),
        reaction=np.zeros((j, 6)),
        stage=new_state(n),
        speed=np.zeros((stages, n, 6)),
        rate=np.zeros((stages, n, 6)),
        attitude=np.zeros((stages, n, 4)),
        W=np.zeros((c, 3, 3)),
        small=np.zeros((3, 3)),
        u=np.zeros(3),
        out=np.zeros(32),
        history=np.zeros((0, 16)),
        trial=new_state(n),
        middle=new_state(n),
        multiplier=np.zeros((j, 6)),
        point=np.zeros(3),
        bound=np.zeros((n, 3)),
    )


def new_records(system: System, saves: int, impacts: int) -> Records:
    """Return empty records for `saves` saved steps and `impacts` impacts."""
    n, c = system.bodies.mass.size, system.contacts.body.size
    state = (np.zeros((saves, n, k)) for k in (3, 4, 3, 3))
    return Records(
        np.zeros(saves), *state, np.zeros((saves, LEDGER_COLUMNS)),
        np.zeros((saves, c), dtype=np.int64), np.zeros((saves, c, 3)),
        np.zeros((impacts, IMPACT_COLUMNS)), np.zeros((impacts, n, 7)), np.zeros((impacts, n, 12)),
    )  # fmt: skip


def longer(records: Records) -> Records:
    """Return the records with room for twice as many impacts."""
    def grow(a):
        return np.concatenate([a, np.zeros_like(a)] if len(a) else [np.zeros((64, *a.shape[1:]))])

    return records._replace(
        impact=grow(records.impact),
        impact_pose=grow(records.impact_pose),
        impact_speed=grow(records.impact_speed),
    )
