"""Input, settings, workspace and result of a multiple impact."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom._compiled.simd import LANES
from carom.friction.layout import ContactWork, new_contact_work
from carom.impact import layout as one

SIMULTANEOUS, SEQUENTIAL, BY_NEWTON = 0, 1, 2
MULTIPLE = {"simultaneous": SIMULTANEOUS, "sequential": SEQUENTIAL, "newton": BY_NEWTON}

OK = 0
BAD_INPUT = 1  #: a number is not finite, or a law or a coefficient is out of its range
NOT_RESOLVED = 2  #: no method ended with contacts that do not approach

MESSAGES = {
    BAD_INPUT: "a number is not finite or out of its range",
    NOT_RESOLVED: "with every method some contacts still approach at the end",
}

# Bits of `marks`.
PLASTIC = 1  #: closed by the plastic event: trapped, or e = 0 everywhere
MISSED = 2  #: the law of Newton or Poisson was not met: the nearest was taken, or the energetic law
CAPPED = 4  #: the law asks for more than e_* = 1 somewhere: not met there, energy cannot grow
FIXED = 8  #: passed with fixed steps
EXACT = 16  #: contacts that move alike, resolved exactly as one
AT_ONCE = 64  #: the layer could not be passed: one contact problem instead
REPELLED = 32  #: the impulse was scaled back by round-off, so that energy does not grow


class MultipleSettings(NamedTuple):
    """Settings of the resolver of multiple impacts."""

    multiple: int = SIMULTANEOUS
    rtol: float = 1e-8  # relative error of velocities
    exponent: float = 1.0  # p of the normal law; 0 in a run: by the shapes that touch
    adaptive_up_to: int = 24  # contacts (unlike ones); above: fixed steps
    fixed_steps: int = 40  # a period of the fastest contact, above `adaptive_up_to`
    max_events: int = 200  # changes of mode, a contact
    max_steps: int = 2000  # a contact
    max_rounds: int = 40  # of the outer iteration of Newton's and Poisson's law


class CornerContacts(NamedTuple):
    """The contacts of an impact: the first `k` of each array; (n, t1, t2) of each are rows of W and u."""

    k: int
    others: int  # closed contacts that are not among these: their blows are others
    W: np.ndarray  # (3K, 3K) inverse mass, symmetric, often singular
    u: (
        np.ndarray
    )  # (3K,) velocity before, approach negative; u_n = 0 where contacts touch or are held
    friction: np.ndarray  # (K,)
    restitution: np.ndarray  # (K,)
    law: np.ndarray  # (K,) of `carom.impact.laws`
    stiffness: np.ndarray  # (K,), only ratios matter
    pair: (
        np.ndarray
    )  # (K,) contacts of one number strike together, those of another in a blow of their own


#: one contact, or a class of contacts that move alike, in scaled variables
CONTACT = [
    ("mu", "f8"),
    ("restitution", "f8"),  # e as given
    ("e", "f8"),  # energetic coefficient in use
    ("root", "f8"),  # kappa^(1/p)
    ("law", "i8"),
    ("approach", "f8"),  # speed of approach before, 0 where there is none
    ("members", "i8"),
    # memory of the normal law
    ("mode", "i8"),
    ("d0", "f8"),  # depth at the last opening
    ("most", "f8"),  # dm
    ("slope", "f8"),  # N = (slope (d - rest))^p
    ("rest", "f8"),
    ("mark", "f8"),  # normal impulse at the last change of mode
    ("wedged", "i8"),  # 1: friction holds it compressed at the end
    # friction
    ("sticks", "i8"),
    ("grip", "f8"),  # mu times the greatest own inverse mass of W_tt
    # sums
    ("loading", "f8"),  # p_c
    ("unloading", "f8"),  # p_r
    ("absorbed", "f8"),  # work taken, >= 0
    ("returned", "f8"),  # work given back
    ("loss", "f8"),  # by friction
]

RESULT = [
    ("energy_change", "f8"),
    ("plastic_change", "f8"),  # part of it: by the plastic event
    ("miss", "f8"),  # greatest ln(target/reached) of Newton's and Poisson's law where not met
    ("error", "f8"),  # estimated, of the velocities; 0 where not estimated
    ("steps", "i8"),
    ("events", "i8"),
    ("rounds", "i8"),  # of the outer iteration
    ("classes", "i8"),  # of contacts that move alike
    ("marks", "i8"),
]


class MultipleResult(NamedTuple):
    """Result of an impact of K contacts."""

    impulse: np.ndarray  # (3K,)
    velocity: np.ndarray  # (3K,) after
    compression: np.ndarray  # (K,) work of the normal force while loading, <= 0
    restitution: np.ndarray  # (K,) while unloading, >= 0
    friction: np.ndarray  # (K,) energy dissipated by friction
    wedged: np.ndarray  # (K,) 1 where friction holds it at the end, and its law could not be met
    summary: np.recarray  # (1,) RESULT


class PassageWork(NamedTuple):
    """Workspace for the passage of a group of K contacts, in few arrays: each costs at every call."""

    contact: np.recarray  # (K,) CONTACT
    saved: np.recarray  # (K,) CONTACT, at the first unloading
    clock: np.recarray  # (1,) CLOCK
    index: np.ndarray  # (11, 3K) rows below
    matrix: np.ndarray  # (9, 3K, 3K) below
    vector: np.ndarray  # (37, 3K) rows below
    series: np.ndarray  # (18, ORDERS, B, 4) below; contact i is lane i % 4 of block i // 4
    columns: (
        np.ndarray
    )  # (3K, 3B, 4) W of the group, scaled, in lanes: blocks of n, then of t1 and t2
    stage: np.ndarray  # (2, 6, 3K) forces and rates at the stages of an implicit step
    single: np.ndarray  # result of one contact, as `carom.impact.layout` says


class BlowWork(NamedTuple):
    """The contacts of one blow, and its result; of a sequence of blows each in turn."""

    member: np.ndarray  # (K,) their places among all contacts
    W: np.ndarray  # (3K, 3K)
    given: np.ndarray  # (4, 3K) rows below
    law: np.ndarray  # (2, K) laws and pairs
    result: MultipleResult


class MultipleWorkspace(NamedTuple):
    """Workspace for impacts of up to K contacts."""

    work: PassageWork
    cones: ContactWork
    blow: BlowWork


#: rows of `given`: velocity before, friction, restitution, stiffness
BLOW_U, BLOW_FRICTION, BLOW_RESTITUTION, BLOW_STIFFNESS = range(4)


#: rows of `index`: class of a contact, first member of a class, its size, its group, members of
#: a group, a stack, contacts of the discs, contacts that stick, pivots, contacts that are closed,
#: 1 for those that some force can press
CLASS, FIRST, SIZE, GROUP, MEMBER, STACK, DISC, STUCK, PIVOT, CLOSED, PRESSED = range(11)
#: `matrix`: W of all contacts, cleaned; W of the group, scaled; W_tt of the discs; Newton's matrix; what
#: holds the sticking contacts, and two for it; the inverse Jacobian of the outer iteration; W of one contact
CLEAN, MASS, DISCS, JACOBIAN, HOLDING, FACTOR, MIDDLE, INVERSE, SINGLE = range(9)
#: rows of `vector`. Velocities before, impulse, velocity; the same at the end of a step
U0, P, U, NEW_P, NEW_U, D, NEW_D, SAVED_P, SAVED_D, WHEN, SCRATCH, ERROR, TRY = range(13)
#: of the discs: given c, friction T, w = A T + c, mismatch, step, trial, radii
DISC_C, DISC_T, DISC_W, DISC_F, DISC_STEP, DISC_TRY, RADIUS = range(13, 20)
#: velocities of contacts that jam, with a seed
SEEDED = 32
#: friction as far as it acts
FRICTION = 33
#: of the series and of stick
WEIGHT, SCALE, LEFT, STICK_T = range(20, 24)
#: of the outer iteration: ln e_*, misses, new misses, step, change of misses, a product, best e_*, its misses
OUT_X, OUT_F, OUT_NEW, OUT_DX, OUT_DF, OUT_H, OUT_BEST, OUT_BEST_F = range(24, 32)
#: of a new order of the series: impulses and velocities
ORDER_P, ORDER_U = 34, 35
#: of the first unloading: which contacts change their modes then
SAVED_WHEN = 36
#: first index of `series`: velocity n, t1, t2; impulse n, t1, t2; depth; N; |u_t|^2; |u_t|; mu N/|u_t|, the
#: same times dt/dtau; 1/|u_t|; friction loss; dtau/dt and dt/dtau; numbers of each contact (rows below)
S_U, S_U1, S_U2, S_P, S_P1, S_P2, S_D, S_N, S_Q, S_R, S_F, S_FS, S_G, S_LOSS, S_RATE, S_SIGMA = (
    range(16)
)
S_LANE, S_AT = 16, 17
#: rows of S_LANE: stiffness, mu where friction is that of slip, 1/|u_t| there, the rates c_i of stretched
#: time, how much more slow slip must be exact, whether any contact of a block slips
SLOPE, ROUGH, ONE_OVER, PULL, FINE, SLIPPING = range(6)
#: rows of S_AT, values at one instant: depth, normal velocity
AT_D, AT_U = 0, 1
FORCE, STAGE = 0, 1  # of `stage`
ORDERS = 26  # room for series

UNLIMITED = 2**62  # steps

#: where the passage of the layer stands
CLOCK = [
    ("step", "f8"),  # next step to try
    ("saved_step", "f8"),
    ("saved_latest", "f8"),
    ("saved_idle", "i8"),
    ("steps", "i8"),
    ("events", "i8"),
    ("idle", "i8"),  # changes of mode since time last went on
    ("branched", "i8"),  # 1 once a state is saved at the first unloading
    ("rest", "i8"),  # steps since all came to rest
    ("stretched", "i8"),  # 1: the last step is measured in stretched time
    ("cut", "i8"),  # 1: the last step by series ended where a contact cannot stick with its share
    ("stiff", "i8"),  # implicit steps to take before series are tried again
    ("saved_stiff", "i8"),
    ("left", "i8"),  # steps that the impact may still take; below 0: it was broken off
    # what the units answer
    ("error", "f8"),
    ("change", "f8"),
    ("code", "i8"),
    ("length", "f8"),
    ("changes", "i8"),
]


def new_multiple_result(capacity: int) -> MultipleResult:
    """Return arrays for the result of up to `capacity` contacts."""
    k = max(int(capacity), 1)
    return MultipleResult(
        np.zeros(3 * k), np.zeros(3 * k), np.zeros(k), np.zeros(k), np.zeros(k),
        np.zeros(k, dtype=np.int64), table(RESULT, 1),
    )  # fmt: skip


def new_multiple_workspace(capacity: int) -> MultipleWorkspace:
    """Return workspace for up to `capacity` contacts."""
    k = max(int(capacity), 1)
    n, blocks = 3 * k, (k + LANES - 1) // LANES
    work = PassageWork(
        contact=table(CONTACT, k),
        saved=table(CONTACT, k),
        clock=table(CLOCK, 1),
        index=np.zeros((11, n), dtype=np.int64),
        matrix=np.zeros((9, n, n)),
        vector=np.zeros((37, 3 * LANES * blocks)),
        series=np.zeros((18, ORDERS, blocks, LANES)),
        columns=np.zeros((n, 3 * blocks, LANES)),
        stage=np.zeros((2, 6, n)),
        single=np.zeros(one.SIZE),
    )
    work.clock["left"] = UNLIMITED
    blow = BlowWork(
        member=np.zeros(k, dtype=np.int64),
        W=np.zeros((n, n)),
        given=np.zeros((4, n)),
        law=np.zeros((2, k), dtype=np.int64),
        result=new_multiple_result(k),
    )
    return MultipleWorkspace(work, new_contact_work(k), blow)
