"""Workspace of a multiple impact: records of contacts and classes, and named arrays."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom._compiled.simd import LANES
from carom.friction.layout import ContactProblem, ContactWork, new_contact_work
from carom.impact.layout import SIZE
from carom.impact.multiple import layout as o

ORDERS = 26  # room for series
UNLIMITED = 2**62  # steps

#: one contact, or a class of contacts that move alike, in scaled variables
CONTACT = [
    ("mu", "f8"),  # of a law, that which bounds stick
    ("restitution", "f8"),  # e as given
    ("e", "f8"),  # energetic coefficient in use
    ("root", "f8"),  # kappa^(1/p)
    ("law", "i8"),  # by number
    ("by_slip", "i8"),  # 1 if its friction depends on the slip
    ("approach", "f8"),  # speed of approach before, at least 0
    # memory of the normal law
    ("mode", "i8"),
    ("when", "f8"),  # time of its first change of mode in a step
    ("d0", "f8"),  # depth at the last opening
    ("most", "f8"),  # dm
    ("slope", "f8"),  # N = (slope (d - rest))^p
    ("rest", "f8"),
    ("mark", "f8"),  # normal impulse at the last change of mode
    ("wedged", "i8"),  # 1: friction keeps it compressed at the end
    # friction
    ("sticks", "i8"),  # 1 if it does, plus HAS_STUCK
    ("grip", "f8"),  # mu times the trace of its W_tt
    ("braking", "f8"),  # c_i, the rate at which its own friction can change its slip
    # friction by the slip
    ("slip_mu", "f8"),  # mu at the slip of a stage
    ("miss", "f8"),  # by how much that misses the law
    ("mu_before", "f8"),  # mu of the iteration before
    # acceleration of one that is to stick, relative to that by its own friction
    ("pull", "f8"),
    # sums
    ("loading", "f8"),  # p_c
    ("unloading", "f8"),  # p_r
    ("absorbed", "f8"),  # work absorbed, >= 0
    ("returned", "f8"),  # work returned
    ("loss", "f8"),  # by friction
]

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

#: contacts that move alike, solved as one
CLASS = [
    ("first", "i8"),  # its first contact
    ("members", "i8"),  # number of its contacts
    (
        "group",
        "i8",
    ),  # number of the group of classes that act on each other, -1 if no force presses it
]

#: one contact in the outer iteration of Newton's and Poisson's law
OUTER = [
    ("x", "f8"),  # ln e_*
    ("miss", "f8"),  # ln(target/reached)
    ("new_miss", "f8"),  # the same after a step
    ("step", "f8"),  # of x
    ("change", "f8"),  # of the miss in this step
    ("reply", "f8"),  # the step that the inverse Jacobian H gives for this change
    ("last", "f8"),  # the step before the last
    ("direction", "f8"),  # v of the update of H
    ("update", "f8"),  # v^T H / (v^T H y)
    ("best", "f8"),  # best x
    ("best_miss", "f8"),  # and its miss
]


class LayerState(NamedTuple):
    """The state of a group in the layer, in scaled variables."""

    impulse: np.ndarray  # (3K,)
    velocity: np.ndarray  # (3K,)
    depth: np.ndarray  # (K + 3,), written four at a time


class StickWork(NamedTuple):
    """The friction T = -H a of Z contacts that stick; rows t1, t2 of each."""

    H: np.ndarray  # (2K, 2K)
    L: np.ndarray  # (2K, 2K) factor of the weighted W of these rows, in the order of pivots
    gram: np.ndarray  # (2K, 2K) L^T L, then its factors
    weight: np.ndarray  # (K,) of each contact, relative
    order: np.ndarray  # (2K,) int64, rows in the order of pivots
    T: np.ndarray  # (2K,) friction; of tangential restitution the change of slip
    coupling: np.ndarray  # (K, 2K) W_nn^+ W_nt of tangential restitution


class Series(NamedTuple):
    """Taylor series of the layer: contact i is lane i % 4 of block i // 4; (B, 4) numbers for each contact."""

    u: np.ndarray  # (3, ORDERS, B, 4) velocity n, t1, t2
    P: np.ndarray  # (3, ORDERS, B, 4) impulse n, t1, t2
    depth: np.ndarray  # (ORDERS, B, 4)
    N: np.ndarray  # (ORDERS, B, 4) normal force
    square: np.ndarray  # (ORDERS, B, 4) |u_t|^2
    slip: np.ndarray  # (ORDERS, B, 4) |u_t|
    rub: np.ndarray  # (ORDERS, B, 4) mu N/|u_t|
    stretched_rub: np.ndarray  # (ORDERS, B, 4) the same times dt/dtau
    inverse: np.ndarray  # (ORDERS, B, 4) 1/|u_t|
    loss: np.ndarray  # (ORDERS, B, 4) by friction
    rate: np.ndarray  # (ORDERS, B, 4) dtau/dt, the same in all lanes
    sigma: np.ndarray  # (ORDERS, B, 4) dt/dtau, the same in all lanes
    slope: np.ndarray  # (B, 4) stiffness
    mu: np.ndarray  # (B, 4) where a contact slips
    over: np.ndarray  # (B, 4) 1/|u_t| there, now
    braking: np.ndarray  # (B, 4) c_i
    slowness: np.ndarray  # (B, 4) weight of errors of slow slip
    slipping: np.ndarray  # (B, 4) first lane: positive if any contact of the block slips
    at_depth: np.ndarray  # (B, 4) depth at one instant
    at_u: np.ndarray  # (B, 4) normal velocity at one instant
    end: np.ndarray  # (2, 4) two numbers of the contacts of one block, at the end of a step
    # (3K, 3B, 4) columns of W of the group, scaled: blocks of n, then of t1 and t2
    columns: np.ndarray


