"""Input, settings, workspace and result of a multiple impact."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom._compiled.simd import LANES
from carom.friction.layout import ContactWork, new_contact_work
from carom.impact.layout import BAD_INPUT, SIZE
from carom.model.laws import Laws

if TYPE_CHECKING:
    from carom.options import Options

SIMULTANEOUS, SEQUENTIAL, BY_NEWTON = 0, 1, 2
MULTIPLE = {"simultaneous": SIMULTANEOUS, "sequential": SEQUENTIAL, "newton": BY_NEWTON}

#: beside those of `carom.impact.layout`: after every method some contact approaches, or energy has grown
NOT_RESOLVED = 2

MESSAGES = {
    BAD_INPUT: "a number is not finite or out of its range",
    NOT_RESOLVED: "with every method some contacts still approach at the end, or energy is gained",
}

# Bits of `marks`, beside AT_ONCE and PLASTIC of `carom.impact.layout`.
MISSED = 2  #: the law of Newton or Poisson was not satisfied; the nearest result or Stronge's law was used
CAPPED = 4  #: the law of a contact requires e_* > 1, and is not satisfied: energy cannot grow
EXACT = 16  #: contacts that move alike, resolved exactly as one
REPELLED = 32  #: the impulse was changed by round-off, so that energy does not grow
NO_RESULT = 256  #: after every method a contact approaches, or energy has grown

HAS_STUCK = 2  #: bit of `sticks`: the contact is open, and opened without slip


class MultipleSettings(NamedTuple):
    """Settings of the resolver of multiple impacts."""

    multiple: int = SIMULTANEOUS
    rtol: float = 1e-8  # relative error of velocities
    exponent: float = 1.0  # p of the normal law; 0 in a run: by the shapes in contact
    max_events: int = 200  # changes of mode per contact
    max_steps: int = 2000  # per contact
    max_rounds: int = 40  # of the outer iteration of Newton's and Poisson's law


def multiple_settings(options: Options, exponent: float = 0.0) -> MultipleSettings:
    """Return the settings for the options of a run; `exponent` where these give none."""
    return MultipleSettings(
        multiple=MULTIPLE[options.multiple], rtol=options.corner_tolerance,
        exponent=options.corner_exponent or exponent,
    )  # fmt: skip


class CornerContacts(NamedTuple):
    """The contacts of an impact: the first `k` of each array; (n, t1, t2) of each are rows of W and u."""

    k: int
    others: int  # number of closed contacts that are not in this impact of a sequence
    W: np.ndarray  # (3K, 3K) inverse mass, symmetric, often singular
    # (3K,) velocity before, approach negative; u_n = 0 for contacts that touch or persist
    u: np.ndarray
    friction: np.ndarray  # (K,) of a law, that which bounds stick
    restitution: np.ndarray  # (K,)
    law: np.ndarray  # (K,) by number
    stiffness: np.ndarray  # (K,), only ratios matter
    # (K,) contacts with equal numbers strike together, others in an impact of their own
    pair: np.ndarray
    laws: Laws


class Passage(NamedTuple):
    """Settings of the passage of a group, and the laws of its contacts."""

    rtol: float
    exponent: float  # p of the normal law
    max_events: int
    max_steps: int
    max_rounds: int
    by_slip: bool  # whether any friction depends on the slip
    speed: float  # unit of speeds [m/s]
    laws: Laws


#: one contact, or a class of contacts that move alike, in scaled variables
CONTACT = [
    ("mu", "f8"),  # of a law, that which bounds stick
    ("restitution", "f8"),  # e as given
    ("e", "f8"),  # energetic coefficient in use
    ("root", "f8"),  # kappa^(1/p)
    ("law", "i8"),  # by number
    ("by_slip", "i8"),  # 1 if its friction depends on the slip
    ("approach", "f8"),  # speed of approach before, at least 0
    ("members", "i8"),
    # memory of the normal law
    ("mode", "i8"),
    ("d0", "f8"),  # depth at the last opening
    ("most", "f8"),  # dm
    ("slope", "f8"),  # N = (slope (d - rest))^p
    ("rest", "f8"),
    ("mark", "f8"),  # normal impulse at the last change of mode
    ("wedged", "i8"),  # 1: friction keeps it compressed at the end
    # friction
    ("sticks", "i8"),  # 1 if it does, plus HAS_STUCK
    ("grip", "f8"),  # mu times the trace of its W_tt
    # sums
    ("loading", "f8"),  # p_c
    ("unloading", "f8"),  # p_r
    ("absorbed", "f8"),  # work absorbed, >= 0
    ("returned", "f8"),  # work returned
    ("loss", "f8"),  # by friction
]

RESULT = [
    ("energy_change", "f8"),
    ("plastic_change", "f8"),  # its part in the plastic event
    ("miss", "f8"),  # greatest ln(target/reached) of Newton's and Poisson's law where not met
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
    restitution: np.ndarray  # (K,) work of the normal force while unloading, >= 0
    friction: np.ndarray  # (K,) energy dissipated by friction
    wedged: np.ndarray  # (K,) 1 if friction blocks the contact at the end: its law fails
    summary: np.recarray  # (1,) RESULT


class PassageWork(NamedTuple):
    """Workspace for the passage of a group of K contacts, in few arrays: each array costs time at a call."""

    contact: np.recarray  # (K,) CONTACT
    saved: np.recarray  # (K,) CONTACT, at the first unloading
    clock: np.recarray  # (1,) CLOCK
    index: np.ndarray  # (12, 3K) rows below
    matrix: np.ndarray  # (7, 3K, 3K) below
    vector: np.ndarray  # (36, 3K) rows below
    series: np.ndarray  # (18, ORDERS, B, 4) below; contact i is lane i % 4 of block i // 4
    # (3K, 3B, 4) W of the group, scaled, in lanes: blocks of n, then of t1 and t2
    columns: np.ndarray
    stage: np.ndarray  # (2, 6, 3K) forces and rates at the stages of an implicit step
    single: np.ndarray  # result of one contact, as `carom.impact.layout` says
    cones: ContactWork
    heading: np.ndarray  # (K, 2) directions of slip of Moreau's problem, which knows none


class BlowWork(NamedTuple):
    """The contacts and the result of one impact, used in turn for each impact of a sequence."""

    member: np.ndarray  # (K,) places of these contacts among all contacts
    W: np.ndarray  # (3K, 3K)
    given: np.ndarray  # (4, 3K) rows below
    law: np.ndarray  # (2, K) laws and pairs
    result: MultipleResult


class MultipleWorkspace(NamedTuple):
    """Workspace for impacts of up to K contacts."""

    work: PassageWork
    blow: BlowWork


#: rows of `given`: velocity before, friction, restitution, stiffness
BLOW_U, BLOW_FRICTION, BLOW_RESTITUTION, BLOW_STIFFNESS = range(4)


#: rows of `index`: class of a contact, first member of a class, its size, its group, members of a group, a
#: stack, contacts of the discs, contacts that stick, their rows in the order of pivots, contacts that are
#: closed, 1 for those that some force can press
CLASS, FIRST_MEMBER, CLASS_SIZE, GROUP, MEMBER, STACK, IN_DISC, STUCK, PIVOTED, CLOSED, PRESSED = (
    range(11)
)
MOREAU_KIND = 11  # kinds of `carom.friction` in Moreau's problem
#: `matrix`: W of all contacts, cleaned; W of the group, scaled; H of the sticking contacts, and two to find it;
#: the inverse Jacobian of the outer iteration; W of one contact
CLEAN, MASS, HOLDING, FACTOR, MIDDLE, INVERSE, SINGLE = range(7)
#: rows of `vector`. Velocities before, impulse, velocity; the same at the end of a step
U0, NOW_P, NOW_U, NEW_P, NEW_U, D, NEW_D, SAVED_P, SAVED_D, WHEN, SCRATCH, ERROR = range(12)
#: at the first unloading: times of the changes of mode; friction where it acts, otherwise 0
SAVED_WHEN, ACTING_MU = 13, 14
#: friction of the discs; of the series and of stick; of a new order of the series: impulses and velocities
DISC_T, WEIGHT, SCALE, STICK_T, ORDER_P, ORDER_U = range(15, 21)
#: of the outer iteration: ln e_*, misses, new misses, step, change of misses, a product, best e_*, its misses,
#: the step before the last, and the direction of the update
OUT_X, OUT_F, OUT_NEW, OUT_DX, OUT_DF, OUT_H, OUT_BEST, OUT_BEST_F, OUT_LAST, OUT_V = range(21, 31)
#: velocity before of one contact; of Moreau's problem: velocity without impulses, friction
SINGLE_U, MOREAU_C, MOREAU_MU = 12, 31, 32
#: of friction by laws: mu at the slip of a stage, by how much it misses the law, and mu before
SLIP_MU, MISS, MU_BEFORE = 33, 34, 35
#: first index of `series`: velocity n, t1, t2; impulse n, t1, t2; depth; N; |u_t|^2; |u_t|; mu N/|u_t|, the
#: same times dt/dtau; 1/|u_t|; friction loss; dtau/dt and dt/dtau; numbers of each contact (rows below)
S_U, S_U1, S_U2, S_P, S_P1, S_P2, S_D, S_N, S_Q, S_R, S_F, S_FS, S_G, S_LOSS, S_RATE, S_SIGMA = (
    range(16)
)
S_LANE, S_AT = 16, 17
#: rows of S_LANE: stiffness, mu where a contact slips, 1/|u_t| there, the rates c_i of stretched time,
#: the weight of errors of slow slip, whether any contact of a block slips
SLOPE, ROUGH, ONE_OVER, PULL, SLOWNESS, SLIPPING = range(6)
#: rows of S_AT, values at one instant: depth, normal velocity
AT_D, AT_U = 0, 1
FORCE, STAGE = 0, 1  # of `stage`
ORDERS = 26  # room for series

UNLIMITED = 2**62  # steps

#: progress of the passage of the layer
CLOCK = [
    ("step", "f8"),  # next step to try
    ("saved_step", "f8"),
    ("saved_latest", "f8"),
    ("saved_idle", "i8"),
    ("steps", "i8"),
    ("events", "i8"),
    ("idle", "i8"),  # successive changes of mode without a step in time
    ("branched", "i8"),  # 1 once a state is saved at the first unloading
    ("rest", "i8"),  # steps since all contacts came to rest
    ("stretched", "i8"),  # 1: the last step is measured in stretched time
    ("cut", "i8"),  # 1: the last series step ended where a contact ceases to stick
    ("stiff", "i8"),  # implicit steps to take before series are tried again
    ("saved_stiff", "i8"),
    ("left", "i8"),  # steps that the impact may still take; below 0 it was stopped
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
        contact=table(CONTACT, k), saved=table(CONTACT, k), clock=table(CLOCK, 1),
        index=np.zeros((12, n), dtype=np.int64), matrix=np.zeros((7, n, n)),
        vector=np.zeros((36, 3 * LANES * blocks)), series=np.zeros((18, ORDERS, blocks, LANES)),
        columns=np.zeros((n, 3 * blocks, LANES)), stage=np.zeros((2, 6, n)),
        single=np.zeros(SIZE), cones=new_contact_work(k), heading=np.zeros((k, 2)),
    )  # fmt: skip
    work.clock["left"] = UNLIMITED
    blow = BlowWork(
        member=np.zeros(k, dtype=np.int64), W=np.zeros((n, n)), given=np.zeros((4, n)),
        law=np.zeros((2, k), dtype=np.int64), result=new_multiple_result(k),
    )  # fmt: skip
    return MultipleWorkspace(work, blow)
