"""Arrays that a run changes besides its records: active set, workspace of a step, contact points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.collision.layout import PairWork
from carom.model.allowance import COUNTS
from carom.model.arrays import STATE

#: state of a contact between events
CONTACT_STATE = [
    # workspace: mark while a group is gathered; in a crowd 1 + first active point
    ("visited", "i8"),
    # 1 if the last event concerns it: it is checked before the next step; PUSHED_IN: it is judged in any case
    ("near", "i8"),
    ("jams", "i8"),  # 1 if an active point of it jams: an impact without collision must follow
    ("leaving", "i8"),  # 1 if the body lifts off without speed: it may touch at the start
    # 1 since a point of it has opened: it has no adhesion until it is pressed or struck anew
    ("broken", "i8"),
    ("blows", "i8"),  # impacts in a row, after low bounces
    ("struck", "f8"),  # time of the last
    ("step", "i8"),  # last step, or piece of one, in which the two were near each other, plus 1
]

#: a contact point in one state
POINT = [
    ("a", "i8"),  # body on the side that the normal points to
    ("b", "i8"),  # the other, -1 for the ground, STATIC for a static body
    ("arm_a", "f8", 3),  # from the mass centre, world axes
    ("arm_b", "f8", 3),
    ("core", "f8", 3),  # part of arm_a that turns with body a; 0 if `drift` describes the motion
    ("axes", "f8", (3, 3)),  # rows n, t1, t2
    ("gap", "f8"),
    ("owner", "i8"),  # of the normal, and the parts of both solids (`carom.collision.features`)
    ("parts", "i8", 2),
    ("motion", "i8"),  # that its rows measure: `MOTION_POINT`, ...
    # that converts an angular velocity, or the rate of a coordinate, to a speed; of an upper stop below 0
    ("length", "f8"),
    (
        "grip",
        "f8",
    ),  # of three coordinates: that converts the rate of the second (`kinematics.wrap`)
    ("coordinate", "i8"),  # of a stop, or of friction in a joint; the first of three
    (
        "moves",
        "i8",
    ),  # 1 if the surface of the other side moves in itself, as `field` says (`CONTACT`)
    ("field", "f8", (4, 3)),
    ("bends", "i8"),  # 1 if a body has modes: its places on both undeformed bodies, in their axes
    ("place_a", "f8", 3),
    ("place_b", "f8", 3),
]

#: `motion` of a point: that of two points, in rows n, t1, t2; relative rotation of rolling (t1, t2) and of
#: pivoting (t1); rate of a coordinate, of a stop (n) and of friction in a joint (t1); of three
#: coordinates
MOTION_POINT, MOTION_ROLL, MOTION_PIVOT, MOTION_STOP, MOTION_JOINT, MOTION_THREE = range(6)

#: `parent` of an entry of a group whose friction has a constant bound; else the one whose force bounds it
CONSTANT = -1

#: index that stands for a static body
STATIC = -2

#: the flight that a body is on, or was on last (`carom.kinematics.flight`, `carom.kinematics.torque_free_top`)
FLIGHT = [
    ("known_attitude", "f8", (2, 4)),  # its states at known times: start and end of a step
    ("known_spin", "f8", (2, 3)),
    ("age", "f8", (2, 2)),  # their times since the flight began, each as a sum of two numbers
    ("turn", "f8", 4),  # attitude at its start, times the inverse of `attitude` at time 0
    ("axes", "i8", 3),  # place of each principal axis in Jacobi's order
    ("sign", "f8", 3),  # by place: -1 for a reversed axis
    ("magnitude", "f8"),  # of the angular momentum
    ("amplitude", "f8", 3),  # of its direction in the body
    ("rate", "f8", 2),  # of half the turn about the momentum, and of the argument
    ("phase", "f8"),  # argument at the start
    ("kind", "i8"),  # how elliptic functions are computed
    ("series", "f8", 14),
    ("fastest", "f8"),  # bound of the acceleration of a point, over its distance from the centre
]

BODY_WORK = [
    ("wrench", "f8", 6),  # input of a solve: force and torque, or impulse
    ("motion", "f8", 6),  # result of a solve: linear, angular
    ("bound", "f8", 3),  # greatest linear, angular acceleration and spin of the last step
    # estimates of the error of a step [m]: of order 5, of 3, the greatest of others of order 5; their scale
    ("miss", "f8", 4),
    (
        "kinks",
        "i8",
    ),  # number of trial steps in a row that failed at a kink; from KINKS_IN_A_ROW on it stays
    ("ahead", "f8"),  # with tolerances: length of the next step of its island
    ("counts", "f8", COUNTS),  # work of its island that counts against its bounds
    ("fits", "f8"),  # length of a step whose error fits the tolerance, by the last step
    ("inverse", "f8", 6),  # inverse inertia, world axes
    ("label", "i8"),  # bodies with the same label move each other, by joints or active contacts
    ("n_active", "i8"),  # of the body with the number of a label: active points of the group
    ("sought", "i8"),  # of the same: 1 if the search for an event concerns the group
    ("status", "i8"),  # FREE, HELD or RESTS
    ("push", "f8", 6),  # change of momentum (linear, angular about the centre) in a step
    ("spin", "f8", 3),  # angular velocity that belongs to `momentum`, in the three-field step
    ("momentum", "f8", 3),  # spatial angular momentum
    *FLIGHT,
    # of time-stepping pieces: mean accelerations of the last one, its end, and the sum of their errors [m]
    ("mean", "f8", 6),
    ("piece_end", "f8"),
    ("astray", "f8"),
    ("whole_until", "i8"),  # the body moves in a crowd up to this step
    ("whole_for", "i8"),  # number of such steps at the last decision
    ("home", "f8", 3),  # centre at the start of the step
    ("room", "f8"),  # largest distance of the centre from it in this step
    ("facing", "f8", 4),  # attitude at the start of the step
    # largest displacement of a point of the body; infinite if the room alone counts
    ("reach", "f8"),
]

JOINT_WORK = [
    ("bias", "f8", 6),  # relative motion that a solve must give: angular, linear
    ("reaction", "f8", 6),  # wrench on the child at its anchor: force, torque
    ("multiplier", "f8", 6),  # impulses of the rows in the three-field step
    ("target", "f8", 6),
]

#: one stage of a Runge-Kutta step, for one body
STAGE = [
    ("speed", "f8", 6),  # linear, angular
    ("turn", "f8", 4),  # rate of the attitude, dQ/dt
    ("rate", "f8", 6),  # acceleration: linear, angular
]

#: accelerations of a body in a state (`carom.dynamics.known_end`)
KNOWN = [
    *STATE,
    ("rate", "f8", 6),
    ("power", "f8"),  # of loads on all bodies, in the first row
]

#: times on which prescribed motion depends
MOMENT = [
    ("start", "f8"),  # at which the trial step starts
    ("time", "f8"),  # of the present state
]

#: a step of an island, or of bodies that move together: between two steps nothing of it is kept
STEP = [
    ("begin", "f8"),
    ("length", "f8"),
    ("spent", "f8"),  # time of it that is done, 0 between two steps
    ("impacts", "f8"),  # entry of the ledger when the step began
    ("owed", "f8"),  # energy that friction gave since, for dropped bounces, and has not taken back
    ("first_touch", "i8"),  # rows of touches, and of events, when the island began with the step
    ("first_event", "i8"),
    ("tries", "i8"),  # pieces of the step of a crowd that were tried
    ("crowd", "i8"),  # 1 if the island moves as a crowd, and 1 if touching bodies have done so
    ("whole", "i8"),
    ("scale", "f8"),  # `Controls.step` and `Controls.pull` of the island
    ("pull", "f8"),
    ("longest", "f8"),  # step of contacts, by the applied forces at the start
    ("able", "f8"),  # work [J] that these could do over the allowed errors of positions
    ("counts", "f8", COUNTS),  # work that counts against the bounds of the island
    ("grow", "i8"),  # which arrays must grow before the loop continues
    ("since", "f8"),  # bodies and points passed since the loop was entered
    ("paused", "i8"),  # 1 if the loop was left in the middle of a trial step
]

#: search for an event inside a step: between two steps nothing of it is kept
SEARCH = [
    ("active", "i8"),
    ("kind", "i8"),
    ("contact", "i8"),
    ("side", "i8"),  # which end of the bracket moved last
    ("above", "f8"),  # values at the ends of the bracket, 0 before they are known
    ("below", "f8"),
    ("alike", "i8"),  # trials in a row that have found the value of an end once more
    ("tried", "i8"),  # trials
    ("many", "i8"),  # 1 if the search concerns several free bodies in contact with each other
    ("low", "f8"),
    ("high", "f8"),
    ("f_low", "f8"),
    ("f_high", "f8"),
    ("t", "f8"),  # last trial
    ("f", "f8"),
    ("rate", "f8"),
    ("before", "f8"),  # the same one trial before: its time, value and rate
    ("f_before", "f8"),
    ("rate_before", "f8"),
    ("width", "f8"),
    ("part", "i8"),  # 1 while its trial steps are made only for the groups that it concerns
    ("tolerance", "f8"),
    ("eager", "i8"),  # 0 if events of several points wait for the end of the step
    ("pending", "i8"),  # an action that waits until arrays have grown
    ("horizon", "f8"),  # time in which bounces may end
    ("left", "f8"),  # time to the end of the step
    ("dt", "f8"),  # the trial step,
    ("pace", "f8"),  # the longest that may be taken,
    ("sure", "f8"),  # twice the last step in which it was sure that nothing closes,
    ("cuts", "i8"),  # number of times that it was cut,
    ("counts", "f8", COUNTS),  # work that counted until it was proposed,
    ("again", "i8"),  # whether one was rejected for its error,
    ("code", "i8"),  # of the step without contacts,
    ("applied", "f8"),  # work of loads and of friction in it,
    ("friction", "f8"),
    ("order", "i8"),  # of the estimate of its error,
    ("stiff", "i8"),  # whether a trial of this step was taken by the implicit member,
    (
        "unnamed",
        "f8",
    ),  # its unexplained loss of energy, relative to the tolerance (the greatest of groups),
    ("found", "i8"),  # whether an event is at its end,
    ("residual", "f8"),  # greatest forbidden velocity that contacts have at its end [m/s]
]

#: state of a body: in FREE flight, HELD by persistent contact, at rest (RESTS)
FREE, HELD, RESTS = range(3)

#: an impact while it is computed
HIT = [
    ("W", "f8", (3, 3)),
    ("u", "f8", 3),
    ("friction", "f8"),
    ("point", "f8", 3),
    ("out", "f8", 32),
    ("restitution", "f8"),
    ("impact_law", "i8"),
    ("closed", "i8"),
    ("code", "i8"),
]


class ActiveSet(NamedTuple):
    """The active set and the states of all contacts: the first `count[0]` of `points` are in use."""

    points: np.recarray  # (P,) ACTIVE_POINT
    contact_states: np.recarray  # (C,) CONTACT_STATE
    carries: np.ndarray  # (V,) 1 for vertices that carry a persistent contact
    count: np.ndarray  # (1,)


class Work(NamedTuple):
    """Workspace of one run: it is made once and never grows."""

    body: np.recarray  # (N,) BODY_WORK
    joint: np.recarray  # (J,), at least 1, JOINT_WORK
    stages: np.recarray  # (S + 1, N) STAGE: of the S stages of a step; of a single state
    known: np.recarray  # (N,) KNOWN, of the end of the last step
    stage: np.recarray  # (N,) STATE of the present stage
    trial: np.recarray  # (N,) STATE at the end of the trial step
    part: np.recarray  # (N,) STATE at the start of the present part of a step
    middle: np.recarray  # (N,) STATE in the middle of a step of the three-field method,
    iterate: np.recarray  # (N,) STATE and at the end of it, as the last iteration left it
    mean: np.recarray  # (N,) STATE at the start of a step of RATTLE, with mean velocities
    beside: np.recarray  # (N,) STATE beside a singular position
    origin: np.recarray  # (N,) STATE from which the return map moves
    struck: np.recarray  # (1,) POINT that strikes alone
    placed: np.recarray  # (1,) POINT of which only gap or place is needed
    pair: PairWork
    touches: np.recarray  # (8,) TOUCH_POINT of the last pair
    solid_pose: np.ndarray  # (2, 7) of its solids
    hit: np.recarray  # (1,) HIT
    moment: np.recarray  # (1,) MOMENT
    step: np.recarray  # (1,) STEP
    search: np.recarray  # (1,) SEARCH
    history: np.ndarray  # (0, 16) no history inside the loop