class Stages(NamedTuple):
    """The six stages of an implicit step."""

    force: np.ndarray  # (6, 3K)
    sinking: np.ndarray  # (6, K) rate of the depth
    loss: np.ndarray  # (6, K) power that friction takes


class SingleImpact(NamedTuple):
    """Input and result of the resolver of one contact."""

    W: np.ndarray  # (3, 3)
    u: np.ndarray  # (3,) velocity before
    out: np.ndarray  # as `carom.impact.layout` says


class PassageWork(NamedTuple):
    """Workspace for the passage of a group of up to K contacts, in scaled variables."""

    contact: np.recarray  # (K,) CONTACT
    clock: np.recarray  # (1,) CLOCK
    outer: np.recarray  # (K,) OUTER
    inverse: np.ndarray  # (K, K) inverse Jacobian of the outer iteration
    W: np.ndarray  # (3K, 3K)
    before: np.ndarray  # (3K,) velocity before
    now: LayerState
    new: LayerState  # at the end of a step
    # at the first unloading
    saved: np.recarray  # (K,) CONTACT
    saved_impulse: np.ndarray  # (3K,)
    saved_depth: np.ndarray  # (K,)
    # int64 lists of contacts
    closed: np.ndarray  # (K,) or those with an impulse
    stuck: np.ndarray  # (K,) that stick
    discs: np.ndarray  # (K,) closed, with friction
    stick: StickWork
    disc_force: np.ndarray  # (2K,) friction of the discs that was found last
    scratch: np.ndarray  # (3K,) impulses or forces
    error: np.ndarray  # (3K,) velocities or accelerations
    more_impulse: np.ndarray  # (3K,) of one order of the series, or of tangential restitution
    more_velocity: np.ndarray  # (3K,) its effect
    series: Series
    stages: Stages
    cones: ContactWork
    problem: ContactProblem  # of Moreau, with this W
    single: SingleImpact


#: one impact of a sequence
BLOW = [
    ("k", "i8"),  # its contacts
    ("others", "i8"),  # number of closed contacts that are not in it
    ("still", "f8"),  # speed that counts as 0 [m/s]
]


class BlowWork(NamedTuple):
    """One impact of a sequence: its contacts, in classes and groups, and its result."""

    impact: np.recarray  # (1,) BLOW
    contacts: o.CornerContacts
    clean: (
        np.ndarray
    )  # (3K, 3K) W that acts: without round-off, and without tangents that have no friction
    classes: np.recarray  # (K,) CLASS
    members: np.ndarray  # (K,) int64, classes of a group
    stack: np.ndarray  # (K,) int64
    sums: np.ndarray  # (3K,) of a row of W over each class
    result: o.MultipleResult


class MultipleWorkspace(NamedTuple):
    """Workspace for impacts of up to K contacts."""

    work: PassageWork
    blow: BlowWork


def new_multiple_workspace(capacity: int) -> MultipleWorkspace:
    """Return workspace for up to `capacity` contacts."""
    k = max(int(capacity), 1)
    n, m, whole = 3 * k, 2 * k, partial(np.zeros, dtype=np.int64)
    W = np.zeros((n, n))
    work = PassageWork(
        contact=table(CONTACT, k), clock=table(CLOCK, 1), outer=table(OUTER, k), inverse=np.zeros((k, k)),
        W=W, before=np.zeros(n), now=_new_state(k), new=_new_state(k),
        saved=table(CONTACT, k), saved_impulse=np.zeros(n), saved_depth=np.zeros(k),
        closed=whole(k), stuck=whole(k), discs=whole(k),
        stick=StickWork(
            H=np.zeros((m, m)), L=np.zeros((m, m)), gram=np.zeros((m, m)), weight=np.zeros(k),
            order=whole(m), T=np.zeros(m), coupling=np.zeros((k, m)),
        ),
        disc_force=np.zeros(m), scratch=np.zeros(n), error=np.zeros(n),
        more_impulse=np.zeros(n), more_velocity=np.zeros(n), series=_new_series(k),
        stages=Stages(np.zeros((6, n)), np.zeros((6, k)), np.zeros((6, k))), cones=new_contact_work(k),
        problem=ContactProblem(W, np.zeros(n), np.zeros(k), whole(k), np.zeros((k, 2))),
        single=SingleImpact(np.zeros((3, 3)), np.zeros(3), np.zeros(SIZE)),
    )  # fmt: skip
    work.clock["left"] = UNLIMITED
    contacts = o.CornerContacts(table(o.CORNER_CONTACT, k), np.zeros((n, n)), np.zeros(n))
    blow = BlowWork(
        impact=table(BLOW, 1), contacts=contacts, clean=np.zeros((n, n)), classes=table(CLASS, k),
        members=whole(k), stack=whole(k), sums=np.zeros(n), result=o.new_multiple_result(k),
    )  # fmt: skip
    return MultipleWorkspace(work, blow)


def _new_state(k: int) -> LayerState:
    """Return arrays for the state of `k` contacts."""
    return LayerState(np.zeros(3 * k), np.zeros(3 * k), np.zeros(k + LANES - 1))


def _new_series(k: int) -> Series:
    """Return arrays for the series of `k` contacts."""
    b = (k + LANES - 1) // LANES
    u, P = np.zeros((2, 3, ORDERS, b, LANES))
    all_orders, numbers = partial(np.zeros, (ORDERS, b, LANES)), partial(np.zeros, (b, LANES))
    return Series(
        u=u, P=P, depth=all_orders(), N=all_orders(), square=all_orders(), slip=all_orders(),
        rub=all_orders(), stretched_rub=all_orders(), inverse=all_orders(), loss=all_orders(),
        rate=all_orders(), sigma=all_orders(), slope=numbers(), mu=numbers(), over=numbers(),
        braking=numbers(), slowness=numbers(), slipping=numbers(), at_depth=numbers(), at_u=numbers(),
        end=np.zeros((2, LANES)), columns=np.zeros((3 * k, 3 * b, LANES)),
    )  # fmt: skip
